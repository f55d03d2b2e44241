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
    from checker.properties.critical_path import Leg
    from checker.properties.schedule import Schedule


class Outcome(Enum):
    """The word of a verdict. What was cut off never reads as *holds*."""

    HOLDS = "holds"
    VIOLATED = "violated"
    INCOMPLETE = "incomplete"


@dataclass(frozen=True, slots=True)
class Violation:
    """One way in which a property fails, with a shortest trace that ends in it.

    Attributes:
        kind: What it is.
        message: In words.
        trace: A shortest run that ends in it.
        details: More lines.
        subject: What it is about, such as a request; empty where the property itself says that.
        alike: How many others there are of that kind that come from the same places in the mission's text.
        path: The critical path: the steps, one after the other, that its date is made of, and what bounds them.
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
        """The details, the critical path, and how many others are alike."""
        path = ("critical path:", *(f"  {leg}" for leg in self.path)) if self.path else ()
        return (*self.details, *path, *([f"and {self.alike:,} alike"] if self.alike else []))

    def __repr__(self) -> str:
        return f"<Violation {cut(self.kind)} steps={len(self.trace)}: {cut(self.message)}>"


@dataclass(frozen=True, slots=True)
class Verdict:
    """What was found of one property.

    Attributes:
        property: The property.
        outcome: Whether it holds.
        violations: One of those that are alike, the shortest trace first, as far as they are shown.
        count: How often a violation was met, in whichever configuration.
        examined: How many things the property was about were found good; 0 makes a verdict vacuous.
        witness: A trace to one of them, where something holds; None also where none was looked for.
        note: How it was decided, or what else is to be known.
        different: How many kinds and subjects of violations there were, shown or not.
        remarks: What makes a verdict that holds say less than it seems to.
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

    def _repr_html_(self) -> str:
        from bigactors.notebook import verdict_html  # noqa: PLC0415 - what notebooks show is built on values

        return verdict_html(self)


class UnknownPropertyError(KeyError):
    """A property that a report has no verdict of."""

    __str__ = Exception.__str__


class Verdicts(tuple[Verdict, ...]):
    """The verdicts of a report in the mission's order; one is also found by the name of its property."""

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
    """All that a check found.

    Attributes:
        verdicts: One for each property, in the mission's order; `verdicts["race_freedom"]` is one by its name.
        configurations: How many were visited, the monitor's cells not counted.
        transitions: How many transitions they have.
        depth: The distance of the farthest.
        bounds: Those that were met; empty where everything was explored.
        rules: How many transitions each inference rule has.
        notes: What is to be known of the verdicts.
        seconds: How long it took.
        coverage: What was reached of the mission's text.
        reduced: What let it visit less, by name; then counts are those of what was visited.
        allowed: How many transitions the visited configurations allow, followed or not.
        schedule: When its flights begin and end, where that was asked for.
        flights: How many seconds a flight of each bigActor takes at most, where times bound it, sorted by name.
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
    flights: tuple[tuple[Name, float], ...] = ()

    def __repr__(self) -> str:
        counts = Counter(verdict.outcome.value for verdict in self.verdicts)
        found = " ".join(f"{outcome.value}={counts[outcome.value]}" for outcome in Outcome)
        return f"<Report {found} configurations={self.configurations} complete={self.complete}>"

    def _repr_html_(self) -> str:
        from bigactors.notebook import report_html  # noqa: PLC0415 - what notebooks show is built on values

        return report_html(self)

    @property
    def complete(self) -> bool:
        """Whether everything reachable was visited."""
        return not self.bounds

    @property
    def exit_code(self) -> int:
        """0 if all hold, 1 if some are violated, 3 if a limit was met."""
        outcomes = {verdict.outcome for verdict in self.verdicts}
        if Outcome.VIOLATED in outcomes:
            return 1
        return 3 if Outcome.INCOMPLETE in outcomes or not self.complete else 0
