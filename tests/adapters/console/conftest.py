"""Lets the tests of this folder import the modules beside them, and those of live runs; flies what they look at."""

import subprocess
import sys
from contextlib import suppress
from functools import partial
from pathlib import Path

import pytest

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "live")]

from browsers import DESK, Watch, chromium  # noqa: E402 - found by the line before
from live_missions import WEST  # noqa: E402
from once import once  # noqa: E402
from page_harness import PAGE  # noqa: E402
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
    subprocess.run(line, check=True, capture_output=True, timeout=300)


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
def taped(request):
    """Return what begins a recording that is still being written."""

    def begin(folder):
        tape = Tape(folder / "run.mcap")
        request.addfinalizer(partial(_close, tape))
        tape.turn(0, uav(WEST, 0))
        return tape

    return begin


def _close(tape):
    with suppress(ValueError):  # it was closed by the test
        tape.recorder.close("over", 2000.0)


@pytest.fixture(scope="module")
def browser():
    if not (PAGE / "parts" / "preact.js").exists():
        pytest.skip("the page has no parts: `make parts` fetches them")
    with chromium() as found:
        yield found


DRAWN = "html[data-drawn]"


@pytest.fixture
def shown(browser):
    """Show a harness in a page until its first frame is drawn whole; at the end, nothing may have gone wrong there."""
    pages = []

    def show(harness, size=DESK, refused=(), name="Ana", until=DRAWN, **options):
        watch = Watch()
        page = browser.new_page(viewport=size, **options)
        watch.over(page, harness.link.partition("#")[0])
        page.set_default_timeout(60_000)
        page.add_init_script(f"if (location.port) localStorage['bigactors.name'] ??= {name!r}")
        page.goto(harness.link)
        page.locator(until).wait_for()
        pages.append((page, watch, refused))
        return page

    yield show
    for page, watch, refused in pages:
        page.close()
        watch.forgive("ERR_CONNECTION_REFUSED", *refused)
        watch.saw_nothing()
