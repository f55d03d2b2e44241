"""Expressions: operators, faults, and bounds on what a mission may compute."""

from contextlib import suppress

import pytest

from semantics.behaviours.expressions import (
    OPERATORS,
    Apply,
    EvaluationScope,
    Fault,
    Literal,
    RouteOf,
    SetOf,
    ShortCircuit,
    TupleOf,
    Variable,
    evaluate,
)
from semantics.behaviours.observations import Observation
from semantics.behaviours.values import LARGEST_NUMBER, Route, Text, Truth
from semantics.state.relations import Linked, Parent

SEEN = Observation.of(("base", "u0"), ("a",), (Parent("u0", "base"), Linked("w", "u0"), Linked("w", "u1")))


def value(expression, **store):
    return evaluate(expression, EvaluationScope("me", "u0", store, {}, {"u0": "Uav", "base": "Place"}, {}))


def of(operator, *values):
    return value(Apply(operator, tuple(map(Literal, values))))


@pytest.mark.parametrize(
    ("operator", "arguments", "expected"),
    [
        ("in", ("u0", SEEN), Truth.TRUE),
        ("in", ("a", SEEN), Truth.TRUE),
        ("in", ("u1", SEEN), Truth.FALSE),
        ("==", (1, Truth.TRUE), Truth.FALSE),
        ("!=", (1, Truth.TRUE), Truth.TRUE),
        ("<", (-2, -1), Truth.TRUE),
        ("+", (2, 3), 5),
        ("+", (frozenset({"x"}), SEEN), frozenset({"x", "base", "u0", "a"})),
        ("-", (2, 3), -1),
        ("-", (SEEN, frozenset({"u0"})), frozenset({"base", "a"})),
        ("of", (SEEN, "Uav"), frozenset({"u0"})),
        ("size", (SEEN,), 3),
        ("empty", (frozenset(),), Truth.TRUE),
        ("nodes", (SEEN,), frozenset({"base", "u0"})),
        ("agents", (SEEN,), frozenset({"a"})),
        ("parent", ("u0", SEEN), "base"),
        ("parent", ("u1", SEEN), "unknown"),
        ("children", ("base", SEEN), frozenset({"u0"})),
        ("linked", ("u0", "u1", SEEN), Truth.TRUE),
        ("linked", ("u0", "base", SEEN), Truth.FALSE),
        ("kind", ("u0",), Text("Uav")),
        ("first", (frozenset({"b", "a"}),), "a"),
        ("element", (("x", "y"), 1), "y"),
        ("in", ("b", Route(("a", "b"))), Truth.TRUE),
        ("in", ("c", Route(("a", "b"))), Truth.FALSE),
        ("==", (Route(("a", "b")), Route(("a", "b"))), Truth.TRUE),
        ("==", (Route(("a", "b")), Route(("b", "a"))), Truth.FALSE),
        ("==", (Route(("a", "b")), ("a", "b")), Truth.FALSE),
        ("==", (Route(()), frozenset()), Truth.FALSE),
        ("size", (Route(("a", "b", "a")),), 3),
        ("empty", (Route(()),), Truth.TRUE),
        ("first", (Route(("b", "a")),), "b"),
        ("element", (Route(("b", "a", "b")), 2), "b"),
        ("+", (Route(("b", "a")), Route(("b",))), Route(("b", "a", "b"))),
        ("+", (frozenset({"a"}), Route(("b", "b"))), frozenset({"a", "b"})),
        ("-", (Route(("b", "a", "b", "c")), frozenset({"a"})), Route(("b", "b", "c"))),
        ("minus", (Route(("b", "a")), Route(("b",))), Route(("a",))),
        ("intersect", (Route(("u0", "x", "u0")), SEEN), Route(("u0", "u0"))),
        ("union", (Route(("b", "a", "b")), frozenset({"c"})), frozenset({"a", "b", "c"})),
        ("of", (Route(("u0", "base", "u0")), "Uav"), Route(("u0", "u0"))),
    ],
)
def test_operators_mean_what_they_say(operator, arguments, expected):
    assert of(operator, *arguments) == expected


@pytest.mark.parametrize(
    "wrong", [7, "text", Text("text"), Truth.TRUE, (1,), frozenset({1}), Route((1,)), SEEN]
)
@pytest.mark.parametrize("name", sorted(OPERATORS))
def test_an_operator_gives_a_value_or_a_fault_of_anything(name, wrong):
    with suppress(Fault):
        assert of(name, *[wrong] * OPERATORS[name].arity) is not None


def test_and_and_or_stop_where_the_first_decides():
    broken = Apply("first", (Literal(frozenset()),))
    assert value(ShortCircuit(True, Literal(Truth.TRUE), broken)) is Truth.TRUE
    assert value(ShortCircuit(False, Literal(Truth.FALSE), broken)) is Truth.FALSE
    with pytest.raises(Fault):
        value(ShortCircuit(False, Literal(Truth.TRUE), broken))


def test_numbers_are_bounded():
    with pytest.raises(Fault, match="digits"):
        of("+", LARGEST_NUMBER - 1, 1)
    with pytest.raises(Fault, match="digits"):
        of("-", 1 - LARGEST_NUMBER, 1)


@pytest.mark.parametrize(
    "make",
    [
        lambda x: TupleOf((x, x)),
        lambda x: SetOf((x, TupleOf((x,)))),
        lambda x: RouteOf((x, x)),
        lambda x: Apply("+", (RouteOf((x,)), RouteOf((x, x)))),
    ],
)
def test_values_are_bounded(make):
    with pytest.raises(Fault, match="parts"):
        nest(make, 100)


def nest(make, times):
    nested = 1
    for _ in range(times):
        nested = value(make(Variable("x")), x=nested)


def test_routes_do_not_grow_without_bound_behind_each_other():
    route = Route(("a",) * 600)
    with pytest.raises(Fault, match="parts"):
        of("+", route, route)


def test_a_fault_prints_sets_in_order():
    with pytest.raises(Fault, match=r"\{a, b, c, d\}"):
        of("<", frozenset("dcba"), 1)
