"""Directed graphs as arrays, and breadth-first search by whole layers."""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from checker.engines.graph import Bools, Numbers
from checker.limits import look
from checker.properties.temporal.effort import Effort

Indices = NDArray[np.int64]


class Arrows(Protocol):
    """A graph in compressed sparse rows, such as `checker.engines.graph.Graph`."""

    @property
    def starts(self) -> Numbers:
        """The start of the edges of each node, and the end of the last."""

    @property
    def targets(self) -> Numbers:
        """The target of each edge."""

    @property
    def sources(self) -> Numbers:
        """The source of each edge."""


@dataclass(frozen=True, eq=False)
class Digraph:
    """A graph in compressed sparse rows, its edges sorted by their sources."""

    starts: Numbers
    targets: Numbers

    @cached_property
    def sources(self) -> Numbers:
        """The source of each edge."""
        nodes = np.arange(len(self.starts) - 1, dtype=self.targets.dtype)
        return np.repeat(nodes, np.diff(self.starts))


def rows_of(sources: Numbers, targets: Numbers, nodes: int) -> Digraph:
    """Return the rows of edges that are sorted by their sources."""
    counts = np.bincount(sources, minlength=nodes)
    return Digraph(np.concatenate((np.zeros(1, dtype=np.int64), np.cumsum(counts))), targets)


def reversed_rows(arrows: Arrows) -> Digraph:
    """Return the graph with every edge reversed."""
    order = np.argsort(arrows.targets, kind="stable")
    return rows_of(arrows.targets[order], arrows.sources[order], len(arrows.starts) - 1)


def leaving(arrows: Arrows, nodes: Numbers) -> Indices:
    """Return the edges that leave the nodes, node by node."""
    first = arrows.starts[nodes].astype(np.int64)
    counts = arrows.starts[nodes + 1].astype(np.int64) - first
    before = np.cumsum(counts) - counts
    return np.repeat(first - before, counts) + np.arange(counts.sum(), dtype=np.int64)


def reaching(backwards: Digraph, goal: Bools, through: Bools) -> Bools:
    """Return the nodes from which a path through some nodes leads to the goal, given the reversed graph."""
    found = goal.copy()
    frontier: Numbers = np.flatnonzero(found)
    while len(frontier):
        look()
        before = backwards.targets[leaving(backwards, frontier)]
        new = before[through[before] & ~found[before]]
        found[new] = True
        frontier = np.unique(new)
    return found


def shortest(
    arrows: Arrows, start: int, goal: Bools, through: Bools | None = None, by: Bools | None = None
) -> tuple[int, ...] | None:
    """Return the edges of a shortest path whose last edge is in the goal; None if there is none.

    Args:
        arrows: The graph.
        start: The first node.
        goal: The edges of which the last is one.
        through: The nodes that it may visit; by default all.
        by: The edges that it may take; by default all.
    """
    parents = np.full(len(arrows.starts) - 1, -1, dtype=np.int64)
    seen = np.zeros(len(parents), dtype=np.bool_)
    seen[start] = True
    frontier: Numbers = np.array([start])
    while len(frontier):
        look()
        edges = leaving(arrows, frontier)
        if by is not None:
            edges = edges[by[edges]]
        if through is not None:
            edges = edges[through[arrows.targets[edges]]]
        hits = edges[goal[edges]]
        if len(hits):
            return _path(arrows, parents, int(hits[0]))
        frontier = _discovered(arrows, edges, seen, parents)
    return None


def distances(arrows: Arrows, start: int, most: int, effort: Effort, through: Bools | None = None) -> Numbers:
    """Return the distance of each node from one, -1 beyond so many edges.

    Raises:
        Exhausted: The search exceeds the effort.
    """
    found = np.full(len(arrows.starts) - 1, -1, dtype=np.int64)
    found[start] = 0
    frontier: Numbers = np.array([start])
    for distance in range(1, most + 1):
        edges = leaving(arrows, frontier)
        effort.spend(len(edges))
        targets = arrows.targets[edges]
        new = targets[(found[targets] < 0) & (True if through is None else through[targets])]
        found[new] = distance
        frontier = np.unique(new)
    return found


def _discovered(arrows: Arrows, edges: Indices, seen: Bools, parents: Indices) -> Numbers:
    """Record the first edge to each new node, and return these nodes in that order."""
    fresh = edges[~seen[arrows.targets[edges]]]
    reached = arrows.targets[fresh]
    parents[reached[::-1]] = fresh[::-1]  # the last write stays, so the first edge
    seen[reached] = True
    new: Numbers = reached[parents[reached] == fresh]
    return new


def _path(arrows: Arrows, parents: Indices, last: int) -> tuple[int, ...]:
    path = [last]
    while (before := int(parents[arrows.sources[path[-1]]])) >= 0:
        path.append(before)
    return tuple(reversed(path))
