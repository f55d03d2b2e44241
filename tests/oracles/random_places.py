"""Random worlds for the tests of regions: places of some size around a latitude and a longitude."""

import math

import numpy as np

WORLDS = {
    "harbour": (37.0, -8.6, 2_000.0),
    "lagos": (37.1, -8.7, 30_000.0),
    "arctic": (70.0, 20.0, 30_000.0),
    "south": (-52.9, 5.4, 100_000.0),
    "date_line": (10.0, 179.95, 60_000.0),
    "near_a_pole": (88.5, 40.0, 20_000.0),
    "equator": (0.0, -0.02, 100_000.0),
    "country": (45.0, 3.0, 350_000.0),
    "continent": (40.0, -100.0, 750_000.0),
}
"""For each world its latitude, its longitude, and the metres within which it lies."""


def place(rng, latitude, longitude, size, kinds=("point", "box", "star", "needle")):
    """Return the vertices (longitude, latitude) of a place: a point, a box, a star with dents, or a narrow strip."""
    up = size / 111_320.0
    across = up / math.cos(math.radians(latitude))
    east, north = longitude + rng.uniform(-0.6, 0.6) * across, latitude + rng.uniform(-0.6, 0.6) * up
    extent = rng.uniform(0.02, 0.3)
    match rng.choice(kinds):
        case "point":
            corners = [(0.0, 0.0)]
        case "box":
            corners = [(0, 0), (extent, 0), (extent, extent * rng.uniform(0.2, 1)), (0, 0)]
            corners[3] = (0, corners[2][1])
        case "needle":
            corners = [(0, 0), (extent, 0.0), (extent, 0.004), (0, 0.004)]
        case _:
            count = int(rng.integers(5, 10))
            turns = (np.arange(count) + 0.8 * rng.random(count)) * 2 * math.pi / count
            reach = extent / 2 * rng.uniform(0.25, 1.0, count)
            corners = list(zip(reach * np.cos(turns), reach * np.sin(turns), strict=True))
    found = [((east + x * across + 180.0) % 360.0 - 180.0, north + y * up) for x, y in corners]
    return np.round(found, 7)
