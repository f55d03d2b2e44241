"""Verdicts: the results of a check, as data."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

from checker.limits import Bound
from checker.properties.coverage import Coverage
from checker.traces import Trace
from semantics.properties.property import Property


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
    """

    kind: str
    message: str
    trace: Trace
    details: tuple[str, ...] = ()
    subject: str = ""


@dataclass(frozen=True, slots=True)
class Verdict:
    """What was found of one property.

    Attributes:
        property: The property.
        outcome: Whether it holds.
        violations: One for each kind and subject, the shortest trace first, as far as they are shown.
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


@dataclass(frozen=True, slots=True)
class Report:
    """All that a check found.

    Attributes:
        verdicts: One for each property, in the mission's order.
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
    """

    verdicts: tuple[Verdict, ...]
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
