"""The properties that a mission asks to check, and the variables that they need."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from semantics.behaviours.program import VariableOf
from semantics.properties.kinds import PropertyKind
from semantics.properties.propositions import Always, Proposition
from semantics.properties.temporal import Fairness, Temporal
from semantics.state.brief import cut
from semantics.state.configuration import Configuration
from semantics.state.signature import Name

TRUE: Final = Always(True)


Ranges = tuple[tuple[Name, ...], ...]
"""The ranges of quantifiers; names are sorted."""


@dataclass(frozen=True, slots=True)
class Property:
    """A property to check.

    Attributes:
        kind: Its kind.
        name: Its name; the word of its kind if the mission gives none.
        formula: The proposition of an invariant, or of reachability.
        line: Its line in the mission's text, from 1; 0 if it was not written.
        temporal: The formula of `ltl` and `ctl`.
        fairness: The fairness of the runs considered, for `ltl`, `ctl`, `progress` and `deadlock_freedom`; all runs if
            empty.
        ranges: The ranges of the quantifiers in its formula.
        written: Its formula as written in the mission's text; empty if it was not written.
        bound: The deadline of `within`, in ticks.
        then: The proposition that has to follow the formula within the bound (`F leads to G`); None if the formula
            itself has to become true.
    """

    kind: PropertyKind
    name: str
    formula: Proposition = TRUE
    line: int = 0
    temporal: Temporal | None = None
    fairness: tuple[Fairness, ...] = ()
    ranges: Ranges = ()
    written: str = ""
    bound: int = 0
    then: Proposition | None = None

    def __repr__(self) -> str:
        return f"<Property {cut(self.name)}{'' if self.name == self.kind else f' kind={self.kind}'}>"

    @property
    def shown(self) -> str:
        """Its formula for people: as written, with its quantifiers; otherwise the expanded formula."""
        return self.written or str(self.formula if self.temporal is None else self.temporal)

    @property
    def is_of_runs(self) -> bool:
        """Whether it is about runs: its kind is, or it has a fairness condition."""
        return self.kind.is_of_runs or bool(self.fairness)


def watched(properties: Iterable[Property]) -> frozenset[VariableOf]:
    """Return the variables that the properties mention, at any depth."""
    found: set[VariableOf] = set()
    waiting: list[object] = list(properties)
    while waiting:
        part = waiting.pop()
        if isinstance(part, VariableOf):
            found.add(part)
        elif isinstance(part, tuple):
            waiting.extend(part)
        else:
            waiting.extend(getattr(part, name) for name in getattr(part, "__dataclass_fields__", ()))
    return frozenset(found)


def watching(c: Configuration, properties: Iterable[Property]) -> Configuration:
    """Return the configuration with the properties' variables kept to the end of the run, and the clocks they need.

    Endurance is timed only for a property `endurance`, since the clocks of several vehicles multiply the states.
    """
    asked, setting = tuple(properties), c.setting
    program, timing = setting.program.watching(watched(asked)), setting.timing
    if (
        timing is not None
        and timing.endurances
        and all(each.kind is not PropertyKind.ENDURANCE for each in asked)
    ):
        timing = timing.without_endurances()
    unchanged = program is setting.program and timing is setting.timing
    return c if unchanged else Configuration(setting.with_(program=program, timing=timing), c.state)
