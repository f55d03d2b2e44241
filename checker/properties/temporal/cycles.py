"""Shortest fair cycles, with the way to them: exact within a bound of effort.

For a single demand this is a breadth-first search from each node. For several, the set of satisfied demands is part of
the search state: there are exponentially many sets, and no better way is known (it is NP-hard). So demands are added
one by one, as shortest cycles that violate them are found.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from checker.engines.graph import Bools, Numbers
from checker.properties.temporal.components import Conditions, Streett
from checker.properties.temporal.digraph import Arrows, Digraph, Indices, leaving, rows_of
from checker.properties.temporal.effort import Effort, Exhausted

MOST_BITS: Final = 12
"""The most bits of a set of demands."""

MOST_TRIPLES: Final = 1 << 23
MOST_TRIPLES_OF_ONE: Final = 1 << 26
"""The most triples of a start, a node and a set of demands: for the starts of one search, and for one start."""

Cycle = tuple[int, tuple[int, ...]]
"""A node and the edges from there to there."""


def shortest_cycle(  # noqa: PLR0913, PLR0917  # independent parameters
    arrows: Arrows,
    depths: Numbers,
    components: Numbers,
    conditions: Conditions,
    most: int,
    effort: Effort,
    by: Bools | None = None,
) -> Cycle | None:
    """Return a fair cycle with the least sum of its node's depth and its length, None if no sum is small enough.

    Args:
        arrows: The graph.
        depths: The distance of each node; -1 for an unreached one.
        components: The fair components.
        conditions: The conditions of the cycle.
        most: The upper bound of the sum, exclusive.
        effort: The effort left.
        by: The edges that it may take; by default all.

    Raises:
        Exhausted: The search exceeds the effort.
    """
    near = np.flatnonzero((components >= 0) & (depths >= 0) & (depths + 1 < most))
    nodes = near[np.argsort(depths[near], kind="stable")]
    ranks = np.full(len(depths), -1, dtype=np.int64)
    ranks[nodes] = np.arange(len(nodes))
    inside = (ranks[arrows.sources] >= 0) & (ranks[arrows.targets] >= 0)
    inside &= components[arrows.sources] == components[arrows.targets]
    edges = np.flatnonzero(inside if by is None else inside & by)
    edges = edges[np.argsort(ranks[arrows.sources[edges]], kind="stable")]
    rows = rows_of(ranks[arrows.sources[edges]], ranks[arrows.targets[edges]], len(nodes))
    found = _fair(rows, depths[nodes], _demands(conditions.over(nodes, edges), len(nodes)), most, effort)
    return found and (int(nodes[found[0]]), tuple(int(edges[edge]) for edge in found[1]))


def _demands(conditions: Conditions, nodes: int) -> list[Streett]:
    """Return the demands on a cycle; a recurrent condition is a demand that is enabled everywhere."""
    everywhere = np.ones(nodes, dtype=np.bool_)
    return [*(Streett(everywhere, each) for each in conditions.recurrent), *conditions.strong]


def _fair(rows: Digraph, depths: Numbers, demands: list[Streett], most: int, effort: Effort) -> Cycle | None:
    """Return a shortest cycle that meets all demands; only those that a shortest cycle misses are searched for."""
    asked: list[Streett] = []
    while True:
        found = _Search(rows, depths, _Owed.of(asked, rows), effort).run(most)
        unmet = [each for each in demands if found is not None and not _meets(found, each, rows)]
        if not unmet:
            return found
        asked.append(min(unmet, key=lambda each: np.count_nonzero(each.taken)))


def _meets(cycle: Cycle, demand: Streett, rows: Digraph) -> bool:
    edges = list(cycle[1])
    return bool(demand.taken[edges].any() or not demand.enabled[rows.targets[edges]].any())


@dataclass(frozen=True, eq=False)
class _Owed:
    """The demands on a cycle, as sets of bits.

    Attributes:
        met: The demands that each edge meets.
        settled: For each set an equivalent one: a taken demand no longer depends on whether it is enabled.
        enough: For each set, whether it suffices.
    """

    met: Indices
    settled: Indices
    enough: Bools

    @classmethod
    def of(cls, demands: list[Streett], rows: Digraph) -> "_Owed":
        sometimes = [each for each in demands if not each.enabled.all()]
        if len(demands) + len(sometimes) > MOST_BITS:
            raise Exhausted
        met = np.zeros(len(rows.targets), dtype=np.int64)
        settled = np.arange(1 << len(demands) + len(sometimes))
        enough = np.ones(len(settled), dtype=np.bool_)
        for rank, each in enumerate([*sometimes, *(each for each in demands if each.enabled.all())]):
            taken, enabled = 1 << rank, 1 << len(demands) + rank
            met += each.taken * taken
            if rank < len(sometimes):
                met += each.enabled[rows.targets] * enabled
                settled[settled & taken > 0] |= enabled
                enough &= (settled & enabled == 0) | (settled & taken > 0)
            else:
                enough &= settled & taken > 0
        return cls(met, settled, enough)

    @property
    def sets(self) -> int:
        """The number of sets."""
        return len(self.enough)


@dataclass(frozen=True, eq=False)
class _Search:
    """Searches from each node, nearest first, through no nearer ones: a cycle is entered at its nearest node."""

    rows: Digraph
    depths: Numbers
    owed: _Owed
    effort: Effort

    def run(self, most: int) -> Cycle | None:
        best = None
        begin = 0
        while begin < len(self.depths) and (room := most - int(self.depths[begin]) - 1) > 0:
            end = min(begin + self.block, int(np.searchsorted(self.depths, self.depths[begin], side="right")))
            found = self.cycle(begin, end, room)
            if found is not None:
                best, most = found, int(self.depths[begin]) + len(found[1])
            begin = end
        return best

    @cached_property
    def block(self) -> int:
        """The number of starts in one search."""
        triples = len(self.depths) * self.owed.sets
        if triples > MOST_TRIPLES_OF_ONE:
            raise Exhausted
        return max(1, MOST_TRIPLES // triples)

    def cycle(self, begin: int, end: int, room: int) -> Cycle | None:
        """Return a shortest cycle from one of some nodes, of at most so many edges."""
        size, sets = len(self.depths), self.owed.sets
        seen = np.zeros((end - begin) * size * sets, dtype=np.bool_)
        homes: Numbers = np.arange(begin, end)
        at = homes
        met = np.zeros(end - begin, dtype=np.int64)
        layers: list[tuple[Indices, Indices]] = []
        for _ in range(room):
            edges = leaving(self.rows, at)
            self.effort.spend(len(edges))
            before = np.repeat(np.arange(len(at)), np.diff(self.rows.starts)[at])
            kept = self.rows.targets[edges] >= homes[before]
            edges, before = edges[kept], before[kept]
            targets = self.rows.targets[edges]
            now = self.owed.settled[met[before] | self.owed.met[edges]]
            closed = np.flatnonzero((targets == homes[before]) & self.owed.enough[now])
            if len(closed):
                layers.append((before, edges))
                return int(homes[before[closed[0]]]), _path(layers, int(closed[0]))
            codes = ((homes[before] - begin) * size + targets) * sets + now
            fresh = np.flatnonzero(~seen[codes])
            _, first = np.unique(codes[fresh], return_index=True)
            new = fresh[np.sort(first)]
            if not len(new):
                return None
            seen[codes[new]] = True
            layers.append((before[new], edges[new]))
            homes, at, met = homes[before[new]], targets[new], now[new]
        return None


def _path(layers: list[tuple[Indices, Indices]], last: int) -> tuple[int, ...]:
    """Return the edges that lead to an entry of the last layer."""
    path = []
    for before, edges in reversed(layers):
        path.append(int(edges[last]))
        last = int(before[last])
    return tuple(reversed(path))
