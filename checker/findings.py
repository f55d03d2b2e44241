"""Findings: what an inspection of a configuration turns up, and the collection of the first of each kind."""

from dataclasses import dataclass, field

from semantics.configuration import Transition


@dataclass(frozen=True, slots=True)
class Finding:
    """One violation.

    Attributes:
        kind: What it is: `unmatched`, `control race`, `deadlock`, ...
        message: In words.
        at: The number of the configuration that it was found in.
        by: The transition that it is about, which belongs to the trace; None where it is about the configuration.
        details: More lines.
    """

    kind: str
    message: str
    at: int
    by: Transition | None = None
    details: tuple[str, ...] = ()


@dataclass(slots=True)
class Collected:
    """The findings of one property.

    Attributes:
        first: The first finding of each kind, which has a shortest trace.
        count: How many there were in all.
        examined: How many things were looked at.
        example: Where one of them was looked at and found good: the last configuration, and what was done there.
        example_by: The transition that the example is about.
    """

    first: dict[str, Finding] = field(default_factory=dict)
    count: int = 0
    examined: int = 0
    example: int | None = None
    example_by: Transition | None = None

    def add(self, finding: Finding) -> None:
        """Count a finding, and keep it if it is the first of its kind."""
        self.count += 1
        self.first.setdefault(finding.kind, finding)

    def looked(self, number: int, by: Transition | None = None) -> None:
        """Count something that was looked at; the first is kept as an example."""
        self.examined += 1
        if self.example is None:
            self.example, self.example_by = number, by
