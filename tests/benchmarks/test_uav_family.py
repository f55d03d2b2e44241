"""The UAV family: the counts without bigraphs, and what the engine finds, are those that BigraphER finds."""

import sys
from pathlib import Path

import pytest

from bigraphs.exploration import explore
from bigraphs.notation import read_system

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from uav_family import Case, counts, text


@pytest.mark.parametrize(
    ("case", "states", "transitions"),
    [
        (Case("row", 3, 4, distinct=False, open=True), 120, 720),
        (Case("row", 4, 4, distinct=False, open=True), 330, 2400),
        (Case("row", 3, 4, distinct=True, open=True), 512, 3840),
        (Case("ring", 5, 6, distinct=False, open=False), 204, 2060),
        (Case("3x3", 2, 9, distinct=False, open=True), 171, 1188),
        (Case("3x3", 3, 9, distinct=False, open=False), 96, 775),
    ],
    ids=str,
)
def test_states_and_transitions_are_those_of_the_reference(case, states, transitions):
    assert counts(case) == (states, transitions)
    found = explore(read_system(text(case)))
    assert (len(found), len(found.starts), found.complete) == (states, transitions, True)


@pytest.mark.parametrize(
    "case",
    [
        Case("row", 2, 3, distinct=True, open=False, stations=3),
        Case("ring", 2, 5, distinct=True, open=False),
        Case("2x2", 3, 4, distinct=False, open=False, stations=3),
    ],
    ids=str,
)
def test_other_members_agree_with_the_count_without_bigraphs(case):
    found = explore(read_system(text(case)))
    assert (len(found), len(found.starts)) == counts(case)
