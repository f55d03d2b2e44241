"""Shapes in latitude and longitude as geometries of GeoJSON (RFC 7946).

They are cut at the antimeridian (§3.1.9). Borders run counterclockwise, and those of holes clockwise (§3.1.6).
"""

from __future__ import annotations

from typing import Any, Final

import shapely
from shapely.affinity import translate
from shapely.geometry.polygon import orient

from physical.frame import E7, Position
from physical.region_outlines import Rings, outline_of
from physical.regions import RegionPart
from physical.shape import Geometry, planar

DIGITS: Final = 7
"""The decimals of a coordinate, about a centimetre."""


def part_geometry(part: RegionPart) -> dict[str, Any]:
    """Return the geometry of a part of a region; an exact place has its own vertices."""
    source = part.sources[0]
    if part.is_exact and isinstance(source, Geometry):
        return place_geometry(source)
    return shape_geometry(outline_of(part))


def place_geometry(geometry: Geometry) -> dict[str, Any]:
    """Return the geometry of a place."""
    return shape_geometry(shapely.transform(planar(geometry), lambda at: at / E7))


def polygon_geometry(polygons: tuple[Rings, ...]) -> dict[str, Any]:
    """Return the geometry of polygons, each a border with its holes."""
    made = [shapely.Polygon(*_plane(rings)) for rings in polygons]
    return shape_geometry(shapely.union_all(made))


def _plane(rings: Rings) -> tuple[list[Position], list[list[Position]]]:
    border, *holes = ([(east, north) for north, east in ring] for ring in rings)
    return border, holes


def line_geometry(first: Position, second: Position) -> dict[str, Any]:
    """Return the line between two positions, a point if they are one."""
    (south, west), (north, east) = first, second
    if first == second:
        return shape_geometry(shapely.Point(west, south))
    return shape_geometry(shapely.LineString([(west, south), (west + _short(east - west), north)]))


def _short(turn: float) -> float:
    return (turn + 180.0) % 360.0 - 180.0


def shape_geometry(shape: shapely.Geometry) -> dict[str, Any]:
    """Return the geometry of a shape with continuous longitudes, in degrees."""
    parts = shapely.get_parts(shapely.set_precision(_cut(shape), 10.0**-DIGITS))
    made = [_geometry(part) for part in parts if not part.is_empty]
    if len(made) == 1:
        return made[0]
    (kind,) = {each["type"] for each in made} or {"Point"}
    return {"type": f"Multi{kind}", "coordinates": [each["coordinates"] for each in made]}


def _cut(shape: shapely.Geometry) -> shapely.Geometry:
    """Return a shape cut at the antimeridian, each part at longitudes within 180 degrees."""
    west, _, east, _ = shape.bounds
    first, last = int((west + 180.0) // 360.0), int((east + 180.0) // 360.0)
    if first == last:
        return _turned(shape, first)
    pieces = [
        _turned(
            shape.intersection(shapely.box(360.0 * turn - 180.0, -90.0, 360.0 * turn + 180.0, 90.0)), turn
        )
        for turn in range(first, last + 1)
    ]
    most = max(shapely.get_dimensions(piece) for piece in pieces)
    parts = [part for piece in pieces for part in shapely.get_parts(piece)]
    return shapely.union_all([part for part in parts if shapely.get_dimensions(part) == most])


def _turned(shape: shapely.Geometry, turn: int) -> shapely.Geometry:
    return translate(shape, -360.0 * turn) if turn else shape


def _geometry(part: shapely.Geometry) -> dict[str, Any]:
    if part.geom_type == "Polygon":
        whole = orient(part)
        return {
            "type": "Polygon",
            "coordinates": [_line(each) for each in (whole.exterior, *whole.interiors)],
        }
    line = _line(part)
    return {"type": part.geom_type, "coordinates": line[0] if part.geom_type == "Point" else line}


def _line(line: shapely.Geometry) -> list[list[float]]:
    return [[round(east, DIGITS), round(north, DIGITS)] for east, north in line.coords]
