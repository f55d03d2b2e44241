"""Instantiation of parameters: regions are moved, dropped and copied; copies share links (Milner's η)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from bigraphs.bigraph import Bigraph, Place, assemble, children
from bigraphs.errors import BigraphError


def instantiate(parameter: Bigraph, regions: Sequence[int], width: int) -> Bigraph:
    """Return the parameter whose region `i` is the old region `regions[i]`; regions from `width` on follow unchanged.

    Nodes without a remaining region are removed.

    Raises:
        BigraphError: If a copied region holds a named node or a node of another region, whose copy would be ambiguous.
    """
    if list(regions) == list(range(width)):
        return parameter
    spare = range(width, parameter.regions)
    order = [*regions, *spare]
    first = {region: place for place, region in reversed(list(enumerate(order)))}
    found = _move(parameter, first, len(order))
    for place, region in enumerate(order):
        if first[region] != place:
            found = _copy(found, parameter, region, place)
    return found


def _move(parameter: Bigraph, region_to: dict[int, int], width: int) -> Bigraph:
    kept = sorted(_below(parameter, region_to))
    rank = {number: place for place, number in enumerate(kept)} | {
        ~old: ~new for old, new in region_to.items()
    }
    nodes = [
        replace(node, parents=tuple(rank[place] for place in node.parents if place in rank))
        for node in (parameter.nodes[number] for number in kept)
    ]
    return assemble(parameter.signature, nodes, regions=width, outer_names=parameter.outer_names)


def _copy(found: Bigraph, parameter: Bigraph, region: int, place: int) -> Bigraph:
    """Add a copy of a region of the parameter to a region of the result."""
    copied = sorted(_below(parameter, [region]))
    others = _below(parameter, (other for other in range(parameter.regions) if other != region))
    for number in copied:
        node = parameter.nodes[number]
        if node.name is not None:
            raise BigraphError(
                "copy", f"the rule would copy {node}", "a name is one node; copy anonymous ones"
            )
        if number in others:
            raise BigraphError("copy", f"the rule would copy a {node} that other places share")
    shift = len(found.nodes)
    rank: dict[Place, Place] = {number: shift + new for new, number in enumerate(copied)} | {~region: ~place}
    added = [
        replace(node, parents=tuple(rank[parent] for parent in node.parents))
        for node in (parameter.nodes[number] for number in copied)
    ]
    return assemble(
        found.signature, [*found.nodes, *added], regions=found.regions, outer_names=found.outer_names
    )


def _below(parameter: Bigraph, regions: Iterable[int]) -> set[int]:
    inside = children(parameter)
    found: set[int] = set()
    waiting: list[Place] = [~region for region in regions]
    while waiting:
        fresh = set(inside[waiting.pop()]) - found
        found |= fresh
        waiting.extend(fresh)
    return found
