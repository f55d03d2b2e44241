"""Pictures of bigraphs: nested boxes, and curves for links."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from bigraphs.bigraph import Bigraph, Link
from bigraphs.errors import BigraphError
from bigraphs.layout import FONT, HEADER, PAD, SMALL, Box, BoxSubject, Layout, layout
from bigraphs.link_curves import LinkRoute, route
from bigraphs.node_labels import link_label
from physical.svg import Canvas, Paint, Picture, PictureError, Point, Words

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
FAINT: Final = "#8a93a3"
MARGIN: Final = 10.0
ENLARGED: Final = 1.25
LARGEST: Final = 1440.0
"""The largest width and height of a picture, in points."""

REGION: Final = Paint("#fbfcfe", "#aab4c4", dash=(4, 3))
SITE: Final = Paint("#eceff4", "#9aa3b2", 0.9, dash=(2, 2))
MARKED: Final = Paint(stroke="#1f2933", width=1.2, dash=(3, 2))
GLOW: Final = Paint(HIGHLIGHT, opacity=0.28)
UNDER: Final = Paint(stroke="#fff", width=3.6, opacity=0.75)
"""The light line under a link, which parts it from the lines that it crosses."""

LEAF: Final = 33.0
"""The greatest height of a box without content."""

# The levels of a drawing, from back to front; boxes are on the levels from 1 to 2, each on that of its depth.
OUTLINES: Final = 2.5
LINES: Final = 3.0
ENDS: Final = 4.0
TEXT: Final = 5.0


def draw_bigraph(
    bigraph: Bigraph, *, highlight: frozenset[str] = frozenset(), title: str | None = None
) -> Picture:
    """Return the picture of a bigraph; equal bigraphs give equal bytes.

    `highlight` holds node and link names. A dashed *ghost* stands for a node in its further places. In a large picture
    one box stands for several similar nodes.
    """
    canvas = draw_layout(layout(bigraph, highlight), highlight=highlight, title=title)
    return canvas.picture(title or "bigraph", min(ENLARGED, LARGEST / max(canvas.width, canvas.height)))


def save_bigraph(
    bigraph: Bigraph, path: str | Path, *, highlight: frozenset[str] = frozenset(), title: str | None = None
) -> None:
    """Write a picture as `.svg` or `.png`, by the suffix."""
    try:
        draw_bigraph(bigraph, highlight=highlight, title=title).save(path)
    except PictureError as error:
        raise BigraphError("picture", error.fact, error.remedy) from error


def draw_layout(
    plan: Layout,
    *,
    highlight: frozenset[str] = frozenset(),
    marked: frozenset[str] = frozenset(),
    title: str | None = None,
) -> Canvas:
    """Draw a layout like `draw_bigraph`; the nodes named in `marked` have a dashed outline."""
    head = 20.0 if title else 0.0
    size = plan.width + 2 * MARGIN, plan.height + 2 * MARGIN + head
    canvas = Canvas(*size, (MARGIN, MARGIN + head))
    _Pen(canvas, plan, highlight, marked).draw()
    if title:
        canvas.text((0.0, -head / 2), title, Words(FONT + 2, INK, bold=True))
    return canvas


class _Pen:
    """The canvas and the colours of a drawing, and its strokes."""

    def __init__(
        self, canvas: Canvas, plan: Layout, highlight: frozenset[str], marked: frozenset[str]
    ) -> None:
        self.canvas, self.plan, self.highlight, self.marked = canvas, plan, highlight, marked
        self.shown, self.bigraph = plan.shown, plan.shown.bigraph
        kinds = sorted(control.name for control in self.bigraph.signature.controls)  # the same in every state
        self.kinds = {kind: KINDS[number % len(KINDS)] for number, kind in enumerate(kinds)}

    def draw(self) -> None:
        for depth, (item, box) in enumerate(self.plan.boxes):
            self.box(item, box, 1 + depth / (len(self.plan.boxes) + 1))
        routes = route(self.plan)
        colours: Mapping[Link, str] = {each.link: LINKS[n % len(LINKS)] for n, each in enumerate(routes)}
        for each in routes:
            self.link(each, colours[each.link])
        inner = dict(self.bigraph.inner_links)
        for name, box in self.plan.outer:
            self.pill(name, box, colours.get(name, FAINT))
        for name, box in self.plan.inner:
            self.pill(name, box, colours.get(inner[name], FAINT))

    def box(self, item: BoxSubject, box: Box, level: float) -> None:
        if item.kind == "region":
            self.rounded(box, 10, REGION, level)
            if self.bigraph.regions > 1:
                self.text((box.x + PAD, box.y + HEADER / 2 + 1), f"region {item.number}", Words(SMALL, FAINT))
        elif item.kind == "site":
            self.rounded(box, 4, SITE, level)
            self.text(box.centre, f"${item.number}", Words(FONT, INK, anchor="middle"))
        elif item.kind == "ghost":
            _, border, ink = self.kinds[self.bigraph.nodes[item.number].control]
            self.rounded(box, 6, Paint(stroke=border, dash=(3, 2)), level)
            look = Words(FONT, ink, slanted=True, anchor="middle", opacity=0.75)
            self.text(box.centre, self.shown.lines[item.number][0], look)
        else:
            self.node(item.number, box, level)

    def node(self, number: int, box: Box, level: float) -> None:
        fill, border, ink = self.kinds[self.bigraph.nodes[number].control]
        name, kind = self.shown.lines[number]
        lit = name in self.highlight
        if lit:
            self.rounded(_around(box, 2.5), 9, GLOW, level)
        members = self.shown.members.get(number, ())
        if members:  # the edge of a second box shows behind
            self.rounded(replace(box, x=box.x + 3, y=box.y + 3), 7, Paint(fill, border), level)
        self.rounded(box, 7, Paint(fill, HIGHLIGHT if lit else border, 2.0 if lit else 1.3), level)
        if self.bigraph.nodes[number].name in self.marked:
            self.rounded(_around(box, 3), 9, MARKED, OUTLINES)
        holding = box.height > LEAF
        x, anchor = (box.x + PAD, "start") if holding else (box.centre[0], "middle")
        y = box.y + (HEADER / 2 + 3 if holding else box.height / 2 - (4.5 if kind else 0))
        self.text((x, y), name, Words(FONT, ink, bold=bool(members), anchor=anchor), members)
        self.text((x, y + 11), kind, Words(SMALL, border, anchor=anchor))

    def link(self, found: LinkRoute, colour: str) -> None:
        lit = link_label(found.link) in self.highlight
        line = Paint(stroke=HIGHLIGHT if lit else colour, width=2.4 if lit else 1.5, opacity=0.95)
        for curve in found.curves:
            self.canvas.curve(curve, UNDER, LINES)
        for curve in found.curves:
            self.canvas.curve(curve, line, LINES + 0.1)
        for port in found.ports:
            self.canvas.circle(port, 2.3, Paint(colour, "#fff", 0.7), ENDS)
        if found.dot:
            self.canvas.circle(found.dot, 3.2, Paint("#fff", colour, 1.5), ENDS)

    def pill(self, name: str, box: Box, colour: str) -> None:
        lit = name in self.highlight
        self.rounded(box, 8, Paint("#fff", HIGHLIGHT if lit else colour, 2.0 if lit else 1.2), ENDS)
        self.text(box.centre, name, Words(SMALL + 1, colour, anchor="middle"))

    def rounded(self, box: Box, radius: float, paint: Paint, level: float) -> None:
        self.canvas.rectangle((box.x, box.y), (box.width, box.height), paint, level, radius=radius)

    def text(self, at: Point, text: str, words: Words, names: Sequence[str] = ()) -> None:
        """Write a line whose middle is at a height."""
        self.canvas.text((at[0], at[1] + 0.3 * words.size), text, replace(words, halo=True), TEXT, names)


def _around(box: Box, by: float) -> Box:
    return Box(box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by)
