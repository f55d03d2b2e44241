"""Lassos: a path to a fair component, and a fair cycle in it."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from checker.engines.graph import Bools, Numbers
from checker.properties.temporal.components import Conditions
from checker.properties.temporal.digraph import Arrows, Digraph, rows_of, shortest

MOST_ENTRIES: Final = 16
MOST_EDGES: Final = 1_000_000
"""The most entries to fair components at which a cycle is searched, nearest first; the shortest lasso is taken. Fewer
entries, at least one, if the search would exceed so many edges.
"""


@dataclass(frozen=True, slots=True)
class Lasso:
    """The edges of a run: `stem`, and then `loop` for ever; without a loop any continuation.

    Attributes:
        stem: The first edges.
        loop: The repeated edges.
        shortest: Whether it is certain that no run with the same evidence has fewer edges.
    """

    stem: tuple[int, ...]
    loop: tuple[int, ...] = ()
    shortest: bool = field(default=False, compare=False)

    def __len__(self) -> int:
        return len(self.stem) + len(self.loop)


@dataclass(frozen=True, eq=False)
class Component:
    """A fair component as a graph of its own; its nodes and edges have their numbers in the whole graph."""

    nodes: Numbers
    edges: Numbers
    rows: Digraph
    conditions: Conditions


def component_of(
    arrows: Arrows, components: Numbers, node: int, conditions: Conditions, by: Bools | None = None
) -> Component:
    """Return the component of a node."""
    inside = components == components[node]
    nodes = np.flatnonzero(inside)
    allowed = inside[arrows.sources] & inside[arrows.targets]
    edges = np.flatnonzero(allowed if by is None else allowed & by)
    numbers = np.cumsum(inside) - 1
    sources, targets = (numbers[ends[edges]] for ends in (arrows.sources, arrows.targets))
    return Component(nodes, edges, rows_of(sources, targets, len(nodes)), conditions.over(nodes, edges))


def fair_cycle(part: Component, entry: int) -> tuple[int, ...]:
    """Return the edges of a short cycle through a node of a fair component that meets the conditions.

    For each condition that the cycle misses, it takes a detour to the nearest edge that meets it.
    """
    start = int(np.searchsorted(part.nodes, entry))
    home = part.rows.targets == start
    path: tuple[int, ...] = ()
    while True:
        at = int(part.rows.targets[path[-1]]) if path else start
        back = () if path and at == start else shortest(part.rows, at, home)
        assert back is not None  # the component is strongly connected
        goal = _unmet(part, (*path, *back))
        if not goal.any():
            return tuple(int(part.edges[edge]) for edge in (*path, *back))
        detour = shortest(part.rows, at, goal)
        assert detour is not None  # the component is fair
        path += detour


def fair_cycles(
    arrows: Arrows, components: Numbers, conditions: Conditions
) -> Iterator[tuple[int, tuple[int, ...]]]:
    """Yield entries to fair components, those of smaller numbers first, each with a cycle."""
    entries = np.flatnonzero(components >= 0)[:MOST_ENTRIES]
    parts: dict[int, Component] = {}
    searched = 0
    for entry in map(int, entries):
        number = int(components[entry])
        if number not in parts:
            parts[number] = component_of(arrows, components, entry, conditions)
        searched += len(parts[number].edges)
        if searched > MOST_EDGES and entry != entries[0]:
            return
        yield entry, fair_cycle(parts[number], entry)


def _unmet(part: Component, cycle: tuple[int, ...]) -> Bools:
    """Return the edges that meet a condition missed by a cycle."""
    taken = np.array(cycle, dtype=np.int64)
    visited = part.rows.targets[taken]
    found = np.zeros(len(part.edges), dtype=np.bool_)
    for recurrent in part.conditions.recurrent:
        if not recurrent[taken].any():
            found |= recurrent
    for each in part.conditions.strong:
        if each.enabled[visited].any() and not each.taken[taken].any():
            found |= each.taken
    return found


def tightened(lasso: Lasso) -> Lasso:
    """Return the same run in its shortest form: a primitive loop, entered as early as possible."""
    stem, loop = list(lasso.stem), list(lasso.loop)
    if not loop:
        return lasso
    period = next(
        n for n in range(1, len(loop) + 1) if len(loop) % n == 0 and loop[:n] * (len(loop) // n) == loop
    )
    loop = loop[:period]
    while stem and stem[-1] == loop[-1]:
        loop = [stem.pop(), *loop[:-1]]
    return Lasso(tuple(stem), tuple(loop))
