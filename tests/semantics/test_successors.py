"""The schedulers, exact counts, determinism, and what holds of every rule on generated configurations."""

import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scale import examples
from small_missions import explore, figure_2, mission, move_to

from semantics import hypothesis_strategies
from semantics.behaviours.expressions import Fault, Literal, QueryOf
from semantics.behaviours.patterns import Anything
from semantics.behaviours.statements import Case, Migrate, Observe, React, Send
from semantics.state.cell_values import QUEUE
from semantics.state.configuration import Configuration, Transition
from semantics.state.requests import FLY, READY, Request
from semantics.state.setting import Control, Scheduler
from semantics.successors import successors


def counts(c: Configuration) -> tuple[int, int]:
    found = explore(c)
    return len(found.configurations), len(found.transitions)


@pytest.mark.parametrize(
    ("guarded", "scheduler", "control", "expected"),
    [
        (False, Scheduler.PROGRAM_ORDER, Control.ATOMIC, (10, 10)),
        (False, Scheduler.PROGRAM_ORDER, Control.TIMED, (13, 14)),
        (False, Scheduler.UNORDERED, Control.ATOMIC, (16, 18)),
        (False, Scheduler.FCFS, Control.ATOMIC, (10, 10)),
        (True, Scheduler.UNORDERED, Control.ATOMIC, (12, 12)),
        (True, Scheduler.PROGRAM_ORDER, Control.ATOMIC, (10, 10)),
    ],
)
def test_figure_2_has_the_known_number_of_configurations_and_transitions(
    guarded, scheduler, control, expected
):
    assert counts(figure_2(guarded, scheduler=scheduler, control=control)) == expected


def test_the_run_of_figure_2_is_the_papers():
    c, labels = figure_2(), []
    for _ in range(8):
        first = successors(c)[0]
        labels.append(first.label.rule)
        c = first.target
    assert labels == ["req_ctr", "actuate", "req_obs", "sense", "rcv_obs", "fun", "req_ctr", "actuate"]
    assert c.structure.logical.parent("u0") == "spill"
    assert successors(c) == ()


def test_what_was_asked_is_served_before_any_agent_goes_on():
    agents = {"a": ("u0", (0,)), "b": ("u1", (0,))}
    c = mission(["base", "area", "u0", "u1"], (move_to("area"),), agents)
    (asked,) = (t.target for t in successors(c) if t.label.agent == "b")
    assert [(t.label.rule, t.label.agent) for t in successors(asked)] == [("actuate", "b"), ("req_ctr", "a")]


# --- what holds of all rules ------------------------------------------------------------------------------------

anywhere = hypothesis_strategies.configurations(hypothesis_strategies.initial_configurations(monitored=None))


@given(anywhere)
def test_a_configuration_has_the_same_successors_in_one_order(c):
    try:
        once = successors(c)
    except Fault:
        return
    again = successors(Configuration.of(c.setting, dict(c.state.items())))
    assert [(t.label, t.target) for t in once] == [(t.label, t.target) for t in again]
    assert len(set(once)) == len(once)


WRITES = {
    "fun": {"code", "store"},
    "req_obs": {"code", "store", "eta"},
    "req_ctr": {"code", "store", "eta"},
    "req_snd": {"code", "store", "eta"},
    "req_mgr": {"code", "store", "eta"},
    "rcv_obs": {"code", "store", "eta"},
    "rcv_msg": {"code", "store", "mailbox"},
    "timeout": {"code", "store"},
    "sense": {"parent", "links", "eta"},
    "actuate": {"parent", "links", "placement", "channels", "eta"},
    "command": {"placement", "eta"},
    "commit": {"parent", "links", "placement", "channels", "eta"},
    "snd": {"mailbox", "eta"},
    "migrate": {"host", "eta"},
    "spawn": {"code", "store", "agents", "host", "mailbox", "eta"},
    "env": {"placement", "channels", "down", "left"},
    "say": {"mailbox", "says"},
}
"""What each rule may write: the words of cells; `eta` for lines, queue and what is on its way."""

OWN = {"code", "store", "host", "line", "sends"}


@given(anywhere)
def test_a_rule_changes_only_what_its_row_says(c):
    try:
        allowed = successors(c)
    except Fault:
        return
    for t in allowed:
        before, after = dict(c.unmonitored().state.items()), dict(t.target.unmonitored().state.items())
        written = {cell for cell in after if before.get(cell, cell) != after[cell]}
        words = {"eta" if cell[0] in ("line", "sends", "queue") else cell[0] for cell in written}
        assert words <= WRITES[t.label.rule], t.label
        whose = {cell[1] for cell in written if cell[0] in OWN}
        spawned = {t.label.about} if t.label.rule == "spawn" else set()
        assert whose - spawned <= {t.label.agent}
        assert set(before) <= set(after)


# --- schedulers -------------------------------------------------------------------------------------------------


def projected(c: Configuration) -> tuple[object, ...]:
    """Return α, S and η as a multiset: what all three schedulers have in common."""
    cells = {cell: value for cell, value in c.state.items() if cell[0] not in ("line", "sends", "queue")}
    return (tuple(cells.items()), tuple(sorted(repr(each.request) for each in c.eta.all())))


def transitions_of(c: Configuration, scheduler: Scheduler) -> set[tuple[object, object]]:
    start = under(c, scheduler)
    return {(projected(before), projected(t.target)) for before, t in explore(start, 1500).transitions}


def under(c: Configuration, scheduler: Scheduler) -> Configuration:
    """Return a first configuration under another scheduler: its lines are empty."""
    cells = {cell: value for cell, value in c.state.items() if cell[0] not in ("line", "sends", "queue")}
    for agent in c.alpha.names():
        cells["line", agent] = ()
        cells |= {("sends", agent): ()} if scheduler is Scheduler.PROGRAM_ORDER else {}
    cells |= {("queue",): ()} if scheduler is Scheduler.FCFS else {}
    return Configuration.of(c.setting.with_(scheduler=scheduler), cells)


@st.composite
def short_missions(draw):
    """Yield missions of two agents with three requests each."""
    statements = [
        move_to("area"),
        move_to("base"),
        Observe(QueryOf("CHILDREN", QueryOf(None, Literal("base")))),
        Send(Literal("go"), Literal("b")),
        Migrate(Literal("u1")),
    ]
    code = st.lists(st.integers(0, len(statements) - 1), max_size=3).map(tuple)
    channels = draw(st.sampled_from([{}, {"u0": ["wifi"], "u1": ["wifi"]}]))
    agents = {"a": ("u0", draw(code)), "b": ("u1", draw(code))}
    return mission(["area", "base", "u0", "u1"], statements, agents, channels=channels)


@examples(25)
@given(short_missions(), st.sampled_from(Control))
def test_each_scheduler_refines_the_one_before(c, control):
    timed = Configuration(c.setting.with_(control=control), c.state)
    unordered, ordered, served_in_turn = (transitions_of(timed, scheduler) for scheduler in Scheduler)
    assert ordered <= unordered
    assert served_in_turn <= ordered


def queued(c: Configuration) -> set[tuple[object, tuple[Request, ...]]]:
    """Return what is reachable under fcfs by its definition: program_order, and a queue of what waits for its turn."""
    first = (under(c, Scheduler.PROGRAM_ORDER), ())
    seen, frontier = {first}, [first]
    while frontier:
        at, queue = frontier.pop()
        allowed = successors(at)
        turns = [queue.index(t.served.request) for t in allowed if t.served and t.label.rule != "commit"]
        for t in allowed:
            waits = t.served is not None and t.label.rule != "commit"
            if waits and queue.index(t.served.request) != min(turns):
                continue
            after = (t.target, queue_after(queue, t))
            if after not in seen:
                seen.add(after)
                frontier.append(after)
    return {(projected(at), queue) for at, queue in seen}


def queue_after(queue: tuple[Request, ...], t: Transition) -> tuple[Request, ...]:
    if t.label.rule.startswith("req_"):
        asked = Counter(each.request for each in t.target.eta.all())
        asked.subtract(each for each in queue)
        (fresh,) = (each for each, count in asked.items() if count > 0 and not isinstance(each, READY | FLY))
        return (*queue, fresh)
    if t.served is None or t.label.rule == "commit":
        return queue
    at = queue.index(t.served.request)
    return queue[:at] + queue[at + 1 :]


def answered(c: Configuration) -> set[tuple[object, tuple[READY, ...]]]:
    """Return what waits in each line to be received, in order."""
    lines = [(cell, value) for cell, value in c.state.items() if cell[0] == "line"]
    return {(cell, tuple(each for each in value if isinstance(each, READY))) for cell, value in lines}


@examples(25)
@given(short_missions(), st.sampled_from(Control))
def test_fcfs_tells_no_two_configurations_apart_but_by_the_order_of_what_waits(c, control):
    timed = Configuration(c.setting.with_(control=control), c.state)
    found = explore(under(timed, Scheduler.FCFS), 3_000).configurations
    seen = {(projected(each), each.read(QUEUE)) for each in found}
    assert seen == queued(timed)
    told = {(projected(each), each.read(QUEUE), frozenset(answered(each))) for each in found}
    assert len(told) == len(found)


def test_an_observation_is_delivered_in_the_order_in_which_it_was_asked_for():
    look = QueryOf("CHILDREN", QueryOf(None, Literal("base")))
    statements = (
        Observe(look),
        Observe(QueryOf("ALL", None)),
        React((Case(Anything("o"), None, ()),)),
    )
    for scheduler, delivered in ((Scheduler.PROGRAM_ORDER, 1), (Scheduler.UNORDERED, 2)):
        c = mission(["area", "base", "u0"], statements, {"a": ("u0", (0, 1, 2))}, scheduler=scheduler)
        for rule in ("req_obs", "req_obs", "sense", "sense"):
            c = next(t.target for t in successors(c) if t.label.rule == rule)
        assert all(isinstance(each.request, READY) for each in c.eta.all())
        assert [t.label.rule for t in successors(c)] == ["rcv_obs"] * delivered


# --- determinism ------------------------------------------------------------------------------------------------

SCRIPT = """
from small_missions import explore, figure_2, talkative
for start in (figure_2(monitored=True), talkative()):
    found = explore(start)
    print(*found.labels(), *map(repr, found.configurations), sep="\\n")
"""


def output(seed: str) -> str:
    here = Path(__file__).parent
    environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(here), "PYTHONUTF8": "1"}
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        env=environment,
        cwd=here.parents[1],
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout


def test_an_exploration_is_the_same_under_two_hash_seeds():
    first = output("1")
    assert len(first) > 10_000
    assert first == output("2")
