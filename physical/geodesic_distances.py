"""Distances between geodesic areas: the nearest points of two, and the farthest.

Two segments that do not meet are nearest at an end of one of them: shortest lines converge on the earth, so a common
perpendicular is never the least distance. So the nearest points of two areas are a vertex of one and a point of an edge
of the other. The gnomonic frame chooses the candidates, and geodesics measure them.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, Final, NamedTuple

import numpy as np
import shapely

from physical.frame import geod
from physical.geodesic_areas import GeodesicArea, projected
from physical.gnomonic import (
    SPHERE,
    Disc,
    GnomonicFrame,
    around,
    beside,
    check_reach,
    frame_of,
    slack,
    stretch,
)
from physical.shape import MEMO

MOST_KNOWN: Final = 1 << 17
"""The number of rough distances that are kept."""

MOST_PAIRS: Final = 400_000
"""The largest number of vertices times edges that are compared at once."""

STEPS: Final = 4
"""Newton's steps towards the foot of a perpendicular; each squares the relative error."""

PRECISION: Final = 1e-3
"""Metres: a frame's nearest points are good enough if no others can be nearer by more."""

Positions = Any
"""An array with rows of longitude and latitude in degrees."""


class GeodesicLine(NamedTuple):
    """The shortest line between two points: its metres, and its ends (longitude, latitude)."""

    metres: float
    first: tuple[float, float]
    second: tuple[float, float]


def shared_frame(a: Disc, b: Disc) -> tuple[GnomonicFrame, float]:
    """Return a frame for two discs, and a bound of the metres that they reach from its centre.

    Raises:
        RegionError: If they reach too far from their common middle.
    """
    both = around(a, b)
    check_reach(both, "a comparison of two regions")
    return frame_of(both), both.radius + beside(both)


@lru_cache(maxsize=MOST_KNOWN)
def rough_distance(a: GeodesicArea, b: GeodesicArea) -> tuple[float, float]:
    """Return a lower and an upper bound of the distance between two areas, in metres; both are 0 if they meet."""
    frame, reach = shared_frame(a.disc, b.disc)
    apart = float(shapely.distance(projected(a, frame), projected(b, frame)))
    return apart / stretch(reach), apart


@lru_cache(maxsize=MEMO)
def nearest_line(a: GeodesicArea, b: GeodesicArea) -> GeodesicLine:
    """Return the shortest line between two areas, of 0 metres if they meet."""
    if a.shape.geom_type == b.shape.geom_type == "Point":
        return _line(_ends(a.shape, b.shape))
    frame, reach = shared_frame(a.disc, b.disc)
    one, other = projected(a, frame), projected(b, frame)
    if shapely.intersects(one, other):
        meeting = shapely.intersection(one, other).representative_point()
        spot = tuple(frame.positions(shapely.get_coordinates(meeting))[0].tolist())
        return GeodesicLine(0.0, spot, spot)
    found = _line(frame.positions(shapely.get_coordinates(shapely.shortest_line(one, other))))
    longest = found.metres * stretch(reach)
    if longest - found.metres <= PRECISION:
        return found
    there = _measured_pairs(one, other, frame, longest)
    back = _measured_pairs(other, one, frame, longest)
    return min([found, *there, *(GeodesicLine(each.metres, each.second, each.first) for each in back)])


def _ends(a: shapely.Point, b: shapely.Point) -> Positions:
    return np.array([[a.x, a.y], [b.x, b.y]])


def _line(ends: Positions) -> GeodesicLine:
    (east, north), (to_east, to_north) = ends.tolist()
    return GeodesicLine(
        float(geod().inv(east, north, to_east, to_north)[2]), (east, north), (to_east, to_north)
    )


def _measured_pairs(
    one: shapely.Geometry, other: shapely.Geometry, frame: GnomonicFrame, longest: float
) -> list[GeodesicLine]:
    """Return the shortest line from a vertex of one shape to an edge of another; none over `longest` in the frame."""
    spots, (starts, ends) = _vertices(one), _edges(other)
    spots = spots[shapely.dwithin(shapely.points(spots), other, longest)]
    near = shapely.dwithin(shapely.linestrings(np.stack([starts, ends], axis=1)), one, longest)
    starts, ends = starts[near], ends[near]
    best: list[GeodesicLine] = []
    rows = max(1, MOST_PAIRS // max(1, len(starts)))
    for at in range(0, len(spots), rows):
        part = spots[at : at + rows]
        apart, shares = _apart_in_frame(part, starts, ends)
        which, edge = np.nonzero(apart <= longest)
        if len(which):
            metres, feet = _perpendiculars(frame, part[which], starts[edge], ends[edge], shares[which, edge])
            least = int(metres.argmin())
            vertex = frame.positions(part[which[least]][None])[0]
            best.append(
                GeodesicLine(float(metres[least]), tuple(vertex.tolist()), tuple(feet[least].tolist()))
            )
    return best


def _vertices(shape: shapely.Geometry) -> Any:
    return np.unique(shapely.get_coordinates(shape), axis=0)


def _edges(shape: shapely.Geometry) -> tuple[Any, Any]:
    """Return the starts and the ends of a shape's edges; a point is an edge of no length."""
    rings = [shapely.get_coordinates(ring) for ring in _rings(shape)]
    starts = np.concatenate([ring[:-1] if len(ring) > 1 else ring for ring in rings])
    ends = np.concatenate([ring[1:] if len(ring) > 1 else ring for ring in rings])
    return starts, ends


def _rings(shape: shapely.Geometry) -> list[shapely.Geometry]:
    parts = shapely.get_parts(shape)
    return [
        ring
        for part in parts
        for ring in (shapely.get_rings(part) if part.geom_type == "Polygon" else [part])
    ]


def _apart_in_frame(spots: Any, starts: Any, ends: Any) -> tuple[Any, Any]:
    """Return the distance in the frame of each spot from each edge, and the foot's share of the edge."""
    edges = ends - starts
    lengths = np.maximum((edges * edges).sum(axis=1), 1e-12)
    beside = spots[:, None, :] - starts[None, :, :]
    shares = np.clip((beside * edges).sum(axis=2) / lengths, 0.0, 1.0)
    apart = beside - shares[:, :, None] * edges
    return np.hypot(apart[:, :, 0], apart[:, :, 1]), shares


def _perpendiculars(
    frame: GnomonicFrame, spots: Any, starts: Any, ends: Any, shares: Any
) -> tuple[Any, Positions]:
    """Return the geodesic distance of each spot from its edge, and the foot on the edge."""
    spots, starts, ends = frame.positions(spots), frame.positions(starts), frame.positions(ends)
    ahead, _, lengths = geod().inv(*starts.T, *ends.T)
    along = shares * lengths
    for step in range(STEPS):
        easts, norths, back = geod().fwd(starts[:, 0], starts[:, 1], ahead, along)
        azimuths, _, metres = geod().inv(easts, norths, *spots.T)
        if step < STEPS - 1:
            turned = np.cos(np.radians(azimuths - (back + 180.0)))
            along = np.clip(along + SPHERE * np.arctan(np.tan(metres / SPHERE) * turned), 0.0, lengths)
    return metres, np.column_stack([easts, norths])


# --- many points and one area -----------------------------------------------------------------------


class Feet(NamedTuple):
    """The distance of each of several points from an area, and its nearest point there."""

    metres: Any
    feet: Positions


def feet_on(positions: Positions, area: GeodesicArea) -> Feet:
    """Return the nearest points of an area to each of some positions; a position inside is its own."""
    disc = _disc_of(positions)
    frame, reach = shared_frame(disc, area.disc)
    shape, spots = projected(area, frame), frame.plane(positions)
    metres, feet = np.zeros(len(spots)), np.array(positions, dtype=float)
    (outside,) = np.nonzero(~shapely.intersects(shape, shapely.points(spots)))
    starts, ends = _edges(shape)
    rows = max(1, MOST_PAIRS // len(starts))
    for at in range(0, len(outside), rows):
        part = outside[at : at + rows]
        apart, shares = _apart_in_frame(spots[part], starts, ends)
        which, edge = np.nonzero(apart <= apart.min(axis=1, keepdims=True) * stretch(reach) + PRECISION)
        found, at_foot = _perpendiculars(
            frame, spots[part][which], starts[edge], ends[edge], shares[which, edge]
        )
        order = np.lexsort((found, which))
        first = order[np.unique(which[order], return_index=True)[1]]
        metres[part], feet[part] = found[first], at_foot[first]
    return Feet(metres, feet)


def _disc_of(positions: Positions) -> Disc:
    middle = positions[0]
    _, _, metres = geod().inv(*np.broadcast_to(middle, positions.shape).T, *positions.T)
    return Disc(float(middle[1]), float(middle[0]), float(metres.max()))


# --- the farthest points ------------------------------------------------------------------------------


@lru_cache(maxsize=MEMO)
def greatest_distance_of(a: GeodesicArea, b: GeodesicArea) -> float:
    """Return the greatest distance in metres of a point of one area from one of another.

    The distance to a point is convex within a quarter of the earth, so the farthest points are vertices of hulls.
    """
    frame, _ = shared_frame(a.disc, b.disc)
    one, other = (_vertices(projected(each, frame).convex_hull) for each in (a, b))
    one, other = frame.positions(one), frame.positions(other)
    chords = np.linalg.norm(_vectors(one)[:, None, :] - _vectors(other)[None, :, :], axis=2)
    first, second = np.nonzero(chords >= chords.max() * (1 - 2 * _ELLIPTIC))
    return float(np.max(geod().inv(*one[first].T, *other[second].T)[2]))


_ELLIPTIC: Final = 0.007
"""A bound of the relative error of a chord of the unit sphere."""


def _vectors(positions: Positions) -> Any:
    east, north = np.radians(positions).T
    return np.column_stack([np.cos(north) * np.cos(east), np.cos(north) * np.sin(east), np.sin(north)])


# --- areas around an area -----------------------------------------------------------------------------

ROUNDS: Final = (16, 64, 256, 1_024, 1_024)
"""For each round the corners on the arc towards the rest, coarse to fine."""

ARC: Final = 40.0
"""The degrees of that arc."""

ROUNDING: Final = 0.3
"""The share of the doubt by which a capsule is too small."""


@lru_cache(maxsize=MEMO)
def lies_within(a: GeodesicArea, b: GeodesicArea, metres: float) -> bool:
    """Whether every point of one area is surely within some metres of another; false in doubt.

    Capsules around the edges of the other area are cut off the first one. Few edges are as far from the rest as the
    metres, so the next capsules can have more corners.
    """
    if (feet_on(shapely.get_coordinates(a.shape), b).metres > metres).any():
        return False
    if "Point" in (a.shape.geom_type, b.shape.geom_type):
        return True  # no point is farther than the corners
    frame, reach = shared_frame(a.disc, b.disc)
    rounding = ROUNDING * slack(reach)
    rest = shapely.difference(projected(a, frame), projected(b, frame))
    starts, ends = _pieces(projected(b, frame), metres, rounding)
    for corners in ROUNDS:
        if rest.is_empty or _is_beyond(frame, rest, b, metres):
            break
        near = shapely.dwithin(_lines(starts, ends), rest, metres * stretch(reach))
        if not near.any():
            break
        starts, ends = starts[near], ends[near]
        capsules = _capsules(frame, rest, (starts, ends), metres - rounding, corners)
        rest = shapely.difference(rest, shapely.union_all(shapely.clip_by_rect(capsules, *_around(rest))))
    return bool(rest.is_empty)


def _lines(starts: Any, ends: Any) -> Any:
    return shapely.linestrings(np.stack([starts, ends], axis=1))


def _pieces(shape: shapely.Geometry, metres: float, rounding: float) -> tuple[Any, Any]:
    """Return the edges of a shape, cut so short that a line beside one, at a distance, hardly bends away from it."""
    longest = SPHERE * math.sqrt(4 * rounding / max(metres, 1.0))
    return _edges(shapely.segmentize(shape, longest))


def _is_beyond(frame: GnomonicFrame, rest: shapely.Geometry, b: GeodesicArea, metres: float) -> bool:
    """Whether a point of some parts is farther from an area than some metres, as far as their middles show."""
    middles = shapely.get_coordinates(shapely.point_on_surface(shapely.get_parts(rest)))
    return bool((feet_on(frame.positions(middles), b).metres > metres).any())


def _around(rest: shapely.Geometry) -> tuple[float, float, float, float]:
    """Return a rectangle around a shape."""
    west, south, east, north = rest.bounds
    return west - 1.0, south - 1.0, east + 1.0, north + 1.0


def _capsules(
    frame: GnomonicFrame, rest: shapely.Geometry, edges: tuple[Any, Any], metres: float, corners: int
) -> Any:
    """Return for each edge an area without a point farther than some metres from it, with round ends."""
    around = np.linspace(0.0, 360.0, ROUNDS[0], endpoint=False)
    offsets = np.concatenate([around, np.linspace(-ARC / 2, ARC / 2, corners)])
    rims = [_rims(frame, spots, _azimuths(spots, rest)[:, None] + offsets, metres) for spots in edges]
    return shapely.convex_hull(shapely.multipoints(np.concatenate(rims, axis=1)))


def _azimuths(spots: Any, rest: shapely.Geometry) -> Any:
    """Return the approximate azimuth in degrees of the nearest point of a shape, for each spot of a frame."""
    ahead = shapely.get_coordinates(shapely.shortest_line(shapely.points(spots), rest))[1::2] - spots
    return np.degrees(np.arctan2(ahead[:, 0], ahead[:, 1]))


def _rims(frame: GnomonicFrame, spots: Any, azimuths: Any, metres: float) -> Any:
    """Return for each spot the points of the frame that are some metres from it."""
    centres = np.repeat(frame.positions(spots), azimuths.shape[1], axis=0)
    far = np.full(len(centres), max(metres, 0.0))
    easts, norths, _ = geod().fwd(centres[:, 0], centres[:, 1], azimuths.ravel(), far)
    return frame.plane(np.column_stack([easts, norths])).reshape(*azimuths.shape, 2)
