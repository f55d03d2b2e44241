"""Bigraphs and transition systems as compact SVG, so that one page can hold hundreds of them."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from math import hypot
from typing import Final

from bigraphs.bigraph import Bigraph
from bigraphs.drawing import INK, KINDS, LINKS, MARGIN
from bigraphs.exports.dot import describe
from bigraphs.folding import Folded
from bigraphs.layout import FONT, HEADER, PAD, SMALL, Box, Item, layout
from bigraphs.link_curves import Route, route
from bigraphs.transitions import TransitionSystem

RADIUS: Final = 15.0
_NOTHING: Final = ("#fbfcfe", "#aab4c4", "#8a93a3")


def bigraph_svg(bigraph: Bigraph) -> str:
    """Return a picture of a bigraph: nested boxes, and curves for links."""
    plan = layout(bigraph)
    width, height = plan.width + 2 * MARGIN, plan.height + 2 * MARGIN
    parts = [_head(width, height, -MARGIN, -MARGIN)]
    for item, box in plan.boxes:
        parts += _item(plan.shown, item, box)
    for number, each in enumerate(route(plan)):
        parts += _link(each, LINKS[number % len(LINKS)])
    for name, box in (*plan.outer, *plan.inner):
        parts.append(_rectangle(box, 8, "white", "#8a93a3"))
        parts.append(_text(box.centre, name, SMALL + 1, INK, "middle"))
    return "".join([*parts, "</svg>"])


def _head(width: float, height: float, x: float, y: float) -> str:
    size = f'width="{width:.0f}" height="{height:.0f}" viewBox="{x:.1f} {y:.1f} {width:.1f} {height:.1f}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="sans-serif">'


def _item(shown: Folded, item: Item, box: Box) -> Iterator[str]:
    if item.kind in ("region", "site"):
        yield _rectangle(
            box, 8, _NOTHING[0] if item.kind == "region" else "#eceff4", _NOTHING[1], dashed=True
        )
        if item.kind == "site":
            yield _text(box.centre, f"${item.number}", FONT, INK, "middle")
        return
    kinds = sorted(control.name for control in shown.bigraph.signature.controls)
    kind = shown.bigraph.nodes[item.number].control
    fill, border, ink = KINDS[kinds.index(kind) % len(KINDS)]
    if item.kind == "ghost":
        yield _rectangle(box, 6, "none", border, dashed=True)
        yield _text(box.centre, shown.lines[item.number][0], FONT, ink, "middle")
        return
    if item.number in shown.members:
        yield _rectangle(Box(box.x + 3, box.y + 3, box.width, box.height), 7, fill, border)
    yield _rectangle(box, 7, fill, border)
    name, below = shown.lines[item.number]
    holds = box.height > 2 * HEADER
    x, side = (box.x + PAD, "start") if holds else (box.centre[0], "middle")
    y = box.y + (HEADER / 2 + 3 if holds else box.height / 2 - (4.5 if below else 0))
    yield _text((x, y), name, FONT, ink, side)
    if below:
        yield _text((x, y + 11), below, SMALL, border, side)


def _link(found: Route, colour: str) -> Iterator[str]:
    for curve in found.curves:
        points = [f"{x:.1f} {y:.1f}" for x, y in curve]
        path = f"M{points[0]} C{' '.join(points[1:])}"
        yield f'<path d="{path}" fill="none" stroke="white" stroke-width="3.6"/>'
        yield f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="1.5"/>'
    for x, y in found.ports:
        yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.3" fill="{colour}"/>'
    if found.dot:
        x, y = found.dot
        yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.2" fill="white" stroke="{colour}" stroke-width="1.5"/>'


def _rectangle(box: Box, radius: float, fill: str, border: str, *, dashed: bool = False) -> str:
    place = f'x="{box.x:.1f}" y="{box.y:.1f}" width="{box.width:.1f}" height="{box.height:.1f}" rx="{radius}"'
    dash = ' stroke-dasharray="4 3"' if dashed else ""
    return f'<rect {place} fill="{fill}" stroke="{border}"{dash}/>'


def _text(at: tuple[float, float], words: str, size: float, colour: str, side: str) -> str:
    where = f'x="{at[0]:.1f}" y="{at[1] + size * 0.35:.1f}" text-anchor="{side}"'
    return f'<text {where} font-size="{size}" fill="{colour}">{escape(words)}</text>'


def graph_svg(system: TransitionSystem) -> str:
    """Return a picture of the states and transitions; a tooltip on an arrow shows its rules.

    States stand in rows by their distance from the initial state, each near its predecessors.
    """
    places = places_of(system)
    width = max(x for x, _ in places) + 2 * RADIUS + 20
    height = max(y for _, y in places) + 2 * RADIUS + 20
    return "".join(
        [_head(width, height, 0, 0), _MARKER, *_arrows(system, places), *_states(system, places), "</svg>"]
    )


_MARKER: Final = (
    '<defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="6" markerHeight="6" orient="auto">'
    '<path d="M0 0L8 4L0 8z" fill="#7b8494"/></marker></defs>'
)


def places_of(system: TransitionSystem) -> list[tuple[float, float]]:
    """Return the position of each state: in rows by distance from the initial state, near its predecessor."""
    depth = [0] * len(system)
    rows: list[list[int]] = [[0]]
    for state in range(1, len(system)):
        depth[state] = depth[system.found_from[state]] + 1
        if depth[state] == len(rows):
            rows.append([])
        rows[depth[state]].append(state)
    widest = max(map(len, rows))
    x = [0.0] * len(system)
    for row in rows:
        row.sort(key=lambda state: (x[system.found_from[state]], state))
        for place, state in enumerate(row):
            x[state] = (place + 0.5) * widest / len(row) * 3.4 * RADIUS
    return [(x[state] + RADIUS, 2 * RADIUS + depth[state] * 5.0 * RADIUS) for state in range(len(system))]


def _arrows(system: TransitionSystem, places: list[tuple[float, float]]) -> Iterator[str]:
    for each in system.transitions():
        title = f"<title>{each.source} to {each.target}: {escape(describe(system, each))}</title>"
        path = _arrow(places[each.source], places[each.target], loop=each.source == each.target)
        yield (
            f'<path class="t" data-from="{each.source}" data-to="{each.target}" d="{path}" fill="none" '
            f'stroke="#9aa3b2" marker-end="url(#tip)">{title}</path>'
        )


def _arrow(start: tuple[float, float], end: tuple[float, float], *, loop: bool) -> str:
    (x, y), (u, v) = start, end
    if loop:
        return f"M{x + RADIUS:.1f} {y - 4:.1f} c18 -14 18 22 1 9"
    along = hypot(u - x, v - y)
    dx, dy = (u - x) / along, (v - y) / along
    bend = min(26.0, along / 6)
    middle = ((x + u) / 2 - dy * bend, (y + v) / 2 + dx * bend)
    begin, finish = (x + dx * RADIUS, y + dy * RADIUS), (u - dx * RADIUS, v - dy * RADIUS)
    return f"M{begin[0]:.1f} {begin[1]:.1f} Q{middle[0]:.1f} {middle[1]:.1f} {finish[0]:.1f} {finish[1]:.1f}"


def _states(system: TransitionSystem, places: list[tuple[float, float]]) -> Iterator[str]:
    for state, (x, y) in enumerate(places):
        labels = system.labels_of(state)
        fill = "#fdf1e3" if labels else "#e8f1fd"
        border, width = (
            ("#cf6363", 2.0) if not system.leaving(state) else ("#4f86c6", 2.5 if state == 0 else 1.2)
        )
        dash = ' stroke-dasharray="3 2"' if state >= system.expanded else ""
        yield (
            f'<g class="s" data-state="{state}"><title>state {state}{": " if labels else ""}'
            f'{escape(", ".join(labels))}</title><circle cx="{x:.1f}" cy="{y:.1f}" r="{RADIUS}" fill="{fill}" '
            f'stroke="{border}" stroke-width="{width}"{dash}/>{_text((x, y), str(state), FONT, INK, "middle")}</g>'
        )
