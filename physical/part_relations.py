"""Relations between two parts of regions, on the ground. In doubt `meet` is true, and the others are false."""

from __future__ import annotations

from functools import lru_cache
from typing import Final, NamedTuple

import shapely

from physical.frame import geod, rounded
from physical.geodesic_areas import area_of, circle_sagitta, disc_of, projected
from physical.geodesic_distances import (
    MOST_KNOWN,
    greatest_distance_of,
    lies_within,
    nearest_line,
    rough_distance,
    shared_frame,
)
from physical.gnomonic import FARTHEST_REACH, around, slack, stretch
from physical.regions import FaceCover, RegionKind, RegionPart
from physical.shape import MEMO, Geometry, contains, equal, intern, share_interior

GREATEST_SLACK: Final = slack(FARTHEST_REACH)


class PartLine(NamedTuple):
    """The shortest line between two parts: its metres, rounded down, and its ends."""

    metres: float
    first: Geometry
    second: Geometry


def least_bound(a: RegionPart, b: RegionPart) -> float:
    """Return a rough lower bound of the metres between points of two parts, which costs a microsecond."""
    return disc_of(a).least(disc_of(b))


def doubt(a: RegionPart, b: RegionPart) -> float:
    """Return the possible error in metres of figures about two parts."""
    if _are_points(a, b):
        return 0.0
    return slack(around(disc_of(a), disc_of(b)).radius) + bulge(a) + bulge(b)


def bulge(part: RegionPart) -> float:
    """Return the metres by which the circles among a part's sources leave their polygons."""
    return max(circle_sagitta(source) for source in part.sources)


def _are_points(a: RegionPart, b: RegionPart) -> bool:
    """Whether both parts are points, perhaps with margins."""
    return _is_point(a) and _is_point(b)


def _is_point(part: RegionPart) -> bool:
    first = part.sources[0]
    return len(part.sources) == 1 and isinstance(first, Geometry) and first.is_point


@lru_cache(maxsize=MEMO)
def line_between(a: RegionPart, b: RegionPart) -> PartLine:
    """Return the shortest line between two parts, of 0 metres if they may meet."""
    one, other = area_of(a), area_of(b)
    metres, (east, north), (to_east, to_north) = nearest_line(one, other)
    left = metres - a.margin - b.margin
    if metres > 0.0 and a.margin + b.margin > 0.0:
        azimuth, _, _ = geod().inv(east, north, to_east, to_north)
        begin = min(a.margin, metres * a.margin / (a.margin + b.margin)) if left < 0.0 else a.margin
        end = begin if left < 0.0 else metres - b.margin
        to_east, to_north, _ = geod().fwd(east, north, azimuth, end)
        east, north, _ = geod().fwd(east, north, azimuth, begin)
    return PartLine(max(0.0, left - doubt(a, b)), _point(north, east), _point(to_north, to_east))


def _point(north: float, east: float) -> Geometry:
    return intern((rounded(north, east),))


@lru_cache(maxsize=MEMO)
def meet(a: RegionPart, b: RegionPart) -> bool:
    """Whether a point of a part may be an interior point of another one."""
    known = _exactly_meet(a, b) if a.is_exact and b.is_exact else None
    if known is not None:
        return known
    return meet_or_touch(a, b)


def meet_or_touch(a: RegionPart, b: RegionPart) -> bool:
    """Whether two parts may have a point in common, on their borders or inside."""
    return not are_apart(a, b, 1e-9)


def _exactly_meet(a: RegionPart, b: RegionPart) -> bool | None:
    """Return the relation of two exact parts, None if it has to be measured."""
    one, other = a.sources[0], b.sources[0]
    if isinstance(other, FaceCover):
        return None
    if other.is_point:
        return False
    if isinstance(one, FaceCover):
        return True if other in one.inside else False if other in one.outside else None
    return contains(other, one) if one.is_point else equal(one, other) or share_interior(one, other)


@lru_cache(maxsize=MEMO)
def lies_in(a: RegionPart, place: Geometry) -> bool:
    """Whether all of a part surely lies in a place."""
    if place.is_point:
        return False
    known = _exactly_in(a, place) if a.is_exact else None
    if known is not None:
        return known
    outer = RegionPart((place,))
    if least_bound(a, outer) > 0.0:
        return False
    one, other = area_of(a), area_of(outer)
    frame, reach = shared_frame(one.disc, other.disc)
    inner, around_it = projected(one, frame), projected(other, frame)
    if not shapely.contains(around_it, inner):
        return False
    needed = a.margin + slack(reach) + bulge(a)
    if shapely.distance(around_it.boundary, inner) >= needed * stretch(reach):
        return True
    return nearest_line(one, other.border).metres >= needed


def _exactly_in(a: RegionPart, place: Geometry) -> bool | None:
    inner = a.sources[0]
    if isinstance(inner, FaceCover):
        return True if place in inner.inside else False if place in inner.outside else None
    return contains(place, inner) or (a.kind is RegionKind.REST and equal(place, inner))


@lru_cache(maxsize=MOST_KNOWN)
def are_apart(a: RegionPart, b: RegionPart, metres: float) -> bool:
    """Whether no point of a part is nearer than some metres to one of another."""
    if metres <= 0.0 or least_bound(a, b) >= metres:
        return True
    if not _are_points(a, b):
        low, high = rough_distance(area_of(a), area_of(b))
        needed = metres + a.margin + b.margin + doubt(a, b)
        if low >= needed or high < needed:
            return low >= needed
    return line_between(a, b).metres >= metres


def are_near(a: RegionPart, b: RegionPart, metres: float) -> bool:
    """Whether no point of a part is farther than some metres from any point of another."""
    if disc_of(a).most(disc_of(b)) <= metres:
        return True
    if least_bound(a, b) > metres:
        return False
    return greatest_distance_of(area_of(a), area_of(b)) + a.margin + b.margin + doubt(a, b) <= metres


def is_covered(a: RegionPart, b: RegionPart, metres: float) -> bool:
    """Whether no point of a part is farther than some metres from the nearest point of another."""
    if disc_of(a).most(disc_of(b)) <= metres:
        return True
    if least_bound(a, b) > metres:
        return False
    (place,) = b.sources[:1]
    if metres >= 0.0 and b.is_exact and isinstance(place, Geometry) and lies_in(a, place):  # its margin, too
        return True
    left = metres - a.margin + b.margin - doubt(a, b)
    return left >= 0.0 and lies_within(area_of(a), area_of(b), left)
