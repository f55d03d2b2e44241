"""The text on a map: names, the scale bar and notes, without overlaps."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import shapely

from physical.geometry_measures import metres_text
from physical.land import ACCURACY
from physical.map_labels import BESIDE, Box, Spot, Wanted, around, place_labels
from physical.map_marks import (
    MARK_RADIUS,
    NORTH,
    RADIUS,
    SPACING,
    Line,
    block_size,
    draw_block,
    draw_leader,
    draw_pointer,
    draw_scale,
)
from physical.map_region_drawing import draw_spans, span_boxes
from physical.map_scene import Scene, Sheet, area_of
from physical.map_style import INK, QUIET, SMALL, darker
from physical.map_view import bounds, scale_length
from physical.outliers import apart
from physical.svg import Canvas, shortened, text_width

MOST_CARRIED: Final = 8
"""The largest number of named cargo items of an entity."""

COAST_NOTE: Final = f"coasts ± {metres_text(ACCURACY)}"

FAR_FROM_PLACE: Final = 24.0
"""The largest distance in points between a place and its name; beyond it they look unrelated."""

FEW: Final = 3
"""The largest number of names in a note; more are only counted."""

FARTHEST: Final = 60.0
"""Points from the centre of a polygon beyond which its label is not moved outside."""


@dataclass(frozen=True, slots=True)
class Writing:
    """The layout of the text: the lines of each label with its box, the scale bar, and notes.

    `unnamed` lists the entities without room for their names.
    """

    blocks: Mapping[str, Sequence[Line]]
    wanted: Mapping[str, Wanted]
    boxes: Mapping[str, Box]
    pointers: Mapping[str, tuple[Spot, Spot]]
    markers: tuple[Box, ...]
    scale: Box
    spans: tuple[Box, ...]
    notes: tuple[tuple[Box, Sequence[Line], tuple[str, ...]], ...]
    unnamed: tuple[str, ...]


def writing_of(scene: Scene, lines: Sequence[Spot]) -> Writing:
    """Return the layout of all text; it avoids `lines`, spots along drawn lines."""
    pointers = {name: _pointer(scene, name) for name in sorted(scene.far)}
    markers = (
        *(around(scene.middle(n), (2 * RADIUS + 3,) * 2) for n in scene.near() if not scene.is_polygon(n)),
        *(around(at, (18.0, 18.0)) for at, _ in pointers.values()),
    )
    length, text = _scale(scene.sheet)
    size = (NORTH + max(length, text_width(text, 7.5)), 30.0 if scene.land else 22.0)
    scale = _corner(scene.sheet, size, markers)
    spans = span_boxes(scene, [*markers, scale])
    absent = _note(scene, ["not in P:", *_listed(scene.absent)], scene.absent, [*markers, scale, *spans])
    taken = [*markers, scale, *spans, *(box for box, _, _ in absent)]
    polygons = [scene.outlines[name] for name in scene.near() if scene.is_polygon(name)]
    borders = [spot for outline in polygons for spot in _along(outline)]
    names = sorted([*scene.near(), *scene.far], key=lambda name: (_freedom(scene, name), name))
    blocks = {name: _block(scene, name) for name in names}
    wanted = {name: _wanted(scene, name, block_size(blocks[name]), pointers) for name in names}
    found = place_labels(list(wanted.values()), taken, [*lines, *borders], scene.sheet.box.grown(-3.0))
    boxes = {name: box for name, box in zip(names, found, strict=True) if box is not None}
    unnamed = tuple(name for name in names if name not in boxes)
    kinds = Counter(scene.entities[name].kind for name in unnamed)
    counts = [f"{kind} ×{count}" for kind, count in sorted(kinds.items())]
    words = ["no room to name:", *_listed(unnamed if len(unnamed) <= FEW else counts)]
    folded = _note(scene, words, unnamed, [*taken, *boxes.values()])
    return Writing(blocks, wanted, boxes, pointers, markers, scale, spans, (*absent, *folded), unnamed)


def write_labels(canvas: Canvas, scene: Scene, writing: Writing) -> None:
    """Write all names, the scale bar, the metres of lines and the notes, so that no two overlap."""
    draw_spans(canvas, scene, writing.spans)
    draw_scale(canvas, writing.scale, *_scale(scene.sheet), COAST_NOTE if scene.land else "")
    for box, lines_of_note, names in writing.notes:
        draw_block(canvas, box, lines_of_note, names=names)
    for name, box in writing.boxes.items():
        draw_block(canvas, box, writing.blocks[name], names=scene.members.get(name, ()))
        _lead(canvas, scene, name, box, writing.wanted[name])
    for name, (at, behind) in writing.pointers.items():
        draw_pointer(canvas, at, behind, scene.colour(name))


def _scale(sheet: Sheet) -> tuple[float, str]:
    """Return the length of the scale bar, in points, and its text."""
    metres = scale_length(sheet.view.width)
    return (metres * sheet.width / sheet.view.width, metres_text(metres))


def _note(
    scene: Scene, words: Sequence[str], names: tuple[str, ...], taken: Sequence[Box]
) -> tuple[tuple[Box, Sequence[Line], tuple[str, ...]], ...]:
    """Return a note about these names, empty without any."""
    if not names:
        return ()
    room = scene.sheet.width - 24.0
    wrapped = _wrapped(words, scene.sheet.width / 2)
    lines = [Line(shortened(line, room, SMALL), SMALL, ink=QUIET) for line in wrapped]
    return ((_corner(scene.sheet, block_size(lines), taken), lines, names),)


def _listed(words: Sequence[str]) -> list[str]:
    return [*(f"{word}," for word in words[:-1]), *words[-1:]]


def _wrapped(words: Sequence[str], width: float) -> list[str]:
    lines = [words[0]]
    for word in words[1:]:
        longer = f"{lines[-1]} {word}"
        if text_width(longer, SMALL) <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def _lead(canvas: Canvas, scene: Scene, name: str, box: Box, want: Wanted) -> None:
    """Draw a leader line from a label to its object, unless it stands inside it or beside it."""
    named = shapely.Point(want.at)
    if scene.is_polygon(name) and name not in scene.far:
        named = shapely.Polygon(scene.outlines[name])
    gap = shapely.shortest_line(shapely.box(*box), named)
    if gap.length > max(want.clearance) + BESIDE or (scene.is_polygon(name) and gap.length > BESIDE):
        draw_leader(canvas, *gap.coords)


def _freedom(scene: Scene, name: str) -> float:
    """Return the sort key of a label: prominent entities, then markers, then polygons by size.

    Large polygons come last, since they have most room.
    """
    if name in scene.highlight or name in scene.marked or name in scene.far:
        return -2.0
    return area_of(scene.outlines[name]) if name not in scene.far and scene.is_polygon(name) else -1.0


def _block(scene: Scene, name: str) -> list[Line]:
    """Return the lines of a label: the name, the destination, the distance, the cargo."""
    entity = scene.entities[name]
    if name in scene.members:
        return [Line(f"{entity.kind} ×{len(scene.members[name])}", bold=True)]
    lines = [Line(name, ink=darker(scene.colour(name)) if entity.place else INK)]
    if entity.towards is not None:
        lines.append(Line(f"→ {entity.towards}", SMALL, ink=QUIET))
    if name in scene.far and entity.geometry is not None:
        near = (scene.entities[each].geometry for each in scene.near())
        metres = apart(entity.geometry, filter(None, near))
        lines.append(Line(f"{metres_text(metres)} away", SMALL, ink=QUIET))
    cargo = scene.cargo(name)
    for depth, each in cargo[:MOST_CARRIED]:
        icon = (scene.shape(each), scene.colour(each))
        looks = {"lit": each in scene.highlight, "marked": each in scene.marked}
        lines.append(Line(each, SMALL, ink=QUIET, indent=8.0 * depth, icon=icon, **looks))
    if len(cargo) > MOST_CARRIED:
        lines.append(Line(f"and {len(cargo) - MOST_CARRIED} more", SMALL, ink=QUIET, indent=9.0))
    return lines


def _wanted(scene: Scene, name: str, size: Spot, pointers: Mapping[str, tuple[Spot, Spot]]) -> Wanted:
    if name in pointers:
        return Wanted(pointers[name][0], size, (9.0, 9.0))
    if not scene.is_polygon(name):
        reach = MARK_RADIUS if name in scene.highlight or name in scene.marked else RADIUS + 1.5
        return Wanted(scene.middle(name), size, (reach, reach))
    outline = scene.outlines[name]
    box = bounds(outline)
    beside = (min(box.width / 2, FARTHEST), min(box.height / 2, FARTHEST))
    return Wanted(
        box.centre, size, beside, _inside(outline, size, scene.sheet.box.grown(-3.0)), FAR_FROM_PLACE
    )


def _inside(outline: Sequence[Spot], size: Spot, view: Box) -> tuple[Spot, ...]:
    """Return possible centres of a label inside a polygon and the view: near its corners first."""
    polygon = shapely.Polygon(outline).buffer(-3.0).intersection(shapely.box(*view))
    if polygon.is_empty:
        return ()
    shapely.prepare(polygon)
    left, bottom, right, top = polygon.bounds
    free = (right - left - size[0] - 2, top - bottom - size[1] - 2)
    spots = [
        (left + 1 + size[0] / 2 + free[0] * across, top - 1 - size[1] / 2 - free[1] * down)
        for down in (0.0, 1.0, 0.05, 0.12, 0.2, 0.3, 0.5, 0.7, 0.85)
        for across in (0.0, 1.0, 0.1, 0.2, 0.5, 0.8)
    ]
    inner = polygon.representative_point()
    return tuple(
        spot for spot in [*spots, (inner.x, inner.y)] if polygon.contains(shapely.box(*around(spot, size)))
    )


def _along(outline: Sequence[Spot]) -> list[Spot]:
    """Return evenly spaced spots along a border."""
    spots: list[Spot] = []
    for (x1, y1), (x2, y2) in pairwise([*outline, outline[0]]):
        parts = min(max(1, round(math.dist((x1, y1), (x2, y2)) / SPACING)), 200)
        spots += [(x1 + (x2 - x1) * part / parts, y1 + (y2 - y1) * part / parts) for part in range(parts)]
    return spots


def _pointer(scene: Scene, name: str) -> tuple[Spot, Spot]:
    """Return the spot at the border of the sheet towards a far entity, and a spot on the way back."""
    frame, (x, y) = scene.sheet.box.grown(-14.0), scene.sheet.box.centre
    far_x, far_y = scene.middle(name)
    across = abs(far_x - x) / (frame.width / 2)
    along = abs(far_y - y) / (frame.height / 2)
    share = 1.0 / max(across, along, 1.0)
    return ((x + (far_x - x) * share, y + (far_y - y) * share), (x, y))


def _corner(sheet: Sheet, size: Spot, taken: Sequence[Box]) -> Box:
    """Return the box for the scale bar or a note, in the emptiest corner."""
    box, (wide, high) = sheet.box.grown(-12.0), size
    corners = [
        Box(left, bottom, left + wide, bottom + high)
        for bottom in (box.bottom, box.top - high)
        for left in (box.right - wide, box.left)
    ]
    return min(corners, key=lambda corner: sum(corner.grown(4.0).shared(each) for each in taken))
