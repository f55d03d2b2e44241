"""Bands of altitude."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from physical.errors import PhysicalError

LIMIT: Final = 1_000_000


@dataclass(frozen=True, slots=True, order=True)
class Band:
    """The altitudes from `low` to `high`, both included, in metres above mean sea level.

    >>> Band(-0.0, 120)
    Band(low=0.0, high=120.0)
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "low", _metres(self.low))
        object.__setattr__(self, "high", _metres(self.high))
        if self.low > self.high:
            raise PhysicalError(
                "altitude",
                f"the band from {self.low} m to {self.high} m is upside down",
                "write the lower end first",
            )


def _metres(value: float) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise PhysicalError("altitude", f"the altitude {value!r:.60} is not a number", "write it in metres")
    if not -LIMIT <= value <= LIMIT:  # also rejects NaN
        raise PhysicalError("altitude", f"an altitude is not between -{LIMIT:,} m and {LIMIT:,} m")
    return float(value) + 0.0  # -0.0 becomes 0.0


def band_contains(outer: Band | None, inner: Band | None) -> bool:
    """Whether `inner` lies within `outer`, ends included; true if either has no band.

    The ends count, unlike borders on the ground: a vessel at 0 m is in a place from 0 m to 100 m.
    """
    return outer is None or inner is None or (outer.low <= inner.low and inner.high <= outer.high)
