"""Stale-observation races: what a control rests on, and what others have changed in it."""

from hypothesis import given
from scale import examples
from small_missions import GUARD, around, explore, is_in, mission, move_to, of_name, received

from semantics import hypothesis_strategies
from semantics.behaviours.expressions import Apply, Fault, Literal, TupleOf, Variable
from semantics.behaviours.patterns import Anything, Elements, Exactly
from semantics.behaviours.statements import (
    After,
    Assign,
    Case,
    ChooseFrom,
    ControlBy,
    For,
    ForEach,
    If,
    Migrate,
    Observe,
    React,
    Send,
)
from semantics.behaviours.values import Truth
from semantics.control import applicable
from semantics.races.monitor import CONTROLS, monitored, slots_used, stale_tests
from semantics.state.requests import FLY
from semantics.state.setting import Control, Scheduler
from semantics.successors import successors

LOOK = Observe(of_name("CHILDREN", "area"))
NOT_U1 = Apply("not", (is_in("u1", "o"),))


def stale(start) -> set[str]:
    """Return the agents whose control is served somewhere though what it rests on was changed by another."""
    return {
        transition.label.agent
        for before, transition in explore(start).transitions
        if is_stale(before, transition)
    }


def is_stale(c, transition) -> bool:
    if transition.label.rule not in CONTROLS:
        return False
    request, redex = transition.served.request, transition.served.request.reaction.redex
    found = [request.match] if isinstance(request, FLY) else applicable(c, request.agent, request.reaction)
    used = [slots_used(m.relations(redex), tuple(node for node, _ in m.closed(redex))) for m in found]
    return bool(stale_tests(request, transition.served.rests_on, frozenset().union(*used)))


def two(statements, a, b, names=("base", "sea", "area", "u0", "u1"), **more):
    more = {"monitored": True} | more
    return mission(names, statements, {"a": ("u0", a), "b": ("u1", b)}, **more)


def look_before_entering(place_of_b="area", **more):
    statements = (
        LOOK,
        received("o", 2),
        If(NOT_U1, (3,)),
        move_to("area"),
        Observe(of_name("CHILDREN", place_of_b)),
        received("p", 6),
        If(Apply("not", (is_in("u0", "p"),)), (7,)),
        move_to(place_of_b),
    )
    return two(statements, (0, 1), (4, 5), **more)


def test_two_that_each_saw_a_place_empty_and_both_enter_are_racing():
    for control in Control:
        for scheduler in (Scheduler.PROGRAM_ORDER, Scheduler.FCFS):
            assert stale(look_before_entering(control=control, scheduler=scheduler)) == {"a", "b"}


def test_two_that_work_apart_from_a_common_base_are_not_racing():
    for control in Control:
        assert (
            stale(
                look_before_entering(
                    place_of_b="sea", names=("base", "sea", "area", "u0", "u1"), control=control
                )
            )
            <= set()
        )


def test_a_control_that_tests_nothing_rests_on_nothing():
    statements = (LOOK, received("o", 2), move_to("area"), move_to("area"))
    assert stale(two(statements, (0, 1), (3,))) == set()


def test_one_agents_own_moves_make_nothing_of_its_own_stale():
    statements = (
        LOOK,
        received("o", 2),
        If(Apply("not", (is_in("u0", "o"),)), (3, 4)),
        move_to("area"),
        move_to("base"),
    )
    assert stale(two(statements, (0, 1), ())) == set()


def test_a_value_computed_from_an_observation_carries_it():
    statements = (
        LOOK,
        received("o", 2, 3),
        Assign("x", NOT_U1),
        If(Variable("x"), (4,)),
        move_to("area"),
        move_to("area"),
    )
    assert stale(two(statements, (0, 1), (5,))) == {"a"}


def test_an_argument_computed_from_an_observation_carries_it():
    target = Apply("parent", (Literal("u1"), Variable("o")))
    statements = (Observe(around()), received("o", 2), ControlBy("MOVE_HOST_TO", (target,)), move_to("area"))
    assert stale(two(statements, (0, 1), (3,))) == {"a"}


def test_going_through_an_observation_carries_it():
    members = Apply("nodes", (Variable("o"),))  # the place that is looked at, too
    ways = (
        (For(members, "#x", 3), ForEach("x", "#x", (4,))),
        (ChooseFrom("x", members, (4,)), Assign("unused", Literal(1))),
    )
    for way in ways:
        statements = (
            Observe(around()),
            received("o", 2),
            *way,
            ControlBy("MOVE_HOST_TO", (Variable("x"),)),
            move_to("area"),
        )
        start = two(statements, (0, 1), (5,))
        assert stale(start) == {"a"}


def test_a_message_carries_what_its_sender_saw():
    statements = (
        LOOK,
        received("o", 2),
        Send(NOT_U1, Literal("b")),
        React((Case(Anything("m", "message"), None, (4,)),)),
        If(Variable("m"), (5,)),
        move_to("area"),
        move_to("area"),
    )
    agents = {"a": ("u0", (0, 1)), "b": ("u0", (3,)), "c": ("u1", (6,))}
    start = mission(["base", "area", "u0", "u1"], statements, agents, monitored=True)
    assert stale(start) == {"b"}


def reacting(*cases, after=None, then=()):
    """Return a mission in which a tells b whether the area is free of u1, and c moves u1 there."""
    never = React(())
    statements = (
        LOOK,
        received("o", 2),
        Send(NOT_U1, Literal("b")),
        React(cases, after),
        GUARD,
        never,
        move_to("area"),
        move_to("area"),
    )
    agents = {"a": ("u0", (0, 1)), "b": ("u0", (3, *then)), "c": ("u1", (7,))}
    return mission(["base", "area", "u0", "u1"], statements, agents, monitored=True)


def test_a_case_that_looks_into_a_message_rests_on_what_it_was_computed_from():
    free, other = Case(Exactly(Truth.TRUE), None, (6,)), Case(Anything("m", "message"), None, ())
    assert stale(reacting(free, other)) == {"b"}
    assert stale(reacting(Case(Anything("m", "message"), None, (6,)))) == set()


def test_a_guard_on_a_message_decides_what_follows_only_where_the_wait_would_end_elsewhere():
    free = Case(Anything("m", "message"), Variable("m"), (4,))
    assert stale(reacting(free, after=After(1.0), then=(6,))) == set()
    assert stale(reacting(free, after=After(1.0, (5,)), then=(6,))) == {"b"}
    assert stale(reacting(free, then=(6,))) == {"b"}


def test_what_is_done_when_a_wait_ends_rests_on_the_message_that_a_guard_refused():
    full = Case(Anything("m", "message"), Apply("not", (Variable("m"),)), (4,))
    assert stale(reacting(full, after=After(1.0, (6,)))) == {"b"}
    word = Case(Exactly("stop"), None, ())
    assert stale(reacting(word, after=After(1.0, (6,)))) == set()


def told(*sender):
    """Return a mission in which a tells b what it saw of the area, and enters it itself."""
    statements = (
        LOOK,
        received("o", *sender),
        Send(TupleOf((Literal("seen"), Variable("o"))), Literal("b")),
        move_to("area"),
        React((Case(Elements((Anything("_w"), Anything("m"))), None, (5,)),)),
        If(Apply("not", (Apply("in", (Literal("u0"), Variable("m"))),)), (6,)),
        move_to("area"),
    )
    return two(statements, (0, 1), (4,), channels={"u0": ["w"], "u1": ["w"]})


def test_a_senders_own_move_makes_its_message_stale_for_the_receiver():
    assert "b" in stale(told(2, 3))  # sent first: it moves while the message is on its way, or in the mailbox
    assert "b" in stale(told(3, 2))  # moved first


def test_an_agent_may_be_called_queue():
    statements = (LOOK, received("o", 2), If(NOT_U1, (3,)), move_to("area"))
    agents = {"queue": ("u0", (0, 1)), "sends": ("u1", (0, 1))}
    c = mission(["base", "area", "u0", "u1"], statements, agents, monitored=True, scheduler=Scheduler.FCFS)
    assert len(explore(c).configurations) > 20
    still = mission(["base", "area", "u0", "u1"], statements, agents, scheduler=Scheduler.FCFS)
    assert {each.unmonitored() for each in explore(c).configurations} == set(explore(still).configurations)


@examples(40)
@given(hypothesis_strategies.initial_configurations())
def test_monitoring_changes_no_configuration(c):
    plain, watched = reach(c, 120), reach(monitored(c), 120)
    if plain is None or watched is None:
        return
    assert {each.unmonitored() for each in watched} == plain


def reach(start, limit):
    """Return what is reachable, faults left out; None where that is more than the limit."""
    seen, frontier = {start}, [start]
    while frontier:
        try:
            allowed = successors(frontier.pop())
        except Fault:
            continue
        fresh = {t.target for t in allowed} - seen
        seen |= fresh
        frontier += fresh
        if len(seen) > limit:
            return None
    return seen


@given(hypothesis_strategies.configurations(hypothesis_strategies.initial_configurations(monitored=True)))
def test_what_is_remembered_runs_beside_what_it_is_about(c):
    for agent in c.alpha.names():
        watch = c.alpha.watch(agent)
        lengths = [len(part) for part in (watch.code, watch.store, watch.mailbox)]
        assert lengths == [len(c.alpha.code(agent)), len(c.alpha.store(agent)), len(c.alpha.mailbox(agent))]
    assert c.eta.all() is not None


def test_migration_and_sensing_are_no_controls():
    c = two((Migrate(Literal("u1")), LOOK), (0,), (1,), channels={"u0": ["w"], "u1": ["w"]})
    assert stale(c) == set()
