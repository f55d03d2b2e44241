"""Draw the first times of predicates over many runs: the share of runs in which each was true by then."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from bigactors.pictures.page import Page
from physical.map_style import FAINT, PALETTE, QUIET
from physical.svg import Paint, Picture, Point

WIDTH: Final = 640.0
HEIGHT: Final = 360.0
MARGIN: Final = 26.0
NAMES: Final = 150.0
"""Points beside the curves for their names."""

LEFT: Final = MARGIN + 34.0
TOP: Final = MARGIN + 50.0
ACROSS: Final = WIDTH - MARGIN - NAMES - LEFT
DOWN: Final = HEIGHT - MARGIN - 34.0 - TOP
MOST_MARKS: Final = 8
GRID: Final = Paint(stroke=FAINT, width=0.7)
AXIS: Final = Paint(stroke=QUIET, width=0.8)


@dataclass(frozen=True, slots=True)
class Curve:
    """The share of runs in which something was true by each of some times, with its interval."""

    name: str
    times: Sequence[float]
    shares: Sequence[float]
    low: Sequence[float]
    high: Sequence[float]


def draw_curves(curves: Sequence[Curve], *, title: str, gloss: str, axis: str, end: float) -> Picture:
    """Return one picture of curves, which start at 0 and reach to the end.

    Args:
        curves: The curves; only as many as there are colours are drawn (`physical.map_style.PALETTE`).
        title: The title.
        gloss: The line below the title.
        axis: The label of the time axis.
        end: The time to which runs were followed.
    """
    page = Page(WIDTH, HEIGHT)
    page.write(MARGIN, MARGIN + 9, title, 14.0, bold=True, width=WIDTH - 2 * MARGIN)
    page.write(MARGIN, MARGIN + 26, gloss, 8.0, ink=QUIET, width=WIDTH - 2 * MARGIN)
    end = end or 1.0
    _draw_axes(page, axis, end)
    for rank, (curve, colour) in enumerate(zip(curves, PALETTE, strict=False)):
        low, high, shares = (
            list(_steps(curve.times, each, end)) for each in (curve.low, curve.high, curve.shares)
        )
        page.polygon([*high, *reversed(low)], Paint(colour, opacity=0.2), 2.0)
        page.line(shares, Paint(stroke=colour, width=1.6), 3.0)
        x, y = LEFT + ACROSS + 16.0, TOP + 12.0 + 14.0 * rank
        page.line([(x, y - 3.0), (x + 10.0, y - 3.0)], Paint(stroke=colour, width=1.6))
        page.write(x + 16.0, y, curve.name, width=WIDTH - x - 24.0)
    return page.picture(title)


def _steps(times: Sequence[float], shares: Sequence[float], end: float) -> Iterator[Point]:
    """Yield the corners of a curve that jumps at each time, from 0 to the end."""
    known = [(0.0, 0.0), *zip(times, shares, strict=True), (end, shares[-1] if shares else 0.0)]
    yield _spot(*known[0], end)
    for (_, before), (time, share) in pairwise(known):
        yield _spot(time, before, end)
        yield _spot(time, share, end)


def _spot(time: float, share: float, end: float) -> Point:
    return LEFT + ACROSS * min(time, end) / end, TOP + DOWN * (1.0 - share)


def _draw_axes(page: Page, axis: str, end: float) -> None:
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        (left, y), (right, _) = _spot(0.0, share, end), _spot(end, share, end)
        page.line([(left, y), (right, y)], GRID)
        page.write(left - 6.0, y + 2.8, f"{100 * share:g} %" if share else "0", ink=QUIET, anchor="end")
    for mark in marks(end):
        (x, bottom), (_, top) = _spot(mark, 0.0, end), _spot(mark, 1.0, end)
        page.line([(x, bottom + 3.0), (x, top)], GRID)
        page.write(x, bottom + 13.0, f"{mark:g}", ink=QUIET, anchor="middle")
    page.line([_spot(0.0, 1.0, end), _spot(0.0, 0.0, end), _spot(end, 0.0, end)], AXIS)
    page.write(LEFT + ACROSS / 2, TOP + DOWN + 27.0, axis, ink=QUIET, anchor="middle")


def marks(end: float) -> tuple[float, ...]:
    """Return round numbers from 0 to the end, at most nine.

    >>> marks(35.0)
    (0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0)
    """
    power = 10.0 ** math.floor(math.log10(end / MOST_MARKS))
    step = next(digit * power for digit in (1, 2, 5, 10, 20) if end / (digit * power) <= MOST_MARKS)
    return tuple(number * step for number in range(math.floor(end / step * (1 + 1e-12)) + 1))
