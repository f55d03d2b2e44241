"""What a mission's `timing` section comes to: every bound that its verdicts rest on. Durations are whole ticks."""

from dataclasses import dataclass, replace
from typing import Final

from semantics.state.signature import Name
from semantics.timing.intervals import ANY_TIME, Interval

ONE_HOST: Final = ""
"""Stands for the channel of a message between two bigActors on one host."""


@dataclass(frozen=True, slots=True)
class Motion:
    """How one vehicle moves.

    Attributes:
        speed: Metres per second, the least and the greatest, above 0.
        climb: Metres per second up or down, the least and the greatest; None where nothing is said.
        circle: The diameter in metres of the circle that it flies where it cannot stand; 0 where it can.
    """

    speed: tuple[float, float]
    climb: tuple[float, float] | None = None
    circle: float = 0.0


@dataclass(frozen=True, slots=True)
class Endurance:
    """How long one vehicle lasts.

    Attributes:
        lasts: So long away from where it is restored.
        places: Where it is restored, sorted; nowhere if empty.
        after: How long that takes.
    """

    lasts: int
    places: tuple[Name, ...] = ()
    after: int = 0


@dataclass(frozen=True, slots=True)
class Every:
    """At least so long lies between two steps of a clause (`drifts` and `drops at most every`)."""

    least: int


@dataclass(frozen=True, slots=True)
class Window:
    """The first step of a clause (`appears`, `vanishes`) is at [after, within] from the start of the mission."""

    after: int = 0
    within: int | None = None


@dataclass(frozen=True, slots=True)
class Sayable:
    """A message may be said at [after, until] from the start of the mission, and need not be."""

    after: int = 0
    until: int | None = None


@dataclass(frozen=True, slots=True)
class ClauseTimes:
    """The times of one clause of the environment.

    Attributes:
        step: When it may take its steps; None where nothing is said.
        returns: Within which time what dropped, or left, returns; None where nothing is said.
    """

    step: Every | Window | Sayable | None = None
    returns: int | None = None


@dataclass(frozen=True, slots=True)
class Timing:
    """The assumptions about time. What is not said takes any time.

    Attributes:
        tick: Milliseconds of a tick.
        motions: How vehicles move, sorted by name.
        endurances: How long vehicles last, sorted by name.
        react: `fun`, `req_*`, `rcv_*`, and how long it takes until a vehicle is sent on its way.
        sense: How long `sense` takes.
        messages: How long a message over a channel takes, sorted by channel; `ONE_HOST` for those on one host.
        commands: By the word of a command or the name of a rule (`HAND`, `CONNECT`, `spawn`), sorted.
        clauses: Those of the clauses of the environment, in their order; empty where none has times.
        lines: The bounds as they were written, with the lines that they stand in.
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
        """Return the assumptions but those about how long vehicles last."""
        lines = tuple(said for said in self.lines if said[0].split()[1:2] != ["lasts"])
        return replace(self, endurances=(), lines=lines)

    def motion(self, vehicle: Name) -> Motion | None:
        """Return how a vehicle moves, None where nothing is said."""
        return dict(self.motions).get(vehicle)

    def message(self, channel: Name) -> Interval:
        """Return how long a message takes over a channel."""
        return dict(self.messages).get(channel, ANY_TIME)

    def command(self, word: str) -> Interval | None:
        """Return how long a command takes by its word, None where nothing is said."""
        return dict(self.commands).get(word)

    def clause(self, number: int) -> ClauseTimes:
        """Return the times of the clause of a number."""
        return self.clauses[number] if self.clauses else ClauseTimes()
