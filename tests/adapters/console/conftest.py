"""Lets the tests of this folder import the modules beside them, and those of live runs; flies what they look at."""

import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import pytest

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "live")]

from browsers import DESK, Watch, chromium  # noqa: E402 - found by the line before
from live_missions import WEST  # noqa: E402
from once import once  # noqa: E402
from page_driving import Operator  # noqa: E402
from page_harness import PAGE, Harness, world  # noqa: E402
from recorded import Tape, eventful, uav  # noqa: E402


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Count what looks at a whole flight among the long tests."""
    for item in items:
        if "spill_watch" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.long)


def fly(folder):
    """Fly the live demonstration into a folder."""
    line = [sys.executable, "-m", "bigactors.live_demo", str(folder)]
    subprocess.run(line, check=True, capture_output=True, timeout=560)


@pytest.fixture(scope="session")
def spill_watch(tmp_path_factory):
    """Return the recording of spill_watch, flown by the simulated plane of `make live-demo`: once for all workers."""
    folder = once(tmp_path_factory, "spill_watch", fly)
    return folder / "run.mcap"


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    path = tmp_path_factory.mktemp("console") / "run.mcap"
    eventful(path)
    return path


@pytest.fixture
def tape(tmp_path):
    """Return a run that is recorded as it goes."""
    with Tape(tmp_path / "r.mcap") as begun:
        yield begun


@pytest.fixture
def flight(tape):
    """Return a run in which the vehicle was heard in the west."""
    tape.turn(0, uav(WEST, 0))
    return tape


@pytest.fixture(scope="module")
def browser():
    if not (PAGE / "parts" / "preact.js").exists():
        pytest.skip("the page has no parts: `make parts` fetches them")
    with chromium() as found:
        yield found


@pytest.fixture
def operates(browser):
    """Seat an operator before a page of a state, or of another's harness; at the end, nothing may have gone wrong."""
    seats, harnesses = [], ExitStack()

    def seat(served=None, *, size=DESK, refused=(), name="Ana", has_touch=False, **options):
        if not isinstance(served, Harness):
            served = harnesses.enter_context(Harness(served or world(), **options))
        watch = Watch()
        page = browser.new_page(viewport=size, has_touch=has_touch)
        watch.over(page, served.link.partition("#")[0])
        seats.append((page, watch, refused))
        return Operator(page, served, name)

    yield seat
    for page, _, _ in seats:
        page.close()
    harnesses.close()
    for _, watch, refused in seats:
        watch.forgive("net::ERR_CONNECTION", *refused)
        watch.saw_nothing()
