"""What may matter of an observation: the answers that are asked, the slots that controls use, and no more."""

from small_missions import around, explore, is_in, mission, move_to, of_name, received

from checker.properties.ownership import owned
from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.expressions import Apply, Literal, QueryOf, TupleOf, Variable
from semantics.behaviours.program import Program
from semantics.behaviours.statements import Assign, ControlBy, For, ForEach, If, Migrate, Observe, Send, Spawn
from semantics.races.provenance import ANY, EVERYTHING, MEMBERS, SIZE
from semantics.races.relevance import (
    HEARD,
    SLOTS,
    anybodys,
    communicated_variables,
    heirs,
    meet,
    questions_of,
    relevant,
    slots_of,
)
from semantics.state.requests import CTR

NAMES = ("base", "sea", "area", "u0", "u1")
LOOK = Observe(of_name("CHILDREN", "area"))
ASKS = (LOOK, received("o", 2), If(is_in("u1", "o"), (3,)), move_to("area"))


def asked(statements, code, hosts=("u0", "u1")):
    c = mission(NAMES, statements, {"a": (hosts[0], code), "b": (hosts[1], ())})
    return questions_of(c, "a")


def test_what_is_tested_may_be_asked_and_nothing_else():
    assert asked(ASKS, (0, 1)) == {("in", "u1"), ("slot parent", "u0")}


def test_who_has_ended_asks_nothing():
    c = mission(NAMES, ASKS, {"a": ("u0", (0, 1)), "b": ("u1", ())})
    assert questions_of(c, "b") == frozenset()


def test_what_was_passed_is_not_asked_again():
    assert asked(ASKS, (3,)) == {("slot parent", "u0")}


def test_a_name_that_is_computed_may_be_any():
    statements = (Assign("x", Apply("parent", (Variable("y"), Variable("o")))),)
    assert asked(statements, (0,)) == {("parent", ANY)}


def test_what_is_not_known_yet_may_be_an_observation_or_hold_one():
    number = Assign("n", Apply("size", (Variable("o"),)))
    found = Assign("x", Apply("in", (Variable("p"), Variable("o"))))
    assert asked((number,), (0,)) == {SIZE, EVERYTHING}
    assert asked((found,), (0,)) == {("in", ANY), EVERYTHING}


def test_going_through_an_observation_asks_who_its_members_are_or_for_all_of_one_among_them():
    statements = (For(Variable("o"), "rest", 1), ForEach("x", "rest", (2,)), move_to("area"))
    assert {MEMBERS, EVERYTHING} <= asked(statements, (0,))


def test_a_control_may_use_the_slots_of_every_place_that_its_argument_may_name():
    statements = (ControlBy("MOVE", (Variable("x"), Variable("y"))),)
    slots = {name for kind, name in asked(statements, (0,)) if kind == "slot parent"}
    assert {"u0", "u1"} <= slots


def test_what_is_passed_on_the_way_is_context_of_which_no_slot_is_used():
    straight, round_about = (move_to("area"), ControlBy("MOVE_HOST_TO", (Literal("area"), Literal("sea"))))
    assert asked((straight,), (0,)) == asked((round_about,), (0,)) == {("slot parent", "u0")}


def test_a_control_that_may_name_too_much_may_use_any_slot():
    way = ControlBy("MOVE_HOST_TO", tuple(map(Variable, "uvwxyz")))
    assert asked((way,), (0,)) == SLOTS
    assert not owned(mission(NAMES, (way,), {"a": ("u0", (0,)), "b": ("u1", (0,))}))


def test_who_may_migrate_may_be_anywhere():
    statements = (*ASKS, Migrate(Variable("h")))
    assert {("slot parent", "u0"), ("slot parent", "u1")} <= asked(statements, (0, 1))


def test_who_sends_may_tell_what_others_ask():
    statements = (*ASKS, Send(Variable("o"), Variable("to")))
    c = mission(NAMES, statements, {"a": ("u0", (4,)), "b": ("u1", (0, 1))})
    assert questions_of(c, "a") == anybodys(c)
    assert {("in", "u1"), ("slot parent", "u0"), ("slot parent", "u1")} <= anybodys(c)


def test_a_query_asks_too():
    statements = (Observe(around()),)
    assert asked(statements, (0,)) == frozenset()


def test_questions_meet_where_one_may_be_the_other():
    anyone, u0, u1 = (frozenset({("in", name)}) for name in (ANY, "u0", "u1"))
    assert meet(anyone, u0)
    assert meet(u0, anyone)
    assert meet(u0, u0)
    assert not meet(u0, u1)
    assert not meet(frozenset({("parent", ANY)}), u0)
    assert relevant([("in", "u0"), ("parent", "u0"), EVERYTHING], anyone) == u0


def test_the_slots_of_a_redex_are_among_what_its_agent_may_ask():
    c = mission(NAMES, ASKS, {"a": ("u0", (0, 1)), "b": ("u1", (3,))})
    pending = [
        each.request
        for found in explore(c).configurations
        for agent in ("a", "b")
        for each in found.eta.of(agent)
        if isinstance(each.request, CTR)
    ]
    assert pending
    assert all(slots_of(request.reaction.redex) <= questions_of(c, request.agent) for request in pending)


def told(statements, code):
    return communicated_variables(Program(tuple(statements), {}, COMMANDS), code)


def test_nobody_is_told_of_what_only_decides():
    statements = (
        *ASKS,
        Assign("x", is_in("u1", "o")),
        If(Variable("x"), (6,)),
        Send(Literal("go"), Variable("y")),
    )
    assert told(statements, (0, 1, 4, 5)) == frozenset()


def test_what_a_message_is_computed_from_may_be_told():
    statements = (
        *ASKS,
        Assign("x", is_in("u1", "o")),
        Send(TupleOf((Literal("n"), Variable("x"))), Literal("b")),
    )
    assert told(statements, (0, 1, 4, 5)) == {"x", "o", HEARD}
    assert told(statements, (0, 4)) == frozenset()


def test_what_a_query_is_asked_of_is_told_with_what_it_shows():
    statements = (
        Observe(QueryOf("CHILDREN", QueryOf(None, Variable("place")))),
        received("o", 2),
        Send(Variable("o"), Literal("b")),
    )
    assert told(statements, (0, 1)) == {"o", "place", HEARD}


def heirs_of(code, *statements):
    return heirs(Program((*ASKS, *statements), {}, COMMANDS), code)


def test_whoever_is_ever_told_anything_may_come_to_hold_what_is_told():
    sends = (Send(Variable("o"), Literal("b")), Send(Literal("go"), Literal("c")))
    assert heirs_of((0, 1, 4), *sends) == {"b", "c"}
    assert heirs_of((4,), Send(Variable("o"), Variable("to"))) == {ANY}
    assert heirs_of((4,), Spawn("d", Literal("u0"), "wait", ())) == {"d"}


def test_who_tells_nobody_anything_has_no_heirs():
    assert heirs_of((0, 1), Send(Variable("o"), Literal("b"))) == frozenset()
