"""The input of a turn: publications and reports of plugins, and messages of operators."""

from __future__ import annotations

from dataclasses import dataclass

from adapters.plugin import Published, Report
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
