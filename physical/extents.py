"""Extents: regions of possible positions, with the least and greatest distance of two of them, in metres.

Both bounds are rounded outwards: bent edges are followed in a metric frame, and the possible error is subtracted or
added. In the frame around a centre, lengths along its rays are those of the earth. Lengths across are too long, at
most by the factor c/sin(c), with c the angle from the centre. This is Rauch's bound: the ellipsoid nowhere bends more
than a sphere of its polar radius.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import Any, Final

import numpy as np
import shapely
from shapely.affinity import translate

from physical.frame import CHORD_TOLERANCE, E7, TURN, LocalFrame, geod, local_frame, rounded
from physical.shape import MEMO, Geometry, planar

POLAR_RADIUS: Final = 6_356_752.0
"""Half the earth's axis in metres."""

FARTHEST: Final = 20_003_932.0
"""The distance from pole to pole in metres: no two points of the earth are farther apart."""

QUARTER: Final = 9_900_000.0
"""Up to this distance, the distance to a point is convex, so the farthest points of a place are corners of its hull."""

LARGE: Final = 1_000_000.0
"""The radius in metres of a place beyond which only samples of its border are used."""

SAMPLES: Final = 512
"""The approximate number of samples; a hull with more corners is simplified, and the error is added."""

NOISE: Final = 1e-6
"""The error in metres of a geodesic's length."""


@dataclass(frozen=True, slots=True)
class Extent:
    """All points within `margin` metres of a geometry, or of the geodesic hull of several.

    Attributes:
        parts: The geometries, sorted; one unless `spanned`.
        spanned: Whether every geodesic between points of the parts belongs to it.
        margin: Metres around.
    """

    parts: tuple[Geometry, ...]
    spanned: bool = False
    margin: float = 0.0


def extent(geometry: Geometry, margin: float = 0.0) -> Extent:
    """Return all points within `margin` metres of a geometry."""
    return Extent((geometry,), margin=margin)


def span(extents: Iterable[Extent]) -> Extent:
    """Return the hull of extents: their points, and all geodesics between them."""
    known = tuple(extents)
    parts = sorted({part for each in known for part in each.parts})
    return Extent(tuple(parts), spanned=True, margin=max(each.margin for each in known))


def least_distance(a: Extent, b: Extent) -> float:
    """Return a lower bound, in metres, of the distance between points of two extents; 0 if they meet.

    >>> from physical import box, point
    >>> round(least_distance(extent(box((37, -9), (37.1, -8.9))), extent(point(37.05, -8.8))))
    8895
    """
    return max(0.0, _least(a.parts, a.spanned, b.parts, b.spanned) - a.margin - b.margin)


def greatest_distance(a: Extent, b: Extent) -> float:
    """Return an upper bound, in metres, of the distance between points of two extents.

    >>> from physical import box, point
    >>> round(greatest_distance(extent(box((37, -9), (37.1, -8.9))), extent(point(37.05, -8.8), 10)))
    18652
    """
    apart = max(_greatest(one, other) for one, other in product(a.parts, b.parts))
    return FARTHEST if apart > QUARTER else apart + a.margin + b.margin


# --- samples and hulls ----------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Points:
    """Sample points (longitudes and latitudes in degrees), and the largest distance of any other point from them."""

    positions: Any
    missed: float

    def apart(self, other: _Points) -> Any:
        """Return the distances in metres from each point to each of the others."""
        (easts, norths), (wests, souths) = self.positions, other.positions
        pairs = (np.repeat(easts, len(wests)), np.repeat(norths, len(wests)))
        return geod().inv(*pairs, np.tile(wests, len(easts)), np.tile(souths, len(easts)))[2]


@lru_cache(maxsize=MEMO)
def _samples(geometry: Geometry) -> _Points:
    """Return samples of a border; every other point of it is at most `missed` metres from one of them."""
    shape = planar(geometry)
    if geometry.is_point:
        return _Points(np.array([[shape.x / E7], [shape.y / E7]]), 0.0)
    step = shape.length / SAMPLES
    coordinates = shapely.get_coordinates(shapely.segmentize(shape, step).exterior)
    return _Points(coordinates.T / E7, math.radians(step / E7) * 6_400_000.0 / 2)  # the poles bend least


@lru_cache(maxsize=MEMO)
def _corners(geometry: Geometry) -> _Points:
    """Return the corners of a geometry's hull, in the frame around its middle."""
    frame, shape = _framed(planar(geometry))
    if geometry.is_point or _reach(shape) > LARGE:
        return _samples(geometry)
    hull = simpler = shape.convex_hull
    cut = 0.0
    while len(simpler.exterior.coords) > SAMPLES:
        cut = 2 * cut + CHORD_TOLERANCE
        simpler = hull.simplify(cut)
    positions = np.array(frame.proj(*shapely.get_coordinates(simpler).T, inverse=True))
    return _Points(positions, cut + _bend(_reach(hull), spanned=True))


def _together(geometries: Iterable[Geometry]) -> shapely.GeometryCollection:
    """Return geometries in one plane, each shifted by the turn that brings it nearest to the first."""
    shapes = [planar(each) for each in geometries]
    turns = [round((shapes[0].bounds[0] - each.bounds[0]) / TURN) * TURN for each in shapes]
    return shapely.GeometryCollection([translate(*pair) for pair in zip(shapes, turns, strict=True)])


def _framed(shape: shapely.Geometry) -> tuple[LocalFrame, shapely.Geometry]:
    west, south, east, north = shape.bounds
    frame = local_frame(rounded((south + north) / 2 / E7, (west + east) / 2 / E7))
    return frame, frame.project(shape)


def _reach(*shapes: shapely.Geometry) -> float:
    """Return the largest distance of shapes from the centre of their frame."""
    return max(float(np.hypot(*shapely.get_coordinates(shape).T).max()) for shape in shapes)


def _bend(reach: float, spanned: bool) -> float:
    """Return the largest distance, in metres, of edges and a hull's geodesics from their chords in a frame.

    A geodesic of half length l, at distance h from the centre, leaves its chord by h·l²/3R², at most 0.13 reach³/R².
    """
    edges = CHORD_TOLERANCE + 1e-6 * reach
    return edges + 0.2 * reach * (reach / POLAR_RADIUS) ** 2 if spanned else edges


# --- bounds ---------------------------------------------------------------------------------------


@lru_cache(maxsize=MEMO)
def _greatest(a: Geometry, b: Geometry) -> float:
    one, other = _corners(a), _corners(b)
    return float(one.apart(other).max()) + one.missed + other.missed + NOISE


@lru_cache(maxsize=MEMO)
def _least(a: tuple[Geometry, ...], a_spanned: bool, b: tuple[Geometry, ...], b_spanned: bool) -> float:
    if len(a) == len(b) == 1 and a[0].is_point and b[0].is_point:
        return _least_sampled(a[0], b[0])
    _, drawn = _framed(_together([*a, *b]))
    if (reach := _reach(drawn)) > LARGE:
        return 0.0 if a_spanned or b_spanned else min(_least_sampled(*pair) for pair in product(a, b))
    one = shapely.GeometryCollection(drawn.geoms[: len(a)])
    other = shapely.GeometryCollection(drawn.geoms[len(a) :])
    apart = shapely.distance(one.convex_hull if a_spanned else one, other.convex_hull if b_spanned else other)
    angle = reach / POLAR_RADIUS
    stretched = angle / math.sin(angle) if angle else 1.0
    return float(apart / stretched - _bend(reach, a_spanned) - _bend(reach, b_spanned))


def _least_sampled(a: Geometry, b: Geometry) -> float:
    if shapely.intersects(*_together((a, b)).geoms):
        return 0.0
    one, other = _samples(a), _samples(b)
    return float(one.apart(other).min()) - one.missed - other.missed - NOISE
