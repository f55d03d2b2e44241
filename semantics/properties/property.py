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
"""What quantifiers go through; names are sorted."""


@dataclass(frozen=True, slots=True)
class Property:
    """What is to be checked.

    Attributes:
        kind: What sort of property it is.
        name: Its name; that of its kind where the mission gives none.
        formula: Of an invariant, or of what is to be reachable.
        line: Where it stands in the mission's text, from 1; 0 where it was not written.
        temporal: The formula of `ltl` and `ctl`.
        fairness: Which runs count, for `ltl`, `ctl`, `progress` and `deadlock_freedom`: all where it is empty.
        ranges: What the quantifiers of its formula go through.
        written: Its formula as it stands in the mission's text; empty where it was not written.
        bound: How many ticks `within` allows.
        then: What has to follow the formula within them (`F leads to G`); None where the formula itself has to hold.
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
        """Its formula for people: as it was written, with its quantifiers, else what it comes to."""
        return self.written or str(self.formula if self.temporal is None else self.temporal)

    @property
    def is_of_runs(self) -> bool:
        """Whether it is about runs: its kind is, or which runs count matters."""
        return self.kind.is_of_runs or bool(self.fairness)


def watched(properties: Iterable[Property]) -> frozenset[VariableOf]:
    """Return the variables that properties name, wherever it is."""
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
    """Return a configuration from which on what properties name is kept to the end of the run, and timed.

    How long vehicles are aloft is timed for `endurance` alone: the clocks of several multiply what is told apart.
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
