"""The values of a mission's `timing` section: every time bound that its verdicts assume. Durations are whole ticks."""

from dataclasses import dataclass, replace
from typing import Final

from semantics.state.signature import Name
from semantics.timing.intervals import ANY_TIME, Interval

ONE_HOST: Final = ""
"""The channel of a message between two bigActors on one host."""


@dataclass(frozen=True, slots=True)
class Motion:
    """The motion of one vehicle.

    Attributes:
        speed: The least and the greatest speed in metres per second, above 0.
        climb: The least and the greatest vertical speed in metres per second, None if not given.
        circle: The diameter in metres of the circle that a vehicle flies if it cannot hover; 0 if it can.
    """

    speed: tuple[float, float]
    climb: tuple[float, float] | None = None
    circle: float = 0.0


@dataclass(frozen=True, slots=True)
class Endurance:
    """The endurance of one vehicle.

    Attributes:
        lasts: The longest time away from places that restore it.
        places: The places that restore it, sorted; possibly none.
        after: The time that restoring takes.
    """

    lasts: int
    places: tuple[Name, ...] = ()
    after: int = 0


@dataclass(frozen=True, slots=True)
class Every:
    """The least time between two steps of a clause (`drifts` and `drops at most every`)."""

    least: int


@dataclass(frozen=True, slots=True)
class Window:
    """The interval [after, within], from the start of the mission, of a clause's first step (`appears`, `vanishes`)."""

    after: int = 0
    within: int | None = None


@dataclass(frozen=True, slots=True)
class Sayable:
    """The interval [after, until], from the start of the mission, in which a message may be said."""

    after: int = 0
    until: int | None = None


@dataclass(frozen=True, slots=True)
class ClauseTimes:
    """The times of one clause of the environment.

    Attributes:
        step: The times of its steps; None if not given.
        returns: The longest time until a channel returns after it dropped or was left; None if not given.
    """

    step: Every | Window | Sayable | None = None
    returns: int | None = None


@dataclass(frozen=True, slots=True)
class Timing:
    """The assumptions about time. A duration that the mission does not give is unbounded.

    Attributes:
        tick: Milliseconds of a tick.
        motions: The motions of vehicles, sorted by name.
        endurances: The endurances of vehicles, sorted by name.
        react: The duration of `fun`, `req_*` and `rcv_*`, and the time until a vehicle is sent on its way.
        sense: The duration of `sense`.
        messages: The duration of messages by channel, sorted; `ONE_HOST` for those on one host.
        commands: The duration by command word or rule name (`HAND`, `CONNECT`, `spawn`), sorted.
        clauses: The times of the environment's clauses, in their order; empty if none has times.
        lines: The bounds as written, with their line numbers.
    """

    tick: int = 1000
    motions: tuple[tuple[Name, Motion], ...] = ()
    endurances: tuple[tuple[Name, Endurance], ...] = ()
    react: Interval = ANY_TIME
    sense: Interval = ANY_TIME
    messages: tuple[tuple[Name, Interval], ...] = ()
    commands: tuple[tuple[str, Interval], ...] = ()
    clauses: tuple[ClauseTimes, ...] = ()
    lines: tuple[tuple[str, int], ...] = ()

    def without_endurances(self) -> "Timing":
        """Return the assumptions without the endurances of vehicles."""
        lines = tuple(said for said in self.lines if said[0].split()[1:2] != ["lasts"])
        return replace(self, endurances=(), lines=lines)

    def motion(self, vehicle: Name) -> Motion | None:
        """Return the motion of a vehicle, None if not given."""
        return dict(self.motions).get(vehicle)

    def message(self, channel: Name) -> Interval:
        """Return the duration of messages over a channel."""
        return dict(self.messages).get(channel, ANY_TIME)

    def command(self, word: str) -> Interval | None:
        """Return the duration of a command by its word, None if not given."""
        return dict(self.commands).get(word)

    def clause(self, number: int) -> ClauseTimes:
        """Return the times of a clause by its number."""
        return self.clauses[number] if self.clauses else ClauseTimes()
