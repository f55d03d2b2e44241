"""The plugin's interface: subscribe mobility commands, publish physical properties (paper §3.2.1).

A plugin stands for what is out there: an autopilot, a receiver, a file of places. It is given a `World` to tell what
it learns, and is told what its vehicles shall do. It decides nothing: what follows for the logical model is the rules'.

Time is the world's: `World.now()` stamps, and whoever waits does so by `asyncio.sleep`, so that an event loop with
another clock (`adapters.simulated.clock`) runs every plugin faster.
"""

from __future__ import annotations

import errno
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

from physical import Band, Geometry, PhysicalError, PhysicalProperty

# --- what a plugin publishes ------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Gone:
    """An entity is known to be no more: a place taken out of its file, a detection withdrawn.

    What merely ceases to be heard of isn't gone: it grows older than its time to live (see `Aged`).
    """

    entity: str
    time: float
    source: str


@dataclass(frozen=True, slots=True)
class Aged:
    """A physical property that holds for a while only.

    Attributes:
        property: What was observed; its `time` is set.
        time_to_live: For how many seconds from its `time` on it may stand in P, if nothing newer comes.
        clock: When that was by the entity's own clock, in milliseconds: it orders what several links tell of it.
    """

    property: PhysicalProperty
    time_to_live: float
    clock: int | None = None


Published = PhysicalProperty | Aged | Gone
"""A bare property stands until another or `Gone` replaces it; all of an entity's property is said each time."""


def entity_of(published: Published) -> str:
    """Return whom a publication is about."""
    return published.property.entity if isinstance(published, Aged) else published.entity


# --- what a plugin is told --------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class GoTo:
    """Go into a place, and stay there.

    The same request with another geometry means that the place has moved on: go to where it is now.

    Attributes:
        request: Names the request in reports; unique in a run.
        entity: Who shall go.
        place: The polygon (or point) as it is now; the waypoint is `physical.waypoint(place)`.
        altitude: The band to be in, in metres above sea level; the vehicle's own choice if None.
        name: The place's name, for messages.
    """

    request: str
    entity: str
    place: Geometry
    altitude: Band | None = None
    name: str = ""


@dataclass(frozen=True, slots=True)
class Follow:
    """Pass places in their order, then go into the last and stay there.

    The same request with another path of as many places means that some of them have moved on: go on along the path as
    it is now.

    Attributes:
        request: Names the request in reports; unique in a run.
        entity: Who shall go.
        path: The polygons (or points) as they are now; the waypoint of each is `physical.waypoint(place)`.
        altitude: The band to be in, in metres above sea level; the vehicle's own choice if None.
        name: The last place's name, for messages.
    """

    request: str
    entity: str
    path: tuple[Geometry, ...]
    altitude: Band | None = None
    name: str = ""


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
    """Stay where you are, as well as you can: a plane circles."""

    request: str
    entity: str


@dataclass(frozen=True, slots=True)
class Return:
    """Go home, as the vehicle understands it."""

    request: str
    entity: str


@dataclass(frozen=True, slots=True)
class Rebind:
    """Believe a vehicle at another address (`HOST:PORT`) than before: an operator says that it has moved there."""

    request: str
    entity: str
    source: str


@dataclass(frozen=True, slots=True)
class GiveBack:
    """Take commands again: an operator has given back the vehicle, which had been taken over."""

    request: str
    entity: str


Command = GoTo | Follow | HandOver | Hold | Return | GiveBack | Rebind
"""What a vehicle can be told. A new one for the same entity ends what it was told before; HandOver and Rebind don't."""


class Refused(Exception):  # an answer, not an error
    """The command cannot be carried out, and nothing was done towards it; `reason` is in the operator's words."""

    def __init__(self, reason: str, hint: str = "") -> None:
        super().__init__(reason)
        self.reason = reason
        self.hint = hint


# --- what a plugin reports --------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Accepted:
    """The vehicle's own state shows that it does what the request asks: mode, armed, target or mission compared."""

    request: str
    entity: str
    time: float


@dataclass(frozen=True, slots=True)
class Arrived:
    """The vehicle's position, or for a hand-over its authority, shows that the request is done.

    Of a path it says that all of it is behind the vehicle, which no position shows. Whether the request is done in
    logical space is decided by the rules, from what is published once it was accepted, not from this.
    """

    request: str
    entity: str
    time: float


@dataclass(frozen=True, slots=True)
class Rejected:
    """A request that was taken on turned out not to be possible: the vehicle refuses, or answers no more."""

    request: str
    entity: str
    time: float
    reason: str


@dataclass(frozen=True, slots=True)
class Doubted:
    """The vehicle may have been taken over, or a message of it came late: nothing is told it until that is certain.

    `TakenOver` follows, or `Accepted` once more; until then where it goes is no arrival.
    """

    entity: str
    time: float


@dataclass(frozen=True, slots=True)
class TakenOver:
    """The vehicle does what nobody here ordered: a pilot, another station, a fail-safe or a reboot has it.

    All that it is told is refused until `GiveBack`, and where it goes is no arrival.
    """

    entity: str
    time: float
    reason: str


@dataclass(frozen=True, slots=True)
class LinkLost:
    """Nothing was heard from the vehicle for a while; `since` is when it was last heard."""

    entity: str
    time: float
    since: float


@dataclass(frozen=True, slots=True)
class LinkRestored:
    """The vehicle is heard again; `rebooted` if its clock began anew meanwhile."""

    entity: str
    time: float
    rebooted: bool = False


@dataclass(frozen=True, slots=True)
class Trouble:
    """Something that an operator should know: input that cannot be used, a forged packet, a second commander.

    Attributes:
        source: The plugin's name.
        time: When it was noticed.
        what: A short word by which equal troubles are counted, such as `bad checksum`.
        detail: One line more, with the remedy where there is one.
        count: How often since the last report of the same; plugins collect them, so a flood is one report a second.
    """

    source: str
    time: float
    what: str
    detail: str = ""
    count: int = 1


@dataclass(frozen=True, slots=True)
class Delivered:
    """A parcel has come from another station: messages for an agent, or an agent (see `semantics.state.partition`).

    Attributes:
        station: Whose it is.
        time: When it came.
        number: The how-many-th parcel of that station it is; it may come again.
        parcel: What is in it, as plain data.
    """

    station: str
    time: float
    number: int
    parcel: Any


@dataclass(frozen=True, slots=True)
class Underway:
    """Another station has sent a vehicle to a node; with no name: it is not under way any more."""

    entity: str
    time: float
    to: str


@dataclass(frozen=True, slots=True)
class Hosts:
    """A bigActor that runs at another station is hosted there at `host`."""

    agent: str
    time: float
    host: str


@dataclass(frozen=True, slots=True)
class Believes:
    """Another station has written into a slot of L: `parent` (of what L has not, no name) or `links` of a node."""

    node: str
    time: float
    slot: str
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Broken:
    """Another station says which assumption of the mission broke."""

    station: str
    time: float
    assumption: str


@dataclass(frozen=True, slots=True)
class Failed:
    """Something that a run needs can't go on: its recording, a log, a plugin.

    Attributes:
        source: What failed: a file, or a plugin's name.
        reason: Why, such as `No space left on device`.
        time: When.
    """

    source: str
    reason: str
    time: float

    @classmethod
    def by(cls, error: OSError | ValueError, source: str, time: float) -> Failed:
        """Say that something fails by an error; a file that the error names is what failed."""
        failed = error.filename if isinstance(error, OSError) and error.filename else source
        return cls(str(failed), _reason(error), time)


def _reason(error: OSError | ValueError) -> str:
    """Return why something fails, in one line, with the remedy where there is one."""
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


Elsewhere = Delivered | Underway | Hosts | Believes | Broken
"""What is reported of other stations."""

Report = (
    Accepted
    | Arrived
    | Rejected
    | Doubted
    | TakenOver
    | LinkLost
    | LinkRestored
    | Trouble
    | Failed
    | Elsewhere
)

# --- who talks to whom ------------------------------------------------------------------------------


class World(Protocol):
    """What a plugin is given. None of the three blocks, and all are called in the event loop's thread."""

    def publish(self, published: Published) -> None:
        """Take what is known of an entity now."""
        ...

    def now(self) -> float:
        """Return the time in seconds since 1970 UTC; it never goes back."""
        ...

    def report(self, report: Report) -> None:
        """Take what happened to a request, to a link or to the input."""
        ...


@runtime_checkable
class Plugin(Protocol):
    """A vehicle, a feed, or a service.

    `run` opens what has to be opened (an OSError or `PhysicalError` there says what is wrong with it), serves until
    it is cancelled, and then closes everything. `command` may be called from then on, also before the vehicle is
    heard; it returns as soon as the command is taken on, and raises Refused if it never can be. What becomes of it
    is reported: any number of Accepted, then one Arrived or Rejected, unless another command takes its place. A request
    that was rejected is refused from then on: who wants it all the same asks anew.
    """

    @property
    def name(self) -> str:
        """What reports call it; unique in a run."""
        ...

    async def run(self, world: World) -> None:
        """Publish until cancelled."""
        ...

    async def command(self, command: Command) -> None:
        """Take on a command for an entity that it owns; raises Refused."""
        ...

    def owns(self, entity: str) -> bool:
        """Whether the entity takes commands from this plugin."""
        ...


__all__ = [
    "Accepted",
    "Aged",
    "Arrived",
    "Believes",
    "Broken",
    "Command",
    "Delivered",
    "Doubted",
    "Elsewhere",
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
    "Published",
    "Rebind",
    "Refused",
    "Rejected",
    "Report",
    "Return",
    "TakenOver",
    "Trouble",
    "Underway",
    "World",
    "entity_of",
]
