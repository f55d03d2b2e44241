"""The distance at which a vehicle counts as having passed a place: it must be inside before it turns away."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from physical import Geometry, circle, contains, waypoint

FARTHEST: Final = 255.0
"""The largest acceptance radius, in metres, that an item can hold."""

_PARTS: Final = (1.0, 0.75, 0.5, 0.25)
LEAST: Final = 0.1
"""The fraction of the usual radius for the smallest places."""


@lru_cache(maxsize=256)
def acceptance(place: Geometry, usual: float) -> float:
    """Return the acceptance radius in metres for the waypoint of a place, 0 for the usual one.

    A circle of this radius around the waypoint lies in the place, if the place is large enough.
    """
    if place.is_point or not 0.0 < usual <= FARTHEST:
        return 0.0
    fits = (part for part in _PARTS if contains(place, circle(waypoint(place).vertices[0], usual * part)))
    part = next(fits, LEAST)
    return 0.0 if part == 1.0 else round(usual * part, 1)
