"""The coast in a window, as GeoJSON for the console's map."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Final

from physical.land import ACCURACY, land_within

SIDES: Final = ("south", "west", "north", "east")


def window_of(query: Mapping[str, str]) -> tuple[float, float, float, float] | None:
    """Return the sides of the window that a query asks for, in degrees; None if it asks for none.

    >>> window_of({"south": "36.5", "west": "-9", "north": "37.5", "east": "-8"})
    (36.5, -9.0, 37.5, -8.0)
    """
    try:
        south, west, north, east = (float(query[side]) for side in SIDES)
    except (KeyError, ValueError):
        return None
    finite = all(map(math.isfinite, (south, west, north, east)))
    good = finite and -90 <= south < north <= 90 and -540 <= west < east <= 540 and east - west <= 720
    return (south, west, north, east) if good else None


@lru_cache(maxsize=32)
def coast(south: float, west: float, north: float, east: float) -> str:
    """Return the land in a window as a GeoJSON feature, with its accuracy in metres."""
    polygons = [
        [[[round(longitude, 4), round(latitude, 4)] for latitude, longitude in ring] for ring in polygon]
        for polygon in land_within((south, west), (north, east))
    ]
    feature = {
        "type": "Feature",
        "properties": {"accuracy": ACCURACY},
        "geometry": {"type": "MultiPolygon", "coordinates": polygons},
    }
    return json.dumps({"type": "FeatureCollection", "features": [feature]}, separators=(",", ":"))
