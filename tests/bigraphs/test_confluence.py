"""Instantaneous rules are taken in the order of their class; where another order ends elsewhere, both ends are told."""

import pytest

from bigraphs.canonical_form import equal
from bigraphs.confluence import Orders, compare_orders
from bigraphs.exploration import explore
from bigraphs.notation import read_system, write_big

ORDER = """
atomic ctrl A = 0; atomic ctrl B = 0; atomic ctrl C = 0; atomic ctrl D = 0; atomic ctrl E = 0;
big s = A;
react ab = A --> B;
react ac = A --> C;
react bd = B --> D;
react ce = C --> E;
begin brs
  init s;
  rules = [ RULES ];
end
"""


def told(text, most=1_000):
    found = compare_orders(read_system(text), most).divergence
    assert found is not None
    return (
        write_big(found.state),
        *((way.rule, write_big(way.outcome)) for way in (found.taken, found.other)),
    )


@pytest.mark.parametrize(
    ("order", "taken", "other"),
    [("ac, ab", ("ac", "C"), ("ab", "B")), ("ab, ac", ("ab", "B"), ("ac", "C"))],
)
def test_the_first_rule_of_a_class_is_taken_and_the_other_outcome_is_told(order, taken, other):
    text = ORDER.replace("RULES", f"({order}), {{bd, ce}}")
    assert told(text) == ("A", taken, other)
    found = explore(read_system(text))
    assert write_big(found.state(0)) == taken[1]


def test_a_class_is_told_by_where_it_stands():
    found = compare_orders(read_system(ORDER.replace("RULES", "(ac, ab), {bd, ce}"))).divergence
    assert found is not None
    assert str(found.rules.position) == "10:13"


def test_orders_that_end_alike_are_not_told():
    text = ORDER.replace("RULES", "(ab, ac, bd, ce2), {x}").replace(
        "begin brs", "react ce2 = C --> D; react x = E --> A; begin brs"
    )
    assert compare_orders(read_system(text)) == Orders(None, complete=True)


def test_a_system_without_instantaneous_rules_has_no_order():
    assert compare_orders(read_system(ORDER.replace("RULES", "{ab, ac, bd, ce}"))) == Orders(
        None, complete=True
    )


def test_what_a_later_class_makes_equal_is_not_told():
    text = ORDER.replace("RULES", "(ab, ac), (bd, cd), {x}").replace(
        "begin brs", "react cd = C --> D; react x = E --> A; begin brs"
    )
    assert compare_orders(read_system(text)) == Orders(None, complete=True)


def test_a_class_that_comes_after_an_ordinary_step_is_looked_at_too():
    text = ORDER.replace("RULES", "(bc, bd), {ab, ce}").replace("begin brs", "react bc = B --> C; begin brs")
    assert told(text) == ("B", ("bc", "C"), ("bd", "D"))


def test_of_several_steps_the_last_state_is_told_from_which_the_ends_differ():
    text = (
        ORDER.replace("RULES", "(ea, ac, ab), {bd, ce}")
        .replace("big s = A;", "big s = E;")
        .replace("begin brs", "react ea = E --> A; begin brs")
    )
    assert told(text) == ("A", ("ac", "C"), ("ab", "B"))


def test_one_rule_that_applies_in_two_places_is_told_too():
    text = """
    ctrl Box = 0; atomic ctrl Ball = 0; atomic ctrl Mark = 0; ctrl Red = 0;
    big start = Box.(Ball | Red.1) | Box.Ball;
    react empty = Box.(Ball | id) --> Box.(Mark | id) if !Mark in ctx;
    react still = Mark --> Mark;
    begin brs init start; rules = [ (empty), {still} ]; end
    """
    told = compare_orders(read_system(text)).divergence
    assert told is not None
    assert told.taken.rule == told.other.rule == "empty"
    assert not equal(told.taken.outcome, told.other.outcome)
    assert equal(explore(read_system(text)).state(0), told.taken.outcome)


def test_a_way_round_in_circles_has_no_end():
    text = ORDER.replace("RULES", "(ab, ba, ac), {ce}").replace("begin brs", "react ba = B --> A; begin brs")
    assert compare_orders(read_system(text)).divergence is None


def test_what_grows_for_ever_ends_the_search():
    text = """
    ctrl A = 0; atomic ctrl B = 0; big s = A.1; react grow = A --> A.A; react x = B --> B;
    begin brs init s; rules = [ (grow), {x} ]; end
    """
    assert compare_orders(read_system(text), most=50) == Orders(None, complete=False)


def test_too_many_orders_are_said_to_be_not_all():
    balls = " | ".join("ABCDEFGH")
    text = (
        "".join(f"atomic ctrl {name} = 0; atomic ctrl {name}{name} = 0;" for name in "ABCDEFGH")
        + f"big s = {balls};"
        + "".join(f"react r{name.lower()} = {name} --> {name}{name};" for name in "ABCDEFGH")
        + f"begin brs init s; rules = [ ({', '.join(f'r{name.lower()}' for name in 'ABCDEFG')}), {{rh}} ]; end"
    )
    assert compare_orders(read_system(text), most=2_000) == Orders(None, complete=True)
    assert compare_orders(read_system(text), most=50) == Orders(None, complete=False)


QUEUE = """
fun ctrl A(n) = 0; atomic ctrl S = 0; ctrl Q = 0; ctrl Done = 0;
big s = Q.(A(1).1 | A(2).1 | A(3).1) | Done.1 | S;
fun react go(n) = S | Q.(A(n) | id) | Done.1 --> S | Q.id | Done.A(n) @ [1, 0];
react x = S | S --> S;
fun big which(n) = Done.A(n);
begin brs
  int n = VALUES;
  init s;
  rules = [ (go(n)), {x} ];
  preds = { which(n) };
end
"""


@pytest.mark.parametrize(
    ("values", "first"),
    [("[1 : 1 : 3]", 1), ("[3 : 1 : 3]", 3), ("{1, 2, 3}", 3), ("{3, 1, 2}", 3)],
)
def test_the_instances_of_a_rule_come_in_bigraphers_order(values, first):
    """BigraphER was run on these: a range from its first value up, a set from its greatest value down."""
    found = explore(read_system(QUEUE.replace("VALUES", values)))
    assert [found.labels_of(number) for number in range(len(found))] == [(f"which({first})",)]
