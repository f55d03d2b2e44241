"""Corridors: the polygon of all points within half a width of a line, such as a fairway, a river or a road."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import accumulate, groupby, pairwise
from typing import Final

import shapely

from physical.errors import GeometryError
from physical.frame import E7, METRES_PER_DEGREE, LocalFrame, PositionE7, local_frame, normal_longitude
from physical.shape import SMALLEST_RADIUS, Geometry, point, polygon

MOST_VERTICES: Final = 1_000
"""The largest number of positions of a line."""

FARTHEST: Final = 300_000.0
"""The largest distance in metres from a line's middle, north or east: there lengths across are off by 4e-4."""

TOLERANCE: Final = 0.01
"""The permitted error of a corridor's border, as a share of half its width."""


def corridor(line: Sequence[Sequence[float]], width: float) -> Geometry:
    """Return the corridor of a width in metres along (latitude, longitude) positions; its ends are round.

    >>> from physical import area
    >>> area(corridor([(37, -8.6), (37, -8.5)], 100)) // 1000
    897.0
    """
    _check_width(width)
    frame, plane = _framed(_unrolled(line))
    strip = frame.project(plane).buffer(width / 2).simplify(width / 2 * TOLERANCE)
    if strip.interiors:
        raise GeometryError(
            "hole",
            f"the line comes back to itself: {width:g} m wide, it encloses an area that it does not cover",
            "split it, or write the whole as a Polygon",
        )
    border = (frame.position(x, y) for x, y in strip.exterior.coords)
    return polygon((north / E7, east / E7) for north, east in border)


def _check_width(width: object) -> None:
    if isinstance(width, bool) or not isinstance(width, int | float):
        raise GeometryError("width", f"the width {width!r:.60} is not a number", "write it in metres")
    if not 2 * SMALLEST_RADIUS <= width <= FARTHEST:
        raise GeometryError(
            "width",
            f"the width {width!r:.60} m is not between {2 * SMALLEST_RADIUS:g} and {FARTHEST:,.0f} m",
            "the width is in metres, from one border to the other",
        )


def _unrolled(line: Sequence[Sequence[float]]) -> list[PositionE7]:
    """Return the positions of a line with continuous longitudes, without repetitions."""
    if len(line) > MOST_VERTICES:
        raise GeometryError(
            "too-many-vertices",
            f"the line has {len(line):,} positions, more than {MOST_VERTICES:,}",
            "simplify it",
        )
    found = [point(*position).ring[0] for position in line]
    found = [here for here, _ in groupby(found)]
    if len(found) < 2:
        hint = "write a place around one position as a Point with radius_m"
        raise GeometryError("zero-length", "the line has no length", hint)
    steps = (normal_longitude(there[1] - here[1]) for here, there in pairwise(found))
    easts = accumulate(steps, initial=found[0][1])
    return [(here[0], east) for here, east in zip(found, easts, strict=True)]


def _framed(line: Sequence[PositionE7]) -> tuple[LocalFrame, shapely.LineString]:
    """Return the metric frame around the middle of a line, and the line in the plane there (1e-7 degree)."""
    norths, easts = zip(*line, strict=True)
    north, east = (min(norths) + max(norths)) // 2, (min(easts) + max(easts)) // 2
    across = (max(easts) - east) * math.cos(math.radians(north / E7))
    if max(max(norths) - north, across) / E7 * METRES_PER_DEGREE > FARTHEST:
        raise GeometryError(
            "too-long",
            f"the line reaches over {FARTHEST / 1000:g} km from its middle",
            "split it into shorter ones",
        )
    middle = normal_longitude(east)
    return local_frame((north, middle)), shapely.LineString([(at - east + middle, up) for up, at in line])
