"""Measures of geometries in metres: area, distance, centroid and waypoints."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from typing import Final

import shapely

from physical.errors import GeometryError
from physical.frame import E7, PositionE7, equal_area, geod, local_frame, rounded
from physical.shape import MEMO, Geometry, contains, intern, planar

_GAUSS: Final = (
    (0.019855071751231912, 0.05061426814518853),
    (0.10166676129318664, 0.11119051722668721),
    (0.2372337950418355, 0.15685332293894344),
    (0.4082826787521751, 0.18134189168918083),
    (0.5917173212478248, 0.18134189168918083),
    (0.7627662050579645, 0.15685332293894344),
    (0.8983332387068134, 0.11119051722668721),
    (0.9801449282487681, 0.05061426814518853),
)
"""Nodes and weights of Gauss-Legendre quadrature on [0, 1]."""


QUARTER: Final = 10_000_000.0
"""Metres from the equator to a pole; beyond it no local frame is usable, and distances between vertices suffice."""


def area(geometry: Geometry) -> float:
    """Return the area on the ellipsoid in square metres; 0 for a point.

    The edges are straight in latitude and longitude, so the area is an integral of the equal-area projection's height
    along each of them.
    """
    return 0.0 if geometry.is_point else _area(geometry)


@lru_cache(maxsize=MEMO)
def _area(geometry: Geometry) -> float:
    edges = list(pairwise(planar(geometry).exterior.coords))
    norths = [a[1] + t * (b[1] - a[1]) for a, b in edges for t, _ in _GAUSS]
    _, heights = equal_area()([0.0] * len(norths), [north / E7 for north in norths])
    base = min(heights)  # differences to it keep their digits in a small polygon
    means = [
        sum(weight * (heights[8 * i + j] - base) for j, (_, weight) in enumerate(_GAUSS))
        for i in range(len(edges))
    ]
    metres_per_unit = equal_area()(1.0, 0.0)[0] / E7
    return float(
        abs(sum((b[0] - a[0]) * mean for (a, b), mean in zip(edges, means, strict=True))) * metres_per_unit
    )


def distance(a: Geometry, b: Geometry) -> float:
    """Return the metres between the nearest points of two geometries, 0 if they meet."""
    if a.is_point and b.is_point:
        return _between(a.ring[0], b.ring[0])
    return _apart(a, b)


@lru_cache(maxsize=1 << 12)
def _apart(a: Geometry, b: Geometry) -> float:
    if _between(_middle(a), _middle(b)) > QUARTER and not planar(a).intersects(planar(b)):
        # A frame turns areas on the other side of the earth inside out.
        return min(_between(one, other) for one in a.ring for other in b.ring)
    frame = local_frame(_middle(a))
    for _ in range(2):  # the frame is exact close to the nearest points
        line = shapely.shortest_line(frame.project(planar(a)), frame.project(planar(b)))
        (x1, y1), (x2, y2) = line.coords
        nearest = frame.position(x1, y1), frame.position(x2, y2)
        frame = local_frame(frame.position((x1 + x2) / 2, (y1 + y2) / 2))
    return 0.0 if line.length == 0.0 else _between(*nearest)


def _between(a: PositionE7, b: PositionE7) -> float:
    metres: float = geod().inv(a[1] / E7, a[0] / E7, b[1] / E7, b[0] / E7)[2]
    return metres


def _middle(geometry: Geometry) -> PositionE7:
    west, south, east, north = planar(geometry).bounds
    return rounded((south + north) / 2 / E7, (west + east) / 2 / E7)


def centroid(geometry: Geometry) -> Geometry:
    """Return the centre of area; for a moved polygon, the point to which it was moved."""
    return geometry if geometry.is_point else _centroid(geometry)


@lru_cache(maxsize=MEMO)
def _centroid(geometry: Geometry) -> Geometry:
    if geometry.anchor is not None:
        return intern((geometry.anchor,))
    centre = _middle(geometry)
    for _ in range(2):  # seen from the middle of the bounds, then from the centroid itself
        frame = local_frame(centre)
        found = frame.project(planar(geometry)).centroid
        centre = frame.position(found.x, found.y)
    return intern((centre,))


def interior_point(geometry: Geometry) -> Geometry:
    """Return a point well inside a polygon; for a point, itself."""
    return geometry if geometry.is_point else _inside(geometry)


@lru_cache(maxsize=MEMO)
def _inside(geometry: Geometry) -> Geometry:
    frame = local_frame(_middle(geometry))
    spot = deep_spot(frame.project(planar(geometry)), 0.001)
    inside = spot and intern((frame.position(*spot),))
    if not inside or not contains(geometry, inside):
        raise GeometryError(
            "too-thin",
            f"no position on the grid of 1 cm lies inside {geometry!r}",
            "widen the place to a metre or more",
        )
    return inside


def deep_spot(shape: shapely.Polygon, clearance: float) -> tuple[float, float] | None:
    """Return a spot well inside a polygon; None if none is farther from its border than `clearance`.

    The border is moved inwards as far as possible, in steps of a fifth; the result is the middle of the rest. The area
    is at most the border's length times the greatest depth, so the rest is not empty at the ratio of the two.
    """
    depth = 2 * shape.area / shape.length
    while depth > clearance:
        core = max(
            shapely.get_parts(shape.buffer(-depth, quad_segs=2)), key=lambda part: part.area, default=None
        )
        if core is not None and not core.is_empty:
            middle = core.centroid
            spot = middle if core.contains(middle) else core.representative_point()
            return (spot.x, spot.y)
        depth *= 0.8
    return None


@lru_cache(maxsize=1 << 10)
def waypoint(geometry: Geometry) -> Geometry:
    """Return the waypoint for a geometry: the centroid if it lies inside, else an interior point."""
    middle = centroid(geometry)
    return middle if geometry.is_point or contains(geometry, middle) else interior_point(geometry)


def metres_text(metres: float) -> str:
    """Return a length as text.

    >>> metres_text(500.0), metres_text(2400.0), metres_text(5000.0), metres_text(1234567.0)
    ('500 m', '2.4 km', '5 km', '1,235 km')
    """
    if metres < 1000:
        return f"{metres:,.0f} m"
    digits = 0 if metres >= 10_000 or metres % 1000 < 50 else 1
    return f"{metres / 1000:,.{digits}f} km"
