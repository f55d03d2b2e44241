"""What is told of compiling: at the first start, and not when what was compiled is loaded."""

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.long

PROGRAM = """
from checker import Engine, check
from specs.elaboration import load_mission
from specs.missions import shipped_missions
mission = load_mission(shipped_missions()["oil_spill"])
told = []
check(mission, report=told.append, engine=Engine.FAST)
print(max((progress.compiling for progress in told), default=0))
"""
NOWHERE = """
import sys, tempfile
def refuse(*args, **settings): raise PermissionError(13, "this file system is read-only")
tempfile.TemporaryFile = refuse  # by which numba tries whether it may write
from bigactors.cli import main
sys.exit(main(["check", "--engine", "fast", "oil_spill"]))
"""


def run(program, **environment):
    return subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | environment,
    )


LIMITED = """
import sys
from bigactors.cli import main
sys.exit(main(["check", "--engine", "fast", "--max-time", "2", "oil_spill"]))
"""


def test_compiling_counts_to_no_limit_of_time_and_is_said_off_a_terminal(tmp_path):
    first, second = (run(LIMITED, NUMBA_CACHE_DIR=str(tmp_path)) for _ in range(2))
    assert (first.returncode, second.returncode) == (0, 0)
    assert "complete" in first.stdout
    assert first.stderr == "oil_spill: compiling loops, some seconds once after an installation\n"
    assert second.stderr == ""


def test_compiling_is_reported_once_after_an_installation(tmp_path):
    first, second = (run(PROGRAM, NUMBA_CACHE_DIR=str(tmp_path)) for _ in range(2))
    assert (first.stderr, second.stderr) == ("", "")
    assert int(first.stdout) > 10
    assert int(second.stdout) == 0


def test_where_nothing_compiled_can_be_kept_the_remedy_is_told():
    found = run(NOWHERE)
    assert (found.returncode, found.stdout) == (3, "")
    assert found.stderr.splitlines() == [
        "oil_spill: numba has no writable folder here for its compiled loops",
        "  hint: set NUMBA_CACHE_DIR to a folder that you may write, or add --engine reference",
    ]


COV = """
import numpy as np
from numba import njit
from checker import Engine, check
from specs.elaboration import load_mission
from specs.missions import shipped_missions
mission = load_mission(shipped_missions()["oil_spill"])
check(mission, engine=Engine.FAST)
print(njit(lambda a: np.cov(a))(np.array([1.0, 2.0, 3.0])))
"""


def test_what_others_compile_in_the_process_finds_its_linear_algebra():
    found = run(COV)
    assert (found.stdout, found.stderr) == ("1.0\n", "")
