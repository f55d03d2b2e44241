"""Intervals of whole ticks: how long something takes, at least and at most."""

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class Interval:
    """[lo, hi] in ticks; both ends belong to it.

    Attributes:
        lo: At least so long.
        hi: At most so long; None where nothing bounds it.
    """

    lo: int = 0
    hi: int | None = None

    def __str__(self) -> str:
        return f"[{self.lo}, {'∞)' if self.hi is None else f'{self.hi}]'}"


ANY_TIME: Final = Interval()
"""What is not said is not assumed."""
