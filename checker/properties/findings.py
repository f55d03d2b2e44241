"""Findings: the results of inspecting configurations, collected by kind and subject."""

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import NamedTuple

from semantics.state.configuration import Transition

Key = tuple[str, str]
"""What is wrong: its kind and its subject; findings with one key are the same violation, met again."""


class Seen(NamedTuple):
    """One thing that a property is about, as it was found in a configuration.

    Attributes:
        wrong: What is wrong with it, None where nothing is.
        by: The transition that it is about, if it is about one.
        message: What is wrong, in words.
        details: More lines; asked for only where they are told.
        alike: What it has in common with what is alike; asked for only where something is wrong. None: nothing is.
    """

    wrong: Key | None = None
    by: Transition | None = None
    message: str = ""
    details: Callable[[], tuple[str, ...]] = tuple
    alike: Callable[[], Hashable] = lambda: None


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
        subject: What it is about: a request, the requests that race, ...; empty where the property says that itself.
        alike: What it has in common with those of its kind that are alike; None where none is.
    """

    kind: str
    message: str
    at: int
    by: Transition | None = None
    details: tuple[str, ...] = ()
    subject: str = ""
    alike: Hashable = None

    @property
    def key(self) -> Key:
        """Its kind and subject."""
        return (self.kind, self.subject)

    @property
    def group(self) -> Hashable:
        """What it has in common with those that are alike: its key if none is."""
        return self.key if self.alike is None else (self.kind, self.alike)


@dataclass(slots=True)
class Collected:
    """The findings of one property.

    Attributes:
        most: How many different ones are kept of each kind.
        first: The first of those that are alike, which has a shortest trace; of each kind `most` at the most.
        met: Every kind and subject that was met.
        groups: The same in groups of those that are alike.
        apart: Whether each kind and subject is kept in `first`, however alike they are.
        count: How many findings there were in all.
        examined: How many things were looked at.
        example: Where one of them was looked at and found good: the last configuration, and what was done there.
        example_by: The transition that the example is about.
    """

    most: int = MOST_VIOLATIONS
    first: dict[Key, Finding] = field(default_factory=dict)
    met: set[Key] = field(default_factory=set)
    groups: dict[Hashable, set[Key]] = field(default_factory=dict)
    apart: bool = False
    count: int = 0
    examined: int = 0
    example: int | None = None
    example_by: Transition | None = None

    @property
    def different(self) -> int:
        """How many kinds and subjects were met."""
        return len(self.met)

    def alike(self, finding: Finding) -> int:
        """Return how many others were met that are alike."""
        return len(self.groups[finding.group]) - 1

    def add(self, finding: Finding) -> None:
        """Count a finding, and keep it if it is the first of those that are alike."""
        self.count += 1
        if finding.key in self.met:
            return
        self.met.add(finding.key)
        group = self.groups.setdefault(finding.group, set())
        group.add(finding.key)
        if len(group) == 1 or self.apart:
            self.keep(finding)

    def keep(self, finding: Finding) -> None:
        """Keep a finding unless there are enough of its kind."""
        if sum(kind == finding.kind for kind, _ in self.first) < self.most:
            self.first[finding.key] = finding

    def note(self, number: int, seen: Seen) -> None:
        """Count what was seen in a configuration."""
        if seen.wrong is None:
            self.looked(number, seen.by)
        else:
            kind, subject = seen.wrong
            details, alike = ((), None) if seen.wrong in self.met else (seen.details(), seen.alike())
            self.add(Finding(kind, seen.message, number, seen.by, details, subject, alike))

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
