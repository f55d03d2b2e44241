"""Equality up to renaming: an exact canonical form by colour refinement and individualisation.

Named nodes are fixed points. The first colour of an anonymous node comes from its own control, ports and places;
refinement adds the colours of its neighbours. If a tie remains, the search individualises each tied node, and the least
encoding wins. Two kinds of symmetry reduce the search (McKay). Equal subtrees in one place get different colours at the
start. A symmetry found at a leaf prunes branches that it maps to earlier branches. The worst case is exponential, on
large strongly regular link graphs.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

from bigraphs.bigraph import Bigraph, Link, children, link_key, normal, sites_in

_Key: TypeAlias = Any  # nested tuples of integers and strings; compared values have the same shape


def canonical(bigraph: Bigraph) -> Bigraph:
    """Return the representative of all bigraphs that differ only in the order of anonymous nodes and edges."""
    anonymous = sum(node.name is None for node in bigraph.nodes)
    if anonymous < 2:
        return bigraph
    return _Search(bigraph).run()


def equal(one: Bigraph, other: Bigraph) -> bool:
    """Return whether two bigraphs are equal up to renaming of anonymous nodes and edges."""
    return one == other or (_outline(one) == _outline(other) and canonical(one) == canonical(other))


def _outline(bigraph: Bigraph) -> tuple[object, ...]:
    kinds = sorted((node.control, node.name or "") for node in bigraph.nodes)
    return bigraph.inner, bigraph.outer, bigraph.edges, kinds


class _Search:
    """One search tree: refine, individualise, compare leaves."""

    def __init__(self, bigraph: Bigraph) -> None:
        self.bigraph = bigraph
        self.graph = _Neighbours(bigraph)
        self.best_key: _Key = None
        self.best_order: list[int] = []
        self.best_path: list[int] = []
        self.best: Bigraph = bigraph
        self.symmetries: list[dict[int, int]] = []

    def run(self) -> Bigraph:
        self.visit(self.graph.refine(self.graph.start()), [])
        return self.best

    def visit(self, colours: list[int], path: list[int]) -> int:
        """Search below one node of the tree; return the depth at which the search continues."""
        cell = _first_tie(colours, len(self.bigraph.nodes))
        if not cell:
            return self.leaf(sorted(range(len(self.bigraph.nodes)), key=colours.__getitem__), path)
        tried: list[int] = []
        for number in cell:
            if self.seen_by_symmetry(number, tried, path):
                continue
            tried.append(number)
            depth = self.visit(self.graph.refine(_single_out(colours, number)), [*path, number])
            if depth < len(path):
                return depth
        return len(path)

    def leaf(self, order: list[int], path: list[int]) -> int:
        found = normal(self.bigraph, order)
        key = _encoding(found)
        if self.best_key is None or key < self.best_key:
            self.best_key, self.best_order, self.best_path, self.best = key, order, path, found
        elif key == self.best_key:
            self.symmetries.append(dict(zip(self.best_order, order, strict=True)))
            return _common(self.best_path, path)
        return len(path)

    def seen_by_symmetry(self, number: int, tried: list[int], path: list[int]) -> bool:
        """Return whether symmetries that fix the path map a tried node to this one."""
        if not tried:
            return False
        fixing = [symmetry for symmetry in self.symmetries if all(symmetry[step] == step for step in path)]
        orbit, waiting = {number}, [number]
        for member in waiting:  # the list grows during the loop; inverses are powers, as the group is finite
            for symmetry in fixing:
                if symmetry[member] not in orbit:
                    orbit.add(symmetry[member])
                    waiting.append(symmetry[member])
        return not orbit.isdisjoint(tried)


class _Neighbours:
    """The neighbours of each node and edge, for refinement; edges are numbered after the nodes."""

    def __init__(self, bigraph: Bigraph) -> None:
        self.bigraph = bigraph
        self.size = len(bigraph.nodes)
        self.children = children(bigraph)
        self.ordered = [bigraph.signature[node.control].ordered for node in bigraph.nodes]
        self.edge_points: list[list[tuple[int, int]]] = [[] for _ in range(bigraph.edges)]
        for number, node in enumerate(bigraph.nodes):
            for port, link in enumerate(node.ports):
                if isinstance(link, int):
                    self.edge_points[link].append((number, port if self.ordered[number] else 0))

    def start(self) -> list[int]:
        """Return the first colours: nodes by control, ports and places, edges by inner names; twins differ."""
        below, twin = sites_in(self.bigraph), _twin_ranks(self.bigraph, self.children)
        first: list[_Key] = []
        for number, node in enumerate(self.bigraph.nodes):
            outside = tuple(parent for parent in node.parents if parent < 0)
            named = tuple(
                (port if self.ordered[number] else 0, link)
                for port, link in enumerate(node.ports)
                if isinstance(link, str)
            )
            row = (node.control, outside, tuple(below.get(number, ())), named, len(node.ports), twin[number])
            first.append((node.name is None, node.name or "", row))
        nodes = _ranks(first)
        within: list[list[str]] = [[] for _ in range(self.bigraph.edges)]
        for name, link in self.bigraph.inner_links:
            if isinstance(link, int):
                within[link].append(name)
        return nodes + [rank + self.size for rank in _ranks(within)]

    def refine(self, colours: list[int]) -> list[int]:
        """Split colours by the colours of neighbours until they are stable."""
        count = len(set(colours))
        while True:
            nodes = _ranks([self._node_row(number, colours) for number in range(self.size)])
            edges = _ranks([self._edge_row(edge, colours) for edge in range(self.bigraph.edges)])
            colours = nodes + [rank + self.size for rank in edges]
            if len(set(colours)) == count:
                return colours
            count = len(set(colours))

    def _node_row(self, number: int, colours: list[int]) -> _Key:
        node = self.bigraph.nodes[number]
        ports = [colours[self.size + link] if isinstance(link, int) else -1 for link in node.ports]
        return (
            colours[number],
            sorted(colours[parent] for parent in node.parents if parent >= 0),
            sorted(colours[child] for child in self.children[number]),
            ports if self.ordered[number] else sorted(ports),
        )

    def _edge_row(self, edge: int, colours: list[int]) -> _Key:
        around = sorted((colours[number], port) for number, port in self.edge_points[edge])
        return colours[self.size + edge], around


def _twin_ranks(bigraph: Bigraph, below: dict[int, list[int]]) -> list[int]:
    """Number equal anonymous subtrees in one place: exchanging two is a symmetry, so any order is correct."""
    shapes: dict[_Key, int] = {}
    shape = [0] * len(bigraph.nodes)
    rank = [0] * len(bigraph.nodes)
    sited = sites_in(bigraph)
    for number in reversed(_top_down(bigraph, below)):
        node = bigraph.nodes[number]
        kept = number if node.name is not None or number in sited or len(node.parents) > 1 else -1
        row = (node.control, node.ports, kept, tuple(sorted(shape[child] for child in below[number])))
        shape[number] = shapes.setdefault(row, len(shapes))
    for inside in below.values():
        seen: dict[int, int] = {}
        for number in inside:
            if len(bigraph.nodes[number].parents) == 1:
                rank[number] = seen[shape[number]] = seen.get(shape[number], -1) + 1
    return rank


def _top_down(bigraph: Bigraph, below: dict[int, list[int]]) -> list[int]:
    waiting = [len(node.parents) for node in bigraph.nodes]
    order: list[int] = []
    places = list(range(-bigraph.regions, 0))
    for place in places:  # the list grows during the loop
        for child in below[place]:
            waiting[child] -= 1
            if waiting[child] == 0:
                order.append(child)
                places.append(child)
    return order


def _ranks(rows: Sequence[_Key]) -> list[int]:
    """Return for each row the position of the first equal row in sorted order."""
    order = sorted(range(len(rows)), key=rows.__getitem__)
    rank = [0] * len(rows)
    for place, number in enumerate(order):
        same = place > 0 and rows[number] == rows[order[place - 1]]
        rank[number] = rank[order[place - 1]] if same else place
    return rank


def _first_tie(colours: list[int], size: int) -> list[int]:
    cells: dict[int, list[int]] = {}
    for number in range(size):
        cells.setdefault(colours[number], []).append(number)
    return next((cells[colour] for colour in sorted(cells) if len(cells[colour]) > 1), [])


def _single_out(colours: list[int], number: int) -> list[int]:
    """Give one node its own colour, just before the nodes that it was tied with."""
    chosen = colours[number]
    return [2 * colour + (colour == chosen and place != number) for place, colour in enumerate(colours)]


def _common(one: list[int], other: list[int]) -> int:
    return next(
        (depth for depth, (a, b) in enumerate(zip(one, other, strict=False)) if a != b),
        min(len(one), len(other)),
    )


def _encoding(bigraph: Bigraph) -> _Key:
    rows = tuple(
        (node.parents, _link_row(node.ports), node.control, node.name or "") for node in bigraph.nodes
    )
    return rows, bigraph.sites, _link_row(tuple(link for _, link in bigraph.inner_links))


def _link_row(links: tuple[Link, ...]) -> _Key:
    return tuple(map(link_key, links))
