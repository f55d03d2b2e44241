"""The rendezvous that is measured is the one that ships, and its counts are those that are asserted."""

import pytest
from scripts import BENCHMARKS, script

from checker import Reduction, explore
from checker.reduction import Reduced
from semantics.races.monitor import monitored
from specs.elaboration import load_mission

rendezvous = script("rendezvous")
spin = script("spin")


def test_five_robots_are_the_mission_that_ships():
    shipped = load_mission(BENCHMARKS.parent / "specs" / "missions" / "rendezvous.mission").initial
    assert dict(rendezvous.rendezvous(5).initial.state.items()).keys() == dict(shipped.state.items()).keys()
    assert len(rendezvous.reduced(rendezvous.rendezvous(5)).configurations) == 67


@pytest.mark.parametrize("robots", [2, 3, 4])
def test_the_full_search_has_the_counts_that_are_asserted(robots):
    found = explore(rendezvous.rendezvous(robots).initial)
    assert (len(found.configurations), found.transitions) == rendezvous.COUNTS[robots]


def test_eight_robots_are_few_configurations_when_reduced():
    found = rendezvous.reduced(rendezvous.rendezvous(8))
    assert (len(found.configurations), found.transitions) == (218, 538)


@pytest.mark.parametrize("robots", [2, 5, 8])
def test_the_reduced_search_for_stale_observations_grows_by_as_many_for_each_robot(robots):
    start = monitored(rendezvous.rendezvous(robots).initial)
    found = explore(start, reduce=Reduced(start, [Reduction.POR]))
    assert (len(found.configurations), found.transitions) == (14 * robots - 14, 14 * robots - 15)


@pytest.mark.parametrize("write", [rendezvous.mission_text, rendezvous.promela_text])
def test_one_robot_meets_nobody(write):
    with pytest.raises(ValueError, match="at least 2 robots, not 1"):
        write(1)


@pytest.mark.skipif(bool(spin.missing()), reason=f"not installed: {', '.join(spin.missing())}")
@pytest.mark.parametrize(("robots", "channels"), [(3, False), (4, False), (4, True)])
def test_spin_counts_the_same_configurations_and_transitions(robots, channels, tmp_path):
    found = spin.bounded(rendezvous.promela_text(robots, channels=channels), tmp_path, spin.Bounds())
    assert not found.bounds
    assert (found.configurations, found.transitions) == rendezvous.COUNTS[robots]


@pytest.mark.skipif(bool(spin.missing()), reason=f"not installed: {', '.join(spin.missing())}")
def test_channels_of_one_reader_and_one_writer_let_spin_reduce(tmp_path):
    found = spin.bounded(rendezvous.promela_text(4, channels=True), tmp_path, spin.Bounds(), reduced=True)
    assert (found.configurations, found.transitions) == (57, 57)
