"""q(A(P)), the observation L_q that a query yields, and L ⊕ L_q.

A query denotes a set of nodes of A(P), composed pointwise. Its observation has the shown nodes, and every answer found
on the way: a yes is a pair, a no follows from an exhaustively listed place or link.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import assert_never

from semantics.behaviours.observations import (
    AGENT,
    NOTHING_SEEN,
    All,
    Applied,
    Fact,
    Nodes,
    Observation,
    Of,
    Query,
    QueryOperator,
    QueryStep,
    Steps,
    Swept,
    agent_key,
)
from semantics.state.agents import Agents
from semantics.state.cell_values import NAMES, Changes
from semantics.state.logical_model import LogicalModel
from semantics.state.physical_model import PhysicalModel
from semantics.state.signature import REGION, Name

# --- q(A(P)) ----------------------------------------------------------------------------------------------------


def evaluate(query: Query, physical: PhysicalModel, alpha: Agents) -> Observation:
    """Return q(A(P)): inner queries denote sets of nodes, and the answers are collected name by name.

    An absent host gives the empty observation.
    """
    return answers(resolve(query, physical, alpha), physical, alpha)


def sights(
    query: Query, physical: PhysicalModel, alpha: Agents, missable: Sequence[Name]
) -> Iterator[tuple[tuple[Name, ...], Observation]]:
    """Yield each possible answer of a query, with the missed entities M: q(A(P)) first, then q(A(P ∖ M)).

    An answer may miss, one after the other, entities of `missable` that it would show. So M is empty or has entities
    that matter to the query; there are at most 2ⁿ answers for n missable entities in view.
    """
    waiting: list[tuple[Name, ...]] = [()]
    for missed in waiting:  # it grows meanwhile
        seen = evaluate(query, physical.without(missed) if missed else physical, alpha)
        yield missed, seen
        for name in missable:
            more = tuple(sorted({*missed, name}))
            if more not in waiting and seen.fact(name) != NOTHING_SEEN:
                waiting.append(more)


def resolve(query: Query, physical: PhysicalModel, alpha: Agents) -> Steps:
    """Return the steps of a query, resolved in A(P)."""
    match query:
        case Of(operator, inner):
            steps = resolve(inner, physical, alpha)
            return (*steps, QueryStep(operator, denoted(steps, physical, alpha)))
        case All():
            return (QueryStep("ALL", tuple(sorted((REGION, *physical.entities())))),)
        case Nodes(names):
            return (QueryStep("", tuple(sorted({name for name in names if name in physical}))),)


def denoted(steps: Steps, physical: PhysicalModel, alpha: Agents) -> tuple[Name, ...]:
    """Return the names that resolved steps denote, sorted."""
    operator, names = steps[-1]
    if operator in ("", "ALL"):
        return names
    if operator == QueryOperator.PARENT:
        return tuple(sorted({REGION if n == REGION else physical.abstract_parent(n) for n in names}))
    looking = _Looking(steps, physical, alpha)
    return tuple(sorted(n for n in (REGION, *looking.names) if looking.shows(n, looking.parent(n))))


def answers(steps: Steps, physical: PhysicalModel, alpha: Agents) -> Observation:
    """Return the observation of a resolved query: the values in A(P) of the slots that it looks at."""
    looking = _Looking(steps, physical, alpha)
    agents = alpha.names() if any(step.operator == QueryOperator.HOSTED_AT for step in steps) else ()
    names = (*looking.names, *map(agent_key, agents))
    return Observation(physical.cells.each(names, looking.fact), looking.swept())


class _Looking:
    """One evaluation of resolved steps."""

    def __init__(self, steps: Steps, physical: PhysicalModel, alpha: Agents) -> None:
        self.physical = physical
        self.alpha = alpha
        self.names: tuple[Name, ...] = physical.cells.read(NAMES)
        self.applied = [(operator, frozenset(names)) for operator, names in steps]
        self.to = {operator: self._to(operator) for operator in QueryOperator}
        self.links = self._links_of_all(self.to[QueryOperator.LINKED_TO])
        operator, inner = self.applied[-1]
        self.followed = self._links_of_all(inner if operator == QueryOperator.LINKED_TO else ())

    def _to(self, operator: QueryOperator) -> frozenset[Name]:
        """Return all arguments of an operator."""
        all_too = operator in (QueryOperator.CHILDREN, QueryOperator.LINKED_TO)
        both: tuple[Applied, ...] = (operator, "ALL") if all_too else (operator,)
        return frozenset[Name]().union(*(names for applied, names in self.applied if applied in both))

    def _links_of_all(self, names: Iterable[Name]) -> frozenset[Name]:
        return frozenset(link for name in names for link in self.links_of(name))

    def swept(self) -> Swept:
        nodes = self.to[QueryOperator.LINKED_TO] - {REGION}
        operator, inner = self.applied[-1]
        around = inner if operator == QueryOperator.CHILDREN else frozenset[Name]()
        listed = (self.to[QueryOperator.CHILDREN], nodes, self.links, around)
        return Swept(*(tuple(sorted(each)) for each in listed))

    def fact(self, name: Name) -> Fact:
        """Return the fact about one name."""
        if name.startswith(AGENT):
            return Fact(self.alpha.host(name.removeprefix(AGENT)) in self.to[QueryOperator.HOSTED_AT])
        parent = self.parent(name)
        links = tuple(link for link in self.links_of(name) if link in self.links) if self.links else ()
        return Fact(self.shows(name, parent), parent, links)

    def shows(self, name: Name, parent: Name | None) -> bool:
        """Whether the outermost operator denotes a node or the region; `parent` may be None if it was not requested."""
        operator, inner = self.applied[-1]
        match operator:
            case "" | "ALL":
                return name in inner
            case QueryOperator.PARENT:
                return any(self.physical.is_in(n, name) if n != REGION else name == n for n in sorted(inner))
            case QueryOperator.CHILDREN:
                return name in inner or parent in inner
            case QueryOperator.LINKED_TO:
                return name in inner or (
                    bool(self.followed) and not self.followed.isdisjoint(self.links_of(name))
                )
            case QueryOperator.HOSTED_AT:
                return False  # it denotes agents
            case _:
                assert_never(operator)

    def parent(self, name: Name) -> Name | None:
        """Return the parent of a node in A(P), as far as the query requests it: by `PARENT`, or by `CHILDREN`."""
        if name == REGION:
            return None
        if name in self.to[QueryOperator.PARENT]:
            return self.physical.abstract_parent(name)
        return self.parent_among(name, self.to[QueryOperator.CHILDREN])

    def parent_among(self, name: Name, places: frozenset[Name]) -> Name | None:
        if len(places) == 1:
            (place,) = places
            return place if name != REGION and self.physical.is_in(name, place) else None
        if not places or name == REGION or name not in self.physical:
            return None
        place = self.physical.abstract_parent(name)
        return place if place in places else None

    def links_of(self, name: Name) -> tuple[Name, ...]:
        return () if name == REGION else self.physical.links(name)


# --- L ⊕ L_q ----------------------------------------------------------------------------------------------------


def overlay(logical: LogicalModel, seen: Observation) -> Mapping[Name, Changes]:
    """Return the writes of L ⊕ L_q, node by node: exactly the answers of the query.

    A yes sets the relation. A no removes only the denied relation. A node believed under a listed place, and not seen
    there, goes to the region. A link that was listed without n loses n. A new node without an observed parent goes to
    the region. On a cycle, the nodes whose parent was not observed go to the region. So L_q ⊆ L ⊕ L_q.
    """
    learning = _Learning(logical, seen)
    return logical.cells.each(learning.names, learning.of)


class _Learning:
    """The update of L by one observation."""

    def __init__(self, logical: LogicalModel, seen: Observation) -> None:
        self.logical = logical
        self.seen = seen
        self.names: tuple[Name, ...] = logical.cells.read(NAMES)
        self.looked_at = frozenset(seen.swept.nodes)

    def of(self, name: Name) -> Changes:
        """Return the writes about one node."""
        place, links = self.place(name), self.links(name)
        nested = {} if place is None else self.logical.nesting(name, place)
        return nested if links is None else nested | self.logical.linking(name, links)

    def place(self, name: Name) -> Name | None:
        """Return the new parent of a node, None if it keeps its parent."""
        answered = self.seen.parent(name)
        if answered is not None:
            return answered
        if name not in self.logical:
            return REGION if self.is_node(name) else None
        return REGION if self.is_denied(name) or self.is_on_cycle(name) else None

    def is_node(self, name: Name) -> bool:
        """Whether a node is in dom(L_q)."""
        return self.seen.fact(name) != NOTHING_SEEN or self.seen.is_parent(name, self.names)

    def is_denied(self, name: Name) -> bool:
        """Whether a node's believed parent is a listed place in which it was not seen."""
        return any(self.logical.is_in(name, place) for place in self.seen.swept.places)

    def is_on_cycle(self, name: Name) -> bool:
        """Whether the new parents lead from a node back to it; never if its kind holds nothing."""
        sorting = self.logical.sorting
        if not sorting.signature[sorting.kind(name)].holds:
            return False
        passed: set[Name] = set()
        at = self.logical.parent(name)
        while at is not None and at != REGION and at not in passed:
            if at == name:
                return True
            passed.add(at)
            at = self.seen.parent(at) or (REGION if self.is_denied(at) else self.logical.parent(at))
        return False

    def links(self, name: Name) -> frozenset[Name] | None:
        """Return the new links of a node, None if it keeps its links."""
        swept = self.seen.swept
        if name in self.looked_at:
            return self.seen.links(name)
        if not swept.links:
            return None
        return frozenset(self.logical.links(name)).difference(swept.links) | self.seen.links(name)
