from pathlib import Path

import pytest
from scripts import script

from checker import explore
from specs import parse_bytes
from specs.elaboration import elaborate

patrol = script("patrol")
spin = script("spin")

COUNTS = {
    (1, 2): (171, 549),
    (1, 3): (390, 1_287),
    (1, 2, True): (777, 2_574),
    (1, 3, True): (1_434, 4_788),
}
TWO_UAVS = (14_232, 62_157)


def start(agents, side, handover=False):
    source, tree = parse_bytes("patrol.mission", patrol.mission_text(agents, side, handover).encode())
    return elaborate(tree, source, Path()).initial


@pytest.mark.parametrize("size", COUNTS)
def test_the_patrol_of_one_uav_has_its_counts(size):
    found = explore(start(*size))
    assert found.complete
    assert (len(found.configurations), found.transitions) == COUNTS[size]


def test_no_rule_of_the_patrol_is_idle():
    assert set(explore(start(1, 2)).rules) == {
        "actuate", "env", "fun", "rcv_obs", "req_ctr", "req_obs", "sense",
    }  # fmt: skip


def test_two_uavs_on_four_cells_have_their_counts():
    found = explore(start(2, 2))
    assert (len(found.configurations), found.transitions) == TWO_UAVS


def test_moves_return_to_the_placements_of_the_start():
    found = explore(start(1, 3))
    placements = {c.read(("placement", "uav0")) for c in found.configurations}
    spots = {c.read(("placement", "spill0")) for c in found.configurations}
    assert (len(placements), len(spots)) == (9, 3)


def test_a_uav_is_handed_over_among_three_stations():
    found = explore(start(1, 2, handover=True))
    assert {c.read(("links", "uav0")) for c in found.configurations} == {
        (f"control:gcs{station}",) for station in range(3)
    }


def test_cells_beside_each_other_are_neighbours_of_each_other():
    for side in (2, 3, 6):
        pairs = {(a, b) for a in range(side * side) for b in patrol.neighbours(a, side)}
        assert pairs == {(b, a) for a, b in pairs}
        assert len(pairs) == 4 * side * (side - 1)


@pytest.mark.parametrize("size", [(0, 2), (5, 3), (1, 1)])
def test_a_patrol_that_does_not_fit_its_grid_is_refused(size):
    with pytest.raises(ValueError, match="a patrol has 1 to 4 UAVs"):
        patrol.mission_text(*size)


@pytest.mark.skipif(bool(spin.missing()), reason=f"not installed: {', '.join(spin.missing())}")
@pytest.mark.parametrize("size", [(1, 3, True), (2, 2)])
def test_spin_counts_the_same_configurations_and_transitions(size, tmp_path):
    found = spin.search(patrol.promela_text(*size), tmp_path)
    assert (found.configurations, found.transitions) == (COUNTS | {(2, 2): TWO_UAVS})[size]
