"""The outlines of regions as polygons in latitude and longitude, for maps and GeoJSON.

The edges of an outline, straight in latitude and longitude, leave the region's border by less than a metre. An outline
with a margin is never smaller than its part by more.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, Final, TypeAlias

import numpy as np
import shapely

from physical.frame import EARTH_RADIUS, Position, geod
from physical.geodesic_areas import area_of, disc_of
from physical.gnomonic import Disc, frame_of
from physical.regions import RegionPart
from physical.shape import MEMO

STEP: Final = 2_000.0
"""The longest edge in metres: a shortest line leaves it by 0.1 m at 45 degrees of latitude, and by 0.5 m at 80."""

ARC: Final = 16
"""The edges of a quarter of a circle."""

Ring = tuple[Position, ...]
"""A closed line as latitudes and longitudes; the longitudes are continuous and may leave [-180, 180]."""

Rings = tuple[Ring, ...]
"""A polygon: its border, and then its holes."""

Shape: TypeAlias = shapely.Geometry
"""A shape with longitude as x and latitude as y, in degrees."""


@lru_cache(maxsize=MEMO)
def outline_of(part: RegionPart, farther: float = 0.0) -> shapely.Geometry:
    """Return a part, grown by its margin and by `farther` metres, with longitude as x and latitude as y in degrees.

    It is a point or a line if the part has no area.

    Raises:
        RegionError: The part is too large, or covers a pole.
    """
    area, margin = area_of(part), part.margin + farther
    frame = frame_of(area.disc)
    shape = frame.unproject(shapely.segmentize(frame.project(area.shape), STEP))
    if margin > 0.0:
        shape = _grown(shape, margin, disc_of(part).grown(farther))
    return _continuous(shape, area.disc.longitude)


def _grown(shape: shapely.Geometry, margin: float, disc: Disc) -> shapely.Geometry:
    """Return a shape in degrees, grown in an equidistant plane around its middle."""
    from pyproj import Proj  # noqa: PLC0415 - many worlds need no metres

    plane = Proj(ellps="WGS84", proj="aeqd", lat_0=disc.latitude, lon_0=disc.longitude)
    angle = min(disc.radius / EARTH_RADIUS, 1.0)
    stretch = angle / math.sin(angle) if angle else 1.0

    def forward(at: Any) -> Any:
        return np.column_stack(plane(at[:, 0], at[:, 1]))

    def back(at: Any) -> Any:
        return np.column_stack(plane(at[:, 0], at[:, 1], inverse=True))

    round_off = margin * stretch / math.cos(math.pi / 4 / ARC)  # the chords of its arcs are inside them
    grown = shapely.transform(shape, forward).buffer(round_off, quad_segs=ARC)
    return shapely.transform(shapely.segmentize(grown, STEP), back)


def _continuous(shape: shapely.Geometry, middle: float) -> shapely.Geometry:
    """Return a shape whose longitudes are within half a turn of a middle one."""

    def turned(at: Any) -> Any:
        return np.column_stack([middle + (at[:, 0] - middle + 180.0) % 360.0 - 180.0, at[:, 1]])

    return shapely.transform(shape, turned)


def aligned(shape: shapely.Geometry, other: shapely.Geometry) -> shapely.Geometry:
    """Return a shape moved by whole turns of longitude next to another one."""
    turns = round((other.centroid.x - shape.centroid.x) / 360.0)
    return shapely.transform(shape, lambda at: at + np.array([360.0 * turns, 0.0])) if turns else shape


def outline_around(parts: Sequence[RegionPart], beside: RegionPart, farther: float = 0.0) -> Shape:
    """Return the outline of parts, grown by some metres, at the longitudes of another part."""
    middle = outline_of(beside)
    return shapely.union_all([aligned(outline_of(part, farther), middle) for part in parts])


def spot_in(shape: Shape) -> Position:
    """Return a point of a shape, in its middle if it is there."""
    east, north = shape.representative_point().coords[0]
    return (north, east)


def farthest_from(shape: Shape, at: Position) -> tuple[Position, float]:
    """Return the vertex of a shape that is farthest from a position, and its metres from there."""
    east, north = shapely.get_coordinates(shape).T
    _, _, metres = geod().inv(np.full(len(east), at[1]), np.full(len(east), at[0]), east, north)
    found = int(np.argmax(metres))
    return (float(north[found]), float(east[found])), float(metres[found])


def rings_of(shape: shapely.Geometry) -> tuple[Rings, ...]:
    """Return the polygons of a shape; none of its points and lines."""
    polygons = (part for part in shapely.get_parts(shape) if part.geom_type == "Polygon" and part.area)
    return tuple(tuple(map(_ring, (each.exterior, *each.interiors))) for each in polygons)


def _ring(line: shapely.LinearRing) -> Ring:
    return tuple((north, east) for east, north in line.coords[:-1])
