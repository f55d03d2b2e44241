"""Curves of links in a drawing: from ports on the borders of boxes to each other, to a dot or to a name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import hypot
from typing import Final

from bigraphs.bigraph import Bigraph, Link, points
from bigraphs.layout import Box, Layout
from bigraphs.link_detours import Curve, Obstacles, Point

NORMALS: Final[Mapping[str, Point]] = {"top": (0, -1), "bottom": (0, 1), "left": (-1, 0), "right": (1, 0)}


@dataclass(frozen=True, slots=True)
class LinkRoute:
    """One link: its curves (chains of cubic Béziers), the ports at their starts, and its optional dot."""

    link: Link
    curves: tuple[Curve, ...]
    ports: tuple[Point, ...]
    dot: Point | None


@dataclass(frozen=True, slots=True)
class _End:
    """A port before it has a position on its side."""

    link: Link
    node: int
    side: str
    target: Point


def route(layout: Layout) -> tuple[LinkRoute, ...]:
    """Return the curves of every link that joins something."""
    bigraph = layout.shown.bigraph
    boxes = {item.number: box for item, box in layout.boxes if item.kind == "node"}
    goals = _goals(bigraph, layout, boxes)
    ends = _ends(bigraph, boxes, goals)
    places = _spaced(ends, boxes)
    obstacles = Obstacles(layout)
    found = []
    for lane, (link, on) in enumerate(points(bigraph).items()):
        mine = [(end, place) for end, place in zip(ends, places, strict=True) if end.link == link]
        names = [box for name, box in layout.inner if dict(bigraph.inner_links)[name] == link]
        if on or names:
            straight = _route(link, mine, goals[link], [_above(box) for box in names])
            found.append(
                replace(straight, curves=tuple(obstacles.avoid(curve, lane) for curve in straight.curves))
            )
    return tuple(found)


def _goals(bigraph: Bigraph, layout: Layout, boxes: Mapping[int, Box]) -> dict[Link, Point]:
    """Return the meeting point of each link's curves: its name, or the middle of its ends."""
    outer = dict(layout.outer)
    goals: dict[Link, Point] = {}
    for link, on in points(bigraph).items():
        if isinstance(link, str):
            goals[link] = outer[link].centre[0], outer[link].y + outer[link].height
            continue
        spots = [boxes[number].centre for number, _ in on]
        spots += [_above(box) for name, box in layout.inner if dict(bigraph.inner_links)[name] == link]
        if spots:
            goals[link] = _middle(spots, list(boxes.values()), layout)
    return goals


def _middle(spots: Sequence[Point], boxes: Sequence[Box], layout: Layout) -> Point:
    """Return the point outside all innermost boxes that is nearest to the middle of the spots."""
    x, y = (sum(spot[axis] for spot in spots) / len(spots) for axis in (0, 1))
    close = [box for box in boxes if _near((x, y), box, 6.0 * 14 + 5.0)]
    inner = [box for box in close if not any(box is not other and box.contains(other) for other in close)]
    around = [(x + 6 * dx, y + 6 * dy) for dx in range(-14, 15) for dy in range(-14, 15)]
    free = [p for p in around if 0 < p[0] < layout.width and not any(_near(p, box, 5.0) for box in inner)]
    return min(free, key=lambda p: (hypot(p[0] - x, p[1] - y), p), default=(x, y))


def _near(point: Point, box: Box, margin: float) -> bool:
    return (
        box.x - margin < point[0] < box.x + box.width + margin
        and box.y - margin < point[1] < box.y + box.height + margin
    )


def _above(box: Box) -> Point:
    return box.centre[0], box.y


def _ends(bigraph: Bigraph, boxes: Mapping[int, Box], goals: Mapping[Link, Point]) -> list[_End]:
    ends = []
    for link, on in points(bigraph).items():
        for number, _ in on:
            target = _other_end(link, number, on, boxes, goals[link])
            ends.append(_End(link, number, _side(boxes[number], target), target))
    return ends


def _other_end(
    link: Link, number: int, on: Sequence[tuple[int, int]], boxes: Mapping[int, Box], goal: Point
) -> Point:
    """Return the target of a port: the other box of an edge with two ends, else the meeting point of the curves."""
    others = [other for other, _ in on if other != number]
    return boxes[others[0]].centre if isinstance(link, int) and len(on) == 2 and others else goal


def _side(box: Box, target: Point) -> str:
    dx, dy = ((target[0] - box.centre[0]) / box.width, (target[1] - box.centre[1]) / box.height)
    if abs(dx) > abs(dy):
        return "right" if dx > 0 else "left"
    return "bottom" if dy > 0 else "top"


def _spaced(ends: Sequence[_End], boxes: Mapping[int, Box]) -> list[Point]:
    """Space the ports on one side of a box evenly, in the order of their targets."""
    sides: dict[tuple[int, str], list[int]] = {}
    for number, end in enumerate(ends):
        sides.setdefault((end.node, end.side), []).append(number)
    places: dict[int, Point] = {}
    for (node, side), here in sides.items():
        axis = 0 if side in ("top", "bottom") else 1
        here.sort(key=lambda number: (ends[number].target[axis], number))
        for rank, number in enumerate(here):
            places[number] = _on_side(boxes[node], side, (rank + 1) / (len(here) + 1))
    return [places[number] for number in range(len(ends))]


def _on_side(box: Box, side: str, share: float) -> Point:
    if side in ("top", "bottom"):
        return box.x + share * box.width, box.y + (box.height if side == "bottom" else 0.0)
    return box.x + (box.width if side == "right" else 0.0), box.y + share * box.height


def _route(link: Link, ends: Sequence[tuple[_End, Point]], goal: Point, names: Sequence[Point]) -> LinkRoute:
    ports = tuple(place for _, place in ends)
    if isinstance(link, int) and len(ends) == 2 and not names and ends[0][0].node != ends[1][0].node:
        (one, start), (other, end) = ends
        return LinkRoute(link, (_between(start, one.side, end, other.side),), ports, None)
    down = (0.0, 1.0) if isinstance(link, str) else None
    curves = [_towards(place, NORMALS[end.side], goal, down) for end, place in ends]
    curves += [_towards(name, NORMALS["top"], goal, down) for name in names]
    return LinkRoute(link, tuple(curves), ports, None if isinstance(link, str) else goal)


def _reach(start: Point, end: Point) -> float:
    return min(110.0, max(10.0, 0.42 * hypot(end[0] - start[0], end[1] - start[1])))


def _along(point: Point, direction: Point, length: float) -> Point:
    return point[0] + direction[0] * length, point[1] + direction[1] * length


def _between(start: Point, side: str, end: Point, other: str) -> Curve:
    reach = _reach(start, end)
    return start, _along(start, NORMALS[side], reach), _along(end, NORMALS[other], reach), end


def _towards(start: Point, normal: Point, goal: Point, arrival: Point | None) -> Curve:
    reach = _reach(start, goal)
    bend = _along(start, normal, reach)
    late = (
        _along(goal, arrival, reach)
        if arrival
        else ((2 * goal[0] + bend[0]) / 3, (2 * goal[1] + bend[1]) / 3)
    )
    return start, bend, late, goal
