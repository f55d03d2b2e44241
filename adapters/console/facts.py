"""What a recording has told up to some message: frozen values, from which views are made."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from adapters.console.view import Json, Section
from adapters.live.state import Bidden, Waiting
from semantics.live_policy import Fallback, TimeLimit
from semantics.state.configuration import Configuration, Label
from semantics.state.signature import Name

Position = tuple[float, float]
"""Latitude and longitude in degrees."""


class Unreplayable(Exception):
    """Steps that cannot be taken again here; the message says why."""


@dataclass(frozen=True, slots=True)
class Rules:
    """What was flown, and its rules: handed in, since they are elaborated and replayed elsewhere.

    Attributes:
        initial: The first configuration.
        fixed: The entities whose place never changes.
        limits: How long requests may take.
        on_broken: What is done when an assumption breaks.
        follow: Takes a recorded step again; raises Unreplayable where it is not allowed.
    """

    initial: Configuration
    fixed: frozenset[Name]
    limits: tuple[TimeLimit, ...]
    on_broken: Fallback
    follow: Callable[[Configuration, Any], tuple[Label, Configuration]]


Opening = Callable[[Mapping[str, Any]], Rules]
"""Returns the rules of what a recording's `run` says was flown; raises Unreplayable."""


@dataclass(frozen=True, slots=True)
class Change:
    """The last step that changed L or P: its number, and the configurations before and after it."""

    number: int
    before: Configuration
    after: Configuration


@dataclass(frozen=True, slots=True)
class Standing:
    """Where the run stands by the rules.

    Attributes:
        rules: Of its mission.
        configuration: ⟨α | S | η⟩.
        change: How its L and P came about.
        heads: The requests at the heads of lines, and since when; as `adapters.live.limits` has them.
    """

    rules: Rules
    configuration: Configuration
    change: Change
    heads: Mapping[str, Waiting] = field(default_factory=dict)


class Seen(NamedTuple):
    """The newest sighting of an entity that has one position.

    Attributes:
        kind: Its kind.
        at: Where.
        course: In degrees from true north.
        speed: In metres a second.
        time: When it was observed.
        until: When it is too old to be shown.
        source: The plugin that tells of it.
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


class Authority(NamedTuple):
    """The stations that a vehicle obeys, and how that changed last, as the cards have it."""

    stations: tuple[str, ...]
    handed: Json = None


class Shape(NamedTuple):
    """The newest sighting of an entity that has an area."""

    kind: str
    ring: tuple[Position, ...]
    altitude: tuple[float, float] | None


@dataclass(frozen=True, slots=True)
class Order:
    """A command to a vehicle, and what became of it.

    Attributes:
        request: Names it in reports.
        command: Its kind.
        to: Where to, or to which channel.
        way: The waypoints of what it passes, and of where it goes.
        since: When it was first sent.
        state: `asked` (to hold or to return, not told yet), `sent`, `accepted`, `arrived` or `refused`.
        why: Why it was refused.
    """

    request: str
    command: str
    to: str
    way: tuple[Position, ...]
    since: float
    state: str = "sent"
    why: str = ""


@dataclass(frozen=True, slots=True)
class Bid:
    """An operator's order to a vehicle to hold or to return, and what became of it.

    Attributes:
        action: The number of the action.
        since: When it was given.
        bidden: The order, as the run has it.
    """

    action: str
    since: float
    bidden: Bidden


@dataclass(frozen=True, slots=True)
class Link:
    """A link to a vehicle: when it was heard last, and whether the link is lost."""

    heard: float | None = None
    lost: bool = False


@dataclass(frozen=True, slots=True)
class Trail:
    """Where a vehicle was, thinned out evenly when there is too much of it.

    Attributes:
        chunks: Its positions, piece by piece; a piece begins where the one before it ends.
        time: Of the last position.
        every: The least seconds between two positions.
    """

    chunks: tuple[tuple[Position, ...], ...]
    time: float
    every: float


@dataclass(frozen=True, slots=True)
class Run:
    """What a recording's `run` says.

    Attributes:
        mission: The section `mission`.
        vehicles: The plugin of each vehicle.
        fences: The section `fences`.
        limits: How long requests may take; None where it does not say.
        station: Whose recording it is, empty where there are no stations.
        stations: All stations.
        rate: How fast its clock runs beside that on the wall; None for as fast as can be computed.
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
    """All that a recording has told.

    Attributes:
        run: What is flown; None before that is told.
        begin: The time of the first message after it; None before that.
        time: The time of the last message, which never goes back.
        ended: Why the run ended; None where it may go on.
        broken_off: Whether that is not told by the recording, which just ends.
        step: The number of the last step.
        standing: Where it stands by the rules; None where steps cannot be replayed.
        seen: Sightings of what has one position.
        shapes: Sightings of what has an area.
        trails: Where vehicles were.
        links: The links to vehicles.
        orders: What vehicles were told last: where to be.
        handing: What they were told last about their authority.
        status: What vehicles say of themselves, as the topic `status` has it.
        words: What they said last, as the cards have it.
        taken: Who was taken over, and how.
        bidden: What operators ordered vehicles to do, until each is given back or taken over.
        rebinds: Of vehicles to be believed from another address, the request and the number of the action.
        stopped: Whose controls are served no more (the empty name is all agents), and what their vehicles were told.
        authority: Whom vehicles obey.
        deadlines: Until when agents wait.
        flights: How long flights take, as the cards have it; where the mission has times.
        failed: Agents whose computation failed.
        steps: The section `steps`.
        ticks: The section `ticks`.
        ticked: How many ticks there were.
        alerts: The section `alerts`.
        found: How many findings there were.
        actions: The section `actions`.
        acted: How many actions there were.
        stations: When each station was heard, and whether it is reached.
        preflight: The section `preflight`.
    """

    run: Run | None = None
    begin: float | None = None
    time: float = 0.0
    ended: str | None = None
    broken_off: bool = False
    step: int = 0
    standing: Standing | None = None
    seen: Mapping[Name, Seen] = field(default_factory=dict)
    shapes: Mapping[Name, Shape] = field(default_factory=dict)
    trails: Mapping[Name, Trail] = field(default_factory=dict)
    links: Mapping[Name, Link] = field(default_factory=dict)
    orders: Mapping[Name, Order] = field(default_factory=dict)
    handing: Mapping[Name, Order] = field(default_factory=dict)
    status: Mapping[Name, Json] = field(default_factory=dict)
    words: Mapping[Name, Json] = field(default_factory=dict)
    taken: Mapping[Name, str] = field(default_factory=dict)
    bidden: Mapping[Name, Bid] = field(default_factory=dict)
    rebinds: Mapping[Name, tuple[str, str]] = field(default_factory=dict)
    stopped: Mapping[Name, str] = field(default_factory=dict)
    authority: Mapping[Name, Authority] = field(default_factory=dict)
    deadlines: Mapping[Name, float] = field(default_factory=dict)
    flights: Mapping[Name, Json] = field(default_factory=dict)
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
