"""Marks of a map, one function each, on the canvas of its sheet."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from physical.map_labels import Box, Spot
from physical.map_style import COAST, FAINT, HALO, INK, LAND, MARK, QUIET, SMALL, Outline
from physical.svg import Canvas, Paint, Words, text_width

RADIUS: Final = 5.5
"""The radius of a marker, in points."""

MARK_RADIUS: Final = RADIUS + 4.0
"""The radius of the dashed circle around a marked entity."""

NORTH: Final = 18.0
"""The width of the north arrow, with the space beside it."""

Curve = tuple[Spot, Spot, Spot]
"""A quadratic Bézier curve."""

LEADING: Final = 1.35
SPACING: Final = 6.0
"""Points between spots along a line."""

# The levels of a map, from back to front.
GROUND, AREAS, GLOWS, BORDERS, OUTLINES, LINES, HALOS, RINGS, MARKERS, TEXT = range(10)

GRID: Final = Paint(stroke=FAINT, width=0.8)
SHORE: Final = Paint(LAND, COAST, 0.9)
POLYGON_GLOW: Final = Paint(stroke=HALO, width=6.0, opacity=0.35)
POLYGON_MARK: Final = Paint(stroke=MARK, width=1.4, dash=(4, 2.5))
GLOW: Final = Paint(HALO, opacity=0.32)
RING: Final = Paint(stroke=MARK, width=1.2, dash=(3, 2))
LEADER: Final = Paint(stroke=QUIET, width=0.6, opacity=0.8)
SCALE: Final = Paint(stroke=INK, width=1.2)


@dataclass(frozen=True, slots=True)
class Line:
    """One line of a label; its icon, an outline with a colour, stands before the text and may glow or be marked."""

    text: str
    size: float = 8.0
    bold: bool = False
    ink: str = INK
    indent: float = 0.0
    icon: tuple[Outline, str] | None = None
    lit: bool = False
    marked: bool = False

    @property
    def start(self) -> float:
        """The start of the text, in points from the left."""
        return self.indent + (9.0 if self.icon else 0.0)


def block_size(lines: Sequence[Line]) -> Spot:
    """Return the width and height of a label, in points."""
    width = max(line.start + text_width(line.text, line.size, line.bold) for line in lines)
    return (width, sum(line.size * LEADING for line in lines))


def draw_block(canvas: Canvas, box: Box, lines: Sequence[Line], names: Sequence[str] = ()) -> None:
    """Write the lines of a label into its box, from the top; `names` are the represented names."""
    top = box.top
    for line in lines:
        height = line.size * LEADING
        baseline = top - height + line.size * 0.33
        _draw_line_icon(canvas, line, (box.left + line.indent + 3.5, baseline + line.size * 0.36))
        words = Words(line.size, line.ink, line.bold, halo=True)
        canvas.text((box.left + line.start, baseline), line.text, words, TEXT, names)
        top -= height


def _draw_line_icon(canvas: Canvas, line: Line, at: Spot) -> None:
    if line.icon:
        draw_icon(canvas, at, *line.icon, radius=2.8)
    if line.lit:
        draw_halo(canvas, at, 5.0)
    if line.marked:
        draw_mark(canvas, at, 4.6)


def draw_icon(
    canvas: Canvas, at: Spot, shape: Outline, colour: str, *, radius: float = RADIUS, hollow: bool = False
) -> None:
    """Draw a marker; a hollow one is in transit."""
    paint = Paint("#fff", colour, 1.4) if hollow else Paint(colour, "#fff", 0.8)
    canvas.polygon([(at[0] + radius * x, at[1] + radius * y) for x, y in shape], paint, MARKERS)


def draw_polygon(canvas: Canvas, outline: Sequence[Spot], colour: str, *, strength: float) -> None:
    """Draw a polygon: lightly filled, with a border of the same colour."""
    canvas.polygon(outline, Paint(colour, opacity=strength), AREAS)
    canvas.polygon(outline, Paint(stroke=colour, width=1.1, opacity=0.85), BORDERS)


def draw_polygon_halo(canvas: Canvas, outline: Sequence[Spot]) -> None:
    """Draw a glow along a polygon's border: it is highlighted."""
    canvas.polygon(outline, POLYGON_GLOW, GLOWS)


def draw_polygon_mark(canvas: Canvas, outline: Sequence[Spot]) -> None:
    """Draw a dashed border over a polygon's own: it is marked."""
    canvas.polygon(outline, POLYGON_MARK, OUTLINES)


def draw_halo(canvas: Canvas, at: Spot, radius: float = RADIUS + 5.0) -> None:
    """Draw a glow around a marker: it is highlighted."""
    canvas.circle(at, radius, GLOW, HALOS)


def draw_mark(canvas: Canvas, at: Spot, radius: float = MARK_RADIUS) -> None:
    """Draw a dashed circle around a marker: it is marked."""
    canvas.circle(at, radius, RING, RINGS)


def arc(start: Spot, end: Spot, bulge: float = 0.12) -> Curve:
    """Return the quadratic Bézier curve between two spots, with a bulge to the left as a share of its length."""
    (x1, y1), (x2, y2) = start, end
    return (start, ((x1 + x2) / 2 - (y2 - y1) * 2 * bulge, (y1 + y2) / 2 + (x2 - x1) * 2 * bulge), end)


def samples(curve: Curve) -> list[Spot]:
    """Return spots along a curve, without its ends."""
    (x1, y1), (x2, y2), (x3, y3) = curve
    parts = min(max(2, round(math.dist(curve[0], curve[2]) / SPACING)), 200)
    weights = [((1 - t) ** 2, 2 * t * (1 - t), t * t) for t in (part / parts for part in range(1, parts))]
    return [(a * x1 + b * x2 + c * x3, a * y1 + b * y2 + c * y3) for a, b, c in weights]


def draw_curve(canvas: Canvas, curve: Curve, colour: str) -> None:
    """Draw a channel between two of its members."""
    canvas.curve(curve, Paint(stroke=colour, opacity=0.7), LINES)


def draw_flight(canvas: Canvas, curve: Curve, colour: str) -> None:
    """Draw a dashed path with an arrow head at its end."""
    canvas.curve(curve, Paint(stroke=colour, width=1.4, dash=(5, 3)), LINES)
    draw_arrow(canvas, curve, colour)


def draw_arrow(canvas: Canvas, curve: Curve, colour: str) -> None:
    """Draw an arrow head at the end of a curve."""
    canvas.polygon(_head(curve[1], curve[2]), Paint(colour), LINES)


def _head(before: Spot, tip: Spot, length: float = 8.0) -> list[Spot]:
    direction = math.atan2(tip[1] - before[1], tip[0] - before[0])
    wings = [direction + math.pi - 0.42, direction + math.pi + 0.42]
    return [tip, *((tip[0] + length * math.cos(a), tip[1] + length * math.sin(a)) for a in wings)]


def draw_pointer(canvas: Canvas, at: Spot, behind: Spot, colour: str) -> None:
    """Draw an arrow head at the border of the view that points away from the spot `behind`."""
    canvas.polygon(_head(behind, at, 10.0), Paint(colour), MARKERS)


def draw_leader(canvas: Canvas, start: Spot, end: Spot) -> None:
    """Draw a thin leader line from a label to its object."""
    canvas.line([start, end], LEADER, OUTLINES)


def draw_scale(canvas: Canvas, box: Box, length: float, text: str, note: str = "") -> None:
    """Draw a scale bar in a box, with its length above, a note below, and a north arrow to the left."""
    right, y = box.right, box.top - 20.0
    left, x = right - length, box.left + NORTH / 2 - 2.0
    canvas.line([(left, y + 3), (left, y), (right, y), (right, y + 3)], SCALE, TEXT)
    words = Words(7.5, INK, anchor="middle", halo=True)
    canvas.text(((left + right) / 2, y + 6.3), text, words, TEXT)
    canvas.text((right, box.bottom + 1.4), note, Words(SMALL, QUIET, anchor="end", halo=True), TEXT)
    arrow = [(x, y + 12.0), (x + 3.6, y - 0.5), (x, y + 2.2), (x - 3.6, y - 0.5)]
    canvas.polygon(arrow, Paint(INK), TEXT)
    canvas.text((x, y + 13.8), "N", words, TEXT)


def draw_ground(canvas: Canvas, paper: str, polygons: Sequence[Sequence[Sequence[Spot]]]) -> None:
    """Draw a background colour, and land on it: polygons, each its border and its lakes."""
    canvas.rectangle((0.0, canvas.height), (canvas.width, canvas.height), Paint(paper), GROUND)
    for rings in polygons:
        canvas.rings(rings, SHORE, GROUND)


def draw_grid(canvas: Canvas, xs: Sequence[float], ys: Sequence[float]) -> None:
    """Draw meridians and parallels at these offsets."""
    for x in xs:
        canvas.line([(x, 0.0), (x, canvas.height)], GRID, GROUND)
    for y in ys:
        canvas.line([(0.0, y), (canvas.width, y)], GRID, GROUND)
