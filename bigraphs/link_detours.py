"""Obstacles of a drawing: a link that would cross boxes or labels takes a detour between them if that is shorter."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from heapq import heappop, heappush
from itertools import pairwise
from math import hypot, inf
from typing import Final, TypeAlias

from bigraphs.layout import GAP, HEADER, PAD, Box, Layout, label_size

Point: TypeAlias = tuple[float, float]
Curve: TypeAlias = tuple[Point, ...]

WEIGHT: Final = 9.0
CLEAR: Final = 3.7  # reduction of a detour's distance from boxes, by lanes and round corners
LARGEST: Final = 120  # boxes; links of a larger drawing are straight
ROUND: Final = 18.0
BEND: Final = 8.0
STRIDE: Final = 200.0
STUB: Final = GAP / 2
SAMPLES: Final = 16


class Obstacles:
    """The obstacles for links: innermost boxes, labels and names on the rim, with the corners of possible detours."""

    def __init__(self, layout: Layout) -> None:
        inner = innermost(layout)
        labels = label_boxes(layout)
        self.boxes = (*inner, *labels, *(box for _, box in (*layout.outer, *layout.inner)))
        few = len(inner) <= LARGEST
        self.corners = [corner for box in self.boxes for corner in _corners(box)] if few else []
        self.known: dict[tuple[Point, Point], float] = {}
        self.neighbours: dict[Point, list[Point]] = {}

    def avoid(self, curve: Curve, lane: int) -> Curve:
        """Return the curve, or a detour around the obstacles that it crosses; `lane` keeps parallel links apart."""
        if not self.corners:
            return curve
        if sum(self.within(one, other, -1.0) for one, other in pairwise(_sampled(curve))) < 2.0:
            return curve
        leave, arrive = _stub(curve[0], curve[1]), _stub(curve[-1], curve[-2])
        way = self.way(leave, arrive)
        shift = 1.8 * (lane % 5 - 2)
        around = [(x + shift, y + shift) for x, y in way[1:-1]]
        return _rounded([curve[0], leave, *around, arrive, curve[-1]])

    def cost(self, start: Point, end: Point) -> float:
        """Return the length of a line, with a higher weight for the parts inside obstacles."""
        key = (start, end) if start < end else (end, start)
        if key not in self.known:
            self.known[key] = _length(start, end) + WEIGHT * self.within(start, end, CLEAR)
        return self.known[key]

    def within(self, start: Point, end: Point, margin: float) -> float:
        """Return the length of a line inside the obstacles, enlarged by `margin`."""
        left, right = min(start[0], end[0]) - margin, max(start[0], end[0]) + margin
        above, below = min(start[1], end[1]) - margin, max(start[1], end[1]) + margin
        return sum(
            _overlap(start, end, box, margin)
            for box in self.boxes
            if box.x < right and left < box.x + box.width and box.y < below and above < box.y + box.height
        )

    def way(self, start: Point, goal: Point) -> list[Point]:
        """Return the cheapest polyline through corners (A*; each bend has a small cost), else a straight line."""
        best = {start: 0.0}
        before: dict[Point, Point] = {}
        waiting = [(_length(start, goal), start)]
        done: set[Point] = set()
        while waiting:
            _, here = heappop(waiting)
            if here == goal:
                break
            if here in done:
                continue
            done.add(here)
            for there in (*self.near(here), *([goal] if _length(here, goal) < STRIDE else [])):
                least = best[here] + BEND + _length(here, there)
                if there in done or least >= best.get(there, inf):
                    continue
                reached = best[here] + BEND + self.cost(here, there)
                if reached < best.get(there, inf):
                    best[there], before[there] = reached, here
                    heappush(waiting, (reached + _length(there, goal), there))
        path = [goal]
        while path[-1] in before:
            path.append(before[path[-1]])
        return path[::-1] if path[-1] == start else [start, goal]

    def near(self, here: Point) -> list[Point]:
        """Return the corners within a stride."""
        if here not in self.neighbours:
            self.neighbours[here] = [each for each in self.corners if 0 < _length(here, each) < STRIDE]
        return self.neighbours[here]


def innermost(layout: Layout) -> list[Box]:
    """Return the boxes without inner boxes."""
    nodes = [box for item, box in layout.boxes if item.kind != "region"]
    return [box for box in nodes if not any(box is not other and box.contains(other) for other in nodes)]


def label_boxes(layout: Layout) -> list[Box]:
    """Return the label areas of the boxes that contain others."""
    inner = set(innermost(layout))
    return [
        Box(box.x + PAD, box.y + 4, label_size(layout.shown, item)[0], HEADER + 6)
        for item, box in layout.boxes
        if item.kind == "node" and box not in inner
    ]


def _corners(box: Box) -> Iterator[Point]:
    aside = GAP / 2
    for x in (box.x - aside, box.x + box.width + aside):
        for y in (box.y - aside, box.y + box.height + aside):
            yield x, y


def _length(one: Point, other: Point) -> float:
    return hypot(one[0] - other[0], one[1] - other[1])


def _overlap(start: Point, end: Point, box: Box, margin: float) -> float:
    """Return the length of a line inside a box enlarged by `margin` (Liang and Barsky)."""
    low, high = 0.0, 1.0
    for at, to, least, most in (
        (start[0], end[0], box.x - margin, box.x + box.width + margin),
        (start[1], end[1], box.y - margin, box.y + box.height + margin),
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
    """Return a polyline with round corners, as a chain of cubic Béziers."""
    curve = [way[0]]
    for before, corner, after in zip(way, way[1:], way[2:], strict=False):
        enter, leave = _short_of(corner, before), _short_of(corner, after)
        curve += [*_line(curve[-1], enter), _third(enter, corner), _third(leave, corner), leave]
    return (*curve, *_line(curve[-1], way[-1]))


def _stub(end: Point, towards: Point) -> Point:
    """Return the end of the straight stub on which a link leaves its port at a right angle."""
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
