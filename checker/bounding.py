"""Bounds on long computations: they check the clock and the memory from time to time.

An exploration that meets a bound keeps what it has. What comes after (surveys of all that was explored, temporal logic)
has no half result: it is given up, and what it would have decided stays undecided. An interruption is such a bound: it
ends an exploration between two configurations, and what comes after a little later.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from time import monotonic

from checker.limits import GRACE, Bound, Limits, Stop, is_full


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
