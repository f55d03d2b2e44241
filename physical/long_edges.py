"""Edges over more than half the earth, whose direction the written numbers leave open.

By RFC 7946 such an edge goes straight from one number to the other, over more than 180 degrees. Most files mean the
shorter way, across the antimeridian. An ambiguous edge is refused.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

from physical.errors import GeometryError

CLEAR: Final = 270.0
"""Degrees of longitude from which an edge certainly crosses the antimeridian: the shorter way is at most 90."""

Positions = Sequence[Sequence[float]]
"""Latitudes and longitudes in degrees, as written."""


def check_edges(positions: Positions, *, closed: bool = True) -> None:
    """Raise GeometryError for an edge of more than 180 and less than 270 degrees."""
    for here, there in _edges(positions, closed=closed):
        apart = abs(there[1] - here[1])
        if 180.0 < apart < CLEAR:
            raise GeometryError(
                "wide",
                f"from longitude {here[1]:g} to {there[1]:g} it is {apart:g} degrees, or {360 - apart:g} degrees "
                "across the antimeridian: which is meant is not clear",
                "divide the place, or the edge: places span less than 180 degrees of longitude",
            )


def goes_around(ring: Positions) -> bool:
    """Whether a ring with clear edges would enclose most of the earth's longitudes if read number by number.

    That holds if it is counterclockwise by its numbers, as RFC 7946 requires.
    """
    if not any(abs(there[1] - here[1]) >= CLEAR for here, there in _edges(ring, closed=True)):
        return False
    return sum(here[1] * there[0] - here[0] * there[1] for here, there in _edges(ring, closed=True)) > 0


def check_width(west: float, east: float) -> None:
    """Raise GeometryError for a box of 180 degrees or more, from west eastwards to east."""
    if (width := (east - west) % 360.0) >= 180.0:
        raise GeometryError(
            "wide",
            f"from longitude {west:g} eastwards to {east:g} there are {width:g} degrees",
            "places span less than 180 degrees of longitude: name the west before the east, or take less",
        )


def _edges(positions: Positions, *, closed: bool) -> Iterator[tuple[Sequence[float], Sequence[float]]]:
    return pairwise([*positions, *(positions[:1] if closed else ())])
