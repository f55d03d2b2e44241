"""Internal computation: liveness, loops, calls, and what is gone through."""

from hypothesis import given
from small_missions import mission

from semantics import hypothesis_strategies
from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.computation import members_of
from semantics.behaviours.expressions import Apply, Literal, RouteOf, SetOf, Variable
from semantics.behaviours.observations import Observation
from semantics.behaviours.program import Behaviour, Program
from semantics.behaviours.statements import (
    Assign,
    Call,
    ChooseFrom,
    Display,
    For,
    ForEach,
    If,
    While,
)
from semantics.behaviours.values import Truth
from semantics.rules import fun


def shown(*statements, code=(0,), behaviours=None):
    program = Program(tuple(statements), behaviours or {}, COMMANDS)
    c = mission(["u0"], agents={"a": ("u0", code)}, program=program)
    (t,) = fun(c, "a")
    return t


def test_for_goes_through_a_set_in_canonical_order():
    members = SetOf((Literal("b"), Literal(2), Literal(-1), Literal("a")))
    t = shown(For(members, "#x", 1), ForEach("x", "#x", (2,)), Display(Variable("x")))
    assert t.shown == ("-1", "2", "a", "b")


def test_for_goes_through_a_route_in_its_order_and_as_often_as_it_passes():
    stops = RouteOf((Literal("b"), Literal("a"), Literal("b")))
    t = shown(For(stops, "#x", 1), ForEach("x", "#x", (2,)), Display(Variable("x")))
    assert t.shown == ("b", "a", "b")


def test_choose_takes_each_stop_of_a_route_once():
    stops = RouteOf((Literal("b"), Literal("a"), Literal("b")))
    program = Program((ChooseFrom("x", stops, (1,)), Display(Variable("x"))), {}, COMMANDS)
    c = mission(["u0"], agents={"a": ("u0", (0,))}, program=program)
    assert [t.shown for t in fun(c, "a")] == [("b",), ("a",)]


def test_an_observation_is_gone_through_by_all_that_it_shows():
    assert members_of(Observation.of(("base", "u0"), ("a",))) == ("a", "base", "u0")


def test_while_runs_as_long_as_its_test_holds():
    less = Apply("<", (Variable("i"), Literal(3)))
    t = shown(
        Assign("i", Literal(0)),
        While(less, (2, 3)),
        Display(Variable("i")),
        Assign("i", Apply("+", (Variable("i"), Literal(1)))),
        code=(0, 1),
    )
    assert t.shown == ("0", "1", "2")


def test_a_call_binds_all_arguments_before_any_parameter():
    swap = {"swap": Behaviour("swap", ("x", "y"), (2, 3))}
    t = shown(
        Assign("x", Literal(1)),
        Call("swap", (Literal(2), Variable("x"))),
        Display(Variable("x")),
        Display(Variable("y")),
        code=(0, 1),
        behaviours=swap,
    )
    assert t.shown == ("2", "1")


def test_what_follows_an_if_runs_either_way():
    for truth, expected in ((Truth.TRUE, ("1", "3")), (Truth.FALSE, ("2", "3"))):
        t = shown(If(Literal(truth), (1,), (2,)), *(Display(Literal(n)) for n in (1, 2, 3)), code=(0, 3))
        assert t.shown == expected


@given(hypothesis_strategies.configurations())
def test_the_store_holds_just_what_may_still_be_read(c):
    for agent in c.alpha.names():
        live = c.setting.program.live(c.alpha.code(agent))
        assert {name for name, _ in c.alpha.store(agent)} <= live
