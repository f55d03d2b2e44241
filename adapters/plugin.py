"""The plugin's interface: subscribe mobility commands, publish physical properties (paper §3.2.1).

A plugin represents a part of the outside world: an autopilot, a receiver, a file of places. It publishes into a
`World`, and gets commands for its vehicles. It makes no decisions: the rules decide the consequences for the logical
model.

Time is the world's: `World.now()` gives time stamps, and plugins wait by `asyncio.sleep`. So an event loop with another
clock (`adapters.simulated.clock`) runs every plugin faster.
"""

from __future__ import annotations

import errno
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final, Protocol, runtime_checkable

from physical import Band, Geometry, PhysicalError, PhysicalProperty, Surroundings

# --- publications -----------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Gone:
    """An entity is gone: a place was removed from its file, a detection withdrawn.

    An entity that is merely silent is not gone: it exceeds its time to live (see `Aged`).
    """

    entity: str
    time: float
    source: str


@dataclass(frozen=True, slots=True)
class Aged:
    """A physical property that is valid for a while only.

    Attributes:
        property: The observation; its `time` is set.
        time_to_live: The seconds from its `time` for which it may stay in P, if no newer one comes.
        clock: Its time by the entity's own clock, in milliseconds, which orders the reports of several links.
    """

    property: PhysicalProperty
    time_to_live: float
    clock: int | None = None


Published = PhysicalProperty | Aged | Gone
"""A bare property is valid until another or `Gone` replaces it; each publication has the entity's whole property."""


def entity_of(published: Published) -> str:
    """Return the entity of a publication."""
    return published.property.entity if isinstance(published, Aged) else published.entity


NOWHERE_ELSE: Final = Surroundings()
"""No places beside the one in which a vehicle stays."""

# --- commands ---------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class GoTo:
    """Go into a place, and stay there.

    The same request with another geometry means that the place has moved: go to its current position.

    Attributes:
        request: Identifies the request in reports; unique in a run.
        entity: The vehicle.
        place: The polygon (or point) at its current position. The waypoint is the point nearest its centroid around
            which the vehicle keeps to its surroundings (`physical.standing`).
        altitude: The band to be in, in metres above sea level; the vehicle's own choice if None.
        name: The place's name, for messages.
        around: The other places to stay in, and out of.
        shape: The vehicle's extent; None for a point.
    """

    request: str
    entity: str
    place: Geometry
    altitude: Band | None = None
    name: str = ""
    around: Surroundings = NOWHERE_ELSE
    shape: Geometry | None = None


@dataclass(frozen=True, slots=True)
class Follow:
    """Pass places in their order, then go into the last and stay there.

    The same request with another path of as many places means that some of them have moved: continue along the new
    path.

    Attributes:
        request: Identifies the request in reports; unique in a run.
        entity: The vehicle.
        path: The polygons (or points) at their current positions. The waypoint of each is `physical.waypoint(place)`;
            that of the last is as in GoTo.
        altitude: The band to be in, in metres above sea level; the vehicle's own choice if None.
        name: The last place's name, for messages.
        around: The other places to stay in, and out of, in the last place.
        shape: The vehicle's extent; None for a point.
    """

    request: str
    entity: str
    path: tuple[Geometry, ...]
    altitude: Band | None = None
    name: str = ""
    around: Surroundings = NOWHERE_ELSE
    shape: Geometry | None = None


@dataclass(frozen=True, slots=True)
class HandOver:
    """Give the control authority over a vehicle from one station's channel to another's.

    `leave` and `join` are channels as missions write them: `control:gcs0`, `control:gcs1`.
    """

    request: str
    entity: str
    leave: str
    join: str


@dataclass(frozen=True, slots=True)
class Hold:
    """Stay in place, as well as possible: a plane circles."""

    request: str
    entity: str


@dataclass(frozen=True, slots=True)
class Return:
    """Go to the vehicle's own home."""

    request: str
    entity: str


@dataclass(frozen=True, slots=True)
class Rebind:
    """Accept a vehicle's messages from a new address, confirmed by an operator.

    Attributes:
        request: Identifies the request in reports; unique in a run.
        entity: The vehicle.
        source: The address (`HOST:PORT`).
    """

    request: str
    entity: str
    source: str


@dataclass(frozen=True, slots=True)
class GiveBack:
    """Take commands again: an operator has given back the vehicle, which had been taken over."""

    request: str
    entity: str


Command = GoTo | Follow | HandOver | Hold | Return | GiveBack | Rebind
"""A command to a vehicle. A new one ends the entity's previous command, except for HandOver and Rebind.

Hold and Return end a hand-over in progress, too.
"""


class Refused(Exception):  # an answer, not an error
    """The command cannot be carried out, and was not begun; `reason` is in the operator's words."""

    def __init__(self, reason: str, hint: str = "") -> None:
        super().__init__(reason)
        self.reason = reason
        self.hint = hint


# --- reports ----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Sent:
    """A plugin has taken on a command, and sends it; the vehicle has shown nothing yet."""

    request: str
    entity: str
    time: float


@dataclass(frozen=True, slots=True)
class Accepted:
    """The vehicle's own state shows that it follows the request: mode, arming, target or mission.

    Attributes:
        request: The request.
        entity: The vehicle.
        time: Time of that state.
        place: The last place of the command that it follows, which may have moved since; None if unknown.
        waypoint: The point around which it will stay; None if unknown.
    """

    request: str
    entity: str
    time: float
    place: Geometry | None = None
    waypoint: Geometry | None = None


@dataclass(frozen=True, slots=True)
class Arrived:
    """The vehicle's position, or for a hand-over its authority, shows that the request is done.

    For a path it means that the vehicle has passed all of it, which no position shows. This report does not complete
    the request in logical space: the rules decide that from positions published after it was accepted. `place` and
    `waypoint` are as in `Accepted`.
    """

    request: str
    entity: str
    time: float
    place: Geometry | None = None
    waypoint: Geometry | None = None


@dataclass(frozen=True, slots=True)
class Rejected:
    """An accepted command turned out to be impossible: the vehicle refuses, or no longer answers."""

    request: str
    entity: str
    time: float
    reason: str


@dataclass(frozen=True, slots=True)
class Doubted:
    """The vehicle may have been taken over, or a message was late: it gets no commands until that is certain.

    `TakenOver` follows, or `Accepted` again; until then no move of the vehicle is an arrival.
    """

    entity: str
    time: float


@dataclass(frozen=True, slots=True)
class TakenOver:
    """The vehicle deviates from its orders: a pilot, another station, a fail-safe or a reboot controls it.

    Until `GiveBack` commands are refused, and no move of the vehicle is an arrival.
    """

    entity: str
    time: float
    reason: str


@dataclass(frozen=True, slots=True)
class LinkLost:
    """The vehicle was silent for a while; `since` is the time of its last message."""

    entity: str
    time: float
    since: float


@dataclass(frozen=True, slots=True)
class LinkRestored:
    """The vehicle is heard again; `rebooted` if its clock restarted meanwhile."""

    entity: str
    time: float
    rebooted: bool = False


@dataclass(frozen=True, slots=True)
class Trouble:
    """A problem for the operator: unusable input, a forged packet, a second commander.

    Attributes:
        source: The plugin's name.
        time: Time of its discovery.
        what: A short name by which equal troubles are counted, such as `bad checksum`.
        detail: One more line, with the remedy if there is one.
        count: Its number since the last such report; plugins collect them, so a flood is one report a second.
    """

    source: str
    time: float
    what: str
    detail: str = ""
    count: int = 1


@dataclass(frozen=True, slots=True)
class Delivered:
    """A parcel from another station: messages for an agent, or an agent (see `semantics.state.station_partition`).

    Attributes:
        station: The sender.
        time: Time of its arrival.
        number: Its index among the sender's parcels; it may come again.
        parcel: Its content, as plain data.
        done: Time of its departure, by the clock here; None if unknown.
    """

    station: str
    time: float
    number: int
    parcel: Any
    done: float | None = None


@dataclass(frozen=True, slots=True)
class Underway:
    """Another station has sent a vehicle to a node; without a name: it is no longer under way.

    Attributes:
        entity: The vehicle.
        time: Time of the report's arrival.
        to: The node.
        done: Time of the event itself, by the clock here; None if unknown.
    """

    entity: str
    time: float
    to: str
    done: float | None = None


@dataclass(frozen=True, slots=True)
class Hosts:
    """The host, at another station, of a bigActor that runs there."""

    agent: str
    time: float
    host: str


@dataclass(frozen=True, slots=True)
class Believes:
    """Another station has written a slot of L: a node's `parent` (no name if L lacks the node) or its `links`."""

    node: str
    time: float
    slot: str
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Broken:
    """Another station reports a broken assumption of the mission."""

    station: str
    time: float
    assumption: str


@dataclass(frozen=True, slots=True)
class Failed:
    """A necessary part of a run has failed: its recording, a log, a plugin.

    Attributes:
        source: The failed part: a file, or a plugin's name.
        reason: The reason, such as `No space left on device`.
        time: Its time.
    """

    source: str
    reason: str
    time: float

    @classmethod
    def by(cls, error: OSError | ValueError, source: str, time: float) -> Failed:
        """Return the failure for an error; if the error names a file, that is the source."""
        failed = error.filename if isinstance(error, OSError) and error.filename else source
        return cls(str(failed), _reason(error), time)


def _reason(error: OSError | ValueError) -> str:
    """Return the reason of an error, in one line, with the remedy if there is one."""
    match error:
        case OSError(errno=errno.EADDRINUSE):
            return "something else listens there: end it, or give another port"
        case OSError(errno=errno.EADDRNOTAVAIL):
            return "this machine has no such address: give one that it has, or 0.0.0.0 for all"
        case OSError():
            return error.strerror or str(error) or type(error).__name__
        case PhysicalError():
            return str(error).replace("\nhint: ", "; ")
    return str(error)


StationReport = Delivered | Underway | Hosts | Believes | Broken
"""Reports about other stations."""


@dataclass(frozen=True, slots=True)
class Battery:
    """A battery: percent that remain, volts; None is *unknown*."""

    percent: int | None = None
    volts: float | None = None


@dataclass(frozen=True, slots=True)
class Status:
    """A vehicle's report on itself; None is *unknown*.

    Attributes:
        entity: The vehicle.
        time: Time of the report.
        plugin: The plugin that hears it.
        heard: Time of its last message.
        mode: Its mode's name.
        armed: Whether its motors may turn.
        battery: Its battery.
        heading: Its heading, in degrees from true north.
        authority: The stations that it obeys.
        height: Metres above its home.
        home: Its home, in degrees.
        returning: Whether it is in the mode in which it flies home.
        lacks: The reason why it has no valid position; empty if it has one.
        follows: Whether it is under way in the mode in which it follows the mission on board.
        surface: Whether it moves on water or on the ground, so that no height of it is shown.
    """

    entity: str
    time: float
    plugin: str = ""
    heard: float | None = None
    mode: str | None = None
    armed: bool | None = None
    battery: Battery | None = None
    heading: float | None = None
    authority: tuple[str, ...] = ()
    height: float | None = None
    home: tuple[float, float] | None = None
    returning: bool | None = None
    lacks: str = ""
    follows: bool | None = None
    surface: bool = False


@dataclass(frozen=True, slots=True)
class StatusText:
    """A text from a vehicle.

    Attributes:
        entity: The vehicle.
        time: Time of the text.
        text: Its text.
        severity: MAVLink's, from 0 (emergency) to 7 (debug).
    """

    entity: str
    time: float
    text: str
    severity: int


@dataclass(frozen=True, slots=True)
class Presence:
    """Whether another station is reached.

    Attributes:
        station: The station.
        time: Time of the report.
        reached: Whether it is reached; None while that is not known yet.
        heard: Time of its last answer; None before the first.
        agrees: Whether its L is the same as ours; None while that is not known.
        begun: Whether its run has begun; None while that is not known.
    """

    station: str
    time: float
    reached: bool | None
    heard: float | None
    agrees: bool | None = None
    begun: bool | None = None


Seen = Status | StatusText | Presence
"""Reports for people alone: a run records them, without any reaction."""

Report = (
    Sent
    | Accepted
    | Arrived
    | Rejected
    | Doubted
    | TakenOver
    | LinkLost
    | LinkRestored
    | Trouble
    | Failed
    | StationReport
    | Seen
)
"""A report on a request, a vehicle, a part of the run or another station."""

# --- interfaces -------------------------------------------------------------------------------------


class World(Protocol):
    """The interface of a run to its plugins. No method blocks, and all are called in the event loop's thread."""

    def publish(self, published: Published) -> None:
        """Take a publication on an entity."""

    def now(self) -> float:
        """Return the time in seconds since 1970 UTC; it never goes back."""

    def report(self, report: Report) -> None:
        """Take a report on a request, a link or the input."""


@runtime_checkable
class Plugin(Protocol):
    """A vehicle, a feed, or a service.

    `run` opens its resources (with OSError or `PhysicalError` on failure), serves until it is cancelled, and then
    closes everything. `command` may be called from then on, also before the vehicle is heard. It returns as soon as the
    command is accepted, and raises Refused if it never can be.

    Reports follow: any number of Accepted, then one Arrived or Rejected, unless another command replaces it. A rejected
    request is refused from then on: a repetition needs a new request. Hold and Return are owed until they are
    confirmed: the same request may come again after it was rejected, and begins anew.
    """

    @property
    def name(self) -> str:
        """Its name in reports; unique in a run."""

    async def run(self, world: World) -> None:
        """Publish until cancelled."""

    async def command(self, command: Command) -> None:
        """Take on a command for an entity that it owns; raises Refused."""

    def owns(self, entity: str) -> bool:
        """Whether the entity takes commands from this plugin."""


@dataclass(frozen=True, slots=True)
class Readiness:
    """A vehicle's readiness before take-off.

    Attributes:
        fence: The fence that was read back from it, in words.
        refuses: Its recent reasons why it cannot be armed.
    """

    fence: str
    refuses: tuple[str, ...] = ()


@runtime_checkable
class Preflight(Protocol):
    """The checks before take-off of a plugin with vehicles, as far as the vehicles have reported."""

    @property
    def fences(self) -> Mapping[str, Geometry]:
        """The fence of each vehicle that has one."""

    def owns(self, entity: str) -> bool:
        """Return whether the vehicle is the plugin's."""

    def is_known(self) -> bool:
        """Return whether all vehicles have reported their state, or were asked for long enough."""

    def remarks(self) -> Iterable[str]:
        """Return messages to the operator."""

    def readiness(self, entity: str) -> Readiness:
        """Return a vehicle's readiness, as it was last reported."""

    def objection(self, entity: str, place: Geometry, name: str, around: Surroundings) -> str | None:
        """Return the reason why a vehicle can't stay at a place and keep to its surroundings; None if it can."""

    def bar(self, entity: str, place: Geometry, name: str) -> str | None:
        """Return the reason why a vehicle can't pass a place; None if it can."""


@runtime_checkable
class Circling(Protocol):
    """A plugin that knows the circles of its vehicles."""

    def owns(self, entity: str) -> bool:
        """Return whether the vehicle is the plugin's."""

    def circle(self, entity: str) -> float:
        """Return the diameter in metres of the circle that a vehicle flies to stay; 0 if it hovers, or if unknown."""


def circling(plugins: Iterable[Plugin]) -> tuple[Circling, ...]:
    """Return the plugins that know the circles of their vehicles; a wrapper's `plugin` counts in its place."""
    own = (getattr(plugin, "plugin", plugin) for plugin in plugins)
    return tuple(plugin for plugin in own if isinstance(plugin, Circling))


def preflights(plugins: Iterable[Plugin]) -> tuple[Preflight, ...]:
    """Return the plugins that have checks before take-off; a wrapper's `plugin` counts in its place."""
    own = (getattr(plugin, "plugin", plugin) for plugin in plugins)
    return tuple(plugin for plugin in own if isinstance(plugin, Preflight))


__all__ = [
    "NOWHERE_ELSE",
    "Accepted",
    "Aged",
    "Arrived",
    "Battery",
    "Believes",
    "Broken",
    "Command",
    "Delivered",
    "Doubted",
    "Failed",
    "Follow",
    "GiveBack",
    "GoTo",
    "Gone",
    "HandOver",
    "Hold",
    "Hosts",
    "LinkLost",
    "LinkRestored",
    "Plugin",
    "Presence",
    "Published",
    "Rebind",
    "Refused",
    "Rejected",
    "Report",
    "Return",
    "Seen",
    "Sent",
    "StationReport",
    "Status",
    "StatusText",
    "TakenOver",
    "Trouble",
    "Underway",
    "World",
    "entity_of",
]
