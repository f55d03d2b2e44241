"""Footprints of queries, reactions, messages, migrations, and the environment's clauses.

They are static over-approximations from the text, the kinds and the first configuration, never from observed reads.
Each function names the rule whose reads and writes it bounds.
"""

from collections.abc import Iterable, Iterator
from functools import cache
from typing import assert_never

from checker.reduction.footprint_slots import NOTHING, Slot, SlotFootprint, Slots
from semantics.analysis.overapproximation import Names, Overapproximation
from semantics.analysis.possible_messages import wakes
from semantics.analysis.value_flow import ValueFlow
from semantics.behaviours.expressions import Expression, Literal
from semantics.behaviours.observations import All, Nodes, Query, QueryOperator
from semantics.behaviours.reaction_rules import (
    LinkTerm,
    NodeTerm,
    NodeVariable,
    PlaceTerm,
    PlaceVariable,
    Reaction,
)
from semantics.behaviours.statements import React
from semantics.environment import Appears, Clause, Drifts, Drops, Leaves, Says, Vanishes
from semantics.state.physical_model import Carried
from semantics.state.setting import Scheduler
from semantics.state.signature import REGION, Name

AGENTS: Slot = ("agents",)


class Footprints:
    """The possible reads and writes of rules, within the bounds of one mission."""

    def __init__(self, bounds: Overapproximation, roles: ValueFlow) -> None:
        self.bounds = bounds
        self.roles = roles
        self.slots = Slots()
        self._where = cache(self._decides_where)
        self.wakes = wakes(bounds.setting.program)
        statements = enumerate(bounds.setting.program.statements)
        self.reacts = tuple(number for number, each in statements if isinstance(each, React))
        self.settled = 0
        """Bits of L that no observation can change: see `settle`."""

    # --- reads of P and L -------------------------------------------------------------------------------------

    def where(self, names: Iterable[Name]) -> int:
        """Return the slots that determine the places of entities, and their holders."""
        return self._where(frozenset(names))

    def there(self, names: Iterable[Name]) -> int:
        """Return the slots that determine whether entities have an image in P."""
        return self.slots.of("present", names)

    def connected(self, names: Iterable[Name]) -> int:
        """Return the slots that determine the links of entities in A(P)."""
        several = frozenset(names)
        here = self.slots.of("channels", several) | self.slots.of("present", several)
        return here | self.slots.of("down", self.bounds.channels)

    def _decides_where(self, names: Names) -> int:
        return self.slots.of("placement", frozenset[Name]().union(*map(self.bounds.around, names)))

    def linked(self, hosts: Iterable[Name], others: Iterable[Name]) -> SlotFootprint:
        """Bound `extension.linked`: whether one of some hosts shares a link with one of others, in L and in P."""
        ours, theirs = frozenset(hosts), frozenset(others)
        if len(ours) == 1 and ours == theirs:
            return NOTHING
        both = ours | theirs
        return SlotFootprint(self.connected(both) | self.slots.of("links", both))

    # --- rules ------------------------------------------------------------------------------------------------

    def sense(self, agent: Name, hosts: Iterable[Name], query: Query) -> SlotFootprint:
        """Bound `sense`: the answers of a query, and the entities that may be missed."""
        return self.look(query) | self._missing(agent, hosts)

    def look(self, query: Query) -> SlotFootprint:
        """Bound the reads of a query, and its changes to L ⊕ L_q."""
        looking = _Looking(self, query)
        merges = looking.merges & ~self.settled
        cyclic = self.slots.of("parent", self.bounds.cyclic)
        breaking = cyclic if merges & cyclic else 0
        return SlotFootprint(looking.reads | breaking, breaking, merges & ~breaking)

    def _missing(self, agent: Name, hosts: Iterable[Name]) -> SlotFootprint:
        """Bound what an answer may miss: no carrier of the agent's host, and each entity together with its cargo."""
        if not self.bounds.setting.missable:
            return NOTHING
        cargo = frozenset[Name]().union(*map(self.bounds.aboard, self.bounds.setting.missable))
        reads = self.where(hosts) | self.slots.of("placement", cargo)
        return SlotFootprint(reads) | self.slots.footprint([("host", agent)])

    def control(self, agent: Name, reaction: Reaction) -> SlotFootprint:
        """Bound `actuate`, `command` and `commit` of a reaction, and `control.obstacle`."""
        return _Reacting(self, reaction).footprint() | self.slots.footprint([("host", agent)])

    def post(self, agent: Name, hosts: Iterable[Name], to: Name, message: Expression) -> SlotFootprint:
        """Bound `snd`: it delivers the message to one mailbox if hosts are linked."""
        reads = [("host", agent), ("host", to), *([AGENTS] if self.roles.may_come(to) else [])]
        delivered = self.slots.footprint(reads, merges=self.mail(to, message))
        return delivered | self.linked(hosts, self.roles.hosts(to))

    def mail(self, to: Name, message: Expression) -> Iterator[Slot]:
        """Yield the slots for each of the receiver's `react` statements that a message may wake, or make fail."""
        for number in self.wakes(message):
            yield from (("mail", to, number), ("fault", to, number))

    def migrate(self, agent: Name, hosts: Iterable[Name], to: Name) -> SlotFootprint:
        """Bound `migrate`."""
        return self.linked(hosts, {to}) | self.slots.footprint(writes=[("host", agent)])

    def waiting(self, agent: Name, react: int, told: bool) -> SlotFootprint:
        """Bound `rcv_msg` and `rcv_obs` without the agent's own cells: its other possible messages and observations.

        Args:
            agent: The waiting agent.
            react: The number of its statement.
            told: Whether its first observation is ready.
        """
        return self.slots.footprint([("mail", agent, react), *([] if told else [("ready", agent)])])

    def telling(self, agent: Name) -> SlotFootprint:
        """Bound the effect of `sense` on its agent: one more observation to receive."""
        faults = (("fault", agent, number) for number in self.reacts)
        unordered = self.bounds.setting.scheduler is Scheduler.UNORDERED
        return self.slots.footprint(merges=[("ready", agent), *(faults if unordered else ())])

    def wary(self, agent: Name, react: int) -> SlotFootprint:
        """Bound the slots that may obstruct a `react` later.

        A guard that fails on one message hides the messages after it. Any arrival may end the wait for a timeout.
        """
        statement = self.bounds.setting.program.statements[react]
        assert isinstance(statement, React)
        guarded = any(case.guard is not None for case in statement.cases)
        faults: list[Slot] = [("fault", agent, react)] if guarded else []
        comes: list[Slot] = [("mail", agent, react), ("ready", agent)] if statement.after else []
        return self.slots.footprint([*faults, *comes])

    def spawn(self) -> SlotFootprint:
        """Bound `spawn`, without the new agent's steps."""
        return self.slots.footprint([AGENTS], [AGENTS])

    # --- the environment --------------------------------------------------------------------------------------

    def clause(self, clause: Clause) -> SlotFootprint:
        """Bound `env` and `say` of one clause."""
        match clause:
            case Drifts(entity):
                return self.slots.footprint([("placement", entity)], [("placement", entity)])
            case Drops(channel):
                return self.slots.footprint([("down", channel)], [("down", channel)])
            case Leaves(entity):
                own: list[Slot] = [("channels", entity)]
                return self.slots.footprint([("present", entity), *own], own)
            case Appears(entity, placements):
                by = (placement.by for placement in placements if isinstance(placement, Carried))
                return SlotFootprint(self.there([entity, *by]), self._all_of([entity]))
            case Vanishes(entity):
                return SlotFootprint(writes=self._all_of({entity, *self.bounds.aboard(entity)}))
            case Says(message, agent):
                reads = [AGENTS] if self.roles.may_come(agent) else []
                return self.slots.footprint(reads, merges=self.mail(agent, Literal(message)))
            case _:
                assert_never(clause)

    def _all_of(self, names: Iterable[Name]) -> int:
        several = frozenset(names)
        return self.slots.of("placement", several) | self.there(several) | self.slots.of("channels", several)

    # --- constant slots ---------------------------------------------------------------------------------------

    def settle(self, everything: SlotFootprint) -> None:
        """Record the slots of L that no observation can change: L agrees with A(P), and neither is ever written.

        Args:
            everything: The union of all actors' footprints.
        """
        logical, physical = self.bounds.initial.structure.logical, self.bounds.initial.structure.physical
        for name in self.bounds.names & self.bounds.known:
            if name not in physical or not self.bounds.around(name).isdisjoint(self.bounds.setting.missable):
                continue  # an answer that misses it, or a place around it, may contradict L
            place = self.slots.of("parent", [name])
            agree = logical.parent(name) == physical.abstract_parent(name) and name not in self.bounds.cyclic
            if agree and not everything.writes & (place | self.where([name])):
                self.settled |= place
            links = self.slots.of("links", [name])
            agree = logical.links(name) == physical.links(name)
            if agree and not everything.writes & (links | self.connected([name])):
                self.settled |= links


class _Looking:
    """The possible reads of one query's evaluation, and the slots of L that its result may change."""

    def __init__(self, of: Footprints, query: Query) -> None:
        self.of = of
        self.bounds = of.bounds
        self.slots = of.slots
        self.reads = self.merges = 0
        self.show(self.ask(query))

    def show(self, names: Iterable[Name]) -> None:
        """Add the slots of shown names that are no nodes of L yet."""
        new = frozenset(names) - self.bounds.known - {REGION}
        self.merges |= self.slots.of("parent", new) | self.slots.of("known", new)

    def ask(self, query: Query) -> Names:
        """Return all names that a query may denote."""
        if isinstance(query, Nodes):
            self.reads |= self.of.there(query.names)
            return frozenset(query.names) & self.bounds.names
        if isinstance(query, All):
            self.everything()
            return self.bounds.names
        found = [self.answer(query.operator, name) for name in sorted(self.ask(query.of))]
        return frozenset[Name]().union(*found)

    def answer(self, operator: QueryOperator, name: Name) -> Names:
        """Return all names that an operator may denote for one node."""
        match operator:
            case QueryOperator.PARENT:
                return self.parent(name)
            case QueryOperator.CHILDREN:
                return self.children(name)
            case QueryOperator.LINKED_TO:
                return self.linked_to(name)
            case QueryOperator.HOSTED_AT:
                return self.hosted_at(name)
            case _:
                assert_never(operator)

    def everything(self) -> None:
        self.reads |= self.of.there(self.bounds.names)
        for name in (REGION, *sorted(self.bounds.names)):
            self.children(name)
            self.linked_to(name)

    def parent(self, name: Name) -> Names:
        if name == REGION:
            return frozenset({REGION})
        self.reads |= self.of.where([name]) | self.of.there([name])
        self.merges |= self.slots.of("parent", [name])
        places = self.bounds.holders(name)
        self.show({name, *places})
        return places | {REGION}

    def children(self, place: Name) -> Names:
        inside = self.bounds.inside(place)
        self.reads |= self.of.where(inside) | self.of.there(inside)
        self.merges |= self.slots.of("parent", inside | self.bounds.believed_inside(place))
        self.show(inside | {place})
        return inside | {place}

    def linked_to(self, name: Name) -> Names:
        if name == REGION:
            return frozenset({REGION})
        self.reads |= self.of.connected(self.bounds.names)
        self.merges |= self.slots.of("links", self.bounds.names)
        self.show(self.bounds.names)
        return self.bounds.names

    def hosted_at(self, _: Name) -> Names:
        self.reads |= self.slots.bits([AGENTS]) | self.slots.of("host", self.of.roles.agents)
        return frozenset()


class _Reacting:
    """The possible reads and writes of serving a control, for any match of its redex."""

    def __init__(self, of: Footprints, reaction: Reaction) -> None:
        self.of = of
        self.bounds = of.bounds
        self.reaction, self.redex, self.reactum = reaction, reaction.redex, reaction.reactum
        self.nodes = frozenset[Name]().union(*map(self.nodes_of, (*self.redex.nodes, *self.reactum.nodes)))
        self.slots = of.slots
        self.reads = self.writes = 0

    def footprint(self) -> SlotFootprint:
        """Return the footprint."""
        self.matching()
        self.placing()
        self.relinking()
        return SlotFootprint(self.reads, self.writes)

    def nodes_of(self, term: NodeTerm) -> Names:
        """Return the nodes that a term may stand for."""
        if not isinstance(term, NodeVariable):
            return frozenset({term})
        kinds = self.bounds.setting.kinds
        return frozenset(name for name in self.bounds.names if term.kind in (None, kinds[name]))

    def places_of(self, place: PlaceTerm, node: Name) -> Names:
        """Return the places that a term may stand for, around a node."""
        if not isinstance(place, PlaceVariable):
            return self.nodes_of(place)
        bound = (self.nodes_of(term) for term, where in self.redex.parents if where == place)
        around = frozenset({node}).union(*bound) & self.bounds.names
        return frozenset[Name]().union(*map(self.bounds.believable, around))

    def matching(self) -> None:
        """Bound `matches`, `is_active`, `is_full` and consistency: the parts of L and P that R uses."""
        self.reads |= self.slots.of("known", self.nodes) | self.of.there(self.nodes)
        for pattern in (self.redex, self.reactum):
            for term, place in pattern.parents:
                self.parents(term, place)
            for link in pattern.links:
                self.links(link)
            for closed in pattern.closed:
                self.full(self.nodes_of(closed))
        if self.bounds.passive:
            above = frozenset[Name]().union(*map(self.bounds.above, self.nodes & self.bounds.names))
            self.reads |= self.slots.of("parent", self.nodes | above)

    def parents(self, term: NodeTerm, place: PlaceTerm) -> None:
        for node in self.nodes_of(term) & self.bounds.names:
            places = self.places_of(place, node) & self.bounds.names
            self.reads |= self.slots.of("parent", [node]) | self.of.where({node, *places})

    def links(self, link: tuple[LinkTerm, NodeTerm]) -> None:
        nodes = self.nodes_of(link[1])
        self.reads |= self.slots.of("links", nodes) | self.of.connected(nodes)

    def full(self, places: Names) -> None:
        for place in places:
            inside = self.bounds.inside(place)
            self.reads |= self.slots.of("parent", self.bounds.believed_inside(place))
            self.reads |= self.of.where(inside) | self.of.there(inside)

    def placing(self) -> None:
        """Bound `moved`, `stays_forest` and `drive`: the nodes that may move, and what is around their targets.

        `parents` has bounded what decides where they are.
        """
        pairs = self.reaction.moves
        moving = frozenset[Name]().union(*(self.nodes_of(node) for node, _ in pairs)) & self.bounds.names
        places = frozenset[Name]().union(
            *(self.places_of(place, each) for node, place in pairs for each in self.nodes_of(node) & self.bounds.names)
        ) & self.bounds.names  # fmt: skip
        for node in moving:
            self.writes |= self.slots.of("parent", [node]) | self.slots.of("placement", [node])
        above = places.union(*map(self.bounds.above, places))
        if above & moving:
            self.reads |= self.slots.of("parent", above)

    def relinking(self) -> None:
        """Bound `relinked`: the nodes whose links and channels may change."""
        changed = set(self.redex.links) ^ set(self.reactum.links)
        nodes = frozenset[Name]().union(*(self.nodes_of(node) for _, node in changed))
        self.writes |= self.slots.of("links", nodes) | self.slots.of("channels", nodes)
