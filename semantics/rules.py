"""The seven inference rules, and the two that split `actuate` when control takes time.

Each is a pure function of a configuration and an agent that yields the transitions of the rule; `env` takes a clause of
the environment instead of an agent. Each docstring shows the premises above the bar, the conclusion below it.
"""

from collections.abc import Callable, Iterator

from semantics.behaviours.computation import compute, enter_case
from semantics.behaviours.expressions import evaluated, name_in, query_of
from semantics.behaviours.process_conversion import continuing, next_statement, process_of, resting_on
from semantics.behaviours.queries import overlay, resolve, sights
from semantics.behaviours.reaction_rules import Reaction, in_flight
from semantics.behaviours.statements import ControlBy, Observe, React, at_internal
from semantics.control import Realisation, commits, realisations
from semantics.drive import Reach
from semantics.environment import Clause, Observed, Says
from semantics.races.provenance import NOTHING, Dependency, causal_dependencies, computed, deciding, held
from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.requests import CTR, FLY, OBS, READY, Received
from semantics.state.setting import Control
from semantics.state.signature import Name

Rule = Callable[[Configuration, Name], Iterator[Transition]]


def fun(c: Configuration, a: Name) -> Iterator[Transition]:
    """Compute: take all internal steps of an agent up to its next command, react or choose.

    a's next step is internal, and leads to a′
    ───────────────────────────────────────────────────  ⟨fun : a⟩
    ⟨α | S | η⟩  →  ⟨α[a ↦ a′] | S | η⟩
    """
    if not at_internal(next_statement(c, a)):  # premise: a's next step is internal
        return
    for process in compute(process_of(c, a)):
        shown = tuple(process.shown)
        yield Transition(Label("fun", a), c.with_(continuing(c, process)), shown)


def req_obs(c: Configuration, a: Name) -> Iterator[Transition]:
    """Request an observation; HOST is resolved at the request.

    a is at observe(q)
    ───────────────────────────────────────────────────  ⟨req_obs : a, observe(q)⟩
    ⟨α | S | η⟩  →  ⟨α[a ↦ a′] | S | η ∪ {OBS(a, q)}⟩
    """
    statement = next_statement(c, a)
    if not isinstance(statement, Observe):  # premise: a is at observe(q)
        return
    process = process_of(c, a)
    query = query_of(statement.query, process.scope)
    rests_on = resting_on(process, computed(process.scope.used))
    process.leave()
    label = Label("req_obs", a, f"observe({query})")
    yield Transition(label, c.with_(continuing(c, process), c.eta.adding(OBS(a, query), rests_on)))


def sense(c: Configuration, a: Name) -> Iterator[Transition]:
    """Observe: evaluate the query over the physical structure; L and P become locally consistent there.

    OBS(a, q) ∈ η, in line      L_q = q(A(P ∖ M)), M entities that the mission lets a miss
    ───────────────────────────────────────────────────────────────────────────────  ⟨sense : OBS(a, q)⟩
    ⟨α | (L, P, β, γ) | η⟩  →  ⟨α | (L ⊕ L_q, P, β, γ) | η[OBS(a, q) ↦ READY(a, q, L_q)]⟩
    """
    for pending in c.eta.in_line(a):
        if not isinstance(pending.request, OBS):  # premise: OBS(a, q) ∈ η, in line
            continue
        query, physical, rests_on = pending.request.query, c.structure.physical, NOTHING
        if c.setting.monitored:  # a race is about q(A(P)): the world's answer, whatever a sensor misses
            looked = Dependency(query, resolve(query, physical, c.alpha), computed=True)
            rests_on = pending.rests_on | {looked}
        for missed, seen in sights(query, physical, c.alpha, missable(c, a)):  # premise: L_q = q(A(P ∖ M))
            ready = c.eta.replacing(pending, READY(a, query, seen), rests_on)
            target = c.with_(ready).with_each(overlay(c.structure.logical, seen))
            yield Transition(Label("sense", a, pending.request, missed), target, served=pending)


def missable(c: Configuration, a: Name) -> tuple[Name, ...]:
    """Return the entities that an agent's observation may miss: never its own host, nor what carries that."""
    if not c.setting.missable:
        return ()
    host = c.alpha.host(a)
    own = {host, *c.structure.physical.carriers(host)}
    return tuple(name for name in c.setting.missable if name not in own)


def rcv_obs(c: Configuration, a: Name) -> Iterator[Transition]:
    """Receive an observation: take the first case that matches it.

    a is at a react with a case x for L_q      READY(a, q, L_q) ∈ η, in line
    ────────────────────────────────────────────────────────────────────────  ⟨rcv_obs : a, react(x)⟩
    ⟨α | S | η⟩  →  ⟨α[a ↦ a′ with x := L_q] | S | η − READY(a, q, L_q)⟩
    """
    statement = next_statement(c, a)
    if not isinstance(statement, React):  # premise: a is at a react
        return
    for pending in c.eta.ready(a):  # premise: READY(a, q, L_q) ∈ η, in line
        assert isinstance(pending.request, READY)
        process = process_of(c, a)
        seen, rests_on = pending.request.observation, pending.rests_on
        asked = deciding(causal_dependencies(rests_on))  # the tests that led to the request
        otherwise = None if statement.after is None else statement.after.body
        if not enter_case(
            process, statement.cases, seen, rests_on - causal_dependencies(rests_on), asked, otherwise
        ):
            continue  # premise: a case for it
        target = c.with_(continuing(c, process), c.eta.removing(pending))
        yield Transition(Label("rcv_obs", a, Received(seen)), target)


def req_ctr(c: Configuration, a: Name) -> Iterator[Transition]:
    """Request a control action.

    a is at control(R ⇒ R′)
    ───────────────────────────────────────────────────  ⟨req_ctr : a, control(R ⇒ R′)⟩
    ⟨α | S | η⟩  →  ⟨α[a ↦ a′] | S | η ∪ {CTR(a, R ⇒ R′)}⟩
    """
    statement = next_statement(c, a)
    if not isinstance(statement, ControlBy):  # premise: a is at control(R ⇒ R′)
        return
    process = process_of(c, a)
    arguments = [evaluated(argument, process.scope) for argument in statement.arguments]
    make = c.setting.program.reactions[statement.name]
    reaction = make(process.scope.host, *(name_in(value) for value, _ in arguments))
    assert isinstance(reaction, Reaction)
    rests_on = resting_on(process, process.scope.placed, *(kept for _, kept in arguments))
    process.leave()
    request = c.eta.adding(CTR(a, reaction), held(deciding(rests_on), a, ()))  # no agent inherits it
    yield Transition(Label("req_ctr", a, f"control({reaction})"), c.with_(continuing(c, process), request))


def actuate(c: Configuration, a: Name) -> Iterator[Transition]:
    """Control in one step: every control under `control atomic`, and under `control timed` those without a flight.

    CTR(a, R ⇒ R′) ∈ η, in line      m a match of R in L
    a's host in m(R)      L[m(R) ↦ m(R′)] a forest
    S locally consistent w.r.t. m(R)      drive(P, m(R′)) = P′
    ──────────────────────────────────────────────────────────────────────────────  ⟨actuate : CTR(a, R ⇒ R′)⟩
    ⟨α | (L, P, β, γ) | η⟩  →  ⟨α | (L[m(R) ↦ m(R′)], P′, β, γ) | η − CTR(a, R ⇒ R′)⟩
    """
    for pending in c.eta.in_line(a):
        if not isinstance(pending.request, CTR):  # premise: CTR(a, R ⇒ R′) ∈ η, in line
            continue
        for found in realisations(c, pending.request):  # the other premises: PREMISES[CTR], P′
            if found.flying and c.setting.control is Control.TIMED:
                continue
            target = c.with_(found.physical, found.logical, c.eta.removing(pending))
            yield Transition(Label("actuate", a, pending.request), target, served=pending)


def command(c: Configuration, a: Name) -> Iterator[Transition]:
    """Send a vehicle on its way (`control timed`); L does not change yet.

    as actuate      neither the moved nodes nor their carriers are in transit
    ──────────────────────────────────────────────────────────────────────────────  ⟨command : CTR(a, R ⇒ R′)⟩
    ⟨α | (L, P, β, γ) | η⟩  →  ⟨α | (L, P[moved ↦ in transit], β, γ) | η[CTR ↦ FLY(a, m, R′)]⟩
    """
    if c.setting.control is not Control.TIMED:  # premise: control takes time
        return
    for pending in c.eta.in_line(a):
        if not isinstance(pending.request, CTR):  # premise: CTR(a, R ⇒ R′) ∈ η, in line
            continue
        reaction = pending.request.reaction
        for found in realisations(c, pending.request):  # the other premises: as actuate
            if not found.flying or found.waits(c):  # premise: not in transit
                continue
            fly = FLY(a, reaction, in_flight(reaction, found.match))
            target = c.with_(found.departing(c), c.eta.replacing(pending, fly))
            yield Transition(Label("command", a, pending.request), target, served=pending)


def commit(c: Configuration, a: Name, reach: Reach | None = None) -> Iterator[Transition]:
    """Arrive (`control timed`): at the destination's current position, and R must still match.

    FLY(a, m, R′) ∈ η, in line      m(R) in P, its travelling nodes in transit there
    R still matches, except for the place of the moved node      L[m(R) ↦ m(R′)] a forest
    its unmoved part is consistent      drive(P, m(R′)) = P′
    ──────────────────────────────────────────────────────────────────────────────  ⟨commit : FLY(a, m, R′)⟩
    ⟨α | (L, P, β, γ) | η⟩  →  ⟨α | (L[m(R) ↦ m(R′)], P′, β, γ) | η − FLY(a, m, R′)⟩
    """
    # In a live mission, `reach` places the vehicle where it was observed: P′ is the observed world.
    for pending in c.eta.in_line(a):
        if not isinstance(pending.request, FLY):  # premise: FLY(a, m, R′) ∈ η, in line
            continue
        found: Realisation | None = commits(
            c, pending.request, reach
        )  # the other premises: PREMISES[FLY], P′
        if found is not None:
            target = c.with_(found.physical, found.logical, c.eta.removing(pending))
            yield Transition(Label("commit", a, pending.request), target, served=pending)


def env(c: Configuration, clause: Clause | Observed) -> Iterator[Transition]:
    """Let the world change as the mission's environment section allows.

    the environment allows P → P′
    ───────────────────────────────────────────────────  ⟨env : P′⟩
    ⟨α | (L, P, β, γ) | η⟩  →  ⟨α | (L, P′, β, γ) | η⟩
    """
    if isinstance(clause, Says):  # premise: the clause is about P
        return
    for words, changes in clause.effects(c.structure.physical):  # premise: the environment allows P → P′
        yield Transition(Label("env", None, words), c.with_(changes))


RULES: tuple[Rule, ...] = (fun, req_obs, sense, rcv_obs, req_ctr, actuate)
"""The paper's rules of agents, in its order; `env` is separate, since it belongs to no agent."""

TIMED_RULES: tuple[Rule, ...] = (command, commit)
"""The rules that replace `actuate` where control takes time."""
