"""How near a vehicle must come to a place that it passes, so that it is seen in it before it turns away."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from physical import Geometry, circle, contains, waypoint

FARTHEST: Final = 255.0
"""Metres of an acceptance radius that an item can hold."""

_PARTS: Final = (1.0, 0.75, 0.5, 0.25)
LEAST: Final = 0.1
"""The part of the usual radius that is asked for in the smallest places."""


@lru_cache(maxsize=256)
def acceptance(place: Geometry, usual: float) -> float:
    """Return the acceptance radius in metres for the waypoint of a place, 0 for the usual one.

    Around the waypoint it lies in the place, if that is large enough.
    """
    if place.is_point or not 0.0 < usual <= FARTHEST:
        return 0.0
    fits = (part for part in _PARTS if contains(place, circle(waypoint(place).vertices[0], usual * part)))
    part = next(fits, LEAST)
    return 0.0 if part == 1.0 else round(usual * part, 1)
