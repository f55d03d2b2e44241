"""The installed names of modules work in a checkout, as the same modules."""

import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest
from bigactors.semantics.state.requests import CTR

import bigactors
from bigactors.checkout import ROOMS
from hatch_build import ROOMS as BUILT

ROOT = Path(bigactors.__file__).parents[1]
MODULES = [
    "semantics",
    "semantics.rules",
    "bigraphs.notation.big.parser",
    "adapters.mavlink",
    "checker.limits",
]


PROGRAM = """
import sys
from importlib import import_module
for name in sys.argv[1:]:
    installed, own = import_module(f"bigactors.{name}"), import_module(name)
    assert installed is own is sys.modules[f"bigactors.{name}"], installed
    assert own.__name__ == own.__spec__.name == name, own.__spec__
"""


def test_a_module_is_one_under_its_installed_name():
    subprocess.run([sys.executable, "-c", PROGRAM, *MODULES], cwd=ROOT, check=True)


def test_names_are_imported_from_installed_modules_and_pickle_by_their_own():
    assert CTR is import_module("semantics.state.requests").CTR
    assert CTR.__module__ == "semantics.state.requests"


@pytest.mark.parametrize("module", ["adapters.simulated", "adapters.mavlink.new_key"])
def test_a_module_is_run_by_its_installed_name(module):
    line = [sys.executable, "-m", f"bigactors.{module}", "--help"]
    done = subprocess.run(line, cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.startswith("usage: ")


def test_an_unknown_module_is_missing_by_its_installed_name():
    with pytest.raises(ModuleNotFoundError, match=r"No module named 'bigactors\.semantics\.ruler'"):
        import_module("bigactors.semantics.ruler")


def test_the_rooms_are_those_of_the_wheel():
    assert set(ROOMS) == set(BUILT)
