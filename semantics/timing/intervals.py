"""Intervals of whole ticks: the least and the greatest duration of a step."""

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class Interval:
    """[lo, hi] in ticks; both ends belong to it.

    Attributes:
        lo: The least duration.
        hi: The greatest duration; None if unbounded.
    """

    lo: int = 0
    hi: int | None = None

    def __str__(self) -> str:
        return f"[{self.lo}, {'∞)' if self.hi is None else f'{self.hi}]'}"


ANY_TIME: Final = Interval()
"""The bounds of a step that the mission does not time: nothing is assumed."""
