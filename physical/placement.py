"""Placement of a mover: a rigid translation, in the local metric frame of the place around it.

A mover is a point or a polygon. A polygon keeps its metric shape (to the frame's 4e-5 at 100 km) and its heading in the
frame. Every placement is computed from the original polygon, so errors do not accumulate.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import Final

import shapely
from shapely.affinity import translate

from physical.errors import GeometryError
from physical.frame import LocalFrame, local_frame
from physical.geometry_measures import centroid
from physical.shape import Geometry, canonical, contains, covers, intern, planar

MARGINS: Final = (0.05, 0.5, 5.0)
"""Metres between a placement and the borders; the first value that survives rounding is used."""

MAX_PIECES: Final = 60_000
"""The largest number of pieces in the erosion of a polygon by a mover."""

CONVEXITY: Final = 0.03
"""The permitted depth in metres of dents in a convex polygon: its coordinates are rounded to 1 cm."""

Offset = tuple[float, float]
"""Metres to the east and to the north."""


def template(mover: Geometry) -> Geometry:
    """Return the original geometry of a mover: itself, if it was never moved."""
    return mover.template or mover


@lru_cache(maxsize=1 << 12)
def outline(polygon: Geometry) -> tuple[Offset, ...]:
    """Return the vertices of an unmoved polygon in metres from its centroid; long edges are divided."""
    frame = local_frame(centroid(polygon).ring[0])
    return tuple(frame.project(planar(polygon)).exterior.coords[:-1])


def placed(mover: Geometry, frame: LocalFrame, x: float, y: float) -> Geometry:
    """Return the mover with its centroid (rounded to 1e-7 degree) at x and y metres of a frame."""
    anchor = frame.position(x, y)
    if mover.is_point:
        return intern((anchor,))
    still = template(mover)
    if centroid(still).ring[0] == anchor:
        return still
    east, north = frame.metres(anchor)
    ring = [frame.position(east + dx, north + dy) for dx, dy in outline(still)]
    return canonical(ring, still, anchor)


def translate_to(mover: Geometry, position: Geometry) -> Geometry:
    """Return the mover with its centroid at a point, its metric shape and heading preserved."""
    return placed(mover, local_frame(centroid(position).ring[0]), 0.0, 0.0)


def nearest_placement(mover: Geometry, target: Geometry, holes: Sequence[Geometry] = ()) -> Geometry | None:
    """Return the placement nearest to the target's centroid, inside the target and outside all holes.

    A point is in a hole if it lies inside it or on its border, a polygon if the hole contains it. The placement keeps 5
    cm from every border that bounds it. The result is None if there is no such placement. Ties go to the northern-most,
    then to the eastern-most one.

    Raises:
        GeometryError: If the borders are too detailed for the mover.
    """
    if target.is_point:
        return None
    return _nearest(still(mover), target, tuple(sorted(set(holes))))


_ANY_POINT: Final = intern(((0, 0),))


def still(mover: Geometry) -> Geometry:
    """Return the original geometry of a mover; one point stands for all, since a point has no shape."""
    return _ANY_POINT if mover.is_point else template(mover)


@lru_cache(maxsize=1 << 14)
def _nearest(mover: Geometry, target: Geometry, holes: tuple[Geometry, ...]) -> Geometry | None:
    frame = local_frame(centroid(target).ring[0])
    central = _tried(mover, frame, (0.0, 0.0))
    if _stands(central, target, holes):
        return central
    free = _free(mover, frame, target, holes)
    for margin in MARGINS:
        spot = nearest_spot(free.buffer(-margin))
        if spot is None:
            return None
        found = _tried(mover, frame, spot)
        if _stands(found, target, holes):
            return found
    return None


def _tried(mover: Geometry, frame: LocalFrame, spot: Offset) -> Geometry | None:
    try:
        return placed(mover, frame, *spot)
    except GeometryError:  # over a pole
        return None


def _stands(mover: Geometry | None, target: Geometry, holes: Iterable[Geometry]) -> bool:
    return mover is not None and contains(target, mover) and not any(swallows(hole, mover) for hole in holes)


def swallows(hole: Geometry, mover: Geometry) -> bool:
    """Whether a mover is in a hole: a point inside it or on its border, a polygon contained in it."""
    return contains(hole, mover) if hole.is_point or not mover.is_point else covers(hole, mover)


def _free(
    mover: Geometry, frame: LocalFrame, target: Geometry, holes: Iterable[Geometry]
) -> shapely.Geometry:
    space = frame.project(planar(target))
    shapes = [frame.project(planar(hole)) for hole in holes if not hole.is_point]
    taken = [shape for shape in shapes if shape.intersects(space)]
    if not mover.is_point:
        reach = _reach(space, taken, outline(mover))
        space, taken = room(space, mover, reach), [room(hole, mover, reach) for hole in taken]
        space = space.intersection(shapely.Point(0, 0).buffer(reach)) if reach < math.inf else space
    return space.difference(shapely.union_all(taken)) if taken else space


def _reach(space: shapely.Polygon, taken: Sequence[shapely.Polygon], offsets: Sequence[Offset]) -> float:
    """Return an upper bound of the distance from the origin to the nearest placement: where a disc around it fits.

    Borders farther away don't matter, which makes placement in a country as fast as in a harbour.
    """
    radius = max(math.hypot(*offset) for offset in offsets) + 2 * MARGINS[-1]
    roomy = space.buffer(-radius).difference(shapely.union_all([hole.buffer(radius) for hole in taken]))
    spot = nearest_spot(roomy)
    return math.inf if spot is None else 1.01 * math.hypot(*spot) + 2 * MARGINS[-1]


def room(space: shapely.Polygon, mover: Geometry, reach: float = math.inf) -> shapely.Geometry:
    """Return the positions of an unmoved mover's centroid at which it is inside a polygon in a metric frame.

    This is the Minkowski erosion: the mover is inside if one of its vertices is, and its border doesn't meet the
    polygon's. The result is valid within `reach` metres of the origin.
    """
    offsets = outline(mover)
    far = reach + max(math.hypot(*offset) for offset in offsets)
    edges = [edge for edge in pairwise(space.exterior.coords) if math.hypot(*_foot(*edge)) <= far]
    return translate(space, -offsets[0][0], -offsets[0][1]).difference(_obstacle(edges, offsets))


def _obstacle(edges: Sequence[tuple[Offset, Offset]], offsets: Sequence[Offset]) -> shapely.Geometry:
    """Return the positions of a mover's centroid at which its border (of a convex one, any part) meets an edge."""
    parts = [offsets] if is_convex(offsets) else list(pairwise([*offsets, offsets[0]]))
    if len(edges) * len(parts) > MAX_PIECES:
        raise GeometryError(
            "too-detailed",
            f"a border of {len(edges)} edges is too detailed for a mover of {len(offsets)} vertices",
            "simplify the place or the mover",
        )
    if not edges:
        return shapely.Polygon()
    swept = [[(x - dx, y - dy) for x, y in edge for dx, dy in part] for edge in edges for part in parts]
    return shapely.union_all(shapely.convex_hull(shapely.linestrings(swept)))


def is_convex(offsets: Sequence[Offset]) -> bool:
    """Whether a polygon is convex, up to dents from rounding."""
    hull = shapely.MultiPoint(offsets).convex_hull.exterior
    return all(bool(hull.distance(shapely.Point(offset)) <= CONVEXITY) for offset in offsets)


def nearest_spot(free: shapely.Geometry) -> Offset | None:
    """Return the point of a planar shape nearest to the origin; ties (to 1 cm) go to the northern-most."""
    if free.is_empty:
        return None
    if free.contains(shapely.Point(0, 0)):
        return (0.0, 0.0)
    edges = [edge for ring in shapely.get_parts(free.boundary) for edge in pairwise(ring.coords)]
    spots = [_foot(*edge) for edge in edges]
    least = min(x * x + y * y for x, y in spots) ** 0.5
    near = [(x, y) for x, y in spots if (x * x + y * y) ** 0.5 <= least + 0.01]
    return max(near, key=lambda spot: (round(spot[1], 1), round(spot[0], 1)))


def _foot(a: tuple[float, float], b: tuple[float, float]) -> Offset:
    """Return the point of a segment nearest to the origin."""
    (ax, ay), (dx, dy) = a, (b[0] - a[0], b[1] - a[1])
    length = dx * dx + dy * dy
    along = min(1.0, max(0.0, -(ax * dx + ay * dy) / length)) if length else 0.0
    return (ax + along * dx, ay + along * dy)
