"""Frames: conversion between coordinates and metres (WGS 84, by pyproj)."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import shapely

if TYPE_CHECKING:
    from pyproj import Geod, Proj

E7: Final = 10_000_000
"""Units per degree: coordinates are integers of 1e-7 degree (about 1 cm)."""

TURN: Final = 360 * E7
"""Once around the earth."""

CHORD_TOLERANCE: Final = 0.005
"""Metres by which an edge may leave its image in a metric frame."""

METRES_PER_DEGREE: Final = 111_320.0
"""Metres per degree of latitude, roughly."""

EARTH_RADIUS: Final = 6_371_000.0
MAX_PARTS_OF_AN_EDGE: Final = 1_000
MAX_PARTS: Final = 20_000

Position = tuple[float, float]
"""Latitude and longitude in degrees, north and east positive."""

PositionE7 = tuple[int, int]
"""Latitude and longitude in units of 1e-7 degree."""


@lru_cache(maxsize=1)
def geod() -> Geod:
    """Return the WGS 84 ellipsoid."""
    from pyproj import Geod  # noqa: PLC0415 - many worlds are points and boxes, and need no metres

    return Geod(ellps="WGS84")


@lru_cache(maxsize=1)
def equal_area() -> Proj:
    """Return the cylindrical equal-area projection: planar areas equal areas on the ellipsoid."""
    return _projection(proj="cea")


def normal_longitude(longitude: int) -> int:
    """Return a longitude in 1e-7 degree, normalised to [-180, 180) degrees."""
    return (longitude + TURN // 2) % TURN - TURN // 2


def rounded(latitude: float, longitude: float) -> PositionE7:
    """Return degrees rounded to the grid of 1e-7 degree; a pole has longitude 0."""
    north = round(latitude * E7)
    return (north, 0 if abs(north) == 90 * E7 else normal_longitude(round(longitude * E7)))


class LocalFrame(NamedTuple):
    """A local metric frame: azimuthal equidistant, x to the east and y to the north of its centre.

    Distances and directions from the centre are exact. At d metres from it, lengths across are off by the share d²/6R²
    (4e-5 at 100 km).
    """

    centre: PositionE7
    proj: Callable[..., Any]

    def metres(self, position: PositionE7) -> tuple[float, float]:
        """Return x and y in metres."""
        x, y = self.proj(position[1] / E7, position[0] / E7)
        return (x, y)

    def position(self, x: float, y: float) -> PositionE7:
        """Return the position on the grid of 1e-7 degree that is nearest to x and y metres."""
        longitude, latitude = self.proj(x, y, inverse=True)
        return rounded(latitude, longitude)

    def project(self, shape: shapely.Geometry) -> shapely.Geometry:
        """Return a planar shape in metres, from 1e-7 degree (x east, y north), with bent edges."""
        bent = shapely.transform(shapely.segmentize(shape, _part(shape)), self._project)
        return bent.simplify(CHORD_TOLERANCE / 2)

    def _project(self, coordinates: Any) -> Any:
        projected = coordinates.copy()
        projected[:, 0], projected[:, 1] = self.proj(coordinates[:, 0] / E7, coordinates[:, 1] / E7)
        return projected


def _part(shape: shapely.Geometry) -> float:
    """Return the longest part of an edge, in 1e-7 degree, whose chord stays within the tolerance.

    A part of s metres leaves its chord by at most s²·tan(latitude)/8R; the frame's own bending gets an equal share.
    """
    west, south, east, north = shape.bounds
    steepest = max(abs(south), abs(north), E7) / E7
    slope = min(1.0 / max(90.0 - steepest, 0.01) * 57.3, 1e4) + 1.0
    metres = (8 * EARTH_RADIUS * CHORD_TOLERANCE / slope) ** 0.5 / 2
    span: float = max(east - west, north - south)
    parts: float = max(metres / METRES_PER_DEGREE * E7, span / MAX_PARTS_OF_AN_EDGE, shape.length / MAX_PARTS)
    return parts


@lru_cache(maxsize=4096)
def local_frame(centre: PositionE7) -> LocalFrame:
    """Return the metric frame around a position."""
    latitude, longitude = centre
    return LocalFrame(centre, _projection(proj="aeqd", lat_0=latitude / E7, lon_0=longitude / E7))


def _projection(**settings: Any) -> Proj:
    from pyproj import Proj  # noqa: PLC0415 - as in `geod`

    return Proj(ellps="WGS84", **settings)
