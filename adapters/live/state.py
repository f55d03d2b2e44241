"""The state of a live run and the changes to it: frozen values, no clock, no input or output."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum

from adapters.live.timing import Timers
from adapters.plugin import Follow, GoTo, HandOver, Hold, Return
from physical import Geometry, PhysicalProperty
from semantics.state.cells import Cell
from semantics.state.configuration import Configuration
from semantics.state.requests import Request
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class Sighting:
    """The newest observation of an entity, and the end of its validity in P."""

    property: PhysicalProperty
    time: float
    until: float


@dataclass(frozen=True, slots=True)
class Order:
    """A command to a vehicle that is not confirmed yet.

    Attributes:
        command: The last command.
        agent: The agent whose request it serves.
        since: Time of its first sending.
        obeyed: Whether the vehicle's last reports show that it follows the command.
        through: Whether the vehicle has reported the end of its path.
        refused: Whether it was refused.
        waypoint: The point around which the vehicle will stay, if it has reported one.
    """

    command: GoTo | Follow | HandOver
    agent: Name
    since: float
    obeyed: bool = False
    through: bool = False
    refused: bool = False
    waypoint: Geometry | None = None

    @property
    def goal(self) -> Geometry | None:
        """The last place of the command, at its position when it was sent."""
        match self.command:
            case GoTo(place=place):
                return place
            case Follow(path=path):
                return path[-1]
        return None


class Fate(StrEnum):
    """The progress of an order to hold or to return."""

    ASKED = "asked"
    SENT = "sent"
    CONFIRMED = "confirmed"
    REFUSED = "refused"


@dataclass(frozen=True, slots=True)
class Bidden:
    """An order to hold or to return, which a vehicle owes until its state shows it.

    It stands until the vehicle is given back or taken over.

    Attributes:
        command: The command to the vehicle.
        by: The operator who gave it, empty if unknown; None for the mission, which falls back.
        fate: Its progress.
        refusal: The last reason of refusal; empty if there was none.
        again: Time of its repetition after a refusal.
    """

    command: Hold | Return
    by: str | None = ""
    fate: Fate = Fate.ASKED
    refusal: str = ""
    again: float = math.inf

    @property
    def owed(self) -> bool:
        """Whether the vehicle has not confirmed it yet."""
        return self.fate is not Fate.CONFIRMED

    @property
    def told(self) -> Fate:
        """Its fate in reports to people: a refused order stays refused while it is repeated."""
        return Fate.REFUSED if self.owed and self.refusal else self.fate

    @property
    def orderer(self) -> str:
        """The orderer's name for people."""
        return "the mission" if self.by is None else operator(self.by)

    @property
    def what(self) -> str:
        """The ordered action."""
        return "hold" if isinstance(self.command, Hold) else "return"

    @property
    def reason(self) -> str:
        """The reason why the mission does not command the vehicle, with the order's progress."""
        if not self.owed:
            return f"{'held' if self.what == 'hold' else 'sent home'} by {self.orderer}"
        if self.refusal:  # also while it is repeated
            return f"refuses to {self.what}, as {self.orderer} ordered: {self.refusal}"
        return f"told to {self.what} by {self.orderer}, not confirmed yet"


def operator(by: str) -> str:
    """Name an operator for people.

    >>> operator("Ana"), operator("")
    ('the operator (Ana)', 'the operator')
    """
    return f"the operator ({by})" if by else "the operator"


@dataclass(frozen=True, slots=True)
class Waiting:
    """The request at the head of an agent's line: its start there, and the limits that it has exceeded."""

    request: Request
    since: float
    late: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Pace:
    """The number of own steps that an agent may take at once, as of a time."""

    tokens: float
    at: float


@dataclass(frozen=True, slots=True)
class LiveState:
    """The state of a live run.

    Attributes:
        configuration: ⟨α | S | η⟩.
        seen: The newest sighting of each entity that the mission names or has admitted.
        expires: Time at which the first sighting becomes too old.
        orders: The order of each vehicle in flight.
        handing: The unconfirmed hand-over of each vehicle.
        lost: Vehicles whose link is lost.
        taken: Vehicles that were taken over, also by an operator's order, with the reason: they get no commands until
            an operator gives them back.
        bidden: The operator's standing order for each vehicle; all of them are taken.
        owed: The fallback that the mission has ordered of each vehicle.
        idle: Agents without own steps: they wait for an observation, a message, or for ever.
        due: The end of each agent's wait at a `react` with an `after` branch.
        quiet: The configuration in which no more requests could be served, None if that is not known.
        heads: The head of each agent's line.
        paces: The pace of each agent.
        suspended: Whether a broken assumption has stopped all controls.
        grounded: Agents whose controls are no longer served, since a request of theirs took too long.
        missing: Cells of P whose removal broke an assumption, with their values: their return breaks no other.
        failed: Agents whose computation failed.
        reported: Messages that are not reported again.
        last: The agent that took the last step: the next turn begins with the one after it.
        number: The number of steps taken.
        told: The number of orders given.
        findings: The number of findings reported: also the number of the last one.
        shares: The number of strangers admitted from each plugin, and of those that are places.
        timers: The clocks of the mission's timing; None before the start, and in a mission without timing.
        stopped: Start of the standstill of a killed run that is resumed; None otherwise.
    """

    configuration: Configuration
    seen: Mapping[Name, Sighting] = field(default_factory=dict)
    expires: float = math.inf
    orders: Mapping[Name, Order] = field(default_factory=dict)
    handing: Mapping[Name, Order] = field(default_factory=dict)
    lost: frozenset[Name] = frozenset()
    taken: Mapping[Name, str] = field(default_factory=dict)
    bidden: Mapping[Name, Bidden] = field(default_factory=dict)
    owed: Mapping[Name, Bidden] = field(default_factory=dict)
    idle: frozenset[Name] = frozenset()
    due: Mapping[Name, float] = field(default_factory=dict)
    quiet: Configuration | None = None
    heads: Mapping[Name, Waiting] = field(default_factory=dict)
    paces: Mapping[Name, Pace] = field(default_factory=dict)
    suspended: bool = False
    grounded: frozenset[Name] = frozenset()
    missing: Mapping[Cell, object] = field(default_factory=dict)
    failed: frozenset[Name] = frozenset()
    reported: frozenset[str] = frozenset()
    last: Name = ""
    number: int = 0
    told: int = 0
    findings: int = 0
    shares: Mapping[str, tuple[int, int]] = field(default_factory=dict)
    timers: Timers | None = None
    stopped: float | None = None

    def with_(self, **changes: object) -> LiveState:
        """Return the state with some of its attributes changed."""
        return replace(self, **changes)  # type: ignore[arg-type]  # names are checked by replace itself

    @property
    def owing(self) -> Mapping[Name, Bidden]:
        """The orders to hold or to return that vehicles have not confirmed."""
        return {name: each for name, each in (*self.owed.items(), *self.bidden.items()) if each.owed}

    @property
    def fates(self) -> Mapping[Name, tuple[str, str]]:
        """The fate of each operator's order, also in words."""
        return {name: (each.told.value, each.reason) for name, each in self.bidden.items()}

    def later(self, seconds: float) -> LiveState:
        """Return the state with all ages and waiting times shifted by a time without listening."""
        seen = {name: replace(each, until=each.until + seconds) for name, each in self.seen.items()}
        heads = {name: replace(each, since=each.since + seconds) for name, each in self.heads.items()}
        due = {agent: at + seconds for agent, at in self.due.items()}
        timers = None if self.timers is None else self.timers.later(seconds)
        return self.with_(seen=seen, expires=self.expires + seconds, heads=heads, due=due, timers=timers)
