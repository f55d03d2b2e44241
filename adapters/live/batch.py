"""The input of a turn, validated: publications and reports of plugins, and messages of operators."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import Any

from adapters.plugin import Aged, Gone, Published, Report
from physical import is_word, legible
from semantics.live_policy import Fallback
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class Heard:
    """A publication of a plugin."""

    plugin: str
    published: Published


@dataclass(frozen=True, slots=True)
class Saying:
    """An operator's message to an agent, with its sender; `number` identifies it in the answer."""

    agent: Name
    message: str
    by: str = ""
    number: int = 0

    @property
    def texts(self) -> tuple[str, ...]:
        """The texts from outside."""
        return self.agent, self.message, self.by


@dataclass(frozen=True, slots=True)
class GivingBack:
    """An operator's permission to command a vehicle again, or the vehicle's new address.

    Attributes:
        vehicle: The vehicle's name.
        at: The vehicle's new HOST:PORT; empty if it may be commanded again.
        by: The operator.
        number: Identifies it in the answer.
    """

    vehicle: Name
    at: str = ""
    by: str = ""
    number: int = 0

    @property
    def texts(self) -> tuple[str, ...]:
        """The texts from outside."""
        return self.vehicle, self.at, self.by


@dataclass(frozen=True, slots=True)
class Ordering:
    """An operator's order: to hold, or to return.

    Attributes:
        fallback: The ordered action.
        vehicle: The vehicle's name, or several names; None for all that this station commands.
        by: The operator.
        number: Identifies the order in the answer.
    """

    fallback: Fallback
    vehicle: Name | tuple[Name, ...] | None = None
    by: str = ""
    number: int = 0

    @property
    def texts(self) -> tuple[str, ...]:
        """The texts from outside."""
        named = self.vehicle if isinstance(self.vehicle, tuple) else (self.vehicle or "",)
        return *named, self.by


@dataclass(frozen=True, slots=True)
class Acknowledging:
    """An operator has seen a finding, given by its number in the recording, from 1."""

    finding: int
    by: str = ""
    number: int = 0

    @property
    def texts(self) -> tuple[str, ...]:
        """The texts from outside."""
        return (self.by,)


@dataclass(frozen=True, slots=True)
class Noting:
    """An operator's note, which is recorded and changes nothing."""

    text: str
    by: str = ""
    number: int = 0

    @property
    def texts(self) -> tuple[str, ...]:
        """The texts from outside."""
        return self.text, self.by


Said = Saying | GivingBack | Ordering | Acknowledging | Noting
"""A message to a run from outside."""


@dataclass(frozen=True, slots=True)
class Batch:
    """All input since the last turn, in order; `missed` are the seconds without listening."""

    heard: tuple[Heard, ...] = ()
    reports: tuple[Report, ...] = ()
    sayings: tuple[Said, ...] = ()
    missed: float = 0.0


def flaw_of(published: Published) -> str:
    """Return the flaw of a publication, or an empty text."""
    observed = published.property if isinstance(published, Aged) else published
    words, numbers = [observed.entity], [observed.time or 0.0]
    if isinstance(published, Aged):
        numbers.append(published.time_to_live)
    if not isinstance(observed, Gone):
        words += [
            observed.kind,
            *observed.channels,
            *([] if observed.carried_by is None else [observed.carried_by]),
        ]
        numbers += [] if observed.velocity is None else [observed.velocity.speed, observed.velocity.course]
    spoilt = next((word for word in words if not is_word(word)), None)
    if spoilt is not None:
        return f"{spoilt!r:.60} is no word of 1 to 200 characters"
    return "" if all(map(math.isfinite, numbers)) else f"a time or velocity of {observed.entity} is no number"


def legible_report(report: Report) -> Report:
    """Return a report with printable texts: file names and server answers may hold anything."""
    texts: list[tuple[str, Any]] = [(each.name, getattr(report, each.name)) for each in fields(report)]
    spoilt = {name: legible(text) for name, text in texts if isinstance(text, str) and legible(text) != text}
    return replace(report, **spoilt) if spoilt else report  # type: ignore[arg-type]  # texts for texts
