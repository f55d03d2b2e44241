"""Limits of an exploration, the bounds that were met, and long computations that look out for them.

An exploration that meets a bound keeps what it has. What comes after (surveys of all that was explored, temporal logic)
has no half result: it is given up, and what it would have decided stays undecided. An interruption is such a bound: it
ends an exploration between two configurations, and what comes after a little later.
"""

import math
import resource
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from enum import Enum
from time import monotonic

MOST_PENDING = 64
"""Requests of one agent, or messages in one mailbox, beyond which a configuration is not explored further."""


class Stop(Enum):
    """What may stop a search or leave something out of it, in words: `{}` is in the place of each figure."""

    CONFIGURATIONS = "the limit of {:,} configurations"
    TIME = "the time limit of {:g} s"
    MEMORY = "the memory limit of {:,.0f} MB"
    PENDING = "more than {} requests or messages of one agent pending"
    INTERRUPTION = "an interruption"
    NO_MEMORY = "the end of the memory that there is"
    NO_ROOM = "the end of the room in {}: {}"
    NO_CHECKPOINT = "a checkpoint that can't be written to {}: {}"


class Part(Enum):
    """Parts of a check that bounds may be met in, beside the exploration itself."""

    LOOKING = "looking at what was explored"
    SEARCHING = "the search for stale observations"


@dataclass(frozen=True, slots=True)
class Bound:
    """A bound that was met.

    Attributes:
        stop: What it is.
        figures: How much that was, or where.
        within: What it was met in, the innermost part first; nothing for the exploration itself.
    """

    stop: Stop
    figures: tuple[float | str | None, ...] = ()
    within: tuple[Part, ...] = ()

    def __str__(self) -> str:
        return ", in ".join((self.stop.value.format(*self.figures), *(part.value for part in self.within)))

    def met_in(self, part: Part) -> "Bound":
        """Return the bound as it was met in a part of the check."""
        return replace(self, within=(*self.within, part))

    @property
    def effect(self) -> str:
        """What it has done, in words."""
        return f"stopped at {self}: what lies beyond was not explored"


GRACE = 2.0
"""For how many seconds what was explored is looked at after that."""


class Interruption:
    """The wish of the user for the end, made by a signal's handler at any moment and asked for where time is."""

    def __init__(self) -> None:
        self.wished: float | None = None

    def wish(self) -> None:
        """Ask for the end."""
        self.wished = monotonic() if self.wished is None else self.wished

    def is_due(self, grace: float = 0.0) -> bool:
        """Tell whether the end was asked for, so many seconds ago."""
        return self.wished is not None and monotonic() - self.wished >= grace


class Uncounted:
    """How many seconds of an exploration count to no limit: loops are compiled once after an installation."""

    def __init__(self) -> None:
        self.seconds = 0.0


@dataclass(frozen=True, slots=True)
class Limits:
    """Where an exploration stops: then it is *incomplete*, and says so.

    Attributes:
        configurations: How many are visited at most.
        seconds: For how long.
        pending: How many requests an agent may have pending, or messages in its mailbox.
        spent: How many of the seconds are gone already.
        memory: How many bytes the process may take; looked at now and then, so that it may be a little more.
        spill: The folder in which the fast explorer has files for its rows when memory ends; None for nowhere.
        interruption: Whether the user has asked for the end.
        uncounted: The seconds of the exploration that are not counted.
    """

    configurations: int | None = 2_000_000
    seconds: float | None = None
    pending: int = MOST_PENDING
    spent: float = 0.0
    memory: int | None = None
    spill: str | None = None
    interruption: Interruption = field(default_factory=Interruption, compare=False, repr=False)
    uncounted: Uncounted = field(default_factory=Uncounted, compare=False, repr=False)

    def bound(self, stop: Stop) -> Bound:
        """Return the bound that is met at one of these limits."""
        figures = {
            Stop.CONFIGURATIONS: self.configurations,
            Stop.TIME: self.seconds,
            Stop.MEMORY: (self.memory or 0) / 1e6,
            Stop.PENDING: self.pending,
        }
        return Bound(stop, (figures[stop],))

    def end(self, seconds: float, share: float = 1.0, grace: float = 0.0) -> Bound | None:
        """Return why it ends after so many seconds: the user wants that, or a share of the time is over.

        The end is wanted for `grace` seconds by then.
        """
        if self.interruption.is_due(grace):
            return Bound(Stop.INTERRUPTION)
        counted = seconds + self.spent - self.uncounted.seconds
        is_over = self.seconds is not None and counted > share * self.seconds
        return self.bound(Stop.TIME) if is_over else None


def is_full(limits: Limits) -> bool:
    """Tell whether the process takes more memory than it may."""
    return memory_left(limits) < 0


def memory_left(limits: Limits) -> float:
    """Return how many bytes of memory the process may take besides what it takes now."""
    return math.inf if limits.memory is None else limits.memory - memory_taken()


def memory_taken() -> int:
    """Return how many bytes of memory the process takes now; its peak where the system doesn't tell.

    What is a file's is not counted: the system takes that back when it needs memory.
    """
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            resident, of_files = map(int, file.read().split()[1:3])
            return (resident - of_files) * resource.getpagesize()
    except OSError:
        unit = 1 if sys.platform == "darwin" else 1024
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


class BoundMet(Exception):  # what it is
    """Time, memory or the user's patience has come to its end."""

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
    """Check whether a bound is met; without bounds none is.

    Raises:
        BoundMet: It is.
    """
    bounds = _BOUNDS.get()
    met = None if bounds is None else bounds.met()
    if met is not None:
        raise BoundMet(met)
