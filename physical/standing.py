"""The places where a circling vehicle can stay: its circle crosses no relevant border.

The rules do not distinguish two points in the same places. So a vehicle matches P as long as it stays in the places of
its point in P, and out of all others: these are its surroundings.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import shapely

from physical.errors import GeometryError
from physical.frame import LocalFrame, local_frame
from physical.geometry_measures import area, centroid
from physical.placement import nearest_spot, placed, room, template
from physical.shape import Geometry, contains, planar, point

CLEARANCE: Final = 1.002
"""The factor of the cleared circle: arcs are cut into chords, and positions are rounded."""

HALVINGS: Final = 24
"""The number of bisection steps for the widest circle."""

_ANY_POINT: Final = point(0, 0)


@dataclass(frozen=True, slots=True)
class Surroundings:
    """The places that a vehicle has to stay in, and out of: sorted geometries, each once."""

    inside: tuple[Geometry, ...] = ()
    outside: tuple[Geometry, ...] = ()


def surroundings_of(spot: Geometry, places: Iterable[Geometry]) -> Surroundings:
    """Return the surroundings of a mover's placement among places."""
    found = sorted({place for place in places if not place.is_point})
    held = tuple(place for place in found if contains(place, spot))
    return Surroundings(held, tuple(place for place in found if place not in held))


def stands(around: Surroundings, mover: Geometry) -> bool:
    """Whether a mover's placement keeps to its surroundings."""
    inside = all(contains(place, mover) for place in around.inside)
    return inside and not any(contains(place, mover) for place in around.outside)


def standing(mover: Geometry, target: Geometry, around: Surroundings, radius: float) -> Geometry | None:
    """Return the placement nearest to the target's centroid whose circle keeps to the surroundings, or None."""
    if target.is_point:
        return target
    return _standing(_still(mover), target, around, radius)


def widest(mover: Geometry, target: Geometry, around: Surroundings) -> float:
    """Return the radius in metres of the widest circle in which a mover could stay, to a part in a million."""
    low, high = 0.0, math.sqrt(area(target) / math.pi)
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        fits = standing(mover, target, around, middle) is not None
        low, high = (middle, high) if fits else (low, middle)
    return low


def leads_straight(mover: Geometry, start: Geometry, end: Geometry, around: Surroundings) -> bool:
    """Whether a mover keeps to its surroundings all the way from one placement straight to another."""
    frame = local_frame(centroid(end).ring[0])
    ends = [frame.metres(centroid(each).ring[0]) for each in (start, end)]
    way = shapely.LineString(ends) if ends[0] != ends[1] else shapely.Point(ends[0])
    inside, outside = _borders(_still(mover), frame, around)
    return all(shape.contains(way) for shape in inside) and not any(
        shape.intersects(way) for shape in outside
    )


def _still(mover: Geometry) -> Geometry:
    return _ANY_POINT if mover.is_point else template(mover)


@lru_cache(maxsize=1 << 12)
def _standing(mover: Geometry, target: Geometry, around: Surroundings, radius: float) -> Geometry | None:
    frame = local_frame(centroid(target).ring[0])
    spot = nearest_spot(_kept(mover, frame, target, around, radius))
    if spot is None:
        return None
    try:
        found = placed(mover, frame, *spot)
    except GeometryError:  # over a pole
        return None
    return found if stands(around, found) else None


def _kept(
    mover: Geometry, frame: LocalFrame, target: Geometry, around: Surroundings, radius: float
) -> shapely.Geometry:
    """Return the permitted positions of a mover, in a metric frame."""
    kept = radius * CLEARANCE
    inside, outside = _borders(mover, frame, Surroundings((target, *around.inside), around.outside))
    space = shapely.intersection_all([shape.buffer(-kept) for shape in inside])
    near = [shape for shape in outside if shape.distance(space) <= kept]
    return space.difference(shapely.union_all([shape.buffer(kept) for shape in near])) if near else space


def _borders(
    mover: Geometry, frame: LocalFrame, around: Surroundings
) -> tuple[list[shapely.Geometry], list[shapely.Geometry]]:
    """Return the positions of a mover inside each place that it stays in, and inside each that it stays out of."""
    return tuple([_room(frame, place, mover) for place in some] for some in (around.inside, around.outside))  # type: ignore[return-value]


def _room(frame: LocalFrame, place: Geometry, mover: Geometry) -> shapely.Geometry:
    space = frame.project(planar(place))
    return space if mover.is_point else room(space, mover)
