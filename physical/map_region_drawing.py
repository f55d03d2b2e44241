"""Draw regions on a map, with the lines between nearest points."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Final

from physical.map_labels import Box, Spot, around
from physical.map_marks import (
    AREAS,
    BORDERS,
    HALOS,
    LINES,
    MARKERS,
    RADIUS,
    SPACING,
    TEXT,
    Curve,
    arc,
    draw_arrow,
    samples,
)
from physical.map_regions import MapSpan
from physical.map_scene import Scene, Sheet
from physical.map_style import BROKEN, INK
from physical.svg import Canvas, Paint, Words, text_width

if TYPE_CHECKING:
    from physical.region_outlines import Rings

SIZE: Final = 8.0
"""The size of the metres' text."""


def draw_regions(canvas: Canvas, scene: Scene) -> None:
    """Draw regions below the places' borders, with the parts that break a property."""
    ways, sheet = scene.ways, scene.sheet
    for region in ways.regions:
        colour = scene.colour_of(region.name)
        for rings in region.polygons:
            spots = spots_of(sheet, rings)
            canvas.rings(spots, Paint(colour, opacity=0.17), AREAS)
            canvas.rings(spots, Paint(stroke=colour, width=0.9, opacity=0.8), BORDERS)
    for rings in ways.limits:
        canvas.rings(spots_of(sheet, rings), Paint(stroke=INK, width=0.9, dash=(2, 3)), BORDERS)
    for rings in ways.breaches:
        spots = spots_of(sheet, rings)
        canvas.rings(spots, Paint(BROKEN, opacity=0.30), BORDERS)
        canvas.rings(spots, Paint(stroke=BROKEN, width=1.2), BORDERS)
    for name, curves in paths(scene):
        draw_path(canvas, curves, scene.colour_of(name))


def draw_path(canvas: Canvas, legs: Sequence[Curve], colour: str) -> None:
    """Draw the middle of a way: a thin dashed line along its legs, with an arrow at its end."""
    paint = Paint(stroke=colour, width=1.1, dash=(4, 3))
    canvas.line([legs[0][0], *(leg[2] for leg in legs)], paint, LINES)
    draw_arrow(canvas, legs[-1], colour)


def paths(scene: Scene) -> list[tuple[str, list[Curve]]]:
    """Return the legs of each drawn path, from the entity's marker on."""
    found = []
    for region in scene.ways.regions:
        spots = list(map(scene.sheet.at, region.path))
        if len(spots) > 1 and region.name in scene.entities:
            spots[0] = scene.middle(region.name)
            found.append((region.name, [arc(here, there, 0.0) for here, there in pairwise(spots)]))
    return found


def way_samples(scene: Scene) -> list[Spot]:
    """Return spots along paths and spans, which names avoid."""
    lines = (span_ends(scene.sheet, span) for span in scene.ways.spans)
    curves = [arc(*ends, 0.0) for ends in lines if math.dist(*ends) > 1.0]
    return path_samples(scene) + [spot for curve in curves for spot in samples(curve)]


def path_samples(scene: Scene) -> list[Spot]:
    """Return spots along paths."""
    return [spot for _, legs in paths(scene) for curve in legs for spot in samples(curve)]


def spots_of(sheet: Sheet, rings: Rings) -> list[list[Spot]]:
    """Return a polygon on the sheet, in one piece."""
    return [[sheet.at(at) for at in ring] for ring in rings]


def span_ends(sheet: Sheet, span: MapSpan) -> tuple[Spot, Spot]:
    """Return the ends of a line on the sheet."""
    return sheet.at(span.first), sheet.at(span.second)


def span_boxes(scene: Scene, taken: Sequence[Box]) -> tuple[Box, ...]:
    """Return a box for the text of each line, beside its middle, where it hides least."""
    boxes: list[Box] = []
    lines = [around(spot, (SPACING, SPACING)) for spot in path_samples(scene)]
    for span in scene.ways.spans:
        first, second = span_ends(scene.sheet, span)
        middle = (first[0] + second[0]) / 2, (first[1] + second[1]) / 2
        size = text_width(span.text, SIZE, bold=True) + 2.0, SIZE * 1.3
        frame = scene.sheet.box.grown(-3.0)
        found = [around(at, size) for at in _beside(middle, (first, second), size)]
        ends = [around(spot, (8.0, 8.0)) for spot in (first, second)]
        hidden = [*taken, *boxes, *ends, *lines]
        boxes.append(min(found, key=lambda box: _hiding(box, frame, hidden)))
    return tuple(boxes)


def _beside(middle: Spot, ends: tuple[Spot, Spot], size: Spot) -> Iterator[Spot]:
    """Yield centres of a text beside a line: near its middle first."""
    angle = math.atan2(ends[1][1] - ends[0][1], ends[1][0] - ends[0][0])
    across = (-math.sin(angle), math.cos(angle))
    for far in (1.0, 1.8, 3.0):
        for side in (1.0, -1.0):
            reach = side * far * (abs(across[0]) * size[0] / 2 + abs(across[1]) * size[1] / 2 + 5.0)
            yield (middle[0] + across[0] * reach, middle[1] + across[1] * reach)
    if math.dist(*ends) <= 1.0:  # a spot has room at all sides
        for far in (8.0, 20.0, 40.0):
            yield (middle[0] + size[0] / 2 + far, middle[1])
            yield (middle[0] - size[0] / 2 - far, middle[1])


def _hiding(box: Box, frame: Box, taken: Sequence[Box]) -> float:
    outside = box.width * box.height - box.shared(frame)
    return 4.0 * outside + sum(box.grown(1.5).shared(each) for each in taken)


def draw_spans(canvas: Canvas, scene: Scene, boxes: Sequence[Box]) -> None:
    """Draw the lines between nearest points, with their metres."""
    markers = [scene.middle(name) for name in scene.near() if not scene.is_polygon(name)]
    for span, box in zip(scene.ways.spans, boxes, strict=True):
        colour = BROKEN if span.broken else INK
        first, second = span_ends(scene.sheet, span)
        if math.dist(first, second) > 1.0:
            canvas.line([first, second], Paint(stroke="#fff", width=3.4, opacity=0.7), LINES)
            canvas.line([first, second], Paint(stroke=colour, width=1.4), HALOS)
        ends = (spot for spot in (first, second) if all(math.dist(spot, at) > RADIUS for at in markers))
        for spot in dict.fromkeys(ends):  # a marker stays visible
            canvas.circle(spot, 3.0, Paint("#fff", colour, 1.6), MARKERS)
        words = Words(SIZE, colour, bold=True, anchor="middle", halo=True)
        canvas.text((box.centre[0], box.bottom + SIZE * 0.33), span.text, words, TEXT)
