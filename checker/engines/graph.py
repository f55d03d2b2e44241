"""The explored transition system as arrays, for temporal properties; the same for every engine."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from checker.engines.edges import Edges
from semantics.state.configuration import Label

Bools = NDArray[np.bool_]
Numbers = NDArray[np.integer]

STUTTER = -1
"""The action of a stutter step: a self-loop where no transition has to happen."""


@dataclass(frozen=True, eq=False)
class Graph:
    """A transition system in compressed sparse rows; configuration 0 is the initial one.

    Attributes:
        starts: The start of the edges of each configuration, and the end of the last (n + 1 numbers).
        targets: For each edge, the number of its target.
        actions: For each edge, the number of its label, or `STUTTER`.
        labels: The labels.
        partial: For each configuration, whether successors may be missing; None if none are.
    """

    starts: Numbers
    targets: Numbers
    actions: Numbers
    labels: tuple[Label, ...] = ()
    partial: Bools | None = None

    @property
    def size(self) -> int:
        """The number of configurations."""
        return len(self.starts) - 1

    @cached_property
    def open(self) -> Bools:
        """For each configuration, whether successors may be missing."""
        return np.zeros(self.size, dtype=np.bool_) if self.partial is None else self.partial

    @cached_property
    def sources(self) -> Numbers:
        """For each edge, the number of its source."""
        return np.repeat(np.arange(self.size, dtype=self.targets.dtype), np.diff(self.starts))

    def total(self, optional: Bools | None = None) -> "Graph":
        """Return the graph with a self-loop at each configuration where no transition has to happen.

        Args:
            optional: For each label, whether its steps need never happen. By default every step has to happen, and only
                deadlocks get the loop.
        """
        needless = self.taken(np.zeros(len(self.labels), dtype=np.bool_) if optional is None else optional)
        resting = ~self.enabled(~needless) & ~self.open
        ends = np.flatnonzero(resting)
        if not len(ends):
            return self
        at = self.starts[ends + 1]
        added = np.concatenate(([0], np.cumsum(resting)))
        return Graph(
            self.starts + added.astype(self.starts.dtype),
            np.insert(self.targets, at, ends),
            np.insert(self.actions, at, STUTTER),
            self.labels,
            self.partial,
        )

    def taken(self, labels: Bools) -> Bools:
        """Return for each edge whether its label is marked; a stutter step's never is."""
        marked: Bools = np.append(labels, False)[self.actions]  # STUTTER addresses the last
        return marked

    def enabled(self, edges: Bools) -> Bools:
        """Return for each configuration whether a marked edge leaves it."""
        found = np.zeros(self.size, dtype=np.bool_)
        found[self.sources[edges]] = True
        return found


def graph_of(edges: Edges, configurations: int) -> Graph:
    """Return the graph of the edges that an exploration kept."""
    starts = np.fromiter(edges.rows(configurations), dtype=np.int64)
    partial = np.zeros(configurations, dtype=np.bool_)
    partial[sorted(edges.partial)] = True
    return Graph(
        starts,
        np.array(edges.targets, dtype=np.int32),
        np.array(edges.actions, dtype=np.int32),
        tuple(edges.labels),
        partial if partial.any() else None,
    )
