"""Families with the shapes of real models: the counts without bigraphs, and what the engine finds, are BigraphER's."""

import pytest
from scripts import script

from bigraphs.exploration import explore
from bigraphs.notation import read_system

shapes = script("bigraph_shapes")


@pytest.mark.parametrize(
    ("model", "states", "transitions"),  # BigraphER 1.9.3 finds as many
    [
        (shapes.batteries(2, 20), 210, 741),
        (shapes.batteries(3, 12), 364, 2300),
        (shapes.agenda(4, 60), 161, 316),
        (shapes.agenda(2, 7), 11, 18),
        (shapes.nest(2, 5), 21, 60),
        (shapes.calls(6), 76, 300),
        (shapes.motes(4), 17, 23),
        (shapes.motes(5), 29, 50),
    ],
    ids=lambda value: getattr(value, "title", None),
)
def test_states_and_transitions_are_those_of_the_reference(model, states, transitions):
    assert (model.states, model.transitions) == (states, transitions)
    found = explore(read_system(model.text))
    assert (len(found), len(found.targets), found.complete) == (states, transitions, True)


@pytest.mark.parametrize(
    "model",
    [shapes.batteries(4, 3), shapes.agenda(3, 10), shapes.nest(3, 8), shapes.calls(5), shapes.motes(6)],
    ids=lambda model: model.title,
)
def test_other_members_agree_with_the_count_without_bigraphs(model):
    found = explore(read_system(model.text))
    assert (len(found), len(found.targets)) == (model.states, model.transitions)
