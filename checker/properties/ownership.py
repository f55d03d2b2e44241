"""Race-freedom by ownership, without a search: the paper's sufficient condition, over-approximated statically.

No agent may write a slot that another's redex, missing site or tested observation may read or write. `children` is no
slot of its own: it stands for the parents that a missing site reads, so two agents that write it don't interfere.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import assert_never

from semantics.analysis.traversal import expressions_of, reachable
from semantics.behaviours.expressions import (
    Apply,
    Expression,
    Host,
    Literal,
    QueryOf,
    Variable,
    direct_parts,
)
from semantics.behaviours.observations import QueryOperator
from semantics.behaviours.reaction_rules import Pattern, Reaction, Term
from semantics.behaviours.statements import ControlBy, Display, Migrate, Observe, Send, Spawn, Statement
from semantics.fixpoints import closure
from semantics.races.relevance import requested
from semantics.state.configuration import Configuration
from semantics.state.setting import Scheduler
from semantics.state.signature import Name

ANY = "*"
"""The wildcard for every name."""

Slot = tuple[str, Name]
"""`("parent", n)`, `("links", n)` or `("children", n)`."""

ANYTHING: frozenset[Slot] = frozenset((kind, ANY) for kind in ("parent", "links", "children"))


@dataclass(frozen=True, slots=True)
class Footprint:
    """The possible writes of one agent, and the possible inputs of its controls."""

    agent: Name
    writes: frozenset[Slot]
    reads: frozenset[Slot]


def owned(c: Configuration) -> bool:
    """Return whether a mission is race-free by ownership; c is its first configuration, with nothing pending."""
    footprints = [footprint(c, a) for a in c.alpha.names()]
    texts = [_Text(c, a) for a in c.alpha.names()]
    if any(isinstance(s, Spawn) for text in texts for s in text.statements):
        return False  # spawned agents can't be analysed yet
    if any(isinstance(s, Send) for text in texts for s in text.statements):
        tested = frozenset[Slot]().union(*(text.tested for text in texts))  # a message carries tests along
        footprints = [
            Footprint(f.agent, f.writes, f.reads | tested if f.writes else f.reads) for f in footprints
        ]
    if c.setting.scheduler is Scheduler.UNORDERED and any(f.writes for f in footprints):
        return False  # an agent may race with itself
    return not any(interferes(one, other) for one in footprints for other in footprints if one != other)


def interferes(one: Footprint, other: Footprint) -> bool:
    """Return whether one agent may write a slot that another may read or write."""
    owned_by_other = {slot for slot in other.writes if slot[0] != "children"}  # children follow from parents
    return any(_overlaps(write, slot) for write in one.writes for slot in other.reads | owned_by_other)


def _overlaps(one: Slot, other: Slot) -> bool:
    return one[0] == other[0] and (ANY in (one[1], other[1]) or one[1] == other[1])


def footprint(c: Configuration, agent: Name) -> Footprint:
    """Return the possible writes and reads of an agent, from its text alone."""
    text = _Text(c, agent)
    if text.reactions is None:
        return Footprint(agent, ANYTHING, ANYTHING)
    writes = frozenset[Slot]().union(*(text.writes(reaction) for reaction in text.reactions))
    reads = frozenset[Slot]().union(*(text.redex(reaction) for reaction in text.reactions))
    return Footprint(agent, writes, reads | text.tested if text.reactions else frozenset())


class _Text:
    """The possible statements, reactions and tests of one agent.

    Only constants name something here, as in the paper. The value flow is finer, and the reductions use it.
    """

    def __init__(self, c: Configuration, agent: Name) -> None:
        self.c = c
        self.agent = agent
        self.program = c.setting.program
        self._taken_along: dict[str | None, frozenset[Slot]] = {}

    @cached_property
    def _has_passive(self) -> bool:
        return any(self.c.setting.signature[kind].passive for kind in set(self.c.setting.kinds.values()))

    @cached_property
    def statements(self) -> tuple[Statement, ...]:
        """The statements that the agent may reach."""
        reach = reachable(self.program, self.c.alpha.code(self.agent))
        return tuple(self.program.statements[number] for number in sorted(reach))

    @cached_property
    def host(self) -> Name:
        """The agent's host, `ANY` if it may migrate."""
        migrates = any(isinstance(statement, Migrate) for statement in self.statements)
        return ANY if migrates else self.c.alpha.host(self.agent)

    def name(self, expression: Expression) -> Name:
        """Return the name that an expression denotes, `ANY` if the text doesn't determine it."""
        if isinstance(expression, Host):
            return self.host
        known = isinstance(expression, Literal) and isinstance(expression.value, str)
        return str(expression.value) if known and isinstance(expression, Literal) else ANY

    @cached_property
    def reactions(self) -> tuple[Reaction, ...] | None:
        """The reactions that the agent may request, for any arguments; None if too many."""
        controls = [statement for statement in self.statements if isinstance(statement, ControlBy)]
        setting = self.c.setting
        hosts = frozenset(setting.kinds) if self.host == ANY else frozenset({self.host})
        found = [requested(setting, each, hosts) for each in controls]
        if any(each is None for each in found):
            return None
        return tuple(reaction for each in found for reaction in each or ())

    def writes(self, reaction: Reaction) -> frozenset[Slot]:
        """Return the slots that a reaction may change.

        A moved container may take any content along. The place of a carrier decides where its cargo can be put.
        """
        before, after = reaction.redex, reaction.reactum
        moved = {self._term(node) for node, _ in reaction.moves}
        linked = {self._term(node) for _, node in set(after.links) ^ set(before.links)}
        places = {("children", ANY)} if moved else set()
        slots = {("parent", node) for node in moved} | {("links", node) for node in linked} | places
        return frozenset(slots.union(*map(self._along, moved)))

    def _along(self, node: Name) -> frozenset[Slot]:
        """Return the slots of entities that move along with a node, or can no longer be put down afterwards."""
        kind = None if node == ANY else self.c.setting.kind(node)
        if kind not in self._taken_along:
            self._taken_along[kind] = self._along_with(kind)
        return self._taken_along[kind]

    def _along_with(self, kind: str | None) -> frozenset[Slot]:
        if kind is None:
            return frozenset({("parent", ANY)})
        signature, kinds = self.c.setting.signature, self.c.setting.kinds
        there = frozenset(kinds.values())
        carried = closure(signature[kind].carries & there, lambda each: signature[each].carries & there)
        if any(signature[each].contains for each in {kind, *carried}):
            return frozenset({("parent", ANY)})
        return frozenset(("parent", name) for name, of in kinds.items() if of in carried)

    def redex(self, reaction: Reaction) -> frozenset[Slot]:
        """Return the slots that a redex uses, missing sites included, and those of its places' positions."""
        pattern: Pattern = reaction.redex
        pairs = (*pattern.parents, *reaction.reactum.parents)
        parents = {("parent", self._term(node)) for node, _ in pattern.parents}
        parents |= {("parent", place) for _, place in pairs if isinstance(place, str)}
        if self._has_passive:  # nothing reacts inside a passive place, so all places around are read
            parents = {("parent", ANY)}
        links = {("links", self._term(node)) for _, node in pattern.links}
        return frozenset(parents | links | {("children", self._term(node)) for node in pattern.closed})

    def _term(self, term: Name | Term) -> Name:
        return term if isinstance(term, str) else ANY

    @cached_property
    def tested(self) -> frozenset[Slot]:
        """The slots that the agent's tests of observations may read."""
        tests = [test for statement in self.statements for test in self._tests(statement)]
        if not tests:
            return frozenset()
        asked: set[Slot] = set()
        for statement in self.statements:
            if isinstance(statement, Observe):
                asked |= set(self._asked(statement.query, tests))
        return frozenset(asked)

    def _tests(self, statement: Statement) -> Iterator[Name]:
        """Yield the tested name for each use of a variable's value; `ANY` unless the use is `name in variable`."""
        if isinstance(statement, Display):
            return
        for expression in expressions_of(statement):
            yield from self._asks(expression)

    def _asks(self, expression: Expression) -> Iterator[Name]:
        match expression:
            case Apply("in", (item, Variable(_))):
                yield self.name(item)
            case Variable(_):
                yield ANY
            case _:
                for part in direct_parts(expression):
                    yield from self._asks(part)

    def _asked(self, query: QueryOf, tests: list[Name]) -> Iterator[Slot]:
        """Yield the slots that determine whether the tested names are shown."""
        inner = query.argument
        match query.operator:
            case QueryOperator.CHILDREN:
                yield from (("parent", name) for name in tests)
            case QueryOperator.PARENT if inner is not None and not isinstance(inner, QueryOf):
                yield ("parent", self.name(inner))
            case QueryOperator.PARENT | QueryOperator.HOSTED_AT:
                yield ("parent", ANY)
            case QueryOperator.LINKED_TO:
                yield ("links", ANY)
            case None:
                yield from (("parent", ANY), ("links", ANY)) if inner is None else ()
            case _:
                assert_never(query.operator)
        if isinstance(inner, QueryOf):
            yield from self._asked(inner, tests)
