"""The `timing` section: how long everything takes."""

from __future__ import annotations

from typing import TypeAlias

from semantics.behaviours.durations import UNITS
from specs.syntax.expressions import Agent, Expression
from specs.syntax.nodes import Name, Node, node
from specs.syntax.statements import Duration
from specs.syntax.world import Length

METRES_PER_SECOND = {"m/s": 1.0, "km/h": 1000 / UNITS["h"], "kn": 1852 / UNITS["h"]}
"""The units of speed."""


@node
class Tick(Node):
    """`tick 100 ms`: the unit of time, of which all durations are whole numbers. Without it, it is a second."""

    duration: Duration


@node
class Speed(Node):
    """`18 m/s`, `65 km/h`, `35 kn`: metres a second, kilometres an hour or knots."""

    value: float
    unit: str

    @property
    def metres_per_second(self) -> float:
        """The speed in metres per second."""
        return self.value * METRES_PER_SECOND[self.unit]


@node
class Speeds(Node):
    """`18 m/s to 25 m/s`, or `20 m/s` for a single speed."""

    least: Speed
    greatest: Speed


@node
class Motion(Node):
    """`UAV flies at 18 m/s to 25 m/s, climbs at 2 m/s to 5 m/s, circles 80 m`.

    How fast the vehicles of a kind are, or one of them (`uav0 flies at ...`); what is said of one counts for it. The
    speeds over ground give each flight its shortest and its longest time, by the distances on the map. `climbs` is
    needed where altitudes differ on the way; `circles` gives the radius of the circles of what cannot stand.
    """

    name: Name
    speeds: Speeds
    climbs: Speeds | None = None
    circles: Length | None = None


@node
class Lasting(Node):
    """`uav0 lasts 45 min, restored in airfield0, base0 after 20 min`.

    How long a vehicle, or each one of a kind, may be away from the places in which it is restored, and how long it has
    to be in one of them to last that long again.
    """

    name: Name
    lasts: Duration
    places: tuple[Name, ...] = ()
    after: Duration | None = None


@node
class Lapse(Node):
    """`within 5 s`, `takes 1 s to 3 s`, `takes 2 s`, `takes at least 2 s`.

    How long something takes: from no time to so long, between two durations, exactly so long, or so long and more.
    Several things `take`.
    """

    least: Duration | None
    most: Duration | None


@node
class ReactionTime(Node):
    """`agents react within 1 s`, or `agents take 1 s to 2 s`.

    How long a bigActor takes for a step of its own: to compute, to ask for something, to take what has come; and how
    long it takes until a vehicle is sent on its way. Other commands take any time where no line says how long.
    """

    lapse: Lapse


@node
class SensingTime(Node):
    """`sense within 5 s`: how long an observation takes."""

    lapse: Lapse


@node
class MessageTime(Node):
    """`messages over wifi take 1 s to 3 s`, `messages on one host within 1 s`.

    How long a message is on its way over a channel, or between two bigActors of one host.
    """

    channel: Name | None
    lapse: Lapse


@node
class StepTime(Node):
    """`HAND within 10 s`, `migrate takes 1 s to 2 s`, `land within 30 s`.

    How long a command takes by its first word, `migrate`, `spawn`, or a rule by its name. How long a flight takes
    follows from speeds and distances.
    """

    word: Name
    lapse: Lapse


@node
class DriftTime(Node):
    """`oilSpill0 drifts at most every 20 min`: at least so long is between two steps of a drift."""

    entity: Name
    every: Duration


@node
class DropTime(Node):
    """`wifi drops at most every 30 min, returns within 5 min`, `wifi drops and returns within 5 min`.

    How often a channel may drop, and after how long it is back at the latest.
    """

    channel: Name
    every: Duration | None
    returns: Duration | None


@node
class LeaveTime(Node):
    """`uav0 leaves wifi at most every 30 min, returns within 5 min`, `uav0 leaves wifi and returns within 5 min`.

    How often an entity may leave a channel, and after how long it is back at the latest.
    """

    entity: Name
    channel: Name
    every: Duration | None
    returns: Duration | None


@node
class PresenceTime(Node):
    """`tanker0 appears after 10 min, within 30 min`, `tanker0 vanishes within 1 h`.

    When it comes or goes first, counted from the start.
    """

    entity: Name
    verb: str
    after: Duration | None
    within: Duration | None


@node
class SayTime(Node):
    """`someone says "handover" to a after 10 min, until 20 min`: when it may be said, counted from the start."""

    message: Expression
    recipient: Agent | None
    after: Duration | None
    until: Duration | None


Bound: TypeAlias = (
    Tick
    | Motion
    | Lasting
    | ReactionTime
    | SensingTime
    | MessageTime
    | StepTime
    | DriftTime
    | DropTime
    | LeaveTime
    | PresenceTime
    | SayTime
)


@node
class Timing(Node):
    """`timing { ... }`: how long everything takes. Of what is not said, nothing is assumed: it takes any time."""

    bounds: tuple[Bound, ...]
