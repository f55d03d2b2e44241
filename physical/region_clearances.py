"""How near a region comes to a place, how far inside it stays, or how far it reaches from it, in metres."""

from __future__ import annotations

import math
from enum import Enum
from typing import Final, NamedTuple

from physical.geodesic_areas import area_of, disc_of
from physical.geodesic_distances import nearest_line
from physical.gnomonic import around, slack
from physical.region_relations import nearest, possibly_in, surely_in, within
from physical.regions import Located, RegionPart

FINENESS: Final = 1.0
"""The accuracy in metres of a reach."""


class PlaceSide(Enum):
    """Where a region is, seen from a place."""

    OUTSIDE = "outside"
    INSIDE = "inside"
    ACROSS = "across"
    """A part of it may be inside."""


class Clearance(NamedTuple):
    """The side of a place on which a region is, and its least distance from the place or from its border.

    Attributes:
        side: Whether it is outside, inside or across.
        metres: The least distance on the ground, rounded down; 0 across.
        gap: The metres of altitude between them, if their altitudes do not meet.
    """

    side: PlaceSide
    metres: float
    gap: float = 0.0


def clearance(u: Located, place: Located) -> Clearance | None:
    """Return the clearance of a region and a place; None if one is absent, or one carries the other."""
    if not u.region or not place.region or u.bearer == place.bearer or place.entity in u.carriers:
        return None
    if surely_in(u, place):
        outer = place.region.parts[0]
        return Clearance(PlaceSide.INSIDE, min(_depth(part, outer) for part in u.region.parts))
    if possibly_in(u, place):
        return Clearance(PlaceSide.ACROSS, 0.0)
    found = nearest(u, place)
    return None if found is None else Clearance(PlaceSide.OUTSIDE, found.metres, found.gap)


def _depth(part: RegionPart, outer: RegionPart) -> float:
    """Return the least distance of a part inside a place from its border."""
    metres = nearest_line(area_of(part), area_of(outer).border).metres
    return max(0.0, metres - part.margin - slack(around(disc_of(part), disc_of(outer)).radius))


def reach(u: Located, v: Located) -> float | None:
    """Return the least D, in whole metres, for which u is within D of v; None if one is absent."""
    if not within(u, v, math.inf):
        return None
    low = 0.0
    high = max(disc_of(a).most(disc_of(b)) for a in u.region.parts for b in v.region.parts)
    while high - low > FINENESS:
        middle = (low + high) / 2
        low, high = (low, middle) if within(u, v, middle) else (middle, high)
    return math.ceil(high)
