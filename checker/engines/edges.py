"""The edges of a transition system, stored compactly as they are found."""

from __future__ import annotations  # array[int] is no type at run time before Python 3.12

from array import array
from collections.abc import Iterator
from dataclasses import dataclass, field

from semantics.state.configuration import Label


@dataclass(slots=True)
class Edges:
    """Rows of edges, one row for each configuration in the order in which they are expanded.

    Attributes:
        starts: Where each row begins; a row is closed by where the next one begins.
        targets: For each edge, the number of the configuration that it leads to.
        actions: For each edge, the number of its label.
        labels: The number of each label, in the order of discovery.
        partial: The configurations of which not all successors are here.
    """

    starts: array[int] = field(default_factory=lambda: array("q", [0]))
    targets: array[int] = field(default_factory=lambda: array("q"))
    actions: array[int] = field(default_factory=lambda: array("q"))
    labels: dict[Label, int] = field(default_factory=dict)
    partial: set[int] = field(default_factory=set)

    def add(self, label: Label, target: int) -> None:
        """Add an edge to the row that is open."""
        self.targets.append(target)
        self.actions.append(self.labels.setdefault(label, len(self.labels)))

    def close(self) -> None:
        """End the row of the configuration that was expanded."""
        self.starts.append(len(self.targets))

    def rows(self, configurations: int) -> Iterator[int]:
        """Yield where each row of so many configurations begins, and where the last ends.

        What was never expanded, or not to the end, has the edges that were found, and is partial.
        """
        yield from self.starts
        expanded = len(self.starts) - 1
        if expanded < configurations:
            self.partial.update(range(expanded, configurations))
            yield from [len(self.targets)] * (configurations - expanded)
