"""Bands of altitude."""

from __future__ import annotations

import math
from dataclasses import dataclass

from physical.errors import PhysicalError


@dataclass(frozen=True, slots=True, order=True)
class Band:
    """The altitudes from `low` to `high`, both included, in metres above mean sea level.

    >>> Band(-0.0, 120)
    Band(low=0.0, high=120.0)
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        for name in ("low", "high"):
            metres = getattr(self, name)
            if isinstance(metres, bool) or not isinstance(metres, int | float) or not math.isfinite(metres):
                raise PhysicalError(
                    "altitude", f"the altitude {metres!r:.60} is not a finite number", "write it in metres"
                )
            object.__setattr__(self, name, float(metres) + 0.0)  # -0.0 becomes 0.0
        if self.low > self.high:
            raise PhysicalError(
                "altitude",
                f"the band from {self.low} m to {self.high} m is upside down",
                "write the lower end first",
            )


def band_contains(outer: Band | None, inner: Band | None) -> bool:
    """Whether `inner` lies within `outer`, its ends included; true where either has no band.

    The ends count, unlike borders on the ground: a vessel at 0 m is in a place from 0 m to 100 m.
    """
    return outer is None or inner is None or (outer.low <= inner.low and inner.high <= outer.high)
