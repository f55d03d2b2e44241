"""The facts: the content of a recording up to some message. Views are made from them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass, field, fields
from typing import Any, Final, NamedTuple, TypeVar

from adapters.console.console_view import Json, Section
from adapters.live.due_times import HeadRequest
from adapters.live.overrides import StandingOrder
from semantics.live_policy import Fallback, TimeLimit
from semantics.state.configuration import Configuration, Label
from semantics.state.signature import Name

Value = TypeVar("Value")

MOST_VEHICLES: Final = 1_000
"""The most vehicles in a table of facts; the oldest are dropped."""

MOST_TICKS: Final = 2_000

Position = tuple[float, float]
"""Latitude and longitude in degrees."""


class Unreplayable(Exception):
    """Steps that cannot be replayed here; the message gives the reason."""


@dataclass(frozen=True, slots=True)
class Rules:
    """The mission that was flown, and its rules; callers supply them, since they elaborate and replay it.

    Attributes:
        initial: The first configuration.
        fixed: The entities that never move.
        limits: The time limits of requests.
        on_broken: The fallback after a broken assumption.
        follow: Replays a recorded step; raises Unreplayable if the rules do not allow it.
    """

    initial: Configuration
    fixed: frozenset[Name]
    limits: tuple[TimeLimit, ...]
    on_broken: Fallback
    follow: Callable[[Configuration, Any], tuple[Label, Configuration]]


Opening = Callable[[Mapping[str, Any]], Rules]
"""Returns the rules of the mission that a recording's `run` names; raises Unreplayable."""


@dataclass(frozen=True, slots=True)
class Change:
    """The last step that changed L or P: its number, and the configurations before and after it."""

    number: int
    before: Configuration
    after: Configuration


@dataclass(frozen=True, slots=True)
class Standing:
    """The state of the run, as replayed by its rules.

    Attributes:
        rules: The rules of its mission.
        configuration: ⟨α | S | η⟩.
        change: The last change of its L or P.
        heads: The requests at the heads of lines, and the start of their waits, as in `adapters.live.fallbacks`.
    """

    rules: Rules
    configuration: Configuration
    change: Change
    heads: Mapping[str, HeadRequest] = field(default_factory=dict)


class SeenEntity(NamedTuple):
    """The newest sighting of an entity that has one position.

    Attributes:
        kind: Its kind.
        at: Its position.
        course: In degrees from true north.
        speed: In metres a second.
        time: The time of the observation.
        until: The time after which it is not shown.
        source: The plugin that reports it.
        channels: The channels that it is on.
        altitude: In metres above sea level.
    """

    kind: str
    at: Position
    course: float | None
    speed: float | None
    time: float
    until: float
    source: str
    channels: tuple[str, ...]
    altitude: float | None = None


class ControllingStations(NamedTuple):
    """The controlling stations of a vehicle, and their last change, in the form of the cards."""

    stations: tuple[str, ...]
    handed: Json = None


class Shape(NamedTuple):
    """The newest sighting of an entity that has an area."""

    kind: str
    ring: tuple[Position, ...]
    altitude: tuple[float, float] | None


@dataclass(frozen=True, slots=True)
class VehicleCommand:
    """A command to a vehicle, and its state.

    Attributes:
        request: Its identifier in reports.
        command: Its kind.
        to: The destination, or the channel of a hand-over.
        way: The waypoints on the way, and of the destination.
        since: The time at which it was first sent.
        state: `asked` (to hold or to return, not sent yet), `sent`, `accepted`, `arrived` or `refused`.
        why: The reason of the refusal.
    """

    request: str
    command: str
    to: str
    way: tuple[Position, ...]
    since: float
    state: str = "sent"
    why: str = ""


@dataclass(frozen=True, slots=True)
class OrderState:
    """An operator's order to a vehicle to hold or to return, and its state.

    Attributes:
        action: The number of the action.
        since: The time of the order.
        order: The order, in the run's form.
    """

    action: str
    since: float
    order: StandingOrder


@dataclass(frozen=True, slots=True)
class Link:
    """A link to a vehicle: the time of the last message, and whether the link is lost."""

    heard: float | None = None
    lost: bool = False


@dataclass(frozen=True, slots=True)
class Trail:
    """The past positions of a vehicle, thinned out evenly when there are too many.

    Attributes:
        chunks: The positions in pieces; a piece begins with the last position of the piece before.
        time: The time of the last position.
        every: The least seconds between two positions.
    """

    chunks: tuple[tuple[Position, ...], ...]
    time: float
    every: float


@dataclass(frozen=True, slots=True)
class Run:
    """The content of a recording's `run`.

    Attributes:
        mission: The section `mission`.
        vehicles: The plugin of each vehicle.
        fences: The section `fences`.
        limits: The time limits of requests; None if it has none.
        station: The station that recorded it; empty if there are no stations.
        stations: All stations.
        rate: Seconds of the run per second of wall time; None for as fast as possible.
    """

    mission: Section
    vehicles: Mapping[Name, str]
    fences: Section
    limits: tuple[TimeLimit, ...] | None
    station: str
    stations: tuple[str, ...]
    rate: float | None = 1.0


class Table(dict[str, Value]):
    """A part of the facts: values by their keys, each replaced as a whole and never changed in place."""

    def bounded(self, most: int) -> None:
        """Drop the oldest values above a number."""
        while len(self) > most:
            del self[next(iter(self))]


@dataclass(slots=True)
class Facts:
    """The content of a recording up to some message. The fold changes a copy, which then stands for itself.

    Attributes:
        run: The mission and its settings; None before the message `run`.
        begin: The time of the first message after `run`; None before it.
        time: The time of the last message, which never goes back.
        ended: Why the run ended; None if it may go on.
        broken_off: Whether the recording just ends, without a reason of its own.
        step: The number of the last step.
        standing: The replayed state; None if steps cannot be replayed.
        seen: Sightings of entities with one position.
        shapes: Sightings of entities with an area.
        trails: The past positions of vehicles.
        links: The links to vehicles.
        orders: The vehicles' last orders of movement.
        hand_overs: The vehicles' last orders of hand-over.
        status: The vehicles' status, in the form of the topic `status`.
        words: The vehicles' last texts, in the form of the cards.
        taken: The vehicles that were taken over, with the reasons.
        standing_orders: The operators' orders to vehicles, until a give-back or a take-over.
        rebinds: The pending changes of vehicles' addresses: the request, and the number of the action.
        stopped: The agents whose controls are no longer served (the empty name: all agents), with the fallback.
        authority: The controlling stations of vehicles.
        deadlines: The times until which agents wait.
        flights: The durations of flights, in the form of the cards, if the mission has times.
        ways: The points to which vehicles are sent.
        invariants: The section `invariants`.
        failed: Agents whose computation failed.
        steps: The section `steps`.
        ticks: The section `ticks`.
        ticked: The number of ticks so far, with those that were dropped.
        alerts: The section `alerts`.
        found: The number of findings so far.
        actions: The section `actions`.
        acted: The number of actions so far.
        stations: For each station, the time of its last message, and whether it is reached.
        preflight: The section `preflight`.
        changed: Whether a message was taken in since they were copied.
    """

    run: Run | None = None
    begin: float | None = None
    time: float = 0.0
    ended: str | None = None
    broken_off: bool = False
    step: int = 0
    standing: Standing | None = None
    seen: Table[SeenEntity] = field(default_factory=Table)
    shapes: Table[Shape] = field(default_factory=Table)
    trails: Table[Trail] = field(default_factory=Table)
    links: Table[Link] = field(default_factory=Table)
    orders: Table[VehicleCommand] = field(default_factory=Table)
    hand_overs: Table[VehicleCommand] = field(default_factory=Table)
    status: Table[Json] = field(default_factory=Table)
    words: Table[Json] = field(default_factory=Table)
    taken: Table[str] = field(default_factory=Table)
    standing_orders: Table[OrderState] = field(default_factory=Table)
    rebinds: Table[tuple[str, str]] = field(default_factory=Table)
    stopped: Table[str] = field(default_factory=Table)
    authority: Table[ControllingStations] = field(default_factory=Table)
    deadlines: Table[float] = field(default_factory=Table)
    flights: Table[Json] = field(default_factory=Table)
    ways: Table[Json] = field(default_factory=Table)
    invariants: Table[Json] = field(default_factory=Table)
    failed: frozenset[Name] = frozenset()
    steps: Table[Json] = field(default_factory=Table)
    ticks: Table[Json] = field(default_factory=Table)
    ticked: int = 0
    alerts: Table[Json] = field(default_factory=Table)
    found: int = 0
    actions: Table[Json] = field(default_factory=Table)
    acted: int = 0
    stations: Table[Json] = field(default_factory=Table)
    preflight: Table[Json] = field(default_factory=Table)
    changed: bool = False

    def copy(self) -> Facts:
        """Return facts that may be changed without changing these."""
        made = copy(self)
        made.changed = False
        for each in fields(made):
            if isinstance(table := getattr(made, each.name), Table):
                setattr(made, each.name, Table(table))
        return made

    def end(self, reason: str, *, broken_off: bool = True) -> None:
        """Note the end of the run, unless it is known; `broken_off`: the recording itself gives no reason."""
        if self.ended is None:
            self.ended, self.broken_off, self.changed = reason, broken_off, True

    def tick(self, time: float, sort: str) -> None:
        """Add a tick; above `MOST_TICKS`, every second tick of the commonest sort is dropped."""
        self.ticked += 1
        self.ticks[str(self.ticked)] = (time, sort)
        if len(self.ticks) > MOST_TICKS:
            ((commonest, _),) = Counter(said for _, said in self.ticks.values()).most_common(1)
            numbers = [number for number, (_, said) in self.ticks.items() if said == commonest]
            for number in numbers[1::2]:
                del self.ticks[number]
