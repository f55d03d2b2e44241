"""Routes around boxes: a link that would cross a box or a label takes the lanes between them if that is shorter."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import hypot, inf
from typing import Final, TypeAlias

from bigraphs.layout import FONT, GAP, HEADER, PAD, Box, Layout

Point: TypeAlias = tuple[float, float]
Curve: TypeAlias = tuple[Point, ...]

BOX_WEIGHT: Final = 9.0
LABEL_WEIGHT: Final = 4.0
LARGEST: Final = 80  # boxes; a larger drawing is crossed straight
ROUND: Final = 34.0
STUB: Final = 11.0
SAMPLES: Final = 16


class Obstacles:
    """The innermost boxes of a layout, and the labels of the others, with the corners to pass them at."""

    def __init__(self, layout: Layout) -> None:
        nodes = [box for item, box in layout.boxes if item.kind != "region"]
        inner = [box for box in nodes if not any(box is not other and box.contains(other) for other in nodes)]
        labels = [_label(box) for box in nodes if box not in inner]
        self.weighted = [(box, BOX_WEIGHT) for box in inner] + [(box, LABEL_WEIGHT) for box in labels]
        self.corners = [corner for box in inner for corner in _corners(box)] if len(inner) <= LARGEST else []
        self.known: dict[tuple[Point, Point], float] = {}

    def avoid(self, curve: Curve, lane: int) -> Curve:
        """Return the curve, or a way around what it crosses; lanes keep links side by side."""
        if not self.corners:
            return curve
        crossed = sum(self.cost(one, other) - _length(one, other) for one, other in pairwise(_sampled(curve)))
        if crossed < 20.0:
            return curve
        leave, arrive = _stub(curve[0], curve[1]), _stub(curve[-1], curve[-2])
        way = self.way(leave, arrive)
        shift = 1.8 * (lane % 5 - 2)
        around = [(x + shift, y + shift) for x, y in way[1:-1]]
        return _rounded([curve[0], leave, *around, arrive, curve[-1]])

    def cost(self, start: Point, end: Point) -> float:
        """Return the length of a line, its parts within obstacles counted more."""
        key = (start, end) if start < end else (end, start)
        if key not in self.known:
            extra = sum(weight * _overlap(start, end, box) for box, weight in self.weighted)
            self.known[key] = _length(start, end) + extra
        return self.known[key]

    def way(self, start: Point, goal: Point) -> list[Point]:
        """Return the cheapest polyline through corners (Dijkstra's algorithm; each bend costs a little)."""
        points = [start, *self.corners, goal]
        best = [inf] * len(points)
        best[0] = 0.0
        before = [0] * len(points)
        open_ = set(range(len(points)))
        while open_:
            near = min(open_, key=lambda number: (best[number], number))
            open_.remove(near)
            if near == len(points) - 1:
                break
            for number in open_:
                reached = best[near] + 8.0
                if reached + _length(points[near], points[number]) < best[number]:
                    reached += self.cost(points[near], points[number])
                    if reached < best[number]:
                        best[number], before[number] = reached, near
        path = [len(points) - 1]
        while path[-1]:
            path.append(before[path[-1]])
        return [points[number] for number in reversed(path)]


def _label(box: Box) -> Box:
    return Box(box.x + PAD, box.y + 3, min(box.width - 2 * PAD, 5.5 * FONT), HEADER + 9)


def _corners(box: Box) -> Iterator[Point]:
    aside = GAP / 2
    for x in (box.x - aside, box.x + box.width + aside):
        for y in (box.y - aside, box.y + box.height + aside):
            yield x, y


def _length(one: Point, other: Point) -> float:
    return hypot(one[0] - other[0], one[1] - other[1])


def _overlap(start: Point, end: Point, box: Box) -> float:
    """Return the length of the part of a line that is in a box (Liang and Barsky)."""
    low, high = 0.0, 1.0
    for at, to, least, most in (
        (start[0], end[0], box.x + 1, box.x + box.width - 1),
        (start[1], end[1], box.y + 1, box.y + box.height - 1),
    ):
        step = to - at
        if abs(step) < 1e-9:
            if not least <= at <= most:
                return 0.0
            continue
        enter, leave = sorted(((least - at) / step, (most - at) / step))
        low, high = max(low, enter), min(high, leave)
        if low >= high:
            return 0.0
    return (high - low) * _length(start, end)


def _sampled(curve: Curve) -> list[Point]:
    (ax, ay), (bx, by), (cx, cy), (dx, dy) = curve
    found = []
    for step in range(SAMPLES + 1):
        t = step / SAMPLES
        a, b, c, d = (1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3
        found.append((a * ax + b * bx + c * cx + d * dx, a * ay + b * by + c * cy + d * dy))
    return found


def _rounded(way: Sequence[Point]) -> Curve:
    """Return a polyline with round corners, as cubic Béziers in a row."""
    curve = [way[0]]
    for before, corner, after in zip(way, way[1:], way[2:], strict=False):
        enter, leave = _short_of(corner, before), _short_of(corner, after)
        curve += [*_line(curve[-1], enter), _third(enter, corner), _third(leave, corner), leave]
    return (*curve, *_line(curve[-1], way[-1]))


def _stub(end: Point, towards: Point) -> Point:
    """Return the point where a link has left its end at a right angle."""
    length = _length(end, towards)
    share = min(1.0, STUB / length) if length else 0.0
    return end[0] + share * (towards[0] - end[0]), end[1] + share * (towards[1] - end[1])


def _short_of(corner: Point, other: Point) -> Point:
    length = _length(corner, other)
    share = min(0.5, ROUND / length) if length else 0.0
    return corner[0] + share * (other[0] - corner[0]), corner[1] + share * (other[1] - corner[1])


def _third(point: Point, corner: Point) -> Point:
    return (point[0] + 2 * corner[0]) / 3, (point[1] + 2 * corner[1]) / 3


def _line(start: Point, end: Point) -> tuple[Point, Point, Point]:
    return _third(end, start), _third(start, end), end
