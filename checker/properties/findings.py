"""Findings: the results of inspecting configurations, collected by kind and subject."""

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import NamedTuple

from semantics.state.configuration import Transition

Key = tuple[str, str]
"""The kind and the subject of a violation; findings with the same key are the same violation."""


class Inspected(NamedTuple):
    """One subject of a property in a configuration.

    Attributes:
        wrong: Its violation, None if there is none.
        by: The transition that it is about, if any.
        message: The violation in words.
        details: Returns more lines; called only where they are shown.
        alike: Returns the group of similar violations; called only for a violation. None for no group.
    """

    wrong: Key | None = None
    by: Transition | None = None
    message: str = ""
    details: Callable[[], tuple[str, ...]] = tuple
    alike: Callable[[], Hashable] = lambda: None


MOST_VIOLATIONS = 5
"""The most different violations of one property that keep a trace, by default."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One violation.

    Attributes:
        kind: Its kind: `unmatched`, `control race`, `deadlock`, ...
        message: The violation in words.
        at: The number of its configuration.
        by: The transition that it is about, which ends the trace; None if it is about the configuration.
        details: More lines.
        subject: Its subject: a request, racing requests, ...; empty if the property itself names it.
        alike: The group of similar violations of its kind; None for no group.
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
        """The group of similar violations; its key if it has none."""
        return self.key if self.alike is None else (self.kind, self.alike)


@dataclass(slots=True)
class Collected:
    """The findings of one property.

    Attributes:
        most: The most different findings kept of each kind.
        first: The first finding of each group, which has a shortest trace; at most `most` of each kind.
        met: The keys of all findings.
        groups: The keys of each group.
        apart: Whether `first` keeps a finding for each key, instead of one for each group.
        count: The number of all findings.
        examined: The number of subjects without a violation.
        example: The configuration of the first of those.
        example_by: The transition that it is about.
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
        """The number of different keys."""
        return len(self.met)

    def alike(self, finding: Finding) -> int:
        """Return the number of other keys in a finding's group."""
        return len(self.groups[finding.group]) - 1

    def add(self, finding: Finding) -> None:
        """Count a finding, and keep it if it is the first of its group."""
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

    def note(self, number: int, seen: Inspected) -> None:
        """Count a subject seen in a configuration."""
        if seen.wrong is None:
            self.looked(number, seen.by)
        else:
            kind, subject = seen.wrong
            details, alike = ((), None) if seen.wrong in self.met else (seen.details(), seen.alike())
            self.add(Finding(kind, seen.message, number, seen.by, details, subject, alike))

    def looked(self, number: int, by: Transition | None = None) -> None:
        """Count a subject without a violation; the first is kept as an example."""
        self.examined += 1
        if self.example is None:
            self.example, self.example_by = number, by

    def chosen(self) -> tuple[Finding, ...]:
        """Return the findings to show: one of each kind before a second of any, in the order of discovery."""
        kinds: set[str] = set()
        firsts: list[Finding] = []
        others: list[Finding] = []
        for finding in self.first.values():
            (others if finding.kind in kinds else firsts).append(finding)
            kinds.add(finding.kind)
        kept = [*firsts, *others][: self.most]
        return tuple(finding for finding in self.first.values() if finding in kept)
