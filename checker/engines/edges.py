"""The edges of a transition system in compact arrays, filled during an exploration."""

from __future__ import annotations  # array[int] is no type at run time before Python 3.12

from array import array
from collections.abc import Iterator
from dataclasses import dataclass, field

from semantics.state.configuration import Label


@dataclass(slots=True)
class Edges:
    """Rows of edges, one for each configuration in the order of expansion.

    Attributes:
        starts: The start of each row; the start of the next row ends it.
        targets: For each edge, the number of its target.
        actions: For each edge, the number of its label.
        labels: The number of each label, in the order of discovery.
        partial: The configurations whose row lacks some successors.
    """

    starts: array[int] = field(default_factory=lambda: array("q", [0]))
    targets: array[int] = field(default_factory=lambda: array("q"))
    actions: array[int] = field(default_factory=lambda: array("q"))
    labels: dict[Label, int] = field(default_factory=dict)
    partial: set[int] = field(default_factory=set)

    def add(self, label: Label, target: int) -> None:
        """Add an edge to the open row."""
        self.targets.append(target)
        self.actions.append(self.labels.setdefault(label, len(self.labels)))

    def close(self) -> None:
        """End the row of the configuration that was expanded."""
        self.starts.append(len(self.targets))

    def rows(self, configurations: int) -> Iterator[int]:
        """Yield the start of each configuration's row, and the end of the last.

        The row of a configuration that was not fully expanded holds the edges found; the configuration is partial.
        """
        yield from self.starts
        expanded = len(self.starts) - 1
        if expanded < configurations:
            self.partial.update(range(expanded, configurations))
            yield from [len(self.targets)] * (configurations - expanded)
