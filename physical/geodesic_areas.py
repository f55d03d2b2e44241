"""Areas with geodesic borders: the sources of regions, and hulls of several.

The edges of places are straight in latitude and longitude. Here they are followed by chords, which are shortest lines,
to `CHORD` metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache, reduce
from itertools import pairwise
from typing import Any, Final

import numpy as np
import shapely

from physical.frame import E7, EARTH_RADIUS, geod
from physical.gnomonic import Disc, GnomonicFrame, RegionError, around, check_reach, frame_of, stretch
from physical.regions import FaceCover, RegionPart, Source
from physical.shape import MEMO, Geometry, planar

CHORD: Final = 0.02
"""Metres by which a border may leave its chords."""

ROUND: Final = 32
"""The least number of corners of a polygon that may stand for a circle."""

MOST_CHORDS: Final = 4_000
"""The largest number of chords of one edge: enough for 1,000 km at any latitude up to 80 degrees."""


@dataclass(frozen=True, slots=True, eq=False)
class GeodesicArea:
    """A point, a line or a polygon; its edges are shortest lines.

    Attributes:
        shape: Its vertices as longitudes and latitudes in degrees; longitudes may be a turn off.
        disc: A disc around it.
    """

    shape: shapely.Geometry
    disc: Disc

    @property
    def border(self) -> GeodesicArea:
        """Return the border of a polygon."""
        return _border(self)


@lru_cache(maxsize=MEMO)
def _border(area: GeodesicArea) -> GeodesicArea:
    return GeodesicArea(area.shape.boundary, area.disc)


def area_of(part: RegionPart) -> GeodesicArea:
    """Return the area of a part without its margin.

    Raises:
        RegionError: If it is too large.
    """
    return _hull(part.sources) if part.spanned else source_area(part.sources[0])


@lru_cache(maxsize=MEMO)
def disc_of(part: RegionPart) -> Disc:
    """Return a disc around a part, with its margin.

    Raises:
        RegionError: If the part is too large, or covers a pole.
    """
    area = area_of(part)
    if not part.is_exact:
        _check_pole(area, part.margin)
    return area.disc.grown(part.margin)


def _check_pole(area: GeodesicArea, margin: float) -> None:
    pole = Disc(math.copysign(90.0, area.disc.latitude), 0.0, 0.0)
    if pole.least(area.disc) > margin:
        return
    frame = frame_of(area.disc)
    spot = shapely.Point(frame.plane(np.array([[pole.longitude, pole.latitude]]))[0])
    if shapely.distance(projected(area, frame), spot) <= margin * stretch(area.disc.radius) + 0.5:
        raise RegionError(
            "region-over-a-pole",
            "a region covers a pole",
            "fly around it by places (VIA): shortest lines near a pole cross it",
        )


@lru_cache(maxsize=MEMO)
def projected(area: GeodesicArea, frame: GnomonicFrame) -> shapely.Geometry:
    """Return an area in a frame, prepared."""
    shape = frame.project(area.shape)
    shapely.prepare(shape)
    return shape


# --- sources --------------------------------------------------------------------------------------


@lru_cache(maxsize=MEMO)
def source_area(source: Source) -> GeodesicArea:
    """Return the area of a source."""
    shape = _chords(planar(source) if isinstance(source, Geometry) else _face(source))
    return GeodesicArea(shape, _disc(shape))


@lru_cache(maxsize=MEMO)
def circle_sagitta(source: Source) -> float:
    """Return the metres by which a circle leaves the polygon that stands for it; 0 if a source is no circle.

    A circle is any polygon of many corners that are about as far from its middle; its edges are its chords.
    """
    if isinstance(source, FaceCover) or len(source.ring) < ROUND:
        return 0.0
    positions = np.array([(east, north) for north, east in source.vertices])
    disc = source_area(source).disc
    middles = np.full_like(positions, (disc.longitude, disc.latitude))
    _, _, metres = geod().inv(*middles.T, *positions.T)
    if metres.min() < 0.99 * metres.max():
        return 0.0
    return float(metres.max()) * (1.0 - math.cos(math.pi / len(positions)))


def _face(cover: FaceCover) -> shapely.Geometry:
    shell, *holes = ([(east, north) for north, east in ring] for ring in (cover.shell, *cover.holes))
    return shapely.Polygon(shell, holes)


def _chords(shape: shapely.Geometry) -> shapely.Geometry:
    """Return a planar shape (1e-7 degree) in degrees, with long edges cut into chords."""
    if shape.geom_type == "Point":
        return shapely.Point(shape.x / E7, shape.y / E7)
    shell, *holes = (_cut_ring(np.array(ring.coords) / E7) for ring in (shape.exterior, *shape.interiors))
    return shapely.Polygon(shell, holes)


def _cut_ring(corners: Any) -> Any:
    return np.concatenate([_cut(here, there) for here, there in pairwise(corners)])


def _cut(here: Any, there: Any) -> Any:
    """Return the vertices of an edge but for its end, close enough for chords.

    A line that is straight in latitude and longitude bends on the sphere. The acceleration over its whole length is at
    most sin φ · (cos φ Δλ² + 2 Δφ Δλ) radians. An eighth of this is its sagitta.
    """
    (east, north), (to_east, to_north) = np.radians(here), np.radians(there)
    across, along = abs(to_east - east), abs(to_north - north)
    steepest = max(abs(north), abs(to_north))
    flattest = 0.0 if north * to_north < 0.0 else min(abs(north), abs(to_north))
    sagitta = EARTH_RADIUS * math.sin(steepest) * across * (math.cos(flattest) * across + 2 * along) / 8
    count = min(MOST_CHORDS, max(1, math.ceil(math.sqrt(sagitta / CHORD))))
    return here + np.linspace(0.0, 1.0, count, endpoint=False)[:, None] * (there - here)


def _disc(shape: shapely.Geometry) -> Disc:
    """Return a small disc around a shape in degrees; its farthest points are vertices."""
    positions = shapely.get_coordinates(shape)
    if len(positions) == 1:
        return Disc(float(positions[0, 1]), float(positions[0, 0]), 0.0)
    return _measured(positions, *_middle(positions))


def _middle(positions: Any) -> tuple[float, float]:
    """Return the latitude and the longitude of the middle of positions as seen from the earth's centre."""
    east, north = np.radians(positions).T
    vectors = np.column_stack([np.cos(north) * np.cos(east), np.cos(north) * np.sin(east), np.sin(north)])
    x, y, z = (vectors.max(axis=0) + vectors.min(axis=0)) / 2
    return math.degrees(math.atan2(z, math.hypot(x, y))), math.degrees(math.atan2(y, x))


def _measured(positions: Any, latitude: float, longitude: float) -> Disc:
    count = len(positions)
    _, _, metres = geod().inv(
        np.full(count, longitude), np.full(count, latitude), positions[:, 0], positions[:, 1]
    )
    return Disc(latitude, longitude, float(metres.max()))


# --- hulls ----------------------------------------------------------------------------------------


@lru_cache(maxsize=MEMO)
def _hull(sources: tuple[Source, ...]) -> GeodesicArea:
    """Return the hull of sources: the smallest set with every shortest line between its points."""
    areas = [source_area(source) for source in sources]
    positions = np.concatenate([shapely.get_coordinates(area.shape) for area in areas])
    around_all = reduce(around, (area.disc for area in areas))
    disc = _measured(positions, around_all.latitude, around_all.longitude)
    check_reach(disc, "a region")
    frame = frame_of(disc)
    hull = shapely.MultiPoint(frame.plane(positions)).convex_hull
    return GeodesicArea(frame.unproject(hull), disc)
