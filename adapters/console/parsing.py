"""Bounded parsing of plain data from an untrusted file; a value of the wrong form becomes None or empty."""

from __future__ import annotations

from typing import Any, Final

from adapters.console.facts import Position
from physical.frame import E7
from physical.shape import MAX_VERTICES
from semantics.state.brief import cut

MOST_TEXT: Final = 400
"""The most characters of a text on the page."""

MOST_NUMBER: Final = 1e15


def number(value: Any) -> float | None:
    """Return a number within the range of clocks and measurements, else None."""
    if isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < MOST_NUMBER:
        return float(value)
    return None


def count(value: Any) -> int | None:
    """Return a whole number of at least 0, else None."""
    return value if type(value) is int and 0 <= value < MOST_NUMBER else None


def text(value: Any) -> str:
    """Return a text, cut to `MOST_TEXT`; an empty one for any other value."""
    return cut(value, MOST_TEXT) if isinstance(value, str) else ""


def texts(value: Any, most: int = 100) -> list[str]:
    """Return the texts among the first `most` values of a list; none for any other value."""
    return [text(each) for each in value[:most] if isinstance(each, str)] if isinstance(value, list) else []


def position(value: Any) -> Position | None:
    """Return a vertex in degrees, from whole numbers of 1e-7 degree."""
    match value:
        case [int(north), int(east)] if abs(north) <= 90 * E7 and abs(east) <= 180 * E7:
            return north / E7, east / E7
    return None


def ring(value: Any) -> tuple[Position, ...]:
    """Return the vertices of a polygon or a point in degrees; none if one of them is invalid."""
    if not isinstance(value, list) or len(value) > MAX_VERTICES:
        return ()
    found = tuple(position(each) for each in value)
    return tuple(each for each in found if each is not None) if None not in found else ()


def band(value: Any) -> tuple[float, float] | None:
    """Return the lowest and the highest altitude, in metres."""
    match value:
        case [low, high] if (bottom := number(low)) is not None and (top := number(high)) is not None:
            return bottom, top
    return None
