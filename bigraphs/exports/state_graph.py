"""The states and transitions of a system as one picture."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin
from typing import Final

from bigraphs.drawing import INK
from bigraphs.exports.dot import describe
from bigraphs.layout import FONT
from bigraphs.transitions import TransitionSystem
from physical.svg import Canvas, Paint, Point, Words

RADIUS: Final = 15.0
ARROW: Final = Paint(stroke="#9aa3b2")
TIP: Final = Paint("#7b8494")
TIP_LENGTH: Final = 6.0
NUMBER: Final = Words(FONT, INK, anchor="middle")


def graph_svg(system: TransitionSystem) -> str:
    """Return a picture of the states and transitions; a tooltip on an arrow shows its rules.

    States stand in rows by their distance from the initial state, each near its predecessors.
    """
    places = places_of(system)
    width = max((x for x, _ in places), default=0.0) + 2 * RADIUS + 20
    height = max((y for _, y in places), default=0.0) + 2 * RADIUS + 20
    canvas = Canvas(width, height)
    for each in system.transitions():
        arrow = Canvas(width, height)
        _draw_arrow(arrow, places[each.source], places[each.target])
        title = f"{each.source} to {each.target}: {describe(system, each)}"
        canvas.put(arrow, (0.0, 0.0), title=title)
    for state, (x, y) in enumerate(places):
        canvas.put(_state(system, state), (x, y), title=_title(system, state))
    return canvas.picture("states and transitions").svg


def places_of(system: TransitionSystem) -> list[tuple[float, float]]:
    """Return the position of each state: in rows by distance from the initial state, near its predecessor."""
    depth = [0] * len(system)
    rows: list[list[int]] = []
    for state in range(len(system)):
        depth[state] = depth[system.found_from[state]] + 1 if state else 0
        if depth[state] == len(rows):
            rows.append([])
        rows[depth[state]].append(state)
    widest = max(map(len, rows), default=0)
    x = [0.0] * len(system)
    for row in rows:
        row.sort(key=lambda state: (x[system.found_from[state]], state))
        for place, state in enumerate(row):
            x[state] = (place + 0.5) * widest / len(row) * 3.4 * RADIUS
    return [(x[state] + RADIUS, 2 * RADIUS + depth[state] * 5.0 * RADIUS) for state in range(len(system))]


def _draw_arrow(canvas: Canvas, start: Point, end: Point) -> None:
    (x, y), (u, v) = start, end
    if start == end:
        curve = [
            (x + RADIUS, y - 4),
            (x + RADIUS + 18, y - 18),
            (x + RADIUS + 18, y + 18),
            (x + RADIUS + 1, y + 5),
        ]
    else:
        along = hypot(u - x, v - y)
        dx, dy = (u - x) / along, (v - y) / along
        bend = min(26.0, along / 6)
        middle = ((x + u) / 2 - dy * bend, (y + v) / 2 + dx * bend)
        curve = [(x + dx * RADIUS, y + dy * RADIUS), middle, (u - dx * RADIUS, v - dy * RADIUS)]
    canvas.curve(curve, ARROW)
    (bx, by), (tx, ty) = curve[-2:]
    back = atan2(ty - by, tx - bx) + pi
    wings = [
        (tx + TIP_LENGTH * cos(back + turn), ty + TIP_LENGTH * sin(back + turn)) for turn in (-0.46, 0.46)
    ]
    canvas.polygon([(tx, ty), *wings], TIP)


def _state(system: TransitionSystem, state: int) -> Canvas:
    border, width = ("#4f86c6", 2.5 if state == 0 else 1.2) if system.leaving(state) else ("#cf6363", 2.0)
    fill = "#fdf1e3" if system.labels_of(state) else "#e8f1fd"
    dash = (3.0, 2.0) if state >= system.expanded else ()
    canvas = Canvas(2 * RADIUS, 2 * RADIUS)
    canvas.circle((0.0, 0.0), RADIUS, Paint(fill, border, width, dash))
    canvas.text((0.0, 0.35 * FONT), str(state), NUMBER)
    return canvas


def _title(system: TransitionSystem, state: int) -> str:
    labels = ", ".join(system.labels_of(state))
    return f"state {state}" + (f": {labels}" if labels else "")
