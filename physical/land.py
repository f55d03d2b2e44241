"""Land on the earth: coasts and lakes for maps, without a network.

`land.zip` is Natural Earth's land at 1:10 million, in the public domain, accurate to about a kilometre
(`tests/data/make_land.py` made it). It has a file for each tile of 10 degrees with land, and an overview of the whole
earth.

A file begins with integers: the number of polygons, the number of rings of each, the number of vertices of each ring.
The steps from vertex to vertex follow, first all to the east, then all to the north. A step is zigzag-encoded (0, 1, 2,
3 stand for 0, -1, 1, -2), and all low bytes precede all high bytes.
"""

from __future__ import annotations

import math
import sys
from array import array
from collections.abc import Iterator
from functools import cache, lru_cache
from importlib.resources import files as resources
from io import BytesIO
from itertools import accumulate
from typing import Final
from zipfile import ZipFile

import shapely
from shapely.affinity import translate

from physical.frame import Position

ACCURACY: Final = 1_000.0
"""The possible error of a coast in metres."""

TILE: Final = 10
STEP: Final = 0.0005
"""Degrees per unit of a tile's numbers."""

OVERVIEW: Final = "overview"
OVERVIEW_STEP: Final = 0.02
WIDE: Final = 25.0
"""The window size in degrees from which the overview suffices."""

Ring = tuple[Position, ...]


def land_within(south_west: Position, north_east: Position) -> tuple[tuple[Ring, ...], ...]:
    """Return the land in a window as polygons, each its border and then its holes.

    In a window across the antimeridian, longitudes go beyond 180, also those of the polygons.

    >>> [len(polygon) for polygon in land_within((36.9, -8.8), (37.2, -8.5))]
    [1]
    """
    (south, west), (north, east) = south_west, north_east
    window = (west, max(south, -90.0), min(east, west + 360.0), min(north, 90.0))
    parts = [shapely.clip_by_rect(polygon, *window) for polygon in _near(*window)]
    joined = shapely.union_all([shapely.make_valid(part) for part in parts if not part.is_empty])
    polygons = [each for each in shapely.get_parts(joined).tolist() if each.geom_type == "Polygon"]
    return tuple(
        tuple(tuple((y, x) for x, y in ring.coords) for ring in (polygon.exterior, *polygon.interiors))
        for polygon in polygons
    )


def land_share(south_west: Position, north_east: Position) -> float:
    """Return the share of a window that is land, between 0 and 1; lakes are water.

    >>> land_share((37.0, -8.7), (37.05, -8.6)), land_share((38.0, -7.6), (38.1, -7.5))
    (0.0, 1.0)
    """
    (south, west), (north, east) = south_west, north_east
    polygons = (shapely.Polygon(rings[0], rings[1:]) for rings in land_within(south_west, north_east))
    area = sum(float(polygon.area) for polygon in polygons)
    return round(area / ((north - south) * (east - west)), 6)


def tile_name(west: int, south: int) -> str:
    """Return the name of a tile by its corner.

    >>> tile_name(-10, 30)
    '-10+30'
    """
    return f"{west:+d}{south:+d}"


def _near(west: float, south: float, east: float, north: float) -> Iterator[shapely.Polygon]:
    """Yield the polygons of all tiles that meet a window, shifted to the window's longitudes."""
    wide = max(east - west, north - south) > WIDE
    size = 360 if wide else TILE
    for turn in range(math.floor((west + 180) / size), math.floor((east + 180) / size) + 1):
        corner = turn * size - 180
        around = (corner + 180) // 360 * 360
        if wide:
            found = _tile(OVERVIEW, -180, -90, OVERVIEW_STEP)
        else:
            souths = range(math.floor(south / TILE) * TILE, math.ceil(north / TILE) * TILE, TILE)
            here = corner - around
            found = tuple(each for at in souths for each in _tile(tile_name(here, at), here, at, STEP))
        for polygon in found:
            yield translate(polygon, around) if around else polygon


@cache
def _archive() -> ZipFile:
    return ZipFile(BytesIO((resources(__package__) / "land.zip").read_bytes()))


@lru_cache(maxsize=64)
def _tile(name: str, west: int, south: int, step: float) -> tuple[shapely.Polygon, ...]:
    """Return the polygons of a tile; none for a tile of sea."""
    if name not in _archive().namelist():
        return ()
    written = _archive().read(name)
    polygons = _numbers(written[:4])[0]
    rings = _numbers(written[4 : 4 + 4 * polygons])
    vertices = _numbers(written[4 + 4 * polygons :][: 4 * sum(rings)])
    steps = written[4 + 4 * (polygons + sum(rings)) :]
    half = len(steps) // 2
    borders = list(_borders(_steps(steps[:half]), _steps(steps[half:]), vertices, (west, south, step)))
    first = accumulate(rings, initial=0)
    return tuple(
        shapely.Polygon(borders[start], borders[start + 1 : start + count])
        for start, count in zip(first, rings, strict=False)
    )


def _borders(
    east: list[int], north: list[int], counts: array[int], grid: tuple[int, int, float]
) -> Iterator[list[tuple[float, float]]]:
    west, south, step = grid
    start = 0
    for count in counts:
        xs = accumulate(east[start : start + count])
        ys = accumulate(north[start : start + count])
        yield [(west + x * step, south + y * step) for x, y in zip(xs, ys, strict=True)]
        start += count


def _numbers(written: bytes) -> array[int]:
    return _native(array("i", written))


def _steps(written: bytes) -> list[int]:
    """Return steps, decoded from bytes of which all low ones come first."""
    both = bytearray(len(written))
    both[::2], both[1::2] = written[: len(written) // 2], written[len(written) // 2 :]
    return [(number >> 1) ^ -(number & 1) for number in _native(array("H", bytes(both)))]


def _native(numbers: array[int]) -> array[int]:
    if sys.byteorder == "big":
        numbers.byteswap()
    return numbers
