"""The `timing` section: the durations and dates of steps."""

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
    """`tick 100 ms`: the unit of time; all durations are multiples of it. The default is a second."""

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

    The speeds over ground of the vehicles of a kind, or of one vehicle (`uav0 flies at ...`), which take precedence.
    With the distances on the map they give each flight its shortest and its longest time. `climbs` is required if
    altitudes differ on the way. `circles` is the radius of circles for vehicles that cannot stand still.
    """

    name: Name
    speeds: Speeds
    climbs: Speeds | None = None
    circles: Length | None = None


@node
class Lasting(Node):
    """`uav0 lasts 45 min, restored in airfield0, base0 after 20 min`.

    The endurance of a vehicle, or of each vehicle of a kind: its longest time away from the places that restore it.
    After the given time in one of these places, its endurance is restored. A carrier restores it on its way, too.
    """

    name: Name
    lasts: Duration
    places: tuple[Name, ...] = ()
    after: Duration | None = None


@node
class Lapse(Node):
    """`within 5 s`, `takes 1 s to 3 s`, `takes 2 s`, `takes at least 2 s`.

    A duration: at most so long, between two durations, exactly so long, or at least so long. After a plural, the verb
    is `take`.
    """

    least: Duration | None
    most: Duration | None


@node
class ReactionTime(Node):
    """`agents react within 1 s`, or `agents take 1 s to 2 s`.

    The duration of a bigActor's own steps: computations, requests, and receptions. It also bounds the time until a
    vehicle sets out. Other commands without a line of their own take any time.
    """

    lapse: Lapse


@node
class SensingTime(Node):
    """`sense within 5 s`: the duration of an observation."""

    lapse: Lapse


@node
class MessageTime(Node):
    """`messages over wifi take 1 s to 3 s`, `messages on one host within 1 s`.

    The delay of a message over a channel, or between two bigActors of one host.
    """

    channel: Name | None
    lapse: Lapse


@node
class StepTime(Node):
    """`HAND within 10 s`, `migrate takes 1 s to 2 s`, `land within 30 s`.

    The duration of a command by its first word, of `migrate`, of `spawn`, or of a rule by its name. The duration of a
    flight follows from speeds and distances.
    """

    word: Name
    lapse: Lapse


@node
class DriftTime(Node):
    """`oilSpill0 drifts at most every 20 min`: the least time between two steps of a drift."""

    entity: Name
    every: Duration


@node
class DropTime(Node):
    """`wifi drops at most every 30 min, returns within 5 min`, `wifi drops and returns within 5 min`.

    The least time between two drops of a channel, and the longest time until its return.
    """

    channel: Name
    every: Duration | None
    returns: Duration | None


@node
class LeaveTime(Node):
    """`uav0 leaves wifi at most every 30 min, returns within 5 min`, `uav0 leaves wifi and returns within 5 min`.

    The least time between two departures of an entity from a channel, and the longest time until its return.
    """

    entity: Name
    channel: Name
    every: Duration | None
    returns: Duration | None


@node
class PresenceTime(Node):
    """`tanker0 appears after 10 min, within 30 min`, `tanker0 vanishes within 1 h`.

    The time of its first appearance or disappearance, counted from the start.
    """

    entity: Name
    verb: str
    after: Duration | None
    within: Duration | None


@node
class SayTime(Node):
    """`someone says "handover" to a after 10 min, until 20 min`: the earliest and latest time of the message."""

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
    """`timing { ... }`: the durations and dates of steps. A step without a bound takes any time."""

    bounds: tuple[Bound, ...]
