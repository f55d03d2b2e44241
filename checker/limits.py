"""Limits of an exploration, the bounds that were met, and bound checks within long computations.

An exploration that meets a bound keeps its results. Later phases (surveys, temporal logic) have no partial result: they
are abandoned, and their properties stay undecided. An interruption is such a bound. It ends an exploration between two
configurations, and a later phase after a short grace.
"""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from enum import Enum
from time import monotonic

from bigraphs.resources import memory_taken

MOST_PENDING = 64
"""The most pending requests of one agent, or messages in one mailbox, in a configuration that is expanded."""


EXPLORING = 0.5
"""The share of the time limit for an exploration; inspecting the result takes as long again."""


class Stop(Enum):
    """The reason why a search stopped or left something out, in words with placeholders `{}`: figures, a plural."""

    CONFIGURATIONS = "the limit of {:,} configuration{}"
    TIME = "the time limit of {:g} s"
    MEMORY = "the memory limit of {:,.0f} MB"
    PENDING = "more than {} requests or messages of one agent pending"
    INTERRUPTION = "an interruption"
    OVERTAKEN = "another engine, which is faster"
    NO_MEMORY = "the end of the available memory"
    NO_ROOM = "the end of the free space in {}: {}"
    NO_CHECKPOINT = "a checkpoint that can't be written to {}: {}"


class CheckPart(Enum):
    """The parts of a check in which bounds may be met, beside the exploration itself."""

    LOOKING = "the examination of the explored configurations"
    SEARCHING = "the search for stale observations"


@dataclass(frozen=True, slots=True)
class Bound:
    """A bound that was met.

    Attributes:
        stop: The kind of bound.
        figures: Its amounts or its place.
        within: The parts of the check in which it was met, innermost first; empty for the exploration itself.
    """

    stop: Stop
    figures: tuple[float | str | None, ...] = ()
    within: tuple[CheckPart, ...] = ()

    def __str__(self) -> str:
        plural = "" if self.figures == (1,) else "s"
        return ", in ".join(
            (self.stop.value.format(*self.figures, plural), *(part.value for part in self.within))
        )

    def met_in(self, part: CheckPart) -> "Bound":
        """Return the bound as met in a part of the check."""
        return replace(self, within=(*self.within, part))

    @property
    def effect(self) -> str:
        """The consequence of the bound, in words."""
        return f"stopped at {self}: the rest was not explored"


GRACE = 2.0
"""Seconds after an interruption during which later phases may still finish."""


class Interruption:
    """The user's request to end, set by a signal handler at any moment and polled by the computations."""

    def __init__(self) -> None:
        self.wished: float | None = None

    def wish(self) -> None:
        """Request the end."""
        self.wished = monotonic() if self.wished is None else self.wished

    def is_due(self, grace: float = 0.0) -> bool:
        """Return whether the end was requested at least so many seconds ago."""
        return self.wished is not None and monotonic() - self.wished >= grace


class Uncounted:
    """The seconds of an exploration that count towards no limit: loops are compiled once after an installation."""

    def __init__(self) -> None:
        self.seconds = 0.0


@dataclass(frozen=True, slots=True)
class Limits:
    """The limits of an exploration; an exploration that meets one is *incomplete*.

    Attributes:
        configurations: The most configurations to visit.
        seconds: The most seconds.
        pending: The most pending requests of an agent, or messages in its mailbox.
        spent: Seconds already used.
        memory: The most bytes of the process, approximately, since it is checked at intervals.
        spill: The folder to which the fast explorer moves its rows when memory ends; None for none.
        interruption: The user's request to end.
        uncounted: The seconds that count towards no limit.
        overtaken: Returns whether another engine takes over.
    """

    configurations: int | None = 2_000_000
    seconds: float | None = None
    pending: int = MOST_PENDING
    spent: float = 0.0
    memory: int | None = None
    spill: str | None = None
    interruption: Interruption = field(default_factory=Interruption, compare=False, repr=False)
    uncounted: Uncounted = field(default_factory=Uncounted, compare=False, repr=False)
    overtaken: Callable[[], bool] | None = field(default=None, compare=False, repr=False)

    def bound(self, stop: Stop) -> Bound:
        """Return the bound for one of these limits."""
        figures = {
            Stop.CONFIGURATIONS: self.configurations,
            Stop.TIME: self.seconds,
            Stop.MEMORY: (self.memory or 0) / 1e6,
            Stop.PENDING: self.pending,
        }
        return Bound(stop, (figures[stop],))

    def end(self, seconds: float, share: float = 1.0, grace: float = 0.0) -> Bound | None:
        """Return the bound met after so many seconds: an interruption, or a share of the time used up.

        An interruption counts `grace` seconds after the request.
        """
        if self.interruption.is_due(grace):
            return Bound(Stop.INTERRUPTION)
        if self.overtaken is not None and self.overtaken():
            return Bound(Stop.OVERTAKEN)
        counted = seconds + self.spent - self.uncounted.seconds
        is_over = self.seconds is not None and counted > share * self.seconds
        return self.bound(Stop.TIME) if is_over else None


def is_full(limits: Limits) -> bool:
    """Return whether the process exceeds the memory limit."""
    return memory_left(limits) < 0


def memory_left(limits: Limits) -> float:
    """Return how many more bytes of memory the process may take."""
    return math.inf if limits.memory is None else limits.memory - memory_taken()


class BoundMet(Exception):  # named for the event, not the error
    """A bound on time or memory, or an interruption, was met."""

    def __init__(self, bound: Bound) -> None:
        super().__init__(str(bound))
        self.bound = bound


@dataclass(frozen=True, slots=True)
class _Bounds:
    limits: Limits
    started: float

    def met(self) -> Bound | None:
        end = self.limits.end(monotonic() - self.started, grace=GRACE)
        return self.limits.bound(Stop.MEMORY) if end is None and is_full(self.limits) else end


_BOUNDS: ContextVar[_Bounds | None] = ContextVar("bounds", default=None)


@contextmanager
def bounded(limits: Limits, started: float | None = None) -> Iterator[None]:
    """Limit time and memory within the context; the time begins now unless its start is given."""
    token = _BOUNDS.set(_Bounds(limits, monotonic() if started is None else started))
    try:
        yield
    finally:
        _BOUNDS.reset(token)


def look() -> None:
    """Check the bounds of the surrounding `bounded` context, if any.

    Raises:
        BoundMet: A bound is met.
    """
    bounds = _BOUNDS.get()
    met = None if bounds is None else bounds.met()
    if met is not None:
        raise BoundMet(met)
