"""The layout of a drawing's boxes: a pure function of the bigraph, in points (1/72 inch), y downwards.

Boxes are packed into rows bottom-up, close to a pleasant aspect ratio, then stretched top-down so that rows are flush.
Outer names lie on the upper rim, inner names on the lower rim. A node with several places is drawn in the first; each
other place has a *ghost*, a small outline with its label.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from math import ceil, log
from typing import Final, TypeAlias

from bigraphs.bigraph import Bigraph, Link, Place, children, points, sites_in
from bigraphs.node_aggregation import Folded, folded
from bigraphs.node_labels import natural
from physical.svg import text_width

FONT: Final = 10.0
SMALL: Final = 7.5
PAD: Final = 9.0
GAP: Final = 15.0
HEADER: Final = 17.0
LEAF_HEIGHT: Final = 32.0
RIM: Final = 26.0
PILL_HEIGHT: Final = 17.0
SHAPE: Final = 1.7
LOOSE: Final = 1.12
"""The width of a label's place, as a multiple of its own width."""


@dataclass(frozen=True, slots=True)
class Box:
    """A rectangle: its upper left corner and its size."""

    x: float
    y: float
    width: float
    height: float

    @property
    def centre(self) -> tuple[float, float]:
        """Return the centre."""
        return self.x + self.width / 2, self.y + self.height / 2

    def contains(self, other: Box, slack: float = 1e-6) -> bool:
        """Return whether the other box lies within this one."""
        return (
            self.x <= other.x + slack
            and self.y <= other.y + slack
            and other.x + other.width <= self.x + self.width + slack
            and other.y + other.height <= self.y + self.height + slack
        )

    def overlaps(self, other: Box, slack: float = 1e-6) -> bool:
        """Return whether the boxes have inner points in common."""
        return (
            self.x + slack < other.x + other.width
            and other.x + slack < self.x + self.width
            and self.y + slack < other.y + other.height
            and other.y + slack < self.y + self.height
        )


@dataclass(frozen=True, slots=True)
class BoxSubject:
    """The subject of a box: a `region`, `node`, `site` or `ghost` of a node, its number, and the place of the box."""

    kind: str
    number: int
    place: Place | None = None


@dataclass(frozen=True, slots=True)
class Layout:
    """All boxes, parents before children, and a pill for each name on the rim.

    `shown` is the drawn bigraph, in which nodes may be folded.
    """

    shown: Folded
    width: float
    height: float
    boxes: tuple[tuple[BoxSubject, Box], ...]
    outer: tuple[tuple[str, Box], ...]
    inner: tuple[tuple[str, Box], ...]

    def box(self, kind: str, number: int) -> Box:
        """Return the first box of that kind and number."""
        return next(box for item, box in self.boxes if (item.kind, item.number) == (kind, number))


Size: TypeAlias = tuple[float, float]
Rows: TypeAlias = tuple[tuple[BoxSubject, ...], ...]


def layout(
    bigraph: Bigraph, apart: Collection[str] = frozenset(), marked: Collection[str] = frozenset()
) -> Layout:
    """Return the boxes of a drawing; they depend on the bigraph alone.

    In a large bigraph one box stands for several similar nodes, either all `marked` or none; the nodes in `apart` have
    their own boxes.
    """
    shown = folded(bigraph, apart, marked)
    bigraph = shown.bigraph
    tree = _tree(shown)
    sizes: dict[BoxSubject, Size] = {}
    rows: dict[BoxSubject, Rows] = {}
    headers: dict[BoxSubject, float] = {}
    for item in _bottom_up(tree, bigraph.regions):
        rows[item], (width, height) = _packed([(child, sizes[child]) for child in tree[item]])
        label = label_size(shown, item)
        headers[item] = _header(item, label)
        sizes[item] = _with_frame(item, (width, height), label)
    tops = [
        (BoxSubject("region", region), sizes[BoxSubject("region", region)])
        for region in range(bigraph.regions)
    ]
    tiers, (width, height) = _packed(tops)
    outer_rows = _pill_rows(bigraph.outer_names, max(width, 120.0))
    inner_rows = _pill_rows(bigraph.inner.names, max(width, 120.0))
    width = max(width, outer_rows.width, inner_rows.width)
    above = outer_rows.height
    boxes: dict[BoxSubject, Box] = {}
    _stretch(tiers, Box(0.0, above, width, height), sizes, boxes)
    for item in _top_down(tree, bigraph.regions):
        _stretch(rows[item], _inside(boxes[item], headers[item]), sizes, boxes)
    centres = _link_centres(
        bigraph, {item.number: box for item, box in boxes.items() if item.kind == "node"}, width
    )
    ordered = tuple((item, boxes[item]) for item in _top_down(tree, bigraph.regions))
    return Layout(
        shown,
        width,
        above + height + inner_rows.height,
        ordered,
        outer_rows.placed({name: centres.get(name, width / 2) for name in bigraph.outer_names}, 0.0, width),
        inner_rows.placed(
            {name: centres.get(link, width / 2) for name, link in bigraph.inner_links},
            above + height + RIM,
            width,
        ),
    )


def label_size(shown: Folded, item: BoxSubject) -> Size:
    """Return the size of a box's label, without the frame."""
    if item.kind == "region":
        several = shown.bigraph.regions > 1
        return (text_width(f"region {item.number}", SMALL), HEADER) if several else (0.0, 0.0)
    if item.kind == "site":
        return text_width(f"${item.number}", FONT), LEAF_HEIGHT - 12
    name, kind = shown.lines[item.number]
    width = LOOSE * max(text_width(name, FONT, item.number in shown.members), text_width(kind, SMALL))
    return (
        (width, LEAF_HEIGHT if kind else LEAF_HEIGHT - 8)
        if item.kind == "node"
        else (width, LEAF_HEIGHT - 10)
    )


def _tree(shown: Folded) -> dict[BoxSubject, list[BoxSubject]]:
    """Return the items drawn in each region and node: nodes in their first place, ghosts in the others."""
    bigraph = shown.bigraph
    inside, sited = children(bigraph), sites_in(bigraph)
    tree: dict[BoxSubject, list[BoxSubject]] = {}
    for place, nodes in inside.items():
        drawn = [
            BoxSubject("node", number)
            if bigraph.nodes[number].parents[0] == place
            else BoxSubject("ghost", number, place)
            for number in sorted(nodes, key=lambda number: natural(shown.lines[number][0]))
        ]
        drawn += [BoxSubject("site", site, place) for site in sited.get(place, ())]
        tree[BoxSubject("node", place) if place >= 0 else BoxSubject("region", ~place)] = drawn
    return tree


def _top_down(tree: Mapping[BoxSubject, Sequence[BoxSubject]], regions: int) -> list[BoxSubject]:
    order = [BoxSubject("region", region) for region in range(regions)]
    for item in order:  # the list grows during the loop
        order.extend(tree.get(item, ()))
    return order


def _bottom_up(tree: dict[BoxSubject, list[BoxSubject]], regions: int) -> list[BoxSubject]:
    order = _top_down(tree, regions)[::-1]
    for item in order:
        tree.setdefault(item, [])
    return order


def _packed(sized: Sequence[tuple[BoxSubject, Size]]) -> tuple[Rows, Size]:
    """Return the boxes in rows, and their total size; the rows balance a small area against the aspect ratio SHAPE."""
    if not sized:
        return (), (0.0, 0.0)
    tries = (_in_rows(sized, width) for width in _row_widths(sized))
    return min(tries, key=lambda rows: _badness(rows[1]))


def _row_widths(sized: Sequence[tuple[BoxSubject, Size]]) -> list[float]:
    widest = max(width for _, (width, _) in sized)
    sums = accumulate(width + GAP for _, (width, _) in sized)
    return sorted(
        {max(widest, total - GAP) for total in list(sums)[:60]} | {sum(w + GAP for _, (w, _) in sized)}
    )


def _in_rows(sized: Sequence[tuple[BoxSubject, Size]], limit: float) -> tuple[Rows, Size]:
    rows: list[list[tuple[BoxSubject, Size]]] = [[]]
    used = 0.0
    for item, (width, height) in sized:
        if rows[-1] and used + width > limit + 1e-6:
            rows.append([])
            used = 0.0
        rows[-1].append((item, (width, height)))
        used += width + GAP
    width = max(sum(w for _, (w, _) in row) + GAP * (len(row) - 1) for row in rows)
    height = sum(max(h for _, (_, h) in row) for row in rows) + GAP * (len(rows) - 1)
    return tuple(tuple(item for item, _ in row) for row in rows), (width, height)


def _badness(size: Size) -> float:
    width, height = size
    return log(width * height) + 0.9 * abs(log(width / height / SHAPE))


def _with_frame(item: BoxSubject, content: Size, label: Size) -> Size:
    """Return the size of a box: its label, and its content below."""
    if content == (0.0, 0.0):
        least = (90.0, 60.0) if item.kind == "region" else (0.0, 0.0)
        return max(label[0] + 2 * PAD, least[0]), max(label[1], least[1])
    header = _header(item, label)
    return max(content[0], label[0]) + 2 * PAD, content[1] + header + PAD


def _header(item: BoxSubject, label: Size) -> float:
    if item.kind == "region":
        return label[1] or PAD
    return (
        HEADER + GAP + (label[1] > LEAF_HEIGHT - 8) * 10.0
    )  # a lane for links between a label and the boxes


def _inside(box: Box, header: float) -> Box:
    return Box(box.x + PAD, box.y + header, box.width - 2 * PAD, box.height - PAD - header)


def _stretch(rows: Rows, room: Box, sizes: Mapping[BoxSubject, Size], boxes: dict[BoxSubject, Box]) -> None:
    """Place rows in a room and distribute the spare space: boxes with content grow, others are centred."""
    if not rows:
        return
    heights = [max(sizes[item][1] for item in row) for row in rows]
    more = (room.height - sum(heights) - GAP * (len(rows) - 1)) / len(rows)
    y = room.y
    for row, height in zip(rows, heights, strict=True):
        spare = room.width - sum(sizes[item][0] for item in row) - GAP * (len(row) - 1)
        x = room.x
        for item in row:
            slot = Box(x, y, sizes[item][0] + spare / len(row), height + more)
            boxes[item] = _fitted(item, slot, sizes[item])
            x += slot.width + GAP
        y += height + more + GAP


def _fitted(item: BoxSubject, slot: Box, size: Size) -> Box:
    """Return the whole slot for a box with content, else the centre of the slot."""
    if item.kind == "region" or size[1] > LEAF_HEIGHT:
        return slot
    width = min(slot.width, size[0] * 1.25)
    return Box(slot.x + (slot.width - width) / 2, slot.y + (slot.height - size[1]) / 2, width, size[1])


@dataclass(frozen=True, slots=True)
class _Pills:
    """Names on one side of the rim, in as few rows as possible."""

    names: tuple[str, ...]
    rows: int

    @property
    def height(self) -> float:
        return self.rows * (PILL_HEIGHT + GAP) + RIM - GAP if self.names else 0.0

    @property
    def width(self) -> float:
        return max((pill_width(name) for name in self.names), default=0.0)

    def placed(self, wanted: Mapping[str, float], top: float, width: float) -> tuple[tuple[str, Box], ...]:
        """Return the pills, near the points that they link, alternating between the rows."""
        order = sorted(self.names, key=lambda name: (wanted[name], name))
        found: list[tuple[str, Box]] = []
        for row in range(self.rows):
            names = order[row :: self.rows]
            y = top + row * (PILL_HEIGHT + GAP)
            lefts = _spread([pill_width(name) for name in names], [wanted[name] for name in names], width)
            found += [
                (name, Box(x, y, pill_width(name), PILL_HEIGHT)) for name, x in zip(names, lefts, strict=True)
            ]
        return tuple(sorted(found))


def pill_width(name: str) -> float:
    """Return the width of a name's pill on the rim."""
    return text_width(name, SMALL + 1) + 12


def _pill_rows(names: Sequence[str], width: float) -> _Pills:
    if not names:
        return _Pills((), 0)
    widths = [pill_width(name) + 8 for name in names]
    return _Pills(tuple(names), max(1, min(len(names), ceil(1.2 * sum(widths) / max(width, *widths)))))


def _spread(widths: Sequence[float], wanted: Sequence[float], room: float) -> list[float]:
    """Return left edges, in order, near the wanted centres, without overlap, and within the room if it suffices."""
    lefts: list[float] = []
    edge = 0.0
    for width, centre in zip(widths, wanted, strict=True):
        lefts.append(max(edge, centre - width / 2))
        edge = lefts[-1] + width + 8
    edge = max(room, sum(widths) + 8 * (len(widths) - 1))
    for number in range(len(lefts) - 1, -1, -1):
        lefts[number] = min(lefts[number], edge - widths[number])
        edge = lefts[number] - 8
    return lefts


def _link_centres(bigraph: Bigraph, boxes: Mapping[int, Box], width: float) -> dict[Link, float]:
    found = {}
    for link, on in points(bigraph).items():
        across = [boxes[number].centre[0] for number, _ in on]
        found[link] = sum(across) / len(across) if across else width / 2
    return found
