"""Pictures of bigraphs: nested boxes and curves, by matplotlib, as SVG or PNG."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from bigraphs.bigraph import Bigraph, Link
from bigraphs.errors import BigraphError
from bigraphs.folding import Folded
from bigraphs.labels import link_label
from bigraphs.layout import FONT, HEADER, PAD, SMALL, Box, Item, Layout, layout
from bigraphs.link_curves import Route, route
from bigraphs.link_detours import Point

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Fill, border and text colours of the kinds of node, assigned in alphabetical order.
KINDS: Final = (
    ("#e8f1fd", "#4f86c6", "#1d4470"),
    ("#e9f7ee", "#4fa672", "#1d5635"),
    ("#fdf1e3", "#d08a3c", "#74450f"),
    ("#f3ebfb", "#8e6bbf", "#4a2d77"),
    ("#fdeaea", "#cf6363", "#7a2323"),
    ("#e6f6f6", "#3f9ea3", "#125257"),
    ("#f7f3dc", "#a8973a", "#574c10"),
    ("#f0f1f4", "#7b8494", "#363d49"),
)
LINKS: Final = ("#2f8f5b", "#c2567a", "#5b6ee1", "#c47f1a", "#2a93a8", "#9a57c2", "#8a6d3b", "#d14d3f")
HIGHLIGHT: Final = "#e4572e"
INK: Final = "#3b4252"
MARGIN: Final = 10.0
ENLARGED: Final = 1.25
LARGEST: Final = 20.0  # inches


def draw_bigraph(
    bigraph: Bigraph,
    axes: Axes | None = None,
    *,
    highlight: frozenset[str] = frozenset(),
    title: str | None = None,
) -> Axes:
    """Draw into matplotlib axes, new ones by default, and return them.

    The text scales with the present size of the axes, so labels always fit. `highlight` holds node and link names. A
    dashed *ghost* stands for a node in its further places. In a large picture one box stands for several similar nodes.
    """
    return draw_layout(layout(bigraph, highlight), axes, highlight=highlight, title=title)


def draw_layout(
    plan: Layout,
    axes: Axes | None = None,
    *,
    highlight: frozenset[str] = frozenset(),
    title: str | None = None,
) -> Axes:
    """Draw a layout like `draw_bigraph`."""
    axes = axes if axes is not None else _new_axes(plan, title)
    axes.set_xlim(-MARGIN, plan.width + MARGIN)
    axes.set_ylim(plan.height + MARGIN, -MARGIN - _head(title))
    axes.set_aspect("equal")
    axes.axis("off")
    pen = _Pen(axes, plan.shown, _scale(axes, plan, title), highlight)
    pen.draw(plan)
    if title:
        pen.text((0.0, -MARGIN - _head(title) / 2), title, FONT + 2, INK, "left", weight="bold")
    return axes


def save_bigraph(
    bigraph: Bigraph, path: str | Path, *, highlight: frozenset[str] = frozenset(), title: str | None = None
) -> None:
    """Write a picture as `.svg` or `.png`, by the suffix; equal bigraphs give equal bytes."""
    kind = Path(path).suffix.lower().lstrip(".")
    if kind not in ("svg", "png"):
        raise BigraphError(
            "picture", f"cannot write a picture as '{Path(path).name}'", "name it .svg or .png"
        )
    _save(bigraph, path, kind, highlight, title)


def bigraph_svg(bigraph: Bigraph) -> str:
    """Return a picture as SVG, at most as wide as a notebook page."""
    written = BytesIO()
    _save(bigraph, written, "svg", frozenset(), None)
    return fitting(written.getvalue().decode())


def fitting(svg: str) -> str:
    """Return the SVG with a width that shrinks with its page.

    >>> fitting('<svg width="96pt" height="72pt" viewBox="0 0 96 72">')
    '<svg style="width:100%;max-width:96pt;height:auto" viewBox="0 0 96 72">'
    """
    style = r'<svg\1style="width:100%;max-width:\2pt;height:auto"'
    return re.sub(r'<svg(\s[^>]*?)width="([\d.]+)(?:pt)?" height="[\d.]+(?:pt)?"', style, svg, count=1)


def _save(
    bigraph: Bigraph, target: str | Path | BytesIO, kind: str, highlight: frozenset[str], title: str | None
) -> None:
    import matplotlib as mpl  # noqa: PLC0415 - a picture is worth the wait, an import is not
    from matplotlib.figure import Figure  # noqa: PLC0415 - a picture is worth the wait, an import is not

    with mpl.rc_context({"svg.hashsalt": "bigraphs", "svg.fonttype": "none"}):
        axes = draw_bigraph(bigraph, highlight=highlight, title=title)
        figure = axes.figure
        assert isinstance(figure, Figure)  # new axes have a figure of their own
        stamp: dict[str, Any] = {"Date": None} if kind == "svg" else {"Software": None}
        figure.savefig(target, format=kind, dpi=160, metadata=stamp)


def names_id(names: Sequence[str]) -> str:
    """Return the SVG id of the text that stands for several names."""
    return f"names:{', '.join(names)}"


def _new_axes(plan: Layout, title: str | None) -> Axes:
    from matplotlib.figure import Figure  # noqa: PLC0415 - a picture is worth the wait, an import is not

    width, height = plan.width + 2 * MARGIN, plan.height + 2 * MARGIN + _head(title)
    inches = min(ENLARGED / 72, LARGEST / max(width, height))
    figure = Figure(figsize=(width * inches, height * inches), facecolor="white")
    return figure.add_axes((0.0, 0.0, 1.0, 1.0))


def _head(title: str | None) -> float:
    return 20.0 if title else 0.0


def _scale(axes: Axes, plan: Layout, title: str | None) -> float:
    """Return the number of paper points per layout point."""
    figure = axes.get_figure(root=True)
    width, height = figure.get_size_inches() if figure is not None else (1.0, 1.0)
    frame = axes.get_position()
    across = frame.width * width * 72 / (plan.width + 2 * MARGIN)
    return float(min(across, frame.height * height * 72 / (plan.height + 2 * MARGIN + _head(title))))


class _Pen:
    """The axes, colours and scale of a drawing, and its strokes."""

    def __init__(self, axes: Axes, shown: Folded, scale: float, highlight: frozenset[str]) -> None:
        self.axes, self.shown, self.scale, self.highlight = axes, shown, scale, highlight
        self.bigraph = bigraph = shown.bigraph
        kinds = sorted(control.name for control in bigraph.signature.controls)  # the same in every state
        self.kinds = {kind: KINDS[number % len(KINDS)] for number, kind in enumerate(kinds)}

    def draw(self, plan: Layout) -> None:
        holding = {item for item, box in plan.boxes if item.kind == "node" and box.height > _LEAF}
        for depth, (item, box) in enumerate(plan.boxes):
            self.box(item, box, 1 + depth * 1e-4, item in holding)
        routes = route(plan)
        colours: Mapping[Link, str] = {each.link: LINKS[n % len(LINKS)] for n, each in enumerate(routes)}
        for each in routes:
            self.link(each, colours[each.link])
        inner = dict(self.bigraph.inner_links)
        for name, box in plan.outer:
            self.pill(name, box, colours.get(name, "#8a93a3"))
        for name, box in plan.inner:
            self.pill(name, box, colours.get(inner[name], "#8a93a3"))

    def box(self, item: Item, box: Box, depth: float, holding: bool) -> None:
        if item.kind == "region":
            self.rounded(
                box, 10, depth, facecolor="#fbfcfe", edgecolor="#aab4c4", linestyle=(0, (4, 3)), linewidth=1.0
            )
            if self.bigraph.regions > 1:
                self.text(
                    (box.x + PAD, box.y + HEADER / 2 + 1), f"region {item.number}", SMALL, "#8a93a3", "left"
                )
        elif item.kind == "site":
            self.rounded(
                box, 4, depth, facecolor="#eceff4", edgecolor="#9aa3b2", linestyle=(0, (2, 2)), linewidth=0.9
            )
            self.text(box.centre, f"${item.number}", FONT, INK, "center")
        elif item.kind == "ghost":
            _, border, ink = self.kinds[self.bigraph.nodes[item.number].control]
            self.rounded(
                box, 6, depth, facecolor="none", edgecolor=border, linestyle=(0, (3, 2)), linewidth=1.0
            )
            self.text(
                box.centre, self.shown.lines[item.number][0], FONT, ink, "center", style="italic", alpha=0.75
            )
        else:
            self.node(item.number, box, depth, holding)

    def node(self, number: int, box: Box, depth: float, holding: bool) -> None:
        fill, border, ink = self.kinds[self.bigraph.nodes[number].control]
        name, kind = self.shown.lines[number]
        lit = name in self.highlight
        if lit:
            glow = Box(box.x - 2.5, box.y - 2.5, box.width + 5, box.height + 5)
            self.rounded(glow, 9, depth, facecolor=HIGHLIGHT, edgecolor="none", alpha=0.28, linewidth=0)
        edge, width = (HIGHLIGHT, 2.0) if lit else (border, 1.3)
        self.rounded(box, 7, depth, facecolor=fill, edgecolor=edge, linewidth=width)
        if folded := number in self.shown.members:  # the edge of a second box shows behind
            behind = Box(box.x + 3, box.y + 3, box.width, box.height)
            self.rounded(behind, 7, depth - 5e-5, facecolor=fill, edgecolor=border, linewidth=1.0)
        x, side = (box.x + PAD, "left") if holding else (box.centre[0], "center")
        y = box.y + (HEADER / 2 + 3 if holding else box.height / 2 - (4.5 if kind else 0))
        names = names_id(self.shown.members[number]) if folded else None
        self.text((x, y), name, FONT, ink, side, weight="bold" if folded else "normal", gid=names)
        if kind:
            self.text((x, y + 11), kind, SMALL, border, side)

    def link(self, found: Route, colour: str) -> None:
        from matplotlib.patches import Circle, PathPatch  # noqa: PLC0415 - see save_bigraph
        from matplotlib.path import Path as Outline  # noqa: PLC0415 - see save_bigraph

        lit = link_label(found.link) in self.highlight
        for curve in found.curves:
            for width, ink, level in (
                (3.6, "white", 3.0),
                (2.4 if lit else 1.5, HIGHLIGHT if lit else colour, 3.1),
            ):
                outline = Outline(curve, [Outline.MOVETO, *[Outline.CURVE4] * (len(curve) - 1)])
                style: dict[str, Any] = {
                    "linewidth": width * self.scale,
                    "alpha": 0.75 if ink == "white" else 0.95,
                }
                self.axes.add_patch(
                    PathPatch(
                        outline, facecolor="none", edgecolor=ink, capstyle="round", zorder=level, **style
                    )
                )
        for port in found.ports:
            style = {"facecolor": colour, "edgecolor": "white", "linewidth": 0.7 * self.scale}
            self.axes.add_patch(Circle(port, 2.3, zorder=4, **style))
        if found.dot:
            style = {"facecolor": "white", "edgecolor": colour, "linewidth": 1.5 * self.scale}
            self.axes.add_patch(Circle(found.dot, 3.2, zorder=4, **style))

    def pill(self, name: str, box: Box, colour: str) -> None:
        lit = name in self.highlight
        self.rounded(
            box,
            8,
            4,
            facecolor="white",
            edgecolor=HIGHLIGHT if lit else colour,
            linewidth=2.0 if lit else 1.2,
        )
        self.text(box.centre, name, SMALL + 1, colour, "center")

    def rounded(self, box: Box, radius: float, level: float, *, linewidth: float, **style: Any) -> None:
        from matplotlib.patches import FancyBboxPatch  # noqa: PLC0415 - see save_bigraph

        shape = f"round,pad=0,rounding_size={min(radius, box.height / 2)}"
        corner, width = (box.x, box.y), linewidth * self.scale
        self.axes.add_patch(
            FancyBboxPatch(
                corner, box.width, box.height, boxstyle=shape, zorder=level, linewidth=width, **style
            )
        )

    def text(self, at: Point, words: str, size: float, colour: str, side: str, **style: Any) -> None:
        from matplotlib.patheffects import withStroke  # noqa: PLC0415 - see save_bigraph

        halo = withStroke(linewidth=2.2 * self.scale, foreground="white", alpha=0.75)
        look: dict[str, Any] = {
            "fontsize": size * self.scale,
            "color": colour,
            "ha": side,
            "va": "center",
            "zorder": 5,
        }
        written = self.axes.text(at[0], at[1], words, **look, **style)
        written.set_path_effects([halo])


_LEAF = 33.0
