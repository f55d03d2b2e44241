"""Regions for tests, from and to the oracle's arrays of longitudes and latitudes."""

import numpy as np

from physical import Geometry, point, polygon
from physical.regions import RegionPart


def geometry(vertices) -> Geometry:
    """Return the geometry of vertices (longitude, latitude)."""
    flipped = [(north, east) for east, north in vertices]
    return point(*flipped[0]) if len(flipped) == 1 else polygon(flipped)


def rings(area):
    """Return the rings of an area, each without its last position."""
    if area.shape.geom_type != "Polygon":
        return [np.array(area.shape.coords)]
    return [np.array(ring.coords)[:-1] for ring in (area.shape.exterior, *area.shape.interiors)]


def hull(*sources, margin=0.0):
    return RegionPart(tuple(sorted(sources)), spanned=True, margin=margin)
