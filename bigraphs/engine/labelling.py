"""Canonical keys of states up to edge numbers: an exact form by refinement and individualisation.

The key of a state without edges and shared nodes is already canonical. Otherwise the codes are unfolded into a small
graph. It has a vertex for each node with an edge in it, and a vertex for each edge. An empty node with a single port on
an edge is an incidence between its parent and that edge, not a vertex. Content without edges becomes part of its
parent's label.

Vertices are coloured by their neighbours until the colours are stable. If a tie remains, each tied vertex is
individualised in turn, and the least encoding wins. Two kinds of symmetry reduce the search (McKay). Edges with the
same incidences get different colours at the start. A symmetry found at a leaf prunes branches that it maps to earlier
branches.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from typing import NamedTuple, TypeAlias

from bigraphs.engine.intern_tables import REFERENCE, InternTables, Row
from bigraphs.engine.state_arrays import GroundState, Key, codes_in

Incidence: TypeAlias = tuple[int, int]
"""A label and an edge; the negative number of a shared node serves as an edge."""

Around: TypeAlias = list[tuple[int, int]]
"""The neighbours of a vertex: pairs of a label, shifted above the colours, and a vertex."""


class SubtreeProfile(NamedTuple):
    """The top of a subtree: the label of its node, its edges, and the codes of its children with edges."""

    label: int
    incidences: tuple[Incidence, ...]
    kids: tuple[int, ...]


_SHIFT = 20  # a shifted label plus a colour is one small integer, for up to a million vertices
_IN, _HOLDS, _EDGE = 0 << _SHIFT, 1 << _SHIFT, 2


class Labelling:
    """The canonical keys of the states of one world."""

    def __init__(self, world: InternTables) -> None:
        self.world = world
        self._labels: dict[object, int] = {}
        self._profiles: dict[int, SubtreeProfile] = {}

    def canonical(self, state: GroundState) -> Key:
        """Return a key that two states of this world share if and only if they are the same bigraph."""
        return self.canonical_of(state.key())

    def canonical_of(self, key: Key) -> Key:
        """Return the canonical key of the state with this raw key."""
        if self.world.plain:
            return key
        graph = _Graph(self)
        *regions, shared = codes_in(self.world, key)
        for region, codes in enumerate(regions):
            graph.add_region(region, codes)
        for code in shared:
            graph.add(code, -1)
        return graph.key()

    def number(self, label: object) -> int:
        """Return the number of a label; the numbers 0 to 2 are reserved for relations between places."""
        return self._labels.setdefault(label, len(self))

    def __len__(self) -> int:
        """Return the end of the range of label numbers."""
        return len(self._labels) + 3

    def profile(self, code: int) -> SubtreeProfile:
        """Return the profile of a code."""
        found = self._profiles.get(code)
        if found is None:
            found = self._profiles[code] = self._make_profile(self.world.rows[code])
        return found

    def _make_profile(self, row: Row) -> SubtreeProfile:
        label, ports, kids, itself = row
        bare, incidences, inside = self.sort_kids(kids)
        own = [(self.number(("port", place)), link) for place, link in self._edge_ports(label, ports)]
        if itself:
            own.append((self.number("itself"), itself))
        number = self.number((label, self._named(ports), bare))
        return SubtreeProfile(number, (*own, *incidences), inside)

    def sort_kids(
        self, kids: tuple[int, ...]
    ) -> tuple[tuple[int, ...], tuple[Incidence, ...], tuple[int, ...]]:
        """Return the codes without edges, the incidences, and the other codes."""
        bare, incidences, inside = [], [], []
        for code in kids:
            if self.world.bare[code]:
                bare.append(code)
            elif (found := self._incidence(self.world.rows[code])) is not None:
                incidences.append(found)
            else:
                inside.append(code)
        return tuple(bare), tuple(incidences), tuple(inside)

    def _incidence(self, row: Row) -> Incidence | None:
        label, ports, kids, itself = row
        edges = self._edge_ports(label, ports)
        if itself or len(edges) != 1 or not all(self.world.bare[kid] for kid in kids):
            return None
        ((place, link),) = edges
        return self.number(("leaf", label, self._named(ports), place, kids)), link

    def _edge_ports(self, label: int, ports: tuple[int, ...]) -> list[Incidence]:
        """Return the ports on edges, numbered where their order matters."""
        fixed, world = len(self.world.names), self.world
        ordered = label != REFERENCE and world.ordered[world.control_of[label]]
        return [(port if ordered else 0, link) for port, link in enumerate(ports) if not 0 <= link < fixed]

    def _named(self, ports: tuple[int, ...]) -> tuple[int, ...]:
        fixed = len(self.world.names)
        return tuple(link if 0 <= link < fixed else -1 for link in ports)


def labels_in(key: Key) -> Iterator[int]:
    """Yield the label numbers in a canonical key."""
    numbers, place = array("I" if key[:1] == b"~" else "Q", key[1:]), 0
    while place < len(numbers):
        end = place + 2 + numbers[place + 1]
        yield numbers[place]
        yield from (near >> _SHIFT for near in numbers[place + 2 : end])
        place = end


class _Graph:
    """The part of a state that needs refinement."""

    def __init__(self, labelling: Labelling) -> None:
        self.labelling = labelling
        self.labels: list[tuple[int, int]] = []  # with the rank among twins
        self.around: list[Around] = []
        self.edges: dict[int, int] = {}

    def add_region(self, region: int, codes: list[int]) -> None:
        bare, incidences, inside = self.labelling.sort_kids(tuple(codes))
        label = self.labelling.number(("region", region, tuple(sorted(bare))))
        self._add(SubtreeProfile(label, incidences, tuple(sorted(inside))), -1)

    def add(self, code: int, parent: int) -> None:
        self._add(self.labelling.profile(code), parent)

    def _add(self, profile: SubtreeProfile, parent: int) -> None:
        """Add a node and all its descendants with edges."""
        waiting = [(profile, parent, 0)]
        while waiting:
            profile, parent, twin = waiting.pop()
            vertex = self._vertex(profile.label, twin)
            if parent >= 0:
                self.around[vertex].append((_IN, parent))
                self.around[parent].append((_HOLDS, vertex))
            self._join(vertex, profile.incidences)
            before, rank = -1, 0
            for code in profile.kids:  # sorted, so twins are neighbours
                rank = rank + 1 if code == before else 0
                before = code
                waiting.append((self.labelling.profile(code), vertex, rank))

    def _join(self, vertex: int, incidences: tuple[Incidence, ...]) -> None:
        for label, link in incidences:
            edge = self.edges.get(link)
            if edge is None:
                edge = self.edges[link] = self._vertex(_EDGE, 0)
            self.around[vertex].append((label << _SHIFT, edge))
            self.around[edge].append((label << _SHIFT, vertex))

    def _vertex(self, label: int, twin: int) -> int:
        self.labels.append((label, twin))
        self.around.append([])
        return len(self.labels) - 1

    def key(self) -> Key:
        """Return the canonical key."""
        self._tell_twin_edges_apart()
        rank = {label: place for place, label in enumerate(sorted(set(self.labels)))}
        colours = _refine(self.around, [rank[label] for label in self.labels])
        if len(set(colours)) == len(colours):
            return self.encode(colours)
        return _Search(self).run(colours)

    def _tell_twin_edges_apart(self) -> None:
        seen: dict[tuple[tuple[int, int], ...], int] = {}
        for edge in self.edges.values():
            same = tuple(sorted(self.around[edge]))
            rank = seen[same] = seen.get(same, -1) + 1
            self.labels[edge] = (_EDGE, rank)

    def encode(self, colours: list[int]) -> Key:
        """Return the label and neighbours of each vertex, in the order of their colours."""
        parts: list[int] = []
        order = [0] * len(colours)
        for vertex, colour in enumerate(colours):
            order[colour] = vertex
        for vertex in order:
            label = self.labels[vertex][0]
            if label != _EDGE:
                near = sorted([kind + colours[other] for kind, other in self.around[vertex]])
                parts += [label, len(near), *near]
        try:
            return b"~" + array("I", parts).tobytes()
        except OverflowError:
            return b"!" + array("Q", parts).tobytes()


def _refine(around: list[Around], colours: list[int]) -> list[int]:
    """Split colours by the colours of neighbours until they are stable; colours are ranks."""
    count = len(set(colours))
    while True:
        keys = [
            (colour, *sorted([label + colours[other] for label, other in near]))
            for colour, near in zip(colours, around, strict=True)
        ]
        rank = {key: place for place, key in enumerate(sorted(set(keys)))}
        colours = [rank[key] for key in keys]
        if len(rank) == count or len(rank) == len(around):
            return colours
        count = len(rank)


class _Search:
    """A search tree: refine, individualise, compare leaves."""

    def __init__(self, graph: _Graph) -> None:
        self.graph = graph
        self.best: Key | None = None
        self.order: list[int] = []
        self.path: list[int] = []
        self.symmetries: list[dict[int, int]] = []

    def run(self, colours: list[int]) -> Key:
        self.visit(colours, [])
        assert self.best is not None  # every branch ends in a leaf
        return self.best

    def visit(self, colours: list[int], path: list[int]) -> int:
        """Search below one node of the tree; return the depth at which the search continues."""
        self.graph.labelling.world.pause()
        cell = _first_tie(colours)
        if not cell:
            return self.leaf(colours, path)
        tried: list[int] = []
        for vertex in cell:
            if tried and self.seen_by_symmetry(vertex, tried, path):
                continue
            tried.append(vertex)
            single = [2 * c + (c == colours[vertex] and v != vertex) for v, c in enumerate(colours)]
            depth = self.visit(_refine(self.graph.around, single), [*path, vertex])
            if depth < len(path):
                return depth
        return len(path)

    def leaf(self, colours: list[int], path: list[int]) -> int:
        key = self.graph.encode(colours)
        order = [vertex for _, vertex in sorted((colour, vertex) for vertex, colour in enumerate(colours))]
        if self.best is None or key < self.best:
            self.best, self.order, self.path = key, order, path
        elif key == self.best:
            self.symmetries.append(dict(zip(self.order, order, strict=True)))
            return _common(self.path, path)
        return len(path)

    def seen_by_symmetry(self, vertex: int, tried: list[int], path: list[int]) -> bool:
        """Return whether symmetries that fix the path map a tried vertex to this one."""
        fixing = [symmetry for symmetry in self.symmetries if all(symmetry[step] == step for step in path)]
        orbit, waiting = {vertex}, [vertex]
        for member in waiting:  # the list grows during the loop; inverses are powers, as the group is finite
            for symmetry in fixing:
                if symmetry[member] not in orbit:
                    orbit.add(symmetry[member])
                    waiting.append(symmetry[member])
        return not orbit.isdisjoint(tried)


def _first_tie(colours: list[int]) -> list[int]:
    cells: dict[int, list[int]] = {}
    for vertex, colour in enumerate(colours):
        cells.setdefault(colour, []).append(vertex)
    return next((cells[colour] for colour in sorted(cells) if len(cells[colour]) > 1), [])


def _common(one: list[int], other: list[int]) -> int:
    return next(
        (depth for depth, (a, b) in enumerate(zip(one, other, strict=False)) if a != b),
        min(len(one), len(other)),
    )
