"""Verdicts: the results of a check, as data."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, SupportsIndex, overload

from bigraphs.notation.spelling import nearest
from checker.limits import Bound
from checker.properties.coverage import Coverage
from checker.traces import Trace
from semantics.properties.property import Property
from semantics.state.brief import cut
from semantics.state.signature import Name

if TYPE_CHECKING:
    from checker.properties.corridors import Corridors
    from checker.properties.critical_path import Leg
    from checker.properties.schedule import Schedule
    from semantics.regions.suspicions import SuspectedWay, Suspicion


class Outcome(Enum):
    """The outcome of a verdict; an exploration that met a bound never yields *holds*."""

    HOLDS = "holds"
    VIOLATED = "violated"
    INCOMPLETE = "incomplete"


@dataclass(frozen=True, slots=True)
class Violation:
    """One way in which a property fails, with a shortest trace that ends in it.

    Attributes:
        kind: The kind of violation.
        message: The violation in words.
        trace: A shortest run that ends in it.
        details: More lines.
        subject: Its subject, such as a request; empty where the property itself names it.
        alike: The number of other violations of this kind from the same places in the mission's text.
        path: The critical path: the consecutive steps that determine its date, each with its time bound.
    """

    kind: str
    message: str
    trace: Trace
    details: tuple[str, ...] = ()
    subject: str = ""
    alike: int = 0
    path: tuple[Leg, ...] = ()

    @property
    def told(self) -> tuple[str, ...]:
        """The details, the critical path, and the number of similar violations."""
        path = ("critical path:", *(f"  {leg}" for leg in self.path)) if self.path else ()
        return (*self.details, *path, *([f"and {self.alike:,} alike"] if self.alike else []))

    def __repr__(self) -> str:
        return f"<Violation {cut(self.kind)} steps={len(self.trace)}: {cut(self.message)}>"


@dataclass(frozen=True, slots=True)
class Verdict:
    """The result for one property.

    Attributes:
        property: The property.
        outcome: Whether it holds.
        violations: The violations shown, one of each similar group, the shortest trace first.
        count: The number of violations, over all configurations.
        examined: The number of subjects that satisfied the property; 0 makes the verdict vacuous.
        witness: A trace to one of them, where the property holds; None also where none was searched.
        note: The method of the decision, or a qualification.
        different: The number of different kinds and subjects of violations, shown or not.
        remarks: Reasons why a positive verdict may be vacuous or weak.
    """

    property: Property
    outcome: Outcome
    violations: tuple[Violation, ...] = ()
    count: int = 0
    examined: int = 0
    witness: Trace | None = None
    note: str = ""
    different: int = 0
    remarks: tuple[str, ...] = ()

    def __repr__(self) -> str:
        found = f" violations={len(self.violations)}" if self.violations else ""
        return f"<Verdict {cut(self.property.name)} {self.outcome.value}{found}>"


class UnknownPropertyError(KeyError):
    """A property without a verdict in a report."""

    __str__ = Exception.__str__


class Verdicts(tuple[Verdict, ...]):
    """The verdicts of a report in the mission's order, also accessible by the name of the property."""

    __slots__ = ()

    @overload
    def __getitem__(self, which: SupportsIndex | str) -> Verdict: ...
    @overload
    def __getitem__(self, which: slice) -> tuple[Verdict, ...]: ...
    def __getitem__(self, which: SupportsIndex | slice | str) -> Verdict | tuple[Verdict, ...]:
        if not isinstance(which, str):
            return super().__getitem__(which)
        found = {verdict.property.name: verdict for verdict in self}
        if which not in found:
            raise UnknownPropertyError(f"no verdict on '{cut(which)}': {_instead(which, list(found))}")
        return found[which]

    def __contains__(self, which: object) -> bool:
        return super().__contains__(which) or any(each.property.name == which for each in self)


def _instead(name: str, names: list[str]) -> str:
    near = nearest(name, names)[:3]
    return (
        f"did you mean {' or '.join(map(repr, near))}?" if near else f"there are {', '.join(names) or 'none'}"
    )


@dataclass(frozen=True, slots=True)
class Report:
    """The result of a check.

    Attributes:
        verdicts: One for each property, in the mission's order; `verdicts["race_freedom"]` is one by its name.
        configurations: The number of visited configurations, the monitor's cells not counted.
        transitions: The number of their transitions.
        depth: The greatest distance from the initial configuration.
        bounds: The bounds that were met; empty for a complete exploration.
        rules: The number of transitions by each inference rule.
        notes: Qualifications of the verdicts.
        seconds: The duration.
        coverage: The reached parts of the mission's text.
        reduced: The names of the reductions applied; counts are then those of the reduced exploration.
        allowed: The number of enabled transitions in the visited configurations, followed or not.
        schedule: The earliest and latest dates of its flights, if requested.
        corridors: The ways of its flights with their lengths and distances, if requested.
        flights: The longest flight of each bigActor in seconds, where it is bounded, sorted by name.
        suspected: For each suspicion about ways a way that confirms it, None if there is none; undecided ones are left
            out.
    """

    verdicts: Verdicts
    configurations: int
    transitions: int
    depth: int
    bounds: tuple[Bound, ...] = ()
    rules: Mapping[str, int] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    seconds: float = 0.0
    coverage: Coverage | None = None
    reduced: tuple[str, ...] = ()
    allowed: int = 0
    schedule: Schedule | None = None
    corridors: Corridors | None = None
    flights: tuple[tuple[Name, float], ...] = ()
    suspected: Mapping[Suspicion, SuspectedWay | None] = field(default_factory=dict)

    def __repr__(self) -> str:
        counts = Counter(verdict.outcome.value for verdict in self.verdicts)
        found = " ".join(f"{outcome.value}={counts[outcome.value]}" for outcome in Outcome)
        return f"<Report {found} configurations={self.configurations} complete={self.complete}>"

    @property
    def complete(self) -> bool:
        """Whether all reachable configurations were visited."""
        return not self.bounds

    @property
    def exit_code(self) -> int:
        """0 if all hold, 1 if some are violated, 3 if a limit was met."""
        outcomes = {verdict.outcome for verdict in self.verdicts}
        if Outcome.VIOLATED in outcomes:
            return 1
        return 3 if Outcome.INCOMPLETE in outcomes or not self.complete else 0
