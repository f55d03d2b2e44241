"""Patterns as arrays of integers: a redex, or the pattern of a condition or predicate."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from dataclasses import dataclass
from typing import Final

from bigraphs.bigraph import Bigraph, children
from bigraphs.engine.intern_tables import InternTables
from bigraphs.errors import BigraphError

MOST_NODES: Final = 150
"""The largest number of nodes of a pattern; the search uses several stack frames per node."""


@dataclass(frozen=True, slots=True)
class CompiledPattern:
    """A pattern over one world; nodes and links are numbered as in its bigraph, edges after names.

    Attributes:
        controls: The control of each node.
        labels: The label of each node, or -1 for a node without a name.
        parents: The parent nodes of each node.
        homes: The regions of each node.
        kids: The child nodes of each node.
        sited: Whether each node has a site.
        ports: The links of each node.
        on: The nodes on each link.
        names: The number of links that are names; the others are edges.
        regions: The number of regions.
        sites: The parent nodes of each site.
        roots: The nodes in a region.
        twins: Groups of nodes that are interchangeable in every rule.
    """

    controls: tuple[int, ...]
    labels: tuple[int, ...]
    parents: tuple[tuple[int, ...], ...]
    homes: tuple[tuple[int, ...], ...]
    kids: tuple[tuple[int, ...], ...]
    sited: tuple[bool, ...]
    ports: tuple[tuple[int, ...], ...]
    on: tuple[tuple[int, ...], ...]
    names: int
    regions: int
    sites: tuple[tuple[int, ...], ...]
    roots: tuple[int, ...]
    twins: tuple[tuple[int, ...], ...]

    @property
    def size(self) -> int:
        """Return the number of nodes."""
        return len(self.controls)

    @property
    def closed(self) -> range:
        """Return the links that are edges."""
        return range(self.names, len(self.on))

    def form(self, world: InternTables) -> Hashable:
        """Return the part that determines the search plan: all but the particular controls and names of the nodes."""
        ordered = tuple([world.ordered[control] for control in self.controls])
        named = tuple([label >= 0 for label in self.labels])
        places = self.parents, self.homes, self.sited, self.sites, self.regions
        return ordered, named, places, self.ports, self.names, self.twins

    def wide(self) -> bool:
        """Return whether one part of it may match inside the content of another."""
        parts = len(self.components()) > 1 or any(len(around) > 1 for around in self.parents)
        return parts and any(self.sited)

    def components(self) -> list[set[int]]:
        """Return the sets of nodes that are connected by nesting."""
        left, found = set(range(self.size)), []
        while left:
            part, waiting = set[int](), [min(left)]
            while waiting:
                node = waiting.pop()
                if node not in part:
                    part.add(node)
                    waiting += [*self.parents[node], *self.kids[node]]
            left -= part
            found.append(part)
        return found


def compile_pattern(world: InternTables, bigraph: Bigraph) -> CompiledPattern:
    """Return the compiled pattern; raises BigraphError if it is too large."""
    check_size(bigraph)
    number: dict[int | str, int] = {name: link for link, name in enumerate(bigraph.outer_names)}
    fixed, inside = len(bigraph.outer_names), children(bigraph)
    labels = [world.label(node.control, node.name) for node in bigraph.nodes]
    ports = tuple(
        tuple(number[link] if isinstance(link, str) else fixed + link for link in node.ports)
        for node in bigraph.nodes
    )
    sited = {place for parents in bigraph.sites for place in parents}
    on: list[list[int]] = [[] for _ in range(fixed + bigraph.edges)]
    for node, links in enumerate(ports):
        for link in set(links):
            on[link].append(node)
    return CompiledPattern(
        tuple(world.control_of[label] for label in labels),
        tuple(
            label if node.name is not None else -1 for label, node in zip(labels, bigraph.nodes, strict=True)
        ),
        tuple(tuple(place for place in node.parents if place >= 0) for node in bigraph.nodes),
        tuple(tuple(~place for place in node.parents if place < 0) for node in bigraph.nodes),
        tuple(tuple(inside[node]) for node in range(len(bigraph.nodes))),
        tuple(node in sited for node in range(len(bigraph.nodes))),
        ports,
        tuple(map(tuple, on)),
        fixed,
        bigraph.regions,
        tuple(tuple(place for place in parents if place >= 0) for parents in bigraph.sites),
        tuple(number for number, node in enumerate(bigraph.nodes) if min(node.parents) < 0),
        _twins(bigraph, ports, inside, sited),
    )


def _twins(
    bigraph: Bigraph, ports: tuple[tuple[int, ...], ...], inside: dict[int, list[int]], sited: Iterable[int]
) -> tuple[tuple[int, ...], ...]:
    """Return groups of empty nodes with the same control, places and links."""
    groups: dict[object, list[int]] = {}
    held = set(sited)
    for number, node in enumerate(bigraph.nodes):
        if node.name is None and not inside[number] and number not in held:
            groups.setdefault((node.control, node.parents, ports[number]), []).append(number)
    return tuple(tuple(group) for group in groups.values() if len(group) > 1)


def check_size(bigraph: Bigraph) -> None:
    """Raise BigraphError if a pattern is too large."""
    if len(bigraph.nodes) > MOST_NODES:
        message = f"a pattern of {len(bigraph.nodes)} nodes; {MOST_NODES} are the most"
        raise BigraphError("too-large", message, "look for a part of it")


def check_solid(redex: Bigraph, what: str) -> None:
    """Raise BigraphError unless each occurrence of a redex decomposes a state uniquely (Milner's solid redexes)."""
    inhabited = {place for node in redex.nodes for place in node.parents}
    idle = sorted(set(redex.outer_names) - {link for node in redex.nodes for link in node.ports})
    if not redex.nodes:
        raise BigraphError("redex", f"{what} has no node to look for", "put one into its left-hand side")
    for region in range(redex.regions):
        if ~region not in inhabited:
            raise BigraphError(
                "redex",
                f"region {region} of {what} has no node, so it would match anywhere",
                "put a node into it, or leave it out",
            )
    for site, parents in enumerate(redex.sites):
        if any(place < 0 for place in parents):
            hint = "the other content of a region is kept anyway; put the site into a node"
            raise BigraphError("redex", f"site {site} of {what} is directly in a region", hint)
        if redex.sites.index(parents) != site:
            first = redex.sites.index(parents)
            raise BigraphError(
                "redex", f"sites {first} and {site} of {what} are side by side", "one site holds it all"
            )
    if idle:
        hint = "link it to a node, or leave it out"
        raise BigraphError(
            "redex", f"the name '{idle[0]}' of {what} is on no node, so it would match any link", hint
        )


__all__ = ["CompiledPattern", "check_size", "check_solid", "compile_pattern"]
