from pathlib import Path

import pytest
from scale import long_ones
from scripts import script

from checker import Engine, explore
from specs import parse_bytes
from specs.elaboration import elaborate

patrol = script("patrol")
spin = script("spin")

COUNTS = {
    (1, 2): (171, 549),
    (1, 3): (390, 1_287),
    (1, 2, True): (777, 2_574),
    (1, 3, True): (1_434, 4_788),
    (2, 2): (14_232, 62_157),
}


def start(agents, side, handover=False):
    source, tree = parse_bytes("patrol.mission", patrol.mission_text(agents, side, handover).encode())
    return elaborate(tree, source, Path()).initial


@pytest.mark.parametrize("size", COUNTS)
def test_the_patrol_has_its_counts(size):
    found = explore(start(*size), engine=Engine.REFERENCE if size[0] == 1 else Engine.FAST)
    assert found.complete
    assert (len(found.configurations), found.transitions) == COUNTS[size]


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
@pytest.mark.parametrize("size", [*long_ones(((1, 3, True),)), (2, 2)])
def test_spin_counts_the_same_configurations_and_transitions(size, tmp_path):
    found = spin.search(patrol.promela_text(*size), tmp_path)
    assert (found.configurations, found.transitions) == COUNTS[size]
