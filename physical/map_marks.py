"""Marks of a map, one function each, on matplotlib axes whose units are points."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from physical.map_labels import Box, Spot
from physical.map_style import COAST, FAINT, HALO, INK, LAND, MARK, PAPER, QUIET, Outline, text_width

if TYPE_CHECKING:
    from matplotlib.axes import Axes

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


def names_id(names: Sequence[str]) -> str:
    """Return the SVG id of an element that stands for several names."""
    return f"names:{', '.join(names)}"


def draw_block(
    axes: Axes, box: Box, lines: Sequence[Line], paper: str = PAPER, names: Sequence[str] = ()
) -> None:
    """Write the lines of a label into its box, from the top; `names` are the represented names."""
    from matplotlib.patheffects import withStroke  # noqa: PLC0415 - only drawing needs matplotlib

    top = box.top
    for line in lines:
        height = line.size * LEADING
        baseline = top - height + line.size * 0.33
        _draw_line_icon(axes, line, (box.left + line.indent + 3.5, baseline + line.size * 0.36))
        axes.text(
            box.left + line.start,
            baseline,
            line.text,
            fontsize=line.size,
            fontweight="bold" if line.bold else "normal",
            color=line.ink,
            parse_math=False,
            gid=names_id(names) if names else None,
            zorder=9,
            path_effects=[withStroke(linewidth=2.4, foreground=paper)],
        )
        top -= height


def _draw_line_icon(axes: Axes, line: Line, at: Spot) -> None:
    if line.icon:
        draw_icon(axes, at, *line.icon, radius=2.8)
    if line.lit:
        draw_halo(axes, at, 5.0)
    if line.marked:
        draw_mark(axes, at, 4.6)


def draw_icon(
    axes: Axes, at: Spot, shape: Outline, colour: str, *, radius: float = RADIUS, hollow: bool = False
) -> None:
    """Draw a marker; a hollow one is in transit."""
    from matplotlib.patches import Polygon  # noqa: PLC0415 - the same

    axes.add_patch(
        Polygon(
            [(at[0] + radius * x, at[1] + radius * y) for x, y in shape],
            facecolor="white" if hollow else colour,
            edgecolor=colour if hollow else "white",
            linewidth=1.4 if hollow else 0.8,
            joinstyle="round",
            zorder=7,
        )
    )


def draw_polygon(
    axes: Axes, outline: Sequence[Spot], colour: str, *, strength: float, width: float = 1.1
) -> None:
    """Draw a polygon: lightly filled, with a border of the same colour."""
    from matplotlib.patches import Polygon  # noqa: PLC0415 - the same

    axes.add_patch(Polygon(outline, facecolor=colour, alpha=strength, linewidth=0, zorder=2))
    axes.add_patch(
        Polygon(outline, facecolor="none", edgecolor=colour, alpha=0.85, linewidth=width, zorder=3)
    )


def draw_polygon_halo(axes: Axes, outline: Sequence[Spot]) -> None:
    """Draw a glow along a polygon's border: it is highlighted."""
    from matplotlib.patches import Polygon  # noqa: PLC0415 - the same

    axes.add_patch(Polygon(outline, facecolor="none", edgecolor=HALO, alpha=0.35, linewidth=6.0, zorder=2.5))


def draw_polygon_mark(axes: Axes, outline: Sequence[Spot]) -> None:
    """Draw a dashed border over a polygon's own: it is marked."""
    from matplotlib.patches import Polygon  # noqa: PLC0415 - the same

    axes.add_patch(
        Polygon(outline, facecolor="none", edgecolor=MARK, linewidth=1.4, linestyle=(0, (4, 2.5)), zorder=4)
    )


def draw_halo(axes: Axes, at: Spot, radius: float = RADIUS + 5.0) -> None:
    """Draw a glow around a marker: it is highlighted."""
    from matplotlib.patches import Circle  # noqa: PLC0415 - the same

    axes.add_patch(Circle(at, radius, facecolor=HALO, alpha=0.32, linewidth=0, zorder=5))


def draw_mark(axes: Axes, at: Spot, radius: float = MARK_RADIUS) -> None:
    """Draw a dashed circle around a marker: it is marked."""
    from matplotlib.patches import Circle  # noqa: PLC0415 - the same

    ring = Circle(
        at, radius, facecolor="none", edgecolor=MARK, linewidth=1.2, linestyle=(0, (3, 2)), zorder=6
    )
    axes.add_patch(ring)


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


def draw_curve(axes: Axes, curve: Curve, colour: str) -> None:
    """Draw a channel between two of its members."""
    from matplotlib.patches import PathPatch  # noqa: PLC0415 - the same
    from matplotlib.path import Path  # noqa: PLC0415 - the same

    path = Path(curve, [Path.MOVETO, Path.CURVE3, Path.CURVE3])
    axes.add_patch(PathPatch(path, facecolor="none", edgecolor=colour, linewidth=1.0, alpha=0.7, zorder=4.5))


def draw_flight(axes: Axes, curve: Curve, colour: str) -> None:
    """Draw a dashed path with an arrow head at its end."""
    from matplotlib.patches import PathPatch, Polygon  # noqa: PLC0415 - the same
    from matplotlib.path import Path  # noqa: PLC0415 - the same

    path = Path(curve, [Path.MOVETO, Path.CURVE3, Path.CURVE3])
    axes.add_patch(
        PathPatch(path, facecolor="none", edgecolor=colour, linewidth=1.4, linestyle=(0, (5, 3)), zorder=4.6)
    )
    axes.add_patch(Polygon(_head(curve[1], curve[2]), facecolor=colour, linewidth=0, zorder=4.7))


def _head(before: Spot, tip: Spot, length: float = 8.0) -> list[Spot]:
    direction = math.atan2(tip[1] - before[1], tip[0] - before[0])
    wings = [direction + math.pi - 0.42, direction + math.pi + 0.42]
    return [tip, *((tip[0] + length * math.cos(a), tip[1] + length * math.sin(a)) for a in wings)]


def draw_pointer(axes: Axes, at: Spot, behind: Spot, colour: str) -> None:
    """Draw an arrow head at the border of the view that points away from the spot `behind`."""
    from matplotlib.patches import Polygon  # noqa: PLC0415 - the same

    axes.add_patch(Polygon(_head(behind, at, 10.0), facecolor=colour, linewidth=0, zorder=7))


def draw_leader(axes: Axes, start: Spot, end: Spot) -> None:
    """Draw a thin leader line from a label to its object."""
    axes.plot([start[0], end[0]], [start[1], end[1]], color=QUIET, linewidth=0.6, alpha=0.8, zorder=4.4)


def draw_scale(axes: Axes, box: Box, length: float, text: str, note: str = "") -> None:
    """Draw a scale bar in a box, with its length above, a note below, and a north arrow to the left."""
    from matplotlib.patches import Polygon  # noqa: PLC0415 - the same

    right, y = box.right, box.top - 20.0
    left, x = right - length, box.left + NORTH / 2 - 2.0
    axes.plot([left, left, right, right], [y + 3, y, y, y + 3], color=INK, linewidth=1.2, zorder=8)
    style: dict[str, Any] = {"fontsize": 7.5, "color": INK, "ha": "center", "va": "bottom", "zorder": 8}
    axes.text((left + right) / 2, y + 4.5, text, **style)
    if note:
        axes.text(right, box.bottom, note, **style | {"fontsize": 6.0, "color": QUIET, "ha": "right"})
    arrow = [(x, y + 12.0), (x + 3.6, y - 0.5), (x, y + 2.2), (x - 3.6, y - 0.5)]
    axes.add_patch(Polygon(arrow, facecolor=INK, linewidth=0, zorder=8))
    axes.text(x, y + 12.0, "N", **style)


def draw_land(axes: Axes, polygons: Sequence[Sequence[Sequence[Spot]]]) -> None:
    """Draw land: polygons, each its border and its lakes."""
    from matplotlib.patches import PathPatch  # noqa: PLC0415 - the same
    from matplotlib.path import Path  # noqa: PLC0415 - the same

    for rings in polygons:
        path = Path.make_compound_path(*(Path([*ring, ring[0]], closed=True) for ring in rings))
        axes.add_patch(PathPatch(path, facecolor=LAND, edgecolor=COAST, linewidth=0.9, zorder=-1))


def draw_grid(
    axes: Axes, xs: Sequence[tuple[float, str]], ys: Sequence[tuple[float, str]], paper: str
) -> None:
    """Draw meridians and parallels, each with its offset in points and its label, on a background colour."""
    axes.set_facecolor(paper)
    axes.set_xticks([x for x, _ in xs], [text for _, text in xs])
    axes.set_yticks([y for y, _ in ys], [text for _, text in ys])
    axes.tick_params(length=0, pad=4, labelsize=7.5, labelcolor=QUIET)
    axes.grid(color=FAINT, linewidth=0.8, zorder=0)
    axes.set_axisbelow(True)
    for spine in axes.spines.values():
        spine.set(color="#cfd6dd", linewidth=0.8)
