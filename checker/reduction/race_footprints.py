"""The race monitor's part of footprints: the steps that mark observations as stale, or pass marks on.

A control marks its changes in the provenance of other agents (`semantics.races.monitor.marked`), and in its own agent's
where that may be passed on. Any use of provenance (test, pass on, drop, extend) has another result before a mark than
after it, so it reads the marks that may be made there. Marks are added to sets, so those of two controls commute, if
neither control changes the inputs of the other's marks.
"""

from collections.abc import Iterable, Iterator
from functools import cache

from checker.reduction.footprint_slots import NOTHING, Slot, SlotFootprint, joined
from checker.reduction.footprints import Footprints
from checker.reduction.observation_flow import tellers
from semantics.analysis.overapproximation import Names
from semantics.analysis.traversal import reachable
from semantics.behaviours.observations import Nodes, Of, Query, QueryOperator
from semantics.behaviours.statements import Observe
from semantics.races.provenance import ANY, SLOT, Key, Provenance
from semantics.races.relevance import Questions, anybodys, hosts_of, questions_in, slots_of, tells
from semantics.state.agents import AgentProvenance, Code, watch_cell
from semantics.state.cell_values import MONITOR
from semantics.state.configuration import Configuration
from semantics.state.eta import line_cell, sends_cell
from semantics.state.requests import CTR, FLY, OBS, SND, Request
from semantics.state.signature import Name

ANSWERS = "answers"
"""Marks on answers to queries; marks on slots of A(P) have a kind for each sort of slot."""

PARENT, LINKS, CHILDREN = (f"{SLOT}{kind}" for kind in ("parent", "links", "children"))
MARKS = frozenset({ANSWERS, PARENT, LINKS, CHILDREN})


def slot_of_mark(holder: Name, key: Key) -> Slot:
    """Return the slot of a mark in an agent's memory."""
    if key[0] == CHILDREN:
        return (CHILDREN, holder)
    return (key[0], holder, key[1]) if key[0] in (PARENT, LINKS) else (ANSWERS, holder)


class Marks:
    """Footprints over marks; empty without the race monitor."""

    def __init__(self, footprints: Footprints) -> None:
        self.footprints = footprints
        self.bounds, self.roles = footprints.bounds, footprints.roles
        self.program = self.bounds.setting.program
        self.monitored = self.bounds.setting.monitored
        self.tellers = tellers(self.bounds.initial, self.roles) if self.monitored else frozenset()
        self.held = cache(self._held)
        self.looking = cache(footprints.look)
        self._making = cache(self._make)
        self._reading = cache(self._of)
        self.resting = cache(self._resting)

    # --- making marks ---------------------------------------------------------------------------------------------

    def made(self, author: Name, does: SlotFootprint) -> SlotFootprint:
        """Bound the marks of a control in other agents' memory, and their inputs, given the control's writes to P."""
        return self._making(author, does.writes) if self.monitored else NOTHING

    def _make(self, author: Name, writes: int) -> SlotFootprint:
        moved, linked = self._changed("placement", writes), self._changed("channels", writes)
        if any(self.bounds.setting.signature[self.bounds.setting.kind(name)].holds for name in moved):
            moved = self.bounds.names
        touched = moved | linked
        slots = self.footprints.slots
        found = SlotFootprint(self.footprints.where(touched) | self.footprints.there(touched))
        found |= SlotFootprint(self.footprints.connected(linked))
        for holder in self.roles.agents:
            if holder != author and self.held(holder):
                found |= slots.footprint(merges=self._of_slots(holder, moved, linked))
            if (
                holder != author or holder in self.tellers
            ):  # its own controls also make its passed-on observations stale
                found |= self._of_answers(holder, writes, touched)
        return found

    def _changed(self, what: str, writes: int) -> Names:
        slots = self.footprints.slots.named(writes)
        return frozenset(str(slot[1]) for slot in slots if slot[0] == what) & self.bounds.names

    def _of_slots(self, holder: Name, moved: Names, linked: Names) -> Iterator[Slot]:
        yield from ((PARENT, holder, name) for name in moved)
        yield from ((LINKS, holder, name) for name in linked)
        if moved:
            yield (CHILDREN, holder)

    def _of_answers(self, holder: Name, writes: int, touched: Names) -> SlotFootprint:
        """Bound the marks on the answers to an agent's queries, for queries that read a change."""
        looks = [each for each in self.held(holder) if writes & self.looking(each).reads]
        reads = 0
        for query in looks:
            reads |= self._deciding(query, touched).reads
        return SlotFootprint(reads, 0, self.footprints.slots.bits([(ANSWERS, holder)]) if looks else 0)

    def _deciding(self, query: Query, touched: Names) -> SlotFootprint:
        """Bound the other inputs that decide how a change of some entities affects the answer to a query.

        Each child of a place is there or not, independently of the others.
        """
        if not isinstance(query, Of) or query.operator != QueryOperator.CHILDREN or not is_local(query):
            return self.looking(query)
        return self.looking(query if touched.intersection(nodes_of(query)) else query.of)

    def _held(self, agent: Name) -> tuple[Query, ...]:
        """Return the queries in an agent's possible provenance; all agents' queries if observations are passed on."""
        whose = self.roles.agents if self.tellers else (agent,)
        return tuple(dict.fromkeys(query for each in whose for query in self._asked(each)))

    def _asked(self, agent: Name) -> Iterator[Query]:
        initial = self.bounds.initial
        pending = initial.eta.of(agent) if agent in initial.alpha else ()
        yield from (each.request.query for each in pending if isinstance(each.request, OBS))
        for number in sorted(self.roles[agent].statements):
            statement = self.program.statements[number]
            if isinstance(statement, Observe):
                yield self.roles.query(agent, statement.query)

    # --- passing marks on -----------------------------------------------------------------------------------------

    def is_blank(self, c: Configuration, agent: Name) -> bool:
        """Return whether an agent's memory, mailbox and requests have no provenance."""
        if not self.monitored:
            return True
        requests = ((MONITOR, *cell) for cell in (line_cell(agent), sends_cell(agent)))
        return c.state.test(watch_cell(agent), _is_blank) and not any(
            c.state.test(cell, _rests) for cell in requests
        )

    def rested_on(self, agent: Name, code: Code) -> SlotFootprint:
        """Bound the marks in an agent's memory while this code is left to it."""
        return self.resting(agent, reachable(self.program, code)) if self.monitored else NOTHING

    def _resting(self, agent: Name, reach: frozenset[int]) -> SlotFootprint:
        if agent in self.tellers and tells(self.program, reach):
            return self._reading(agent, anybodys(self.bounds.initial))
        initial = self.bounds.initial
        return self._reading(agent, questions_in(initial.setting, reach, hosts_of(initial, agent)))

    def told(self, agent: Name, listeners: Iterable[Name]) -> SlotFootprint:
        """Bound the marks in an agent's messages; receivers that can never exist don't count."""
        if agent not in self.tellers:
            return NOTHING
        there = (each for each in listeners if each in self.roles.agents)
        return joined(self._reading(each, anybodys(self.bounds.initial)) for each in there)

    def carried(self, agent: Name, request: Request, rested_on: SlotFootprint) -> SlotFootprint:
        """Bound the marks in the provenance of an agent's request, given those in its memory."""
        match request:
            case SND(_, to):
                return self.told(agent, [to])
            case CTR(_, reaction) | FLY(_, reaction, _) if self.monitored:
                return self._reading(agent, slots_of(reaction.redex))
            case _:
                return rested_on

    def _of(self, holder: Name, questions: Questions) -> SlotFootprint:
        return self.footprints.slots.footprint([(ANSWERS, holder), *self._asked_for(holder, questions)])

    def _asked_for(self, holder: Name, questions: Questions) -> Iterator[Slot]:
        for kind, *names in questions:
            if kind == CHILDREN:
                yield (CHILDREN, holder)
            elif kind in (PARENT, LINKS):
                yield from ((kind, holder, name) for name in (self.bounds.names if ANY in names else names))


def _is_blank(watch: AgentProvenance | None) -> bool:
    return watch is None or not any((*watch.code, *watch.store, *watch.mailbox, watch.host))


def _rests(kept: tuple[Provenance, ...] | None) -> bool:
    return any(kept or ())


def is_local(query: Of) -> bool:
    """Return whether a query starts at nodes and goes only to parents before its last operator."""
    inner = query.of
    while isinstance(inner, Of) and inner.operator == QueryOperator.PARENT:
        inner = inner.of
    return isinstance(inner, Nodes)


def nodes_of(query: Query) -> tuple[Name, ...]:
    """Return the nodes that a query starts at; none for ALL."""
    while isinstance(query, Of):
        query = query.of
    return query.names if isinstance(query, Nodes) else ()
