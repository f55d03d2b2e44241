"""The offset of another station's clock, measured by round trips."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import Final

KEPT: Final = 8
"""The number of remembered round trips; the shortest is the most exact."""


@dataclass(frozen=True, slots=True)
class Measure:
    """Seconds by which a clock is ahead of ours, and the error bound."""

    ahead: float
    error: float

    def exceeds(self, bound: float) -> bool:
        """Return whether the clock is off by more than a bound, for any error within the error bound."""
        return abs(self.ahead) - self.error > bound


def measured(sent: float, theirs: float, received: float) -> Measure:
    """Measure by one round trip: the answer was written at some time in between.

    >>> measured(10.0, 13.5, 11.0)
    Measure(ahead=3.0, error=0.5)
    """
    return Measure(theirs - (sent + received) / 2, (received - sent) / 2)


@dataclass(slots=True)
class Skew:
    """The last measures of one clock."""

    measures: deque[Measure] = field(default_factory=lambda: deque(maxlen=KEPT))

    def add(self, measure: Measure) -> None:
        """Remember a measure."""
        self.measures.append(measure)

    @property
    def best(self) -> Measure | None:
        """The most exact of them."""
        return min(self.measures, key=lambda measure: measure.error, default=None)
