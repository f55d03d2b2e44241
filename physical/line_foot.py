"""The nearest point of a shortest line to a position, and its distance."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from physical.geodesic_areas import area_of
from physical.geodesic_distances import feet_on
from physical.geometry_measures import centroid
from physical.regions import RegionPart
from physical.shape import Geometry, point


class Foot(NamedTuple):
    """A position's distance in metres from a line, and the nearest point there."""

    metres: float
    at: Geometry


def foot(at: Geometry, start: Geometry, end: Geometry) -> Foot:
    """Return the distance of a geometry's centre from the shortest line between two points, and the nearest point.

    Raises:
        RegionError: The line reaches over 1,000 km from its middle, or crosses a pole.
    """
    line = area_of(RegionPart(tuple(sorted({start, end})), spanned=True))
    ((latitude, longitude),) = centroid(at).vertices
    found = feet_on(np.array([[longitude, latitude]]), line)
    east, north = found.feet[0].tolist()
    return Foot(float(found.metres[0]), point(north, (east + 180.0) % 360.0 - 180.0))
