"""The rendezvous that is measured is the one that ships, and its counts are those that are asserted."""

import importlib.util
from pathlib import Path

import pytest

from checker import explore
from specs.elaboration import load_mission

ROOT = Path(__file__).parents[2]
SPEC = importlib.util.spec_from_file_location("benchmarks_rendezvous", ROOT / "benchmarks" / "rendezvous.py")
rendezvous = importlib.util.module_from_spec(SPEC)  # the folder is no package
SPEC.loader.exec_module(rendezvous)


def test_five_robots_are_the_mission_that_ships():
    shipped = load_mission(ROOT / "specs" / "missions" / "rendezvous.mission").initial
    assert dict(rendezvous.rendezvous(5).initial.state.items()).keys() == dict(shipped.state.items()).keys()
    assert len(rendezvous.reduced(rendezvous.rendezvous(5)).configurations) == 67


@pytest.mark.parametrize("robots", [2, 3, 4])
def test_the_full_search_has_the_counts_that_are_asserted(robots):
    found = explore(rendezvous.rendezvous(robots).initial)
    assert (len(found.configurations), found.transitions) == rendezvous.COUNTS[robots]


def test_eight_robots_are_few_configurations_when_reduced():
    found = rendezvous.reduced(rendezvous.rendezvous(8))
    assert (len(found.configurations), found.transitions) == (218, 538)


def test_one_robot_meets_nobody():
    with pytest.raises(ValueError, match="at least 2 robots, not 1"):
        rendezvous.mission_text(1)
