"""Strongly connected components in which a fair run can stay for ever."""

from dataclasses import dataclass

import numpy as np

from checker.engines.graph import Bools, Numbers
from checker.engines.strong_components import strong_components
from checker.limits import look
from checker.properties.temporal.digraph import Arrows, Indices, rows_of


@dataclass(frozen=True, eq=False)
class Streett:
    """A strong fairness (Streett) condition: taken infinitely often if it is enabled infinitely often.

    Attributes:
        enabled: For each node, whether it is enabled there.
        taken: For each edge, whether it is taken there.
    """

    enabled: Bools
    taken: Bools


@dataclass(frozen=True, eq=False)
class Conditions:
    """The conditions on a run's infinitely frequent nodes and edges.

    Attributes:
        recurrent: For each condition a set of edges; one of them is taken infinitely often.
        strong: The conditions of strong fairness.
    """

    recurrent: tuple[Bools, ...] = ()
    strong: tuple[Streett, ...] = ()

    @property
    def none(self) -> bool:
        """Whether every run satisfies them."""
        return not self.recurrent and not self.strong

    def over(self, nodes: Numbers, edges: Numbers) -> "Conditions":
        """Return the conditions of a subgraph with these nodes and edges."""
        strong = (Streett(each.enabled[nodes], each.taken[edges]) for each in self.strong)
        return Conditions(tuple(each[edges] for each in self.recurrent), tuple(strong))


def fair_components(
    arrows: Arrows, conditions: Conditions, within: Bools | None = None, by: Bools | None = None
) -> Indices:
    """Return for each node the number of its fair component, or -1.

    A component in which a strong condition is enabled and never taken loses the nodes where it is enabled; the rest is
    divided again (Emerson and Lei, 1987). Each round is linear; the number of rounds is at most the nesting of
    conditions.

    Args:
        arrows: The graph.
        conditions: The conditions of fair runs.
        within: The nodes in which a run has to stay.
        by: The edges that it may take.
    """
    size = len(arrows.starts) - 1
    found = np.full(size, -1, dtype=np.int64)
    nodes: Numbers = np.arange(size) if within is None else np.flatnonzero(within)
    edges: Numbers = np.arange(len(arrows.targets)) if by is None else np.flatnonzero(by)
    fair_so_far = 0
    while len(nodes):
        look()
        part = _components(arrows, nodes, edges)
        judged = _judge(part, conditions)
        numbers = np.cumsum(judged.fair) - 1 + fair_so_far
        fair = judged.fair[part.of]
        found[nodes[fair]] = numbers[part.of[fair]]
        fair_so_far += int(judged.fair.sum())
        nodes, edges = nodes[judged.left], part.edges
    return found


@dataclass(frozen=True, eq=False)
class _Part:
    """The components of a part of a graph.

    Attributes:
        nodes: The nodes of the part.
        edges: The edges within components.
        of: For each of the nodes, the number of its component.
        inner: For each of the edges, the number of its component.
        count: The number of components.
    """

    nodes: Numbers
    edges: Numbers
    of: Numbers
    inner: Numbers
    count: int

    def having(self, components: Numbers) -> Bools:
        """Return for each component whether it is among these."""
        found = np.zeros(self.count, dtype=np.bool_)
        found[components] = True
        return found


@dataclass(frozen=True, eq=False)
class _Judged:
    """The fair components, and the nodes to divide again."""

    fair: Bools
    left: Bools


def _components(arrows: Arrows, nodes: Numbers, edges: Numbers) -> _Part:
    numbers = np.full(len(arrows.starts) - 1, -1, dtype=np.int32)
    numbers[nodes] = np.arange(len(nodes), dtype=np.int32)
    sources, targets = numbers[arrows.sources[edges]], numbers[arrows.targets[edges]]
    kept = (sources >= 0) & (targets >= 0)
    edges, sources, targets = edges[kept], sources[kept], targets[kept]
    rows = rows_of(sources, targets, len(nodes))
    count, of = strong_components(rows.starts, targets)
    inner = of[sources] == of[targets]
    return _Part(nodes, edges[inner], of, of[sources[inner]], count)


def _judge(part: _Part, conditions: Conditions) -> _Judged:
    live = part.having(part.inner)
    for recurrent in conditions.recurrent:
        live &= part.having(part.inner[recurrent[part.edges]])
    again, dropped = np.zeros(part.count, dtype=np.bool_), np.zeros(len(part.nodes), dtype=np.bool_)
    for each in conditions.strong:
        enabled = each.enabled[part.nodes]
        owed = part.having(part.of[enabled]) & ~part.having(part.inner[each.taken[part.edges]])
        again |= owed
        dropped |= enabled & owed[part.of]
    return _Judged(live & ~again, (live & again)[part.of] & ~dropped)
