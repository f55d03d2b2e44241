"""The positions of a map's labels: a pure function of boxes, in points, the same in every process."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

Spot = tuple[float, float]
"""Coordinates to the right and up, in points; those of a view are in metres."""

GAP: Final = 2.0
"""Points kept free between labels."""

RINGS: Final = (3.0, 8.0, 15.0, 24.0, 36.0, 50.0)
"""Points from the clearance to the label, tried in turn."""

DIRECTIONS: Final = (0, 180, 90, 270, 45, 315, 135, 225, 22, 338, 158, 202, 68, 292, 112, 248)
"""Degrees counter-clockwise from the right, the most readable first."""

BESIDE: Final = 9.0
"""Points from the clearance to a label that needs no leader line."""

CELL: Final = 24.0
"""The width in points of the cells that index spots along lines."""

_Cells = dict[tuple[int, int], list[Spot]]

FORBIDDEN: Final = 1e3
ON_A_LINE: Final = 1.5


class Box(NamedTuple):
    """A rectangle."""

    left: float
    bottom: float
    right: float
    top: float

    @property
    def width(self) -> float:
        """The width."""
        return self.right - self.left

    @property
    def height(self) -> float:
        """The height."""
        return self.top - self.bottom

    @property
    def centre(self) -> Spot:
        """The centre."""
        return ((self.left + self.right) / 2, (self.bottom + self.top) / 2)

    def grown(self, by: float) -> Box:
        """Return the box, enlarged on every side."""
        return Box(self.left - by, self.bottom - by, self.right + by, self.top + by)

    def shared(self, other: Box) -> float:
        """Return the common area of two boxes, 0 if they only touch."""
        wide = min(self.right, other.right) - max(self.left, other.left)
        high = min(self.top, other.top) - max(self.bottom, other.bottom)
        return wide * high if wide > 0 and high > 0 else 0.0

    def holds(self, spot: Spot) -> bool:
        """Whether a spot is inside or on the border."""
        return self.left <= spot[0] <= self.right and self.bottom <= spot[1] <= self.top

    def nearest(self, spot: Spot) -> Spot:
        """Return the spot of the box that is nearest to another spot."""
        return (min(max(spot[0], self.left), self.right), min(max(spot[1], self.bottom), self.top))


def around(centre: Spot, size: Spot) -> Box:
    """Return the box with this centre and size (width and height)."""
    return Box(
        centre[0] - size[0] / 2, centre[1] - size[1] / 2, centre[0] + size[0] / 2, centre[1] + size[1] / 2
    )


def union(boxes: Sequence[Box]) -> Box:
    """Return the smallest box around boxes, at least one."""
    lefts, bottoms, rights, tops = zip(*boxes, strict=True)
    return Box(min(lefts), min(bottoms), max(rights), max(tops))


@dataclass(frozen=True, slots=True)
class Wanted:
    """A label to be placed.

    Attributes:
        at: The spot that it names.
        size: Its width and height.
        clearance: The free distance around the spot, horizontally and vertically.
        inside: Preferred centres of the label, best first.
        farthest: The largest distance from the clearance.
    """

    at: Spot
    size: Spot
    clearance: Spot = (0.0, 0.0)
    inside: tuple[Spot, ...] = ()
    farthest: float = RINGS[-1]


def place_labels(
    wanted: Sequence[Wanted], obstacles: Sequence[Box], lines: Sequence[Spot], view: Box
) -> tuple[Box | None, ...]:
    """Return a box for each label: in the view, off the obstacles, off each other, near its spot.

    Labels are placed in the given order, each at its least cost. `lines` are spots that labels should avoid. A label
    without room nearby has None.
    """
    taken, cells = list(obstacles), _cells(lines)
    found: list[Box | None] = []
    for label in wanted:
        box = _cheapest(label, taken, cells, view)
        found.append(box)
        if box is not None:
            taken.append(box)
            _add(cells, leader(box, label))
    return tuple(found)


def leader(box: Box, label: Wanted) -> tuple[Spot, ...]:
    """Return spots along the leader line from a label to its spot, none if it stands beside it or inside."""
    if any(math.dist(box.centre, spot) < 0.01 for spot in label.inside):
        return ()
    (x1, y1), (x2, y2) = box.nearest(label.at), label.at
    length = math.dist((x1, y1), label.at)
    if length <= max(label.clearance) + BESIDE:
        return ()
    parts = round(length / 4.0)
    return tuple((x1 + (x2 - x1) * n / parts, y1 + (y2 - y1) * n / parts) for n in range(1, parts))


def _add(cells: _Cells, spots: Iterable[Spot]) -> None:
    for spot in spots:
        cells.setdefault((int(spot[0] // CELL), int(spot[1] // CELL)), []).append(spot)


def _cells(spots: Iterable[Spot]) -> _Cells:
    """Return spots by cell, for fast lookup of those in a box."""
    cells: _Cells = {}
    _add(cells, spots)
    return cells


def _within(box: Box, cells: _Cells) -> int:
    """Return the number of spots inside a box."""
    xs = range(int(box.left // CELL), int(box.right // CELL) + 1)
    ys = range(int(box.bottom // CELL), int(box.top // CELL) + 1)
    return sum(box.holds(spot) for x in xs for y in ys for spot in cells.get((x, y), ()))


def _cheapest(label: Wanted, taken: Sequence[Box], cells: _Cells, view: Box) -> Box | None:
    best, least = None, FORBIDDEN
    for price, box in _candidates(label):
        if price >= least:
            break  # candidates come cheapest first
        way = leader(box, label)
        crossed = sum(other.holds(spot) for spot in way for other in taken)
        cost = price + _cost(box, taken, cells, view) + ON_A_LINE * crossed
        if cost < least:
            best, least = box, cost
    return best


def _candidates(label: Wanted) -> Iterator[tuple[float, Box]]:
    for rank, centre in enumerate(label.inside):
        yield rank * 0.5, around(centre, label.size)
    start = len(label.inside) * 0.5
    for ring in (each for each in RINGS if each <= label.farthest):
        for rank, direction in enumerate(DIRECTIONS):
            price = start + ring + rank * 0.1
            yield price, _beside(label, math.radians(direction), ring)
        start += 2.0  # hence no later candidate is cheaper


def _beside(label: Wanted, direction: float, distance: float) -> Box:
    """Return the label's box at a distance from its spot, in a direction."""
    east, north = math.cos(direction), math.sin(direction)
    wide, high = label.size
    # The box's support in that direction; a label to the side stays level with its spot.
    x = label.at[0] + east * (label.clearance[0] + distance) + _sign(east) * wide / 2
    y = label.at[1] + north * (label.clearance[1] + distance) + _sign(north) * high / 2
    return around((x, y), label.size)


def _sign(value: float) -> int:
    return 0 if abs(value) < 1e-9 else (1 if value > 0 else -1)


def _cost(box: Box, taken: Sequence[Box], cells: _Cells, view: Box) -> float:
    wide = box.grown(GAP)
    over = sum(wide.shared(other) for other in taken)
    outside = wide.width * wide.height - wide.shared(view)
    return FORBIDDEN * (over + outside) + ON_A_LINE * _within(box, cells)
