"""Folding: in a large picture, one box stands for several similar nodes and shows their number.

Nodes are similar if they are empty and have the same control, the same place, the same links and the same mark.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Final

from bigraphs.bigraph import Bigraph, children, moved, sites_in
from bigraphs.node_labels import natural, node_labels

CROWD: Final = 30
"""Up to this number of nodes, each node has its own box."""

FEWEST: Final = 3
"""The smallest group of similar nodes that is folded."""


@dataclass(frozen=True, slots=True)
class Folded:
    """A bigraph with fewer nodes, the two label lines of each, and the labels of the nodes behind each folded one."""

    bigraph: Bigraph
    lines: tuple[tuple[str, str], ...]
    members: Mapping[int, tuple[str, ...]]


def unfolded(bigraph: Bigraph) -> Folded:
    """Return the bigraph with all its nodes."""
    named = zip(node_labels(bigraph), bigraph.nodes, strict=True)
    lines = ((label, node.control if node.name is not None else "") for label, node in named)
    return Folded(bigraph, tuple(lines), {})


def folded(
    bigraph: Bigraph, apart: Collection[str] = frozenset(), marked: Collection[str] = frozenset()
) -> Folded:
    """Return the bigraph; above 30 nodes, fold similar ones, except the nodes named in `apart`.

    The `marked` nodes are folded among themselves.

    >>> from bigraphs.relational_bigraphs import from_relations
    >>> world = from_relations({f"uav{n}": "UAV" for n in range(31)}, {}, {"wifi": ["uav7"]})
    >>> folded(world, {"uav8"}).lines
    (('UAV ×29', 'uav0, uav1, …'), ('uav7', 'UAV'), ('uav8', 'UAV'))
    """
    whole = unfolded(bigraph)
    if len(bigraph.nodes) <= CROWD:
        return whole
    groups = [group for group in _alike(bigraph, apart, marked) if len(group) >= FEWEST]
    gone = {number for group in groups for number in group[1:]}
    kept = [number for number in range(len(bigraph.nodes)) if number not in gone]
    rank = {number: place for place, number in enumerate(kept)}
    nodes = tuple(
        moved(bigraph.nodes[number], lambda at: (rank.get(at, at),), lambda link: link) for number in kept
    )
    sites = tuple(tuple(rank.get(parent, parent) for parent in parents) for parents in bigraph.sites)
    members = {
        rank[group[0]]: tuple(sorted((whole.lines[number][0] for number in group), key=natural))
        for group in groups
    }
    lines = tuple(
        _summary(bigraph.nodes[number].control, members[place]) if place in members else whole.lines[number]
        for place, number in enumerate(kept)
    )
    return Folded(replace(bigraph, nodes=nodes, sites=sites), lines, members)


def _alike(bigraph: Bigraph, apart: Collection[str], marked: Collection[str]) -> list[list[int]]:
    inside, sited = children(bigraph), sites_in(bigraph)
    groups: dict[object, list[int]] = {}
    for number, node in enumerate(bigraph.nodes):
        alone = inside[number] or number in sited or len(node.parents) != 1 or node.name in apart
        named = node.name is None, node.name in marked
        key = number if alone else (node.control, node.parents, node.ports, *named)
        groups.setdefault(key, []).append(number)
    return list(groups.values())


def _summary(control: str, labels: tuple[str, ...]) -> tuple[str, str]:
    return f"{control} ×{len(labels)}", f"{labels[0]}, {labels[1]}, …"
