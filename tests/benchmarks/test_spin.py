"""SPIN counts as many configurations and transitions of the same models in Promela."""

from pathlib import Path

import pytest
from oracles import oil_spill_in_promela as oil_spill
from oracles import rendezvous_in_promela as rendezvous
from scale import long_ones
from scripts import BENCHMARKS, script

from checker import Reduction, explore
from checker.reduction import Reduced
from semantics.races.monitor import monitored
from specs import parse_bytes
from specs.elaboration import elaborate, load_mission

spin = script("spin")

MISSIONS = BENCHMARKS.parent / "specs" / "missions"
needs_spin = pytest.mark.skipif(bool(spin.missing()), reason=f"not installed: {', '.join(spin.missing())}")


def start(model, *size):
    source, tree = parse_bytes("model.mission", model.mission_text(*size).encode())
    return elaborate(tree, source, Path())


def reduced(mission):
    formulas = [each.formula for each in mission.properties if each.kind.has_proposition]
    return explore(mission.initial, reduce=Reduced(mission.initial, [Reduction.POR], formulas))


def counts(found):
    assert found.complete
    return len(found.configurations), found.transitions


def test_one_uav_and_one_spill_have_the_counts_of_the_mission_that_ships():
    shipped = explore(load_mission(MISSIONS / "oil_spill.mission").initial)
    assert counts(explore(start(oil_spill, 1).initial)) == counts(shipped)


@pytest.mark.parametrize(("uavs", "spills", "known"), [(2, 1, (510, 1_438)), (2, 2, (1_530, 6_354))])
def test_several_uavs_and_spills_have_their_counts(uavs, spills, known):
    assert counts(explore(start(oil_spill, uavs, spills).initial)) == known


@needs_spin
@pytest.mark.parametrize(
    ("uavs", "spills", "known"), [(2, 1, (510, 1_438)), *long_ones((2, 2, (1_530, 6_354)))]
)
def test_spin_counts_as_many_for_several_uavs_and_spills(uavs, spills, known, tmp_path):
    found = spin.search(oil_spill.promela_text(uavs, spills), tmp_path)
    assert (found.configurations, found.transitions) == known


def test_five_robots_are_the_mission_that_ships():
    shipped = load_mission(MISSIONS / "rendezvous.mission").initial
    five = start(rendezvous, 5)
    assert dict(five.initial.state.items()).keys() == dict(shipped.state.items()).keys()
    assert len(reduced(five).configurations) == 67


@pytest.mark.parametrize("robots", [2, 3, 4])
def test_robots_have_the_counts_of_the_full_search(robots):
    assert counts(explore(start(rendezvous, robots).initial)) == rendezvous.COUNTS[robots]


def test_eight_robots_are_few_configurations_when_reduced():
    assert counts(reduced(start(rendezvous, 8))) == (218, 538)


@pytest.mark.parametrize("robots", [2, 5, 8])
def test_the_reduced_search_for_stale_observations_grows_by_as_many_for_each_robot(robots):
    initial = monitored(start(rendezvous, robots).initial)
    found = explore(initial, reduce=Reduced(initial, [Reduction.POR]))
    assert counts(found) == (14 * robots - 14, 14 * robots - 15)


@needs_spin
@pytest.mark.parametrize("robots", [3, *long_ones(4)])
def test_spin_counts_as_many_for_several_robots(robots, tmp_path):
    found = spin.search(rendezvous.promela_text(robots), tmp_path)
    assert (found.configurations, found.transitions) == rendezvous.COUNTS[robots]
