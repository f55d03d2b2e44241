"""Crosscheck: compare the rules' recorded reads and writes with the static footprints of the reduction.

Footprints and visible cells are computed from the text, independently of the rules. Here rules and properties run over
recording cells; any access outside its footprint is a bug of ours.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from typing import Any

from checker.recording.access_recording import Asked, ColumnQuestion
from checker.recording.whole_cells import recorded_cells, writes_of
from checker.reduction.actor_footprints import Acting, Actor, Actors
from checker.reduction.ample import Ample, disturbed
from checker.reduction.footprint_slots import NOTHING, Slot, SlotFootprint
from checker.reduction.race_footprints import ANSWERS, MARKS, slot_of_mark
from semantics.behaviours.expressions import Fault, Literal
from semantics.bigactor_rules import say, spawn
from semantics.control import applicable, obstacle
from semantics.properties.propositions import Proposition, holds
from semantics.races.monitor import marked, slots_used
from semantics.races.provenance import ANY, Dependency, Key
from semantics.races.relevance import possible_receivers, questions_of, relevant, slots_of
from semantics.rules import env, rcv_obs
from semantics.state.agents import AgentProvenance, mailbox_cell, watch_cell
from semantics.state.cell_values import MONITOR, Cell, Changes, has, is_something
from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.physical_model import is_aboard
from semantics.state.printing import print_configuration
from semantics.state.requests import CTR, FLY, READY, SND
from semantics.state.signature import REGION, Name
from semantics.successors import SERVING, by_clause, rules_of, steps

Rule = Callable[[Configuration, Any], Iterable[Transition]]
"""A rule, given a configuration and its agent or clause."""

OWN = {
    "program": frozenset({"code", "store", "mailbox", "line", "sends"}),
    "line": frozenset({"line", "sends"}),
    "request": frozenset({"line", "sends"}),
    "clause": frozenset({"says"}),
}
"""The private cells of each kind of actor; they divide an agent into actors."""

PRIVATE = frozenset({MONITOR}).union(*OWN.values())
"""Cells that only their owner accesses as a whole; questions that others ask about them are slots."""

RECEIVED = ("mail", "fault", "ready")
"""The kinds of slots for an agent's incoming messages and observations."""

MEMORY = frozenset({"agents", "code", "line", "sends", MONITOR})
"""The cells that decide which marks are relevant to an agent; changing them reads the marks that may be made there."""


NOBODY = Acting(NOTHING, NOTHING, NOTHING)


class Drift(Exception):  # named for the event, not the error
    """A deviation of the rules from their static footprints: a bug of ours."""


def crosscheck(ample: Ample, c: Configuration) -> None:
    """Check a configuration against the footprints.

    Raises:
        Drift: An access is outside its footprint; the message names the access, its actor, and the configuration.
    """
    for found in outside(ample, c):
        raise Drift(f"{found}, in the configuration\n{print_configuration(c)}")


def outside(ample: Ample, c: Configuration) -> Iterator[str]:
    """Yield in words the deviations from footprints and visible cells."""
    acting, slots = ample.actors.of(c), ample.actors.footprints.slots
    for formula in ample.eyes.formulas:
        yield from _unseen(ample, c, formula)
    for actor, may in acting.items():
        yield from _Held(ample.actors, c, actor, may.now).outside()
        unheard = may.now.changes & ~ample.actors.everything.changes
        yield from (f"{actor} changes {slot}, which no footprint contains" for slot in slots.named(unheard))
        lasting = (slot for slot in slots.named(may.now.beyond(may.ever)) if slot[0] not in RECEIVED)
        yield from (f"{actor} may access {slot} now, and its whole footprint lacks it" for slot in lasting)
    yield from unheeded(c)
    for mover, step in _moves(ample.actors, c):
        yield from _beyond(ample.actors, acting, mover, step)


# --- slots and cells ------------------------------------------------------------------------------------------------

Told = Callable[[Any], Any]
"""The part of a cell's value that a slot covers."""


def slots_over(actors: Actors, cell: Cell) -> Iterator[tuple[Slot, Told | None]]:
    """Yield the slots of a cell, each with the part of the value that it covers; None for the whole value.

    Marks are left out: they are sets to which others add (`slot_of_mark`).
    """
    reacts = actors.footprints.reacts
    match cell:
        case ("placement", name):
            yield from ((cell, None), (("present", name), is_something))
        case ("parent", name):
            yield from ((cell, None), (("known", name), is_something))
        case ("mailbox", agent):
            yield from (((what, agent, n), _waking(actors, n)) for what in ("mail", "fault") for n in reacts)
        case ("left", entity, _):  # writers of channels may write it
            yield ("channels", entity), None
        case ("line", agent):
            yield ("ready", agent), _observations
            if not actors.ordered:
                yield from ((("fault", agent, number), _observations) for number in reacts)
        case (word, *_) if word not in PRIVATE:
            yield cell, None


def _waking(actors: Actors, react: int) -> Told:
    """Return a function that selects the messages of a mailbox that may wake a `react`."""
    return lambda mailbox: [each for each in mailbox or () if react in actors.footprints.wakes(Literal(each))]


def _observations(line: tuple[Any, ...] | None) -> Any:
    """Return the received observations of a line."""
    return [each for each in line or () if isinstance(each, READY)]


def varies(actors: Actors, cell: Cell) -> bool:
    """Return whether any actor may ever write a cell; footprints omit the other cells."""
    changes, slots = actors.everything.changes, slots_over(actors, cell)
    return cell[0] in PRIVATE or any(actors.footprints.slots.has(changes, slot) for slot, _ in slots)


def recorded(actors: Actors, c: Configuration) -> tuple[Asked, Configuration]:
    """Return a record of questions, and a configuration that fills it; questions about constant cells don't count."""
    return recorded_cells(c, lambda cell: varies(actors, cell))


# --- visible cells --------------------------------------------------------------------------------------------------


def _unseen(ample: Ample, c: Configuration, formula: Proposition) -> Iterator[str]:
    asked, over = recorded(ample.actors, c)
    holds(formula, over)
    for ask in asked:
        seen = [each for each in ample.eyes.seen if each.cell == ask.cell]
        if not any(
            each.question in (None, ask.question) and each.constants in ((), ask.constants) for each in seen
        ):
            yield f"the property '{formula}' reads {ask.cell}, which is not taken for visible"


# --- reads and writes of rules --------------------------------------------------------------------------------------


def hindered(c: Configuration, agent: Name) -> Iterator[Transition]:
    """Yield the obstacle of each of an agent's controls, in the form of a step."""
    for pending in c.eta.in_line(agent):
        if isinstance(pending.request, CTR | FLY):
            found = obstacle(c, pending.request)
            yield Transition(Label("obstacle", agent, found.value if found else ""), c.with_({}))


class _Held:
    """The check of one actor's steps in a configuration against its current footprint."""

    def __init__(self, actors: Actors, c: Configuration, actor: Actor, now: SlotFootprint) -> None:
        self.actors = actors
        self.slots = actors.footprints.slots
        self.actor = actor
        self.now = now
        self.c = _alone(actors, c, actor)
        clause = c.setting.environment[int(actor.owner)] if actor.kind == "clause" else None
        self.about: Any = clause or actor.owner
        self.whose = f"'{clause.words[0]}'" if clause else f"'{actor.owner}'"
        to = getattr(clause, "agent", None) or getattr(actor.request, "to", None)
        self.mailbox = mailbox_cell(str(actor.owner)) if actor.kind == "program" else None
        self.posting = {mailbox_cell(to), watch_cell(to)} if to else set()

    def outside(self) -> Iterator[str]:
        """Yield its rules' accesses outside the footprint."""
        for rule in self.rules():
            for done, things in self.of_rule(rule):
                for each in things:
                    yield f"{rule.__name__} of {self.whose} {done} {each}, which its footprint leaves out"

    def rules(self) -> tuple[Rule, ...]:
        """Return the actor's rules."""
        if self.actor.kind == "clause":
            return (env, say)
        serving = self.actor.kind != "program"
        found = (rule for rule in rules_of(self.c.setting.control) if (rule in SERVING) is serving)
        return (*found, *([hindered] if serving else []))

    def of_rule(self, rule: Rule) -> Iterator[tuple[str, Iterable[Any]]]:
        """Yield the reads, writes and marks of a rule's steps outside the footprint."""
        asked, over = recorded(self.actors, self.c)
        found = self.run(rule, over)
        written = [writes_of(step) for step in found]
        beyond = [ask.cell for ask in asked if not self.may_read(rule, ask)]
        yield "reads", [cell for cell in beyond if self.matters(rule, cell, written)]
        for step, changes in zip(found, written, strict=True):
            yield "writes", [each for cell in changes for each in self.unwritten(rule, cell, changes[cell])]
            yield "keeps", [slot for slot in self.kept(changes) if not self.has(slot)]
            known, after = set(asked), writes_of(marked(over, step))
            news = (ask for ask in asked if ask not in known and ask.cell[0] not in MEMORY)
            yield "reads", [ask.cell for ask in news if not self.may_read(rule, ask)]
            made = self.marks(after).difference(self.marks(changes))
            yield "marks", [slot for slot in sorted(made) if not self.slots.has(self.now.changes, slot)]

    def run(self, rule: Rule, c: Configuration) -> list[Transition]:
        """Return the steps of a rule, up to the first fault."""
        found: list[Transition] = []
        with suppress(Fault):
            found.extend(rule(c, self.about))
        return found

    def matters(self, rule: Rule, cell: Cell, written: list[Changes]) -> bool:
        """Return whether a read outside the footprint may affect the writes.

        A control reads the ancestors of a place in L to prevent a cycle; where no cycle is possible, the read is
        without effect. So the rule is run with every parent that L may ever hold there.
        """
        if cell[0] != "parent":
            return True
        believable = (*self.actors.footprints.bounds.believable(cell[1]), REGION)
        others = (self.c.with_({cell: place}) for place in believable if not self.is_above(cell[1], place))
        return any(
            [writes_of(step) for step in self.run(rule, recorded(self.actors, c)[1])] != written
            for c in others
        )

    def is_above(self, node: Name, place: Name) -> bool:
        return node == place or node in self.c.structure.logical.ancestors(place)

    def may_read(self, rule: Rule, ask: ColumnQuestion) -> bool:
        """Return whether a question is within the footprint; a cell that only the actor itself writes needs no slot."""
        cell, value = ask.cell, self.c.read(ask.cell)
        if ask.question is has and not self.actors.roles.may_come(ask.constants[0]):
            return True
        if ask.question is is_aboard and not ask.constants[0] & self.actors.footprints.bounds.carriers(
            cell[1]
        ):
            return True  # nothing else can carry it
        if cell == self.mailbox:
            return self.has(("mail", cell[1], *self.c.alpha.code(cell[1])[:1]))
        if rule is rcv_obs and cell[0] == "line" and not (self.actors.ordered and _observations(value)):
            return self.has(("ready", cell[1]))
        if cell[0] in PRIVATE:
            return self.is_own(cell)
        return any(
            self.has(slot) for slot, told in slots_over(self.actors, cell) if told in (None, ask.question)
        )

    def unwritten(self, rule: Rule, cell: Cell, value: Any) -> Iterator[Slot]:
        """Yield the slots that a write changes outside the footprint, and the written private cells of other actors."""
        if rule is spawn and cell[-1] not in self.c.alpha:
            return  # no actor reads the cells of absent agents
        old = self.c.read(cell)
        for slot, told in slots_over(self.actors, cell):
            changed = told(old) != told(value) if told else old != value or varies(self.actors, cell)
            if changed and not self.slots.has(self.now.changes, slot) and not self.consumes(slot):
                yield slot
        if cell[0] in PRIVATE and not self.is_own(cell):
            yield cell

    def kept(self, changes: Changes) -> set[Slot]:
        """Return the slots of provenance that is added, passed on or dropped; other agents may mark it."""
        before, after = self.memory({}), self.memory(changes)
        return {(ANSWERS, holder) for holder, _ in (before - after) + (after - before)}

    def marks(self, changes: Changes) -> set[Slot]:
        """Return the slots of all marks after some changes."""
        return {slot_of_mark(holder, key) for holder, one in self.memory(changes) for key, _ in one.changed}

    def memory(self, changes: Changes) -> Counter[tuple[Name, Dependency]]:
        """Return the provenance after some changes, with its holders; the holder of a message's is the receiver."""
        if not self.c.setting.monitored:
            return Counter()
        after = self.c.with_(changes)
        kept = [
            (each.to if isinstance(each, SND) else each.agent, rests_on)
            for each, _, _, rests_on in after.eta.all()
        ]
        for agent in after.alpha.names():
            watch = after.alpha.watch(agent) or AgentProvenance()
            kept += [
                (agent, rests_on) for rests_on in (*watch.code, *watch.store, *watch.mailbox, watch.host)
            ]
        there = set(self.actors.roles.agents)
        return Counter((holder, one) for holder, rests_on in kept if holder in there for one in rests_on)

    def has(self, slot: Slot) -> bool:
        """Return whether a slot is in the footprint."""
        return self.slots.has(self.now.reads | self.now.changes, slot)

    def consumes(self, slot: Slot) -> bool:
        """Return whether a slot is about the actor's own incoming messages; nobody else waits for those."""
        return self.actor.kind == "program" and slot[:2] in {(what, self.actor.owner) for what in RECEIVED}

    def is_own(self, cell: Cell) -> bool:
        """Return whether a private cell is the actor's own, or belongs to the mailbox that it posts to."""
        own = cell[-1] == self.actor.owner and cell[0] in OWN[self.actor.kind] | {MONITOR}
        return own or cell in self.posting or cell == getattr(self.about, "counter", None)


def _alone(actors: Actors, c: Configuration, actor: Actor) -> Configuration:
    """Return the configuration without the requests of the agent's other actors.

    The footprints of those actors cover reading them.
    """
    if actor.kind not in ("line", "request"):
        return c
    for each in c.eta.of(str(actor.owner)):
        if actors.serving(each.request) != actor:
            return _alone(actors, c.with_(c.eta.removing(each)), actor)
    return c


# --- the race monitor's provenance ----------------------------------------------------------------------------------


def heed(c: Configuration) -> None:
    """Check that the race monitor's over-approximations cover the questions and used slots of a configuration.

    Raises:
        Drift: One is not covered.
    """
    for found in unheeded(c):
        raise Drift(f"{found}, in the configuration\n{print_configuration(c)}")


def unheeded(c: Configuration) -> Iterator[str]:
    """Yield in words the questions and used slots, now or after a step, that the race monitor's approximations miss."""
    for agent in c.alpha.names() if c.setting.monitored else ():
        known, may_ask = _asked(c, agent), questions_of(c, agent)
        for step in steps(c, agent):
            if isinstance(step, Transition):
                asked = _asked(step.target, agent) - known | questions_of(step.target, agent)
                for key in sorted(asked - relevant(asked, may_ask)):
                    yield f"after {step.label} '{agent}' may ask for {key}, which the race monitor forgets"
        told = possible_receivers(c.setting.program)
        sends = (each.request for each in c.eta.of(agent) if isinstance(each.request, SND))
        for send in (send for send in sends if told.isdisjoint({send.to, ANY})):
            yield f"{send} passes an observation on to '{send.to}', which the race monitor forgets"
        for request in (each.request for each in c.eta.of(agent) if isinstance(each.request, CTR | FLY)):
            redex = request.reaction.redex
            for match in applicable(c, agent, request.reaction):
                used = slots_used(match.relations(redex), tuple(node for node, _ in match.closed(redex)))
                for key in sorted(used - relevant(used, slots_of(redex))):
                    yield f"{request} uses {key}, which the race monitor forgets"


def _asked(c: Configuration, agent: Name) -> frozenset[Key]:
    """Return the questions behind an agent's provenance, and the slots that its controls may use."""
    requests, watch = c.eta.of(agent), c.alpha.watch(agent) or AgentProvenance()
    kept = (*watch.code, *watch.store, *watch.mailbox, watch.host, *(each.rests_on for each in requests))
    asked = {one.asked for rests_on in kept for one in rests_on if one.asked is not None}
    used = (slots_of(each.request.reaction.redex) for each in requests if isinstance(each.request, CTR | FLY))
    return frozenset(asked).union(*used)


# --- abilities after a step -----------------------------------------------------------------------------------------


def _moves(actors: Actors, c: Configuration) -> Iterator[tuple[Actor, Transition]]:
    """Yield all steps, each with its actor."""
    for agent in c.alpha.names():
        found = (step for step in steps(c, agent) if isinstance(step, Transition))
        yield from ((actors.actor_of(step.label), marked(c, step)) for step in found)
    for number, clause in enumerate(c.setting.environment):
        yield from ((Actor("clause", number), step) for step in by_clause(c, clause))


def _beyond(actors: Actors, acting: dict[Actor, Acting], mover: Actor, step: Transition) -> Iterator[str]:
    """Yield the unforeseen accesses after a step, of its actor and of actors that it should not disturb."""
    for actor, may in actors.of(step.target).items():
        known = acting.get(actor, NOBODY)
        bounds = [("may ever do", may.ever, known.ever | acting[mover].ever)]
        if mover.kind == "program" and actors.ordered and actor != Actor("line", mover.owner):
            bounds.append(("may do aside", may.aside, known.aside | acting[mover].aside))
        if actor in acting and actor != mover and not disturbed(acting, actor, mover):
            bounds.append(("may do now", may.now, known.now))
        for what, found, bound in bounds:
            asking = replace(found, reads=found.reads & actors.everything.changes)
            for slot in actors.footprints.slots.named(asking.beyond(bound)):
                if what != "may do now" or slot[0] not in MARKS:
                    yield f"after {step.label}, {actor} {what} something to {slot}, which was not foreseen"
