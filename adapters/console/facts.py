"""The facts: the content of a recording up to some message, as frozen values. Views are made from them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from adapters.console.console_view import Json, Section
from adapters.live.due_times import HeadRequest
from adapters.live.overrides import StandingOrder
from semantics.live_policy import Fallback, TimeLimit
from semantics.state.configuration import Configuration, Label
from semantics.state.signature import Name

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


@dataclass(frozen=True, slots=True)
class Facts:
    """The content of a recording up to some message.

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
    """

    run: Run | None = None
    begin: float | None = None
    time: float = 0.0
    ended: str | None = None
    broken_off: bool = False
    step: int = 0
    standing: Standing | None = None
    seen: Mapping[Name, SeenEntity] = field(default_factory=dict)
    shapes: Mapping[Name, Shape] = field(default_factory=dict)
    trails: Mapping[Name, Trail] = field(default_factory=dict)
    links: Mapping[Name, Link] = field(default_factory=dict)
    orders: Mapping[Name, VehicleCommand] = field(default_factory=dict)
    hand_overs: Mapping[Name, VehicleCommand] = field(default_factory=dict)
    status: Mapping[Name, Json] = field(default_factory=dict)
    words: Mapping[Name, Json] = field(default_factory=dict)
    taken: Mapping[Name, str] = field(default_factory=dict)
    standing_orders: Mapping[Name, OrderState] = field(default_factory=dict)
    rebinds: Mapping[Name, tuple[str, str]] = field(default_factory=dict)
    stopped: Mapping[Name, str] = field(default_factory=dict)
    authority: Mapping[Name, ControllingStations] = field(default_factory=dict)
    deadlines: Mapping[Name, float] = field(default_factory=dict)
    flights: Mapping[Name, Json] = field(default_factory=dict)
    ways: Mapping[Name, Json] = field(default_factory=dict)
    invariants: Section = field(default_factory=dict)
    failed: frozenset[Name] = frozenset()
    steps: Section = field(default_factory=dict)
    ticks: Section = field(default_factory=dict)
    ticked: int = 0
    alerts: Section = field(default_factory=dict)
    found: int = 0
    actions: Section = field(default_factory=dict)
    acted: int = 0
    stations: Mapping[str, Json] = field(default_factory=dict)
    preflight: Section = field(default_factory=dict)
