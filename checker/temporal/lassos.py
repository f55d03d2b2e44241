"""Lassos: a way to a fair component, and a cycle in it that is fair."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from checker.graph import Bools, Numbers
from checker.temporal.arrows import Arrows, Rows, rows_of, shortest
from checker.temporal.components import Conditions

MOST_ENTRIES: Final = 16
"""At so many entries to fair components a cycle is looked for, the nearest first; the shortest lasso is taken."""


@dataclass(frozen=True, slots=True)
class Lasso:
    """The edges of a run: `stem`, and then `loop` again and again; without a loop whatever may follow."""

    stem: tuple[int, ...]
    loop: tuple[int, ...] = ()

    def __len__(self) -> int:
        return len(self.stem) + len(self.loop)


@dataclass(frozen=True, eq=False)
class _Component:
    """A component as a graph of its own: of its nodes and edges, which they are of the whole."""

    nodes: Numbers
    edges: Numbers
    rows: Rows
    conditions: Conditions


def fair_cycle(
    arrows: Arrows, components: Numbers, entry: int, conditions: Conditions, by: Bools | None = None
) -> tuple[int, ...]:
    """Return the edges of a short cycle through a node of a fair component, which meets the conditions.

    Each of them that the shortest cycle doesn't meet is met by a detour to where it is met nearest.
    """
    part = _part(arrows, components, entry, conditions, by)
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


def _part(
    arrows: Arrows, components: Numbers, entry: int, conditions: Conditions, by: Bools | None
) -> _Component:
    inside = components == components[entry]
    nodes = np.flatnonzero(inside)
    allowed = inside[arrows.sources] & inside[arrows.targets]
    edges = np.flatnonzero(allowed if by is None else allowed & by)
    sources, targets = (np.searchsorted(nodes, ends[edges]) for ends in (arrows.sources, arrows.targets))
    return _Component(nodes, edges, rows_of(sources, targets, len(nodes)), conditions.over(nodes, edges))


def _unmet(part: _Component, cycle: tuple[int, ...]) -> Bools:
    """Return the edges by which some condition is met that a cycle doesn't meet."""
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
    """Return the same run written shorter: the loop not repeated in itself, nor begun before it is entered."""
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
