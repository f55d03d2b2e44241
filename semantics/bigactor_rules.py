"""The bigActor extension (paper, 3.1): messages, migration, spawning, and messages from outside.

Its rules have the form of the seven rules.
"""

from collections.abc import Iterator

from semantics.behaviours.computation import (
    Tried,
    bind_parameters,
    enter_case,
    first_fitting,
    give_up,
    look_into,
)
from semantics.behaviours.expressions import Fault, evaluated, name_in
from semantics.behaviours.process_conversion import (
    continuing,
    joining,
    new_process,
    next_statement,
    placed,
    process_of,
    resting_on,
    starting,
)
from semantics.behaviours.statements import Case, Migrate, React, Send, Spawn
from semantics.behaviours.values import Value, show
from semantics.environment import Clause, Says
from semantics.races.provenance import NOTHING, Provenance, causal_dependencies, deciding, held
from semantics.races.relevance import possible_receivers
from semantics.rules import Rule
from semantics.state.cell_values import Changes
from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.requests import MGR, READY, SND
from semantics.state.signature import Name

MOST_AGENTS = 64
"""The largest number of agents in a mission, spawned ones included."""


def linked(c: Configuration, here: Name, there: Name) -> bool:
    """Whether two hosts are one node, or share a link in L and in P."""
    return here == there or any(True for _ in channels_between(c, here, there))


def channels_between(c: Configuration, here: Name, there: Name) -> Iterator[Name]:
    """Yield the links that two hosts share in L and in P."""
    logical, physical = c.structure.logical, c.structure.physical
    for link in sorted(set(logical.links(here)).intersection(logical.links(there))):
        if physical.connected(link, here) and physical.connected(link, there):
            yield link


def req_snd(c: Configuration, a: Name) -> Iterator[Transition]:
    """Request the delivery of a message.

    a is at send(m, b)
    ───────────────────────────────────────────────────  ⟨req_snd : a, send(m, b)⟩
    ⟨α | S | η⟩  →  ⟨α[a ↦ a′] | S | η ∪ {SND(a, b, m)}⟩
    """
    statement = next_statement(c, a)
    if not isinstance(statement, Send):  # premise: a is at send(m, b)
        return
    process = process_of(c, a)
    message, carried = evaluated(statement.message, process.scope)
    to, chosen = evaluated(statement.to, process.scope)
    send = SND(a, name_in(to), message)
    rests_on = held(
        resting_on(process, carried, deciding(chosen)), send.to, possible_receivers(process.program)
    )
    process.leave()
    label = Label("req_snd", a, f"send({show(message)}, {send.to})")
    yield Transition(label, c.with_(continuing(c, process), c.eta.adding(send, rests_on)))


def snd(c: Configuration, a: Name) -> Iterator[Transition]:
    """Deliver a message.

    SND(a, b, m) ∈ η      b ∈ α      the hosts of a and b are one node, or share a link in L and in P
    ─────────────────────────────────────────────────────────────────────────  ⟨snd : SND(a, b, m)⟩
    ⟨α | S | η⟩  →  ⟨α[mailbox(b) + m] | S | η − SND(a, b, m)⟩
    """
    for pending in c.eta.in_line(a):
        send = pending.request
        if not isinstance(send, SND) or send.to not in c.alpha:  # premises: SND(a, b, m) ∈ η, b ∈ α
            continue
        if not linked(c, c.alpha.host(a), c.alpha.host(send.to)):  # premise: one node, or linked
            continue
        target = c.with_(c.alpha.posting(send.to, send.message, pending.rests_on), c.eta.removing(pending))
        yield Transition(Label("snd", a, send), target, served=pending)


def rcv_msg(c: Configuration, a: Name) -> Iterator[Transition]:
    """Receive a message: take the first case that matches it.

    a is at a react with a case x for m      m ∈ mailbox(a)
    ───────────────────────────────────────────────────────────────  ⟨rcv_msg : a, react(m)⟩
    ⟨α | S | η⟩  →  ⟨α[a ↦ a′ with x := m, mailbox(a) − m] | S | η⟩
    """
    statement = next_statement(c, a)
    if not isinstance(statement, React):  # premise: a is at a react
        return
    watch = c.alpha.watch(a)
    looked_into = look_into(statement.cases)
    for position, message in enumerate(c.alpha.mailbox(a)):  # premise: m ∈ mailbox(a)
        rests_on = watch.mailbox[position] if watch else NOTHING
        process = process_of(c, a)
        asked = deciding(rests_on if looked_into else causal_dependencies(rests_on))
        otherwise = None if statement.after is None else statement.after.body
        if not enter_case(process, statement.cases, message, rests_on, asked, otherwise):
            continue  # premise: a case for it
        taken = c.with_(c.alpha.taking(a, position))
        target = taken.with_(continuing(taken, process))
        yield Transition(Label("rcv_msg", a, f"react({show(message)})"), target)


def timeout(c: Configuration, a: Name) -> Iterator[Transition]:
    """Stop waiting: no case takes any observation or message that has come. These stay where they are.

    a is at a react with a branch after d
    no case takes a READY(a, q, L_q) ∈ η, in line, or an m ∈ mailbox(a)
    ───────────────────────────────────────────────────────────────  ⟨timeout : a, after d⟩
    ⟨α | S | η⟩  →  ⟨α[a ↦ a′] | S | η⟩
    """
    statement = next_statement(c, a)
    if not isinstance(statement, React) or statement.after is None:  # premise: a is at a react with after d
        return
    refused = _refused(c, a, statement.cases)
    if refused is None:  # premise: no case takes anything
        return
    process = process_of(c, a)
    give_up(process, statement.cases, statement.after, refused)
    yield Transition(Label("timeout", a, str(statement.after)), c.with_(continuing(c, process)))


def _refused(c: Configuration, a: Name, cases: tuple[Case, ...]) -> Tried | None:
    """Return the guards that refuse everything an agent could receive, None if a case takes some of it, or fails."""
    watch, tests = c.alpha.watch(a), list[tuple[int, Provenance]]()
    mailbox = c.alpha.mailbox(a)
    posted = zip(mailbox, watch.mailbox if watch else (NOTHING,) * len(mailbox), strict=True)
    ready = ((p.request.observation, p.rests_on) for p in c.eta.ready(a) if isinstance(p.request, READY))
    for value, rests_on in (*ready, *posted):
        try:
            rank, tried = first_fitting(process_of(c, a), cases, value, rests_on)
        except Fault:  # `rcv_obs` or `rcv_msg` reports it
            return None
        if rank is not None:
            return None
        tests += tried
    return tuple(tests)


def req_mgr(c: Configuration, a: Name) -> Iterator[Transition]:
    """Request to move to another host.

    a is at migrate(h)
    ───────────────────────────────────────────────────  ⟨req_mgr : a, migrate(h)⟩
    ⟨α | S | η⟩  →  ⟨α[a ↦ a′] | S | η ∪ {MGR(a, h)}⟩
    """
    statement = next_statement(c, a)
    if not isinstance(statement, Migrate):  # premise: a is at migrate(h)
        return
    process = process_of(c, a)
    host, rests_on = evaluated(statement.host, process.scope)
    request = MGR(a, node_named(c, host))
    rests_on = resting_on(process, rests_on)
    process.leave()
    rests_on = placed(process, rests_on)
    label = Label("req_mgr", a, f"migrate({request.host})")
    yield Transition(label, c.with_(continuing(c, process), c.eta.adding(request, rests_on)))


def migrate(c: Configuration, a: Name) -> Iterator[Transition]:
    """Move an agent to another host.

    MGR(a, h) ∈ η, in line      a's host is h, or shares a link with it in L and in P
    ─────────────────────────────────────────────────────────────────────────  ⟨migrate : MGR(a, h)⟩
    ⟨α | S | η⟩  →  ⟨α[host(a) ↦ h] | S | η − MGR(a, h)⟩
    """
    for pending in c.eta.in_line(a):
        request = pending.request
        if not isinstance(request, MGR):  # premise: MGR(a, h) ∈ η, in line
            continue
        if not linked(c, c.alpha.host(a), request.host):  # premise: one node, or linked
            continue
        target = c.with_(c.alpha.hosting(a, request.host, pending.rests_on), c.eta.removing(pending))
        yield Transition(Label("migrate", a, request), target, served=pending)


def spawn(c: Configuration, a: Name) -> Iterator[Transition]:
    """Create an agent; a second agent of the same name is an error.

    a is at spawn b hosted_at h with_behavior B      b ∉ α
    ───────────────────────────────────────────────────  ⟨spawn : a, b⟩
    ⟨α | S | η⟩  →  ⟨α[a ↦ a′] ∪ {b at h running B} | S | η⟩
    """
    statement = next_statement(c, a)
    if not isinstance(statement, Spawn):  # premise: a is at spawn
        return
    if statement.name in c.alpha:  # premise: b ∉ α
        raise Fault(f"an agent '{statement.name}' is there already")
    if len(c.alpha.names()) >= MOST_AGENTS:
        raise Fault(f"more than {MOST_AGENTS} agents")
    parent = process_of(c, a)
    host, chosen = evaluated(statement.host, parent.scope)
    behaviour = c.setting.program.behaviours[statement.behaviour]
    bound = parent.fork()  # the parent may be running the same behaviour: its own parameters must stay
    bind_parameters(bound, behaviour, statement.arguments, parent.rests_on[0])
    child = new_process(c.setting, statement.name, node_named(c, host), behaviour.body)
    for name in behaviour.parameters:
        child.scope.binding({name: bound.scope.store[name]}, bound.scope.rests_on[name])
    child.scope.placed = chosen
    child.rests_on = (parent.rests_on[0],) * len(child.code)
    parent.leave()
    begun = starting(c.setting, statement.name, child.scope.host, child)
    label = Label("spawn", a, statement.name)
    yield Transition(label, c.with_(continuing(c, parent), begun, joining(c, statement.name)))


def node_named(c: Configuration, value: Value) -> Name:
    """Return the node that a value names.

    Raises:
        Fault: The value names no node.
    """
    name = name_in(value)
    if name not in c.setting.kinds:
        raise Fault(f"there is no node {show(value)}")
    return name


def say(c: Configuration, clause: Clause) -> Iterator[Transition]:
    """Let a person or program outside the mission put a message into a mailbox.

    the environment says m to a, and has not said it too often      a ∈ α
    ───────────────────────────────────────────────────  ⟨say : m to a⟩
    ⟨α | S | η⟩  →  ⟨α[mailbox(a) + m] | S | η⟩
    """
    if not isinstance(clause, Says):  # premise: the environment says m to a
        return
    left: int = c.read(clause.counter)
    if left == 0 or clause.agent not in c.alpha:  # premises: not too often, a ∈ α
        return
    counted: Changes = {clause.counter: left - 1}
    label = Label("say", None, clause.words[0])
    yield Transition(label, c.with_(c.alpha.posting(clause.agent, clause.message), counted))


EXTENSION: tuple[Rule, ...] = (req_snd, snd, rcv_msg, timeout, req_mgr, migrate, spawn)
"""The extension's rules of agents; `say` is separate, as `env` is."""
