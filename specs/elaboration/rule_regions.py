"""Regions of a rule: which are the same place on both sides, and which need a root.

In the paper's rules a region is somewhere that the rule doesn't name. Its roots share their parent, which is the
region's place variable. A region of the reactum is the one of the redex that has a root in common with it, so
`a || b -> b || a` moves nothing. Where that is ambiguous (`a | x || b -> b | x || a`) and both sides have as many
regions, their position decides.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from bigraphs.notation.paper import NodeTerm as WrittenNode
from bigraphs.notation.paper import RegionTerm, SiteTerm
from semantics.behaviours.reaction_rules import NodeTerm, PlaceTerm, PlaceVariable

Owner = int | NodeTerm
"""What a site stands under: a region by its index, or a node."""

Pairs = tuple[tuple[NodeTerm, PlaceTerm], ...]


@dataclass(frozen=True, slots=True)
class Region:
    """One region as written: everything in it with what it stands under, None for the region itself."""

    index: int
    items: tuple[tuple[WrittenNode | SiteTerm, WrittenNode | None], ...]

    def nodes(self) -> Iterator[WrittenNode]:
        """Yield its nodes in the order written."""
        return (item for item, _ in self.items if isinstance(item, WrittenNode))


def regions_of(regions: tuple[RegionTerm, ...]) -> Iterator[Region]:
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
        yield Region(index, tuple(items))


@dataclass(frozen=True)
class Side:
    """One side of a rule with the meaning of its words."""

    regions: tuple[Region, ...]
    meaning: Mapping[str, NodeTerm | None]

    def term(self, node: WrittenNode) -> NodeTerm:
        """Return what a node means."""
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
        """What all nodes mean."""
        return tuple(map(self.term, self.nodes))

    @cached_property
    def nested(self) -> Pairs:
        """The pairs (node, node that it is written in)."""
        return tuple(
            (self.term(item), self.term(above))
            for region in self.regions
            for item, above in region.items
            if isinstance(item, WrittenNode) and above is not None
        )

    @cached_property
    def roots(self) -> tuple[tuple[WrittenNode, ...], ...]:
        """The nodes of each region that are written in no other."""
        return tuple(
            tuple(item for item, above in region.items if isinstance(item, WrittenNode) and above is None)
            for region in self.regions
        )

    @cached_property
    def sites(self) -> tuple[tuple[SiteTerm, Owner], ...]:
        """The sites, each with what it stands under."""
        return tuple(
            (item, region.index if above is None else self.term(above))
            for region in self.regions
            for item, above in region.items
            if isinstance(item, SiteTerm)
        )

    @cached_property
    def closed(self) -> tuple[NodeTerm, ...]:
        """The nodes that are written without a site."""
        open_ones = {owner for _, owner in self.sites}
        return tuple(term for term in self.terms if term not in open_ones)


@dataclass(frozen=True, slots=True)
class RegionPlaces:
    """What regions say of parents.

    Attributes:
        same: For each region of the reactum the redex's that is the same place, None where none is.
        redex, reactum: The pairs (root, place variable) that each side needs.
        unplaced: Roots of the reactum that go where no variable tells, each with its region.
    """

    same: Mapping[int, int | None]
    redex: Pairs
    reactum: Pairs
    unplaced: tuple[tuple[WrittenNode, int], ...]


def region_places(before: Side, after: Side) -> RegionPlaces:
    """Return the pairs that say where roots are; a single root that stays one needs none."""
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
    """Return for each region of the reactum the same region of the redex."""
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
