"""Lets the tests of this folder import the modules beside them, and those of live runs; flies what they look at."""

import subprocess
import sys
from contextlib import suppress
from functools import partial
from pathlib import Path

import pytest

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "live")]

from live_missions import WEST  # noqa: E402 - found by the line before
from once import once  # noqa: E402
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
