"""Gnomonic frames on the ellipsoid: shortest lines (geodesics) are straight in them.

A shortest line between two points at most r metres from the centre leaves its chord by at most 0.11 m at r = 500 km,
and 1.7 m at r = 1,000 km. It grows with the fourth power of r (tests/physical/test_gnomonic.py measures it). Lengths
are not kept: a length in the frame is that on the earth, times a factor from 1 to `stretch(r)`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final, NamedTuple

import numpy as np
import shapely

from physical.errors import GeometryError
from physical.extents import POLAR_RADIUS
from physical.frame import geod

FINE: Final = 500_000.0
"""Metres from the middle within which figures are good to half a metre."""

FARTHEST_REACH: Final = 1_000_000.0
"""Metres from the middle within which figures are good to five metres; larger regions are refused."""

BENDING: Final = 0.2
"""A bound in metres of the error of straightness at `FINE`, for a frame with its centre beside the middle."""

COARSEST: Final = 0.5
FINEST: Final = 0.125
"""Degrees between the centres of frames; a smaller step would only make more frames."""

METRES_PER_STEP: Final = 900_000.0
"""Metres of reach per degree of that step, so that a centre is near its middle in proportion."""

METRES_PER_LATITUDE: Final = 111_700.0
"""Metres per degree of latitude, or of longitude, at most."""

SPHERE: Final = 6_371_000.0
ELLIPTICITY: Final = 0.007
"""A bound of the relative error of distances on the sphere."""


class RegionError(GeometryError):
    """A region that is too large for its figures, or that covers a pole."""


class Disc(NamedTuple):
    """All points within `radius` metres of a position (latitude and longitude in degrees)."""

    latitude: float
    longitude: float
    radius: float

    def grown(self, by: float) -> Disc:
        """Return the disc with a larger radius."""
        return Disc(self.latitude, self.longitude, self.radius + by)

    def vector(self) -> tuple[float, float, float]:
        """Return the centre on the unit sphere."""
        north, east = math.radians(self.latitude), math.radians(self.longitude)
        return (math.cos(north) * math.cos(east), math.cos(north) * math.sin(east), math.sin(north))

    def to_centre(self, other: Disc) -> float:
        """Return the metres between two centres, to the share `ELLIPTICITY`."""
        north, south = math.radians(self.latitude), math.radians(other.latitude)
        half = math.sin(math.radians(self.longitude - other.longitude) / 2)
        chord = math.sin((north - south) / 2) ** 2 + math.cos(north) * math.cos(south) * half * half
        return 2 * SPHERE * math.asin(math.sqrt(min(1.0, chord)))

    def least(self, other: Disc) -> float:
        """Return a lower bound of the metres between points of two discs."""
        return self.to_centre(other) * (1 - ELLIPTICITY) - self.radius - other.radius

    def most(self, other: Disc) -> float:
        """Return an upper bound of the metres between points of two discs."""
        return self.to_centre(other) * (1 + ELLIPTICITY) + self.radius + other.radius


def around(a: Disc, b: Disc) -> Disc:
    """Return a disc around two discs; it is little larger than need be, and exactly so near the largest size."""
    apart = a.to_centre(b) * (1 + ELLIPTICITY)
    if apart + b.radius <= a.radius:
        return a
    if apart + a.radius <= b.radius:
        return b
    if apart + a.radius + b.radius > 1.8 * FARTHEST_REACH:
        return _closely_around(a, b)
    share = (apart + b.radius - a.radius) / 2 / apart
    middle = _on_the_sphere(a, b, share)
    radius = max(each.to_centre(middle) * (1 + ELLIPTICITY) + each.radius for each in (a, b))
    return Disc(middle.latitude, middle.longitude, radius)


def _closely_around(a: Disc, b: Disc) -> Disc:
    azimuth, _, apart = geod().inv(a.longitude, a.latitude, b.longitude, b.latitude)
    radius = max((apart + a.radius + b.radius) / 2, a.radius, b.radius)
    longitude, latitude, _ = geod().fwd(a.longitude, a.latitude, azimuth, max(0.0, radius - a.radius))
    return Disc(latitude, longitude, radius)


def _on_the_sphere(a: Disc, b: Disc, share: float) -> Disc:
    """Return the position at a share of a short chord between two centres, seen from the earth's centre."""
    x, y, z = ((1 - share) * one + share * other for one, other in zip(a.vector(), b.vector(), strict=True))
    return Disc(math.degrees(math.atan2(z, math.hypot(x, y))), math.degrees(math.atan2(y, x)), 0.0)


def slack(reach: float) -> float:
    """Return a bound of a figure's error in metres, where all lies within `reach` metres of the middle."""
    return 0.05 + BENDING * (reach / FINE) ** 4


def stretch(reach: float) -> float:
    """Return the greatest factor of a length in a frame, within `reach` metres of its centre."""
    return 1.0 / math.cos(min(reach, 2 * FARTHEST_REACH) / POLAR_RADIUS) ** 2


def check_reach(disc: Disc, what: str) -> None:
    """Raise RegionError if a disc is too large."""
    if disc.radius > FARTHEST_REACH:
        raise RegionError(
            "region-too-large",
            f"{what} reaches {disc.radius / 1000:,.0f} km from its middle, over {FARTHEST_REACH / 1000:,.0f} km",
            "divide the places, or fly by places in between (VIA)",
        )


@dataclass(frozen=True, slots=True, eq=False)
class GnomonicFrame:
    """A plane in metres, x to the east and y to the north of a centre (latitude and longitude in degrees)."""

    latitude: float
    longitude: float
    proj: Any

    def project(self, shape: shapely.Geometry) -> shapely.Geometry:
        """Return the image of a shape in longitudes and latitudes (degrees)."""
        return shapely.transform(shape, self._forward)

    def unproject(self, shape: shapely.Geometry) -> shapely.Geometry:
        """Return a shape of the frame with longitudes and latitudes in degrees."""
        return shapely.transform(shape, self._back)

    def plane(self, positions: Any) -> Any:
        """Return the coordinates of positions: rows of longitude and latitude."""
        return self._forward(positions)

    def positions(self, plane: Any) -> Any:
        """Return the longitudes and latitudes of coordinates in the frame."""
        return self._back(plane)

    def _forward(self, coordinates: Any) -> Any:
        return np.column_stack(self.proj(coordinates[:, 0], coordinates[:, 1]))

    def _back(self, coordinates: Any) -> Any:
        return np.column_stack(self.proj(coordinates[:, 0], coordinates[:, 1], inverse=True))


def _step(disc: Disc) -> float:
    """Return the degrees between the centres of frames for discs of this size: a power of two."""
    return min(COARSEST, FINEST * 2.0 ** max(0, math.frexp(disc.radius / METRES_PER_STEP / FINEST)[1] - 1))


def beside(disc: Disc) -> float:
    """Return a bound of the metres from a disc's centre to that of its frame."""
    return 0.71 * METRES_PER_LATITUDE * _step(disc)


def frame_of(disc: Disc) -> GnomonicFrame:
    """Return the frame for a disc; discs near one another share it."""
    step = _step(disc)
    north = max(-90.0, min(90.0, round(disc.latitude / step) * step))
    east = (round(disc.longitude / step) * step + 180.0) % 360.0 - 180.0
    return _frame(north, east)


@lru_cache(maxsize=1 << 12)
def _frame(latitude: float, longitude: float) -> GnomonicFrame:
    from pyproj import Proj  # noqa: PLC0415 - many worlds need no metres

    return GnomonicFrame(
        latitude, longitude, Proj(ellps="WGS84", proj="gnom", lat_0=latitude, lon_0=longitude)
    )
