"""Decomposition of a match: target = context ∘ (redex ⊗ identity) ∘ parameter, with all names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from bigraphs.algebra import compose, identity, tensor
from bigraphs.bigraph import Bigraph, Link, Place, assemble, children, moved
from bigraphs.interface import Interface
from bigraphs.matching import Match


@dataclass(frozen=True, slots=True)
class Parts:
    """The decomposition of a target at a match.

    The first regions of `parameter` fill the redex's sites. The next `spare` regions, which only shared places need,
    and the names `wires` go past the redex into `context`. `instance` is the redex with the target's node names.
    """

    context: Bigraph
    instance: Bigraph
    parameter: Bigraph
    spare: int
    wires: tuple[str, ...]

    @property
    def beside(self) -> Bigraph:
        """Return the identity beside the redex."""
        return identity(Interface(self.spare, self.wires))


def take_apart(match: Match) -> Parts:
    """Return context, redex and parameter of a match."""
    inside = _inside(match)
    wires = _wires(match, inside)
    outside = [number for number in range(len(match.target.nodes)) if number not in {*inside, *match.nodes}]
    spares = {number: places for number in inside if (places := _spare_places(match, inside, number))}
    return Parts(
        _context(match, outside, list(spares.values()), wires),
        _instance(match),
        _parameter(match, inside, list(spares), wires),
        len(spares),
        tuple(sorted(wires.values())),
    )


def recompose(parts: Parts) -> Bigraph:
    """Return the target: the composition of context, redex and parameter."""
    return compose(parts.context, compose(tensor(parts.instance, parts.beside), parts.parameter))


def _inside(match: Match) -> list[int]:
    """Return the nodes inside the sites, sorted."""
    below = children(match.target)
    found = {number for tops in match.sites for number in tops}
    waiting = list(found)
    while waiting:
        fresh = set(below[waiting.pop()]) - found
        found |= fresh
        waiting.extend(fresh)
    return sorted(found)


def _spare_places(match: Match, inside: Sequence[int], number: int) -> list[Place]:
    """Return the parents of a node that lie in the context and that no site of the redex covers."""
    accounted = {*inside, *match.nodes}
    for site, tops in enumerate(match.sites):
        if number in tops:
            regions = (match.regions[~parent] for parent in match.redex.sites[site] if parent < 0)
            accounted.update(place for places in regions for place in places)
    return [place for place in match.target.nodes[number].parents if place not in accounted]


def _wires(match: Match, inside: Sequence[int]) -> dict[Link, str]:
    """Return a name for each link of the parameter; no name occurs in the redex."""
    linked = dict.fromkeys(link for number in inside for link in match.target.nodes[number].ports)
    taken = set(match.redex.outer_names)
    fresh = (name for name in map("w{}".format, range(len(linked) + len(taken))) if name not in taken)
    return dict(zip(linked, fresh, strict=False))


def _instance(match: Match) -> Bigraph:
    redex = match.redex
    nodes = [
        replace(node, name=match.target.nodes[image].name)
        for node, image in zip(redex.nodes, match.nodes, strict=True)
    ]
    return assemble(
        redex.signature,
        nodes,
        regions=redex.regions,
        sites=redex.sites,
        edges=redex.edges,
        outer_names=redex.outer_names,
    )


def _context(
    match: Match, outside: Sequence[int], spares: Sequence[Sequence[Place]], wires: Mapping[Link, str]
) -> Bigraph:
    """Return the part around the redex; it owns every edge that the redex does not match."""
    target = match.target
    rank = {number: place for place, number in enumerate(outside)}
    matched = {image for link, image in match.links if isinstance(link, int)}
    kept = [edge for edge in range(target.edges) if edge not in matched]
    edges = {edge: place for place, edge in enumerate(kept)}

    def places(place: Place) -> tuple[Place]:
        return (rank.get(place, place),)

    def link(old: Link) -> Link:
        return edges[old] if isinstance(old, int) else old

    passing = {name: link(old) for old, name in wires.items()}
    wanted = {name: link(image) for name, image in match.links if isinstance(name, str)}
    return assemble(
        target.signature,
        [moved(target.nodes[number], places, link) for number in outside],
        regions=target.regions,
        sites=[[rank.get(place, place) for place in around] for around in (*match.regions, *spares)],
        edges=len(kept),
        inner_links=passing | wanted,
        outer_names=target.outer_names,
    )


def _parameter(
    match: Match, inside: Sequence[int], spares: Sequence[int], wires: Mapping[Link, str]
) -> Bigraph:
    """Return the content of the sites, a region for each, then a region for each node that the context also holds."""
    rank = {number: place for place, number in enumerate(inside)}
    regions: dict[int, list[Place]] = {number: [] for number in inside}
    for site, tops in enumerate(match.sites):
        for number in tops:
            regions[number].append(~site)
    for spare, number in enumerate(spares):
        regions[number].append(~(len(match.sites) + spare))
    nodes = []
    for number in inside:
        node = match.target.nodes[number]
        within = (*regions[number], *(rank[place] for place in node.parents if place in rank))
        nodes.append(replace(node, parents=within, ports=tuple(wires[link] for link in node.ports)))
    return assemble(
        match.target.signature,
        nodes,
        regions=len(match.sites) + len(spares),
        outer_names=wires.values(),
    )
