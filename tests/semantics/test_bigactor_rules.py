"""Messages, migration, spawning and `say`: each rule's conclusion, and what happens without each premise."""

import pytest
from small_missions import GUARD, around, enabled, mission, move_to, run

from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.expressions import Apply, Fault, Literal, Self, Variable
from semantics.behaviours.observations import Observation
from semantics.behaviours.patterns import Anything, Elements, Exactly
from semantics.behaviours.program import Behaviour, Program
from semantics.behaviours.statements import After, Case, Display, Loop, Migrate, Observe, React, Send, Spawn
from semantics.behaviours.values import Text
from semantics.bigactor_rules import MOST_AGENTS, migrate, rcv_msg, req_mgr, req_snd, say, snd, spawn, timeout
from semantics.environment import Drops, Says
from semantics.races.monitor import monitored
from semantics.state.initial import Beliefs
from semantics.state.relations import Parent
from semantics.state.setting import Scheduler
from semantics.successors import successors

GO = Send(Literal(Text("go")), Literal("b"))
ON_W = {"u0": ["w"], "u1": ["w"]}


def hears(*cases):
    return React(cases or (Case(Anything("m", "message"), None, ()),))


def pair(*statements, a=(0,), b=(), **more):
    """Return a mission with a on u0 and b on u1."""
    return mission(["base", "u0", "u1"], statements, {"a": ("u0", a), "b": ("u1", b)}, **more)


# --- premises ---------------------------------------------------------------------------------------------------


def received(message, *cases, **more):
    code = (Send(message, Literal("b")), hears(*cases), Display(Literal(1)))
    return run(pair(*code, a=(0,), b=(1,), channels=ON_W, **more), "req_snd", "snd")


def waiting(*cases, ready=(), after=(2,), **more):
    """Return a mission with b at a react with an `after` branch that displays 1; a sends what it is asked to."""
    code = (GO, React(cases, After(600.0, after)), Display(Literal(1)), Observe(around()), GUARD)
    return pair(*code, a=(0,), b=(*ready, 1), channels=ON_W, **more)


def spawning(*statements, behaviour=(1,), parameters=("x",), name="c", a=(0,)):
    code = (Spawn(name, Literal("u1"), "child", (Literal(Text("go")),)), Display(Variable("x")), *statements)
    program = Program(code, {"child": Behaviour("child", parameters, behaviour)}, COMMANDS)
    return mission(["base", "u0", "u1"], agents={"a": ("u0", a)}, program=program)


def linked(actual, believed):
    return {"channels": actual, "beliefs": Beliefs({}, believed)}


NOBODY = Send(Literal(Text("go")), Literal("nobody"))
GOING, LEAVING = Migrate(Literal("u1")), (move_to("base"), Migrate(Literal("u1")))
OBSERVED, TAKEN = Case(Anything("o", "observation"), None, ()), Case(Exactly(Text("go")), None, ())
UNLINKED = {"u0": [], "u1": []}
WITHOUT = {
    "req_snd: the agent is at send": (req_snd, "a", pair(move_to("base"))),
    "snd: a message is pending": (snd, "a", pair(GO, channels=ON_W)),
    "snd: its receiver is there": (snd, "a", run(pair(NOBODY, channels=ON_W), "req_snd")),
    "snd: a link in belief": (snd, "a", run(pair(GO, **linked(ON_W, UNLINKED)), "req_snd")),
    "snd: a link in fact": (snd, "a", run(pair(GO, **linked({}, ON_W)), "req_snd")),
    "snd: a link in belief of its sender": (
        snd,
        "a",
        run(pair(GO, **linked(ON_W, {"u0": [], "u1": ["w"]})), "req_snd"),
    ),
    "snd: a link in belief of its receiver": (
        snd,
        "a",
        run(pair(GO, **linked(ON_W, {"u0": ["w"], "u1": []})), "req_snd"),
    ),
    "snd: a link in fact of its sender": (snd, "a", run(pair(GO, **linked({"u1": ["w"]}, ON_W)), "req_snd")),
    "snd: a link in fact of its receiver": (
        snd,
        "a",
        run(pair(GO, **linked({"u0": ["w"]}, ON_W)), "req_snd"),
    ),
    "snd: one link": (snd, "a", run(pair(GO, **linked(ON_W, {"u0": ["v"], "u1": ["v"]})), "req_snd")),
    "rcv_msg: the agent is at a react": (rcv_msg, "b", run(pair(GO, channels=ON_W), "req_snd", "snd")),
    "rcv_msg: there is a message": (rcv_msg, "b", pair(hears(), a=(), b=(0,))),
    "rcv_msg: a case for it": (rcv_msg, "b", received(Literal(Text("go")), Case(Exactly("stop"), None, ()))),
    "rcv_msg: a case for messages": (rcv_msg, "b", received(Literal(Text("go")), OBSERVED)),
    "timeout: the agent is at a react": (timeout, "a", pair(GO)),
    "timeout: it has an after branch": (timeout, "a", pair(hears(), a=(0,))),
    "timeout: no case takes a message": (timeout, "b", run(waiting(TAKEN), "req_snd", "snd")),
    "timeout: no case an observation": (timeout, "b", run(waiting(OBSERVED, ready=(3,)), "req_obs", "sense")),
    "req_mgr: the agent is at migrate": (req_mgr, "a", pair(GO)),
    "migrate: a link in belief": (migrate, "a", run(pair(GOING, **linked(ON_W, UNLINKED)), "req_mgr")),
    "migrate: a link in fact": (migrate, "a", run(pair(GOING, **linked({}, ON_W)), "req_mgr")),
    "migrate: it is in line": (
        migrate,
        "a",
        run(pair(*LEAVING, a=(0, 1), channels=ON_W), "req_ctr", "req_mgr"),
    ),
    "spawn: the agent is at spawn": (spawn, "a", spawning(a=(1,))),
}


@pytest.mark.parametrize("premise", WITHOUT)
def test_without_a_premise_a_rule_does_nothing(premise):
    rule, agent, c = WITHOUT[premise]
    assert list(rule(c, agent)) == []


# --- messages ---------------------------------------------------------------------------------------------------


def test_req_snd_adds_the_request_and_the_agent_continues():
    c = run(pair(GO), "req_snd")
    assert [str(each.request) for each in c.eta.all()] == ['SND(a, b, "go")']
    assert c.alpha.code("a") == ()


@pytest.mark.parametrize("value", [1, frozenset(), frozenset({"a", "b"})])
def test_sending_to_what_is_not_one_name_is_a_fault(value):
    with pytest.raises(Fault, match="name was expected"):
        successors(pair(Send(Literal(Text("go")), Literal(value))))


def test_snd_puts_the_message_into_the_mailbox():
    c = run(pair(GO, channels=ON_W), "req_snd", "snd")
    assert c.alpha.mailbox("b") == (Text("go"),)
    assert c.eta.all() == ()


def test_snd_requires_a_channel_that_is_up():
    c = run(pair(GO, channels=ON_W, environment=(Drops("w", returns=True),)), "req_snd", "env")
    assert list(snd(c, "a")) == []
    assert len(list(snd(run(c, "env"), "a"))) == 1


def test_agents_on_one_node_need_no_link():
    c = mission(["u0"], (GO,), {"a": ("u0", (0,)), "b": ("u0", ())})
    assert run(c, "req_snd", "snd").alpha.mailbox("b") == (Text("go"),)


def test_a_message_stands_in_no_line():
    c = run(pair(Observe(around()), GO, a=(0, 1), channels=ON_W), "req_obs", "req_snd")
    assert enabled(c) == ["sense", "snd"]


def test_a_message_that_cannot_be_delivered_holds_up_no_other():
    both = (GO, Send(Literal(Text("go")), Literal("c")))
    agents = {"a": ("u0", (0, 1)), "b": ("u1", ()), "c": ("u0", ())}
    c = run(mission(["base", "u0", "u1"], both, agents), "req_snd", "req_snd")
    (t,) = snd(c, "a")
    assert str(t.label) == '⟨snd : SND(a, c, "go")⟩'


def test_a_message_that_no_case_takes_hides_no_other():
    both = (Send(Literal("x"), Literal("b")), Send(Literal("y"), Literal("b")))
    c = pair(*both, hears(Case(Exactly("y"), None, ())), a=(0, 1), b=(2,), channels=ON_W)
    c = run(c, "req_snd", "req_snd", "snd", "snd")
    (t,) = rcv_msg(c, "b")
    assert t.target.alpha.mailbox("b") == ("x",)


def test_a_mailbox_has_no_order_of_arrival():
    both = (Send(Literal("x"), Literal("b")), Send(Literal("y"), Literal("b")))
    c = run(pair(*both, a=(0, 1), channels=ON_W), "req_snd", "req_snd")
    ends = {after.target for first in snd(c, "a") for after in snd(first.target, "a")}
    assert [end.alpha.mailbox("b") for end in ends] == [("x", "y")]


def test_messages_that_show_alike_are_kept_apart_in_one_order():
    one, other = Observation.of(("u0",)), Observation.of(("u0",), relations=(Parent("u0", "base"),))
    c = pair(a=())
    for first, second in ((one, other), (other, one)):
        after = c.with_(c.alpha.posting("b", first))
        after = after.with_(after.alpha.posting("b", second))
        assert after.alpha.mailbox("b") == tuple(sorted((one, other), key=repr))


def test_rcv_msg_binds_the_message_and_takes_it_from_the_mailbox():
    c = run(
        received(Literal(("found", "u0")), Case(Elements((Exactly("found"), Anything("x"))), None, (2,))),
        "rcv_msg",
    )
    assert c.alpha.mailbox("b") == ()
    assert c.alpha.code("b") == (2,)


def test_a_message_goes_into_the_first_case_that_fits():
    same = Apply("==", (Variable("x"), Literal("stop")))
    cases = (
        Case(Anything("x", "message"), same, (2,)),
        Case(Exactly(Text("go")), None, ()),
        Case(Anything("y"), None, (2,)),
    )
    (t,) = rcv_msg(received(Literal(Text("go")), *cases), "b")
    assert t.target.alpha.code("b") == ()


def test_a_react_takes_an_observation_or_a_message_whichever_fits():
    cases = (Case(Anything("o", "observation"), None, (4,)), Case(Anything("m", "message"), None, (5,)))
    statements = (GO, Observe(around()), hears(*cases), GUARD, Display(Literal(1)), Display(Literal(2)))
    c = pair(*statements, a=(0,), b=(1, 2), channels=ON_W)
    c = run(c, "req_snd", "snd", "req_obs", "sense")
    assert enabled(c) == ["rcv_msg", "rcv_obs"]
    assert run(c, "rcv_msg").alpha.code("b") == (5,)
    assert run(c, "rcv_obs").alpha.code("b") == (4,)


def test_several_messages_that_fit_give_several_successors():
    both = (Send(Literal("x"), Literal("b")), Send(Literal(Text("x")), Literal("b")), hears())
    c = run(pair(*both, a=(0, 1), b=(2,), channels=ON_W), "req_snd", "req_snd", "snd", "snd")
    assert sorted(str(t.label) for t in successors(c)) == [
        '⟨rcv_msg : b, react("x")⟩',
        "⟨rcv_msg : b, react(x)⟩",
    ]


# --- no longer than needed ---------------------------------------------------------------------------------------


STOP = Case(Exactly("stop"), None, ())
IN_SIGHT = Apply("in", (Literal("u0"), Variable("o")))


def test_timeout_takes_the_branch_and_leaves_what_has_come():
    c = run(waiting(STOP), "req_snd", "snd")
    (t,) = timeout(c, "b")
    assert str(t.label) == "⟨timeout : b, after 10 min⟩"
    assert t.target.alpha.code("b") == (2,)
    assert t.target.alpha.mailbox("b") == (Text("go"),)
    assert t.target.eta.all() == ()


def test_an_observation_that_a_guard_refuses_ends_no_wait():
    refused = Case(Anything("o", "observation"), Apply("not", (IN_SIGHT,)), (4,))
    c = run(waiting(refused, ready=(3,)), "req_obs", "sense")
    assert len(list(timeout(c, "b"))) == 1


def test_where_a_guard_fails_there_is_no_timeout():
    failing = Case(Anything("m", "message"), Apply("<", (Variable("m"), Literal(1))), (4,))
    c = run(waiting(failing), "req_snd", "snd")
    assert list(timeout(c, "b")) == []


def test_what_a_timeout_leads_to_rests_on_the_guards_that_refused_and_on_nothing_else():
    refused = Case(Anything("o", "observation"), Apply("not", (IN_SIGHT,)), (4,))
    for ready, tests in (((3,), [("in", "u0")]), ((), [])):
        c = monitored(waiting(refused, ready=ready))
        c = run(c, "req_obs", "sense") if ready else c
        (t,) = timeout(c, "b")
        assert [[each.asked for each in part] for part in t.target.alpha.watch("b").code] == [tests]


def test_a_react_without_cases_only_waits():
    c = pair(Loop((1,)), React((), After(1.0)), a=(1,))
    assert run(c, "timeout").alpha.code("a") == ()


@pytest.mark.parametrize(
    ("seconds", "words"), [(90, "90 s"), (600, "10 min"), (5400, "90 min"), (7200, "2 h"), (0.5, "0.5 s")]
)
def test_a_duration_is_told_in_the_longest_unit_that_divides_it(seconds, words):
    assert str(After(float(seconds))) == f"after {words}"


# --- migration --------------------------------------------------------------------------------------------------


def test_migrate_changes_the_host():
    c = run(pair(Migrate(Literal("u1")), channels=ON_W), "req_mgr", "migrate")
    assert c.alpha.host("a") == "u1"
    assert c.eta.all() == ()


def test_in_no_order_a_migration_without_a_link_holds_up_no_other():
    code = (Migrate(Literal("u0")), Migrate(Literal("u1")))
    agents = {"a": ("u1", (0, 1))}
    c = mission(["base", "u0", "u1"], code, agents, scheduler=Scheduler.UNORDERED)
    (t,) = migrate(run(c, "req_mgr", "req_mgr"), "a")
    assert str(t.label) == "⟨migrate : MGR(a, u1)⟩"


def test_migrating_to_what_is_no_node_is_a_fault():
    for value in ("nowhere", "region", 1, frozenset({"u0", "u1"})):
        with pytest.raises(Fault):
            list(req_mgr(pair(Migrate(Literal(value))), "a"))


# --- spawning ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("scheduler", Scheduler)
def test_spawn_adds_an_agent_with_its_arguments(scheduler):
    c = spawning()
    setting = c.setting.with_(scheduler=scheduler)
    c = run(type(c)(setting, c.state), "spawn")
    assert c.alpha.names() == ("a", "c")
    assert (c.alpha.host("c"), c.alpha.code("c"), c.alpha.store("c")) == ("u1", (1,), (("x", Text("go")),))
    assert c.alpha.code("a") == ()


@pytest.mark.parametrize("count", [MOST_AGENTS - 1, MOST_AGENTS])
def test_there_are_only_so_many_agents(count):
    code = (Spawn("c", Literal("u0"), "child", ()), Display(Literal(1)))
    program = Program(code, {"child": Behaviour("child", (), (1,))}, COMMANDS)
    others = {f"a{number}": ("u0", ()) for number in range(1, count)}
    c = mission(["base", "u0"], agents={"a": ("u0", (0,)), **others}, program=program)
    if count < MOST_AGENTS:
        assert len(run(c, "spawn").alpha.names()) == MOST_AGENTS
    else:
        with pytest.raises(Fault, match=f"more than {MOST_AGENTS} agents"):
            successors(c)


def test_spawning_an_agent_that_is_there_is_a_fault():
    with pytest.raises(Fault, match="there already"):
        list(spawn(spawning(name="a"), "a"))


def test_spawning_ones_own_behaviour_leaves_ones_own_parameters():
    more = Apply("+", (Variable("n"), Literal(1)))
    code = (Spawn("c", Literal("u0"), "child", (more,)), Send(Variable("n"), Self()))
    program = Program(code, {"child": Behaviour("child", ("n",), (0, 1))}, COMMANDS)
    c = mission(["u0"], agents={"a": ("u0", (0, 1))}, program=program)
    c = run(c.with_({("store", "a"): (("n", 1),)}), "spawn")
    assert (c.alpha.store("a"), c.alpha.store("c")) == ((("n", 1),), (("n", 2),))


# --- say --------------------------------------------------------------------------------------------------------


def said(times=1, agent="a"):
    clause = Says(Text("go"), agent, times, 0)
    return mission(["u0"], agents={"a": ("u0", ())}, environment=(clause, Drops("w", returns=False))), clause


def test_say_puts_a_message_into_one_mailbox_and_counts():
    c, clause = said(times=2)
    (t,) = say(c, clause)
    assert (t.target.alpha.mailbox("a"), t.target.read(clause.counter)) == ((Text("go"),), 1)


def test_say_requires_that_it_was_not_said_too_often():
    c, clause = said()
    (t,) = say(c, clause)
    assert list(say(t.target, clause)) == []


def test_say_requires_the_agent_and_a_clause_of_its_own():
    c, clause = said(agent="nobody")
    assert list(say(c, clause)) == []
    assert list(say(c, c.setting.environment[1])) == []
