"""The four relations over regions, and the nearest points of two.

In doubt `possibly_in` is true and the others are false. The doubt is less than 0.5 m where both regions lie within 500
km of their common middle, and less than 5 m within 1,000 km; a circle, which is drawn as a polygon of 64 corners, adds
0.12 % of its radius. Places and entities at certain positions compare exactly.

Raises RegionError where two regions reach farther and their bounds do not decide, or where one covers a pole.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from physical.altitude import Band, band_contains
from physical.part_relations import (
    are_apart,
    are_near,
    is_covered,
    least_bound,
    lies_in,
    line_between,
    meet,
)
from physical.regions import Located, RegionPart
from physical.shape import Geometry


class Nearest(NamedTuple):
    """The nearest points of two regions, on the ground.

    Attributes:
        metres: Their distance: never more than that of any two points of the regions.
        first: The point of the first region.
        second: The point of the second one.
        parts: The part of each region to which the points belong.
        gap: The metres of altitude between the two parts; 0 if their bands meet.
    """

    metres: float
    first: Geometry
    second: Geometry
    parts: tuple[RegionPart, RegionPart]
    gap: float = 0.0


def possibly_in(u: Located, place: Located) -> bool:
    """Whether u may be in a place: a point of its region is an interior point of the place's, or it carries u."""
    return place.entity in u.carriers or next(_meetings(u, place), None) is not None


def possible_point(u: Located, place: Located) -> Geometry | None:
    """Return a point of u's region that is in a place, or next to it; None if there is none, or it carries u."""
    found = next(_meetings(u, place), None)
    return None if found is None or place.entity in u.carriers else line_between(*found).first


def _meetings(u: Located, place: Located) -> Iterator[tuple[RegionPart, RegionPart]]:
    if place.region.is_area and u.entity != place.entity:
        for a, b in _pairs(u, place):
            if altitude_gap(a.altitude, b.altitude) == 0.0 and meet(a, b):
                yield a, b


def _pairs(u: Located, v: Located) -> Iterator[tuple[RegionPart, RegionPart]]:
    return ((a, b) for a in u.region.parts for b in v.region.parts)


def altitude_gap(a: Band | None, b: Band | None) -> float:
    """Return the metres between two bands; 0 if they meet, ends included, or one is unknown."""
    return 0.0 if a is None or b is None else max(0.0, a.low - b.high, b.low - a.high)


def surely_in(u: Located, place: Located) -> bool:
    """Whether u is present, and all of its region is in a certain place and in its band; or the place carries u."""
    if place.entity in u.carriers:
        return True
    outer = _certain_place(place)
    return (
        outer is not None
        and u.entity != place.entity
        and bool(u.region)
        and all(_levels_in(a, outer) and lies_in(a, outer.sources[0]) for a in u.region.parts)
    )


def _certain_place(place: Located) -> RegionPart | None:
    return place.region.parts[0] if place.region.certain else None


def _levels_in(a: RegionPart, outer: RegionPart) -> bool:
    return outer.altitude is None or (a.altitude is not None and band_contains(outer.altitude, a.altitude))


def at_least(u: Located, v: Located, metres: float, up: float | None = None) -> bool:
    """Whether no point of u's region is nearer than `metres` to one of v's.

    Parts are apart too if their bands are `up` metres apart or more (`metres` if `up` is None). It is true if one is
    absent, and false if both have one outermost carrier.
    """
    if not u.region or not v.region:
        return True
    if u.bearer == v.bearer:
        return metres <= 0.0
    height = metres if up is None else up
    return all(
        altitude_gap(a.altitude, b.altitude) >= height > 0.0 or are_apart(a, b, metres)
        for a, b in _pairs(u, v)
    )


def within(u: Located, v: Located, metres: float) -> bool:
    """Whether both are present, and no point of u's region is farther than `metres` from any of v's.

    Of a certain v, the nearest point counts.
    """
    if not u.region or not v.region:
        return False
    if u.bearer == v.bearer:
        return metres >= 0.0
    relation = is_covered if v.region.certain else are_near
    return all(relation(a, b, metres) for a, b in _pairs(u, v))


def nearest(u: Located, v: Located, up: float | None = None) -> Nearest | None:
    """Return the nearest points of two regions; None if one is absent, or both have one outermost carrier.

    If `up` is given, parts with bands `up` metres apart or more do not count; None if no others are left.
    """
    if u.bearer == v.bearer:
        return None
    best: Nearest | None = None
    for a, b in sorted(_pairs(u, v), key=lambda pair: least_bound(*pair)):
        gap = altitude_gap(a.altitude, b.altitude)
        if (up is not None and gap >= up > 0.0) or (best is not None and least_bound(a, b) >= best.metres):
            continue
        line = line_between(a, b)
        if best is None or line.metres < best.metres:
            best = Nearest(line.metres, line.first, line.second, (a, b), gap)
    return best
