"""Reactions R ⇒ R' of missions: patterns of relations over names and variables, and their matches in L.

Matching is by relations: injective on nodes, and the image of one redex region may lie inside another's site.
(`bigraphs.matching` keeps Milner's own disjointness, for `.big` systems.)
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from semantics.state.relations import Linked, Parent, Relation
from semantics.state.signature import REGION, Name

if TYPE_CHECKING:  # reactions are also loaded for the language's words, without geometry
    from semantics.state.logical_model import LogicalModel
    from semantics.state.physical_model import PhysicalModel

CONTROL_AUTHORITY = "control"
"""The kind of the channels that represent control authority over a vehicle: `control:gcs0`."""


@dataclass(frozen=True, slots=True)
class NodeVariable:
    """Stands for a node, of a kind if one is given."""

    name: str
    kind: str | None = None

    def __str__(self) -> str:
        return self.name if self.kind is None else f"{self.name}_{self.kind}"


@dataclass(frozen=True, slots=True)
class PlaceVariable:
    """Stands for any place, node or region, possibly the same as another term."""

    name: str

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True, slots=True)
class LinkVariable:
    """Stands for a link; `kind` is the part before the colon in `control:gcs0`.

    Attributes:
        kind: Only links of this kind, None for any.
        but: No links of this kind.
    """

    name: str
    kind: str | None = None
    but: str | None = None

    def __str__(self) -> str:
        return self.name


NodeTerm = Name | NodeVariable
PlaceTerm = Name | NodeVariable | PlaceVariable
LinkTerm = Name | LinkVariable
Term = NodeVariable | PlaceVariable | LinkVariable


@dataclass(frozen=True, slots=True)
class Pattern:
    """One side of a reaction.

    Attributes:
        nodes: The nodes named.
        parents: Pairs (node, place).
        links: Pairs (link, node).
        closed: Nodes written without a site: they have no other child.
    """

    nodes: tuple[NodeTerm, ...]
    parents: tuple[tuple[NodeTerm, PlaceTerm], ...] = ()
    links: tuple[tuple[LinkTerm, NodeTerm], ...] = ()
    closed: tuple[NodeTerm, ...] = ()

    def beside(self, nodes: tuple[NodeTerm, ...]) -> Pattern:
        """Return the pattern with more nodes as context, without relations."""
        return replace(self, nodes=(*self.nodes, *nodes)) if nodes else self


Sides = tuple[Pattern, Pattern]
"""R and R'."""


@dataclass(frozen=True, slots=True)
class Reaction:
    """R ⇒ R', printed as the programmer wrote it.

    Attributes:
        text: The written text.
        redex: R.
        reactum: R'.
        via: The places that the travelling nodes pass, in order; R and R' contain them unchanged.
    """

    text: str
    redex: Pattern
    reactum: Pattern
    via: tuple[Name, ...] = ()

    def __hash__(self) -> int:
        return hash(self.text)  # strings cache their hash; each step hashes requests

    def __str__(self) -> str:
        return self.text

    @property
    def moves(self) -> tuple[tuple[NodeTerm, PlaceTerm], ...]:
        """The moved nodes and their new places, as terms of the patterns; `moved` gives those of a match."""
        before = dict(self.redex.parents)
        return tuple((node, place) for node, place in self.reactum.parents if before.get(node) != place)


@dataclass(frozen=True, slots=True)
class Match:
    """m: the value of each variable of a redex, sorted by variable."""

    binding: tuple[tuple[Term, Name], ...] = ()

    def __hash__(self) -> int:
        return hash(tuple(name for _, name in self.binding))

    def __getitem__(self, term: Name | Term) -> Name:
        return term if isinstance(term, str) else dict(self.binding)[term]

    def nodes(self, pattern: Pattern) -> tuple[Name, ...]:
        """Return the images of a pattern's nodes."""
        return tuple(self[node] for node in pattern.nodes)

    def relations(self, pattern: Pattern) -> tuple[Relation, ...]:
        """Return m(R): the pairs of σ_L between the images, according to the pattern."""
        return (
            *(Parent(self[node], self[place]) for node, place in pattern.parents),
            *(Linked(self[link], self[node]) for link, node in pattern.links),
        )

    def closed(self, pattern: Pattern) -> Iterator[tuple[Name, frozenset[Name]]]:
        """Yield the image of each closed node with all children that it may have."""
        for node in pattern.closed:
            inside = frozenset(self[child] for child, place in pattern.parents if place == node)
            yield self[node], inside

    def rebound(self, changes: Mapping[Term, Name]) -> Match:
        """Return the match with new values of these variables."""
        return make_match({**dict(self.binding), **changes})


def make_match(binding: Mapping[Term, Name]) -> Match:
    """Return the match with this binding."""
    return Match(tuple(sorted(binding.items(), key=lambda item: (type(item[0]).__name__, item[0].name))))


# --- the effect -----------------------------------------------------------------------------------------------


def moved(reaction: Reaction, match: Match) -> tuple[tuple[Name, Name], ...]:
    """Return the pairs (node, new parent) that the reaction changes, in the reactum's order."""
    before = {match[node]: match[place] for node, place in reaction.redex.parents}
    after = [(match[node], match[place]) for node, place in reaction.reactum.parents]
    return tuple((node, place) for node, place in after if before.get(node) != place)


def in_flight(reaction: Reaction, match: Match) -> Match:
    """Return the match that `commit` tests: places that occur only as origins of moving nodes become the region.

    So those origins are forgotten. `commit` uses the node's current place instead, and nothing moves to the region.
    """
    redex, gone = reaction.redex, {node for node, _ in moved(reaction, match)}
    places = [place for side in (redex, reaction.reactum) for _, place in side.parents]
    left = (place for node, place in redex.parents if match[node] in gone and places.count(place) == 1)
    return match.rebound({place: REGION for place in left if isinstance(place, PlaceVariable)})


def relinked(
    reaction: Reaction, match: Match, model: LogicalModel
) -> tuple[tuple[Name, frozenset[Name], frozenset[Name]], ...]:
    """Return (node, links lost, links gained) for each node whose links the reaction changes.

    A node that already has all links that it would gain loses nothing: handing over to the present authority is the
    identity.
    """
    before = {(match[link], match[node]) for link, node in reaction.redex.links}
    after = {(match[link], match[node]) for link, node in reaction.reactum.links}
    changes = []
    for node in sorted({node for _, node in before ^ after}):
        lost = frozenset(link for link, point in before - after if point == node)
        gained = frozenset(link for link, point in after - before if point == node)
        identity = bool(gained) and gained.issubset(model.links(node))
        changes.append((node, frozenset() if identity else lost, gained))
    return tuple(changes)


# --- matching -------------------------------------------------------------------------------------------------


def matches(redex: Pattern, logical: LogicalModel) -> tuple[Match, ...]:
    """Return every match of a redex in L, in canonical order: relations hold, nodes differ, closed nodes are full."""
    if not all(node in logical for node in redex.nodes if isinstance(node, str)):
        return ()
    search = _Search(redex, logical)
    found = {make_match(binding) for binding in search.solve(search.constraints(), {})}
    fitting = (match for match in found if _fits(match, redex, logical))
    return tuple(sorted(fitting, key=lambda match: match.binding and [value for _, value in match.binding]))


def _fits(match: Match, redex: Pattern, logical: LogicalModel) -> bool:
    nodes = match.nodes(redex)
    return is_active(nodes, logical) and len(set(nodes)) == len(nodes) and is_full(match, redex, logical)


def is_active(nodes: Iterable[Name], logical: LogicalModel) -> bool:
    """Whether no node lies, at any depth, in a node of a passive kind."""
    signature, kind = logical.sorting.signature, logical.sorting.kind
    return not any(signature[kind(place)].passive for node in nodes for place in logical.ancestors(node))


def is_full(match: Match, redex: Pattern, model: LogicalModel | PhysicalModel) -> bool:
    """Whether nodes written without a site have no other child, in L or in A(P)."""
    return all(inside.issuperset(model.children(node)) for node, inside in match.closed(redex))


def stays_forest(reaction: Reaction, match: Match, logical: LogicalModel) -> bool:
    """Whether L is still a forest when the reactum is true."""
    parents = dict(moved(reaction, match))
    for start in parents:
        seen: set[Name] = set()
        place: Name | None = start
        while place is not None and place != REGION:
            if place in seen:
                return False
            seen.add(place)
            place = parents.get(place, logical.parent(place))
    return True


Constraint = tuple[str, NodeTerm, PlaceTerm | LinkTerm | None]
Binding = dict[Term, Name]


class _Search:
    """Solves the constraints of a redex one after another, each against the relations of L."""

    def __init__(self, redex: Pattern, logical: LogicalModel) -> None:
        self.redex = redex
        self.logical = logical

    def constraints(self) -> tuple[Constraint, ...]:
        """Return the constraints, those with a name first: they have the fewest solutions."""
        related: list[Constraint] = [("parent", node, place) for node, place in self.redex.parents]
        related += [("linked", node, link) for link, node in self.redex.links]
        related.sort(key=lambda constraint: not any(isinstance(term, str) for term in constraint[1:]))
        return (*related, *(("node", node, None) for node in self.redex.nodes))

    def solve(self, constraints: tuple[Constraint, ...], binding: Binding) -> Iterator[Binding]:
        if not constraints:
            yield binding
            return
        relation, node, other = constraints[0]
        for name in self.candidates(node, other, relation, binding):
            bound = self.bind(binding, node, name)
            if bound is None:
                continue
            for after in self.relate(relation, name, other, bound):
                yield from self.solve(constraints[1:], after)

    def candidates(
        self, node: NodeTerm, other: PlaceTerm | LinkTerm | None, relation: str, binding: Binding
    ) -> tuple[Name, ...]:
        if isinstance(node, str):
            return (node,)
        if node in binding:
            return (binding[node],)
        place = other if isinstance(other, str) else binding.get(other) if other is not None else None
        return (
            self.logical.children(place)
            if relation == "parent" and place is not None
            else self.logical.nodes()
        )

    def relate(
        self, relation: str, name: Name, other: PlaceTerm | LinkTerm | None, binding: Binding
    ) -> Iterator[Binding]:
        if other is None:
            yield binding
            return
        values = (self.logical.parent(name),) if relation == "parent" else self.logical.links(name)
        for value in values:
            bound = None if value is None else self.bind(binding, other, value)
            if bound is not None:
                yield bound

    def bind(self, binding: Binding, term: Name | Term, value: Name) -> Binding | None:
        """Return the binding with a value for a term, None if it conflicts."""
        if isinstance(term, str):
            return binding if term == value else None
        if term in binding:
            return binding if binding[term] == value else None
        return {**binding, term: value} if self.allows(term, value) else None

    def allows(self, term: Term, value: Name) -> bool:
        if isinstance(term, PlaceVariable):
            return True
        if isinstance(term, NodeVariable):
            return value != REGION and term.kind in (None, self.logical.sorting.kind(value))
        kind = value.partition(":")[0] if ":" in value else None
        return (term.kind is None or term.kind == kind) and (term.but is None or term.but != kind)
