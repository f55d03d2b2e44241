"""Symmetries of rules: which occurrences are one."""

import pytest

from bigraphs.engine.automorphisms import symmetries
from bigraphs.engine.intern_tables import InternTables
from bigraphs.engine.patterns import compile_pattern
from bigraphs.notation import read_system

CONTROLS = "ctrl R = 0; atomic ctrl A = 1; atomic ctrl B = 1; atomic ctrl M = 2;"


def count(rule):
    """Return the number of symmetries of a rule, the identity and those of twins left out."""
    text = f"{CONTROLS} big start = {{x}}; react r = {rule}; begin brs init start; rules = [ {{r}} ]; end"
    system = read_system(text)
    (found,) = system.rules()
    world = InternTables(system.signature, ("x",), 1, sharing=False)
    return len(symmetries(found, compile_pattern(world, found.redex)))


@pytest.mark.parametrize(
    ("rule", "expected"),
    [
        ("A{x} | A{y} --> B{x} | B{y}", 1),
        ("A{x} | A{y} --> B{x} | A{y}", 0),
        ("A{x} | A{x} --> B{x} | A{x}", 0),  # twins: the search keeps them in order
        ("/x A{x} | /x A{x} --> /x A{x} | /x B{x}", 1),
        ("R.(A{x} | id) || R.(A{y} | id) --> R.(B{x} | id) || R.(B{y} | id)", 1),
        ("R.(A{x} | id) || R.(A{y} | id) --> R.(A{y} | id) || R.(A{x} | id)", 1),
        ("R.(A{x} | id) || R.(A{y} | id) --> R.(A{x} | A{y} | id) || R.id", 0),
        ("R.id || R.id --> R.id || R.id @ [1, 0]", 1),
        ("R.id || R.id --> R.id || R.id @ [0, 0]", 0),
        ("M{x,y} --> M{x,x} | A{y}", 0),
        ("M{x,y} --> A{x} | A{y}", 1),
        ("A{x} || A{y} || A{z} --> B{x} || B{y} || B{z}", 5),
        ("A{x} || A{y} || A{z} --> B{x} || B{y} || A{z}", 1),
    ],
)
def test_a_symmetry_of_the_left_side_counts_if_the_right_side_has_it_too(rule, expected):
    assert count(rule) == expected
