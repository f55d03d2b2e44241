"""Views of equal configurations are equal, those that say otherwise are not, and none is compared unseen in a rule."""

import pytest
from hypothesis import given
from scale import examples

from checker.recording.access_recording import CellRecorder
from semantics import successors
from semantics.hypothesis_strategies import configurations
from semantics.state.cell_values import Written
from semantics.state.logical_model import LogicalModel, parent_cell


def views(configuration):
    structure = configuration.structure
    return {
        "alpha": configuration.alpha,
        "structure": structure,
        "logical": structure.logical,
        "physical": structure.physical,
        "eta": configuration.eta,
    }


@examples(30)
@given(configurations())
def test_views_are_equal_where_they_say_the_same(configuration):
    again = configuration.with_({})
    assert views(configuration) == views(again)
    assert list(map(hash, views(configuration).values())) == list(map(hash, views(again).values()))
    for transition in successors(configuration):
        after = transition.target
        same = [name for name, view in views(after).items() if view == views(configuration)[name]]
        if {"alpha", "structure", "eta"} <= set(same):
            assert after.unmonitored() == configuration.unmonitored() or "down" in str(after)
        assert ("structure" in same) == ({"logical", "physical"} <= set(same))


@examples(20)
@given(configurations())
def test_a_view_that_says_otherwise_is_another(configuration):
    for name in configuration.structure.logical.nodes()[:3]:
        changed = configuration.with_({parent_cell(name): None})
        assert changed.structure.logical != configuration.structure.logical
        assert changed.structure != configuration.structure
        assert changed.structure.physical == configuration.structure.physical
        assert changed.alpha == configuration.alpha
    assert configuration.structure.logical != configuration.structure.physical
    assert configuration.eta != "eta"


@given(configurations())
@examples(5)
def test_a_view_is_not_compared_within_a_rule(configuration):
    logical = configuration.structure.logical
    recorder = CellRecorder(None, configuration.state, lambda _: True, frozenset())
    for cells in (recorder, Written(configuration, {})):
        within = LogicalModel(cells, logical.sorting)
        with pytest.raises(TypeError, match="compared within a rule"):
            assert within == logical
        with pytest.raises(TypeError, match="compared within a rule"):
            hash(within)
