"""Regions of a rule: the correspondence of regions on both sides, and the roots that need a parent.

In the paper's rules a region is a place that the rule does not name. Its roots share their parent, the region's place
variable. A region of the reactum corresponds to the region of the redex with which it shares a root, so `a || b -> b ||
a` moves nothing. If that is ambiguous (`a | x || b -> b | x || a`) and both sides have equally many regions, they
correspond by position.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from bigraphs.notation.paper import NodeTerm as WrittenNode
from bigraphs.notation.paper import RegionTerm, SiteTerm
from semantics.behaviours.reaction_rules import NodeTerm, PlaceTerm, PlaceVariable

Owner = int | NodeTerm
"""The parent of a site: a region by its index, or a node."""

Pairs = tuple[tuple[NodeTerm, PlaceTerm], ...]


@dataclass(frozen=True, slots=True)
class WrittenRegion:
    """One written region: its nodes and sites, each with its parent, None for the region itself."""

    index: int
    items: tuple[tuple[WrittenNode | SiteTerm, WrittenNode | None], ...]

    def nodes(self) -> Iterator[WrittenNode]:
        """Yield its nodes in the order written."""
        return (item for item, _ in self.items if isinstance(item, WrittenNode))


def regions_of(regions: tuple[RegionTerm, ...]) -> Iterator[WrittenRegion]:
    """Yield the regions of one side of a rule, flattened."""
    for index, region in enumerate(regions):
        items: list[tuple[WrittenNode | SiteTerm, WrittenNode | None]] = []
        waiting: list[tuple[WrittenNode | SiteTerm, WrittenNode | None]] = [
            (term, None) for term in reversed(region)
        ]
        while waiting:
            term, above = waiting.pop()
            items.append((term, above))
            if isinstance(term, WrittenNode):
                waiting.extend((child, term) for child in reversed(term.children))
        yield WrittenRegion(index, tuple(items))


@dataclass(frozen=True)
class Side:
    """One side of a rule with the meaning of its words."""

    regions: tuple[WrittenRegion, ...]
    meaning: Mapping[str, NodeTerm | None]

    def term(self, node: WrittenNode) -> NodeTerm:
        """Return the meaning of a node."""
        word = node.name or "" if node.control is None else f"{node.name or ''}_{node.control}"
        term = self.meaning[word]
        assert term is not None
        return term

    @cached_property
    def nodes(self) -> tuple[WrittenNode, ...]:
        """All nodes, in the order written."""
        return tuple(node for region in self.regions for node in region.nodes())

    @cached_property
    def terms(self) -> tuple[NodeTerm, ...]:
        """The meanings of all nodes."""
        return tuple(map(self.term, self.nodes))

    @cached_property
    def nested(self) -> Pairs:
        """The pairs (node, parent) of nested nodes."""
        return tuple(
            (self.term(item), self.term(above))
            for region in self.regions
            for item, above in region.items
            if isinstance(item, WrittenNode) and above is not None
        )

    @cached_property
    def roots(self) -> tuple[tuple[WrittenNode, ...], ...]:
        """The roots of each region."""
        return tuple(
            tuple(item for item, above in region.items if isinstance(item, WrittenNode) and above is None)
            for region in self.regions
        )

    @cached_property
    def sites(self) -> tuple[tuple[SiteTerm, Owner], ...]:
        """The sites, each with its parent."""
        return tuple(
            (item, region.index if above is None else self.term(above))
            for region in self.regions
            for item, above in region.items
            if isinstance(item, SiteTerm)
        )

    @cached_property
    def closed(self) -> tuple[NodeTerm, ...]:
        """The nodes without a site."""
        open_ones = {owner for _, owner in self.sites}
        return tuple(term for term in self.terms if term not in open_ones)


@dataclass(frozen=True, slots=True)
class RegionPlaces:
    """The parents that regions determine.

    Attributes:
        same: For each region of the reactum, the corresponding region of the redex, None if there is none.
        redex: The pairs (root, place variable) that the redex needs.
        reactum: The pairs (root, place variable) that the reactum needs.
        unplaced: Roots of the reactum without a place variable, each with its region.
    """

    same: Mapping[int, int | None]
    redex: Pairs
    reactum: Pairs
    unplaced: tuple[tuple[WrittenNode, int], ...]


def region_places(before: Side, after: Side) -> RegionPlaces:
    """Return the pairs that determine the parents of roots; a single root that stays needs none."""
    old = [set(map(before.term, roots)) for roots in before.roots]
    new = [set(map(after.term, roots)) for roots in after.roots]
    same = _same(old, new)
    into: dict[int, set[NodeTerm]] = {index: set() for index in range(len(old))}
    for index, place in same.items():
        if place is not None:
            into[place] |= new[index]
    needed = {
        index for index, roots in enumerate(old) if len(roots | into[index]) > 1 or roots != into[index]
    }
    redex = tuple(
        (before.term(root), _place(index))
        for index, roots in enumerate(before.roots)
        for root in roots
        if index in needed
    )
    reactum: list[tuple[NodeTerm, PlaceTerm]] = []
    unplaced: list[tuple[WrittenNode, int]] = []
    for index, roots in enumerate(after.roots):
        place = same[index]
        for root in roots:
            if place is None or not old[place]:
                unplaced.append((root, index))
            elif place in needed:
                reactum.append((after.term(root), _place(place)))
    return RegionPlaces(same, redex, tuple(reactum), tuple(unplaced))


def _same(old: list[set[NodeTerm]], new: list[set[NodeTerm]]) -> dict[int, int | None]:
    """Return the corresponding region of the redex for each region of the reactum."""
    sharing = {
        index: [place for place, there in enumerate(old) if there & roots] for index, roots in enumerate(new)
    }
    kept = {index: places[0] for index, places in sharing.items() if len(places) == 1}
    if len(old) != len(new):
        return {index: kept.get(index) for index in sharing}
    if any(len(places) > 1 for places in sharing.values()) or len(set(kept.values())) < len(kept):
        return {index: index for index in sharing}
    free = set(sharing) - set(kept.values())
    return {index: kept.get(index, index if index in free else None) for index in sharing}


def _place(index: int) -> PlaceVariable:
    return PlaceVariable(f"region{index}")
