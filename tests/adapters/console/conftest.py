"""Lets the tests of this folder import the modules beside them, and those of live runs; flies what they look at."""

import fcntl
import os
import subprocess
import sys
from contextlib import suppress
from functools import partial
from pathlib import Path

import pytest

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "live")]

from live_missions import WEST  # noqa: E402 - found by the line before
from recorded import Tape, eventful, uav  # noqa: E402


@pytest.fixture(scope="session")
def spill_watch(tmp_path_factory):
    """Return the recording of spill_watch, flown by the simulated plane of `make live-demo`: once for all workers."""
    shared = tmp_path_factory.getbasetemp()
    shared = shared.parent if "PYTEST_XDIST_WORKER" in os.environ else shared
    folder, flying = shared / "spill_watch", shared / "spill_watch_flying"
    with (shared / "spill_watch.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not folder.exists():
            line = [sys.executable, "-m", "bigactors.live_demo", str(flying)]
            subprocess.run(line, check=True, capture_output=True, timeout=300)
            flying.rename(folder)
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
