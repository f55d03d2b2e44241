"""How near a region comes to a place, how far inside it stays, or how far it reaches from it, in metres."""

from __future__ import annotations

import math
from enum import Enum
from typing import Final, NamedTuple

import shapely

from physical.frame import rounded
from physical.geodesic_areas import GeodesicArea, area_of, disc_of
from physical.geodesic_distances import feet_on, nearest_line
from physical.gnomonic import around, slack
from physical.region_relations import nearest, possibly_in, surely_in, within
from physical.regions import Located, RegionPart
from physical.shape import Geometry, intern

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


class Outermost(NamedTuple):
    """A point of a region, and how far the region reaches beyond a place there.

    Attributes:
        metres: The metres, with the region's margin.
        point: The point, without the margin.
    """

    metres: float
    point: Geometry


def outermost(u: Located, place: Located) -> Outermost | None:
    """Return where a region reaches farthest beyond a place; None if it does not, or if the place may move.

    Raises:
        RegionError: The two are too far from each other.
    """
    if not place.region.certain:
        return None
    outer = area_of(place.region.parts[0])
    found = [_outermost(part, outer) for part in u.region.parts]
    return max((each for each in found if each.metres > 0.0), key=lambda each: each.metres, default=None)


def _outermost(part: RegionPart, outer: GeodesicArea) -> Outermost:
    area = area_of(part)
    corners = shapely.get_coordinates(area.shape)
    metres = feet_on(corners, outer).metres
    at = int(metres.argmax())
    if metres[at] > 0.0:
        return Outermost(float(metres[at]) + part.margin, _point(*corners[at]))
    line = nearest_line(area, outer.border)
    return Outermost(part.margin - line.metres, _point(*line.first))


def _point(east: float, north: float) -> Geometry:
    return intern((rounded(north, east),))


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
