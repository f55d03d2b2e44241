"""Findings: the results of inspecting configurations, collected by kind and subject."""

from dataclasses import dataclass, field

from semantics.state.configuration import Transition

MOST_VIOLATIONS = 5
"""How many different violations of one property are kept with a trace, unless more are asked for."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One violation.

    Attributes:
        kind: What it is: `unmatched`, `control race`, `deadlock`, ...
        message: In words.
        at: The number of the configuration that it was found in.
        by: The transition that it is about, which belongs to the trace; None where it is about the configuration.
        details: More lines.
        subject: What it is about: a request, the requests that race, ...; findings of one kind and subject are the
            same violation, met again. Empty where the property says itself what it is about.
    """

    kind: str
    message: str
    at: int
    by: Transition | None = None
    details: tuple[str, ...] = ()
    subject: str = ""


@dataclass(slots=True)
class Collected:
    """The findings of one property.

    Attributes:
        most: How many different ones are kept of each kind.
        first: The first finding of each kind and subject, which has a shortest trace; of each kind `most` at the most.
        different: Every kind and subject that was met.
        count: How many findings there were in all.
        examined: How many things were looked at.
        example: Where one of them was looked at and found good: the last configuration, and what was done there.
        example_by: The transition that the example is about.
    """

    most: int = MOST_VIOLATIONS
    first: dict[tuple[str, str], Finding] = field(default_factory=dict)
    different: set[tuple[str, str]] = field(default_factory=set)
    count: int = 0
    examined: int = 0
    example: int | None = None
    example_by: Transition | None = None

    def add(self, finding: Finding) -> None:
        """Count a finding, and keep it if it is the first of its kind and subject."""
        self.count += 1
        key = (finding.kind, finding.subject)
        if key in self.different:
            return
        self.different.add(key)
        if sum(kind == finding.kind for kind, _ in self.first) < self.most:
            self.first[key] = finding

    def looked(self, number: int, by: Transition | None = None) -> None:
        """Count something that was looked at; the first is kept as an example."""
        self.examined += 1
        if self.example is None:
            self.example, self.example_by = number, by

    def chosen(self) -> tuple[Finding, ...]:
        """Return the findings that are shown: one of each kind before a second of any, in the order of discovery."""
        kinds: set[str] = set()
        firsts: list[Finding] = []
        others: list[Finding] = []
        for finding in self.first.values():
            (others if finding.kind in kinds else firsts).append(finding)
            kinds.add(finding.kind)
        kept = [*firsts, *others][: self.most]
        return tuple(finding for finding in self.first.values() if finding in kept)
