"""Maps of a physical model: places, movers, channels and flights on the earth, with a scale.

The pure modules `map_view` and `map_labels` compute the positions.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Final

from physical.map_crowds import HIDING
from physical.map_labels import Spot
from physical.map_marks import (
    Curve,
    arc,
    draw_curve,
    draw_flight,
    draw_grid,
    draw_ground,
    draw_halo,
    draw_icon,
    draw_leader,
    draw_mark,
    draw_polygon,
    draw_polygon_halo,
    draw_polygon_mark,
    samples,
)
from physical.map_region_drawing import draw_regions, way_samples
from physical.map_regions import NO_WAYS, MapWays
from physical.map_scene import MapEntity, Scene, Sheet, area_of, arranged, scene_of, shows_coasts
from physical.map_style import PAPER, QUIET, SEA, kind_colours
from physical.map_view import bounds, degrees_text, tick_step, ticks
from physical.map_writing import Writing, write_labels, writing_of
from physical.shape import Geometry
from physical.svg import Canvas, Paint, Words

__all__ = ["MapEntity", "draw_map"]

LATITUDES: Final = 46.0
"""The width of the latitudes, to the left of the sheet."""

LONGITUDES: Final = 16.0
"""The height of the longitudes, below the sheet."""

FRAME: Final = Paint(stroke="#cfd6dd", width=0.8)

REACHES: Final = (HIDING, 20.0, 35.0, 55.0, 80.0)
"""Distances in points within which markers of one kind are folded, tried in turn."""

BULGES: Final = (0.12, -0.12, 0.05, -0.05, 0.19, -0.19)
"""The bulges of channel lines, as shares of their length."""


def draw_map(  # noqa: PLR0913 - each is one aspect of the map
    entities: Iterable[MapEntity],
    size: Spot,
    *,
    highlight: Collection[str] = frozenset(),
    marked: Collection[str] = frozenset(),
    colours: Mapping[str, str] | None = None,
    channel_colours: Mapping[str, str] | None = None,
    within: Sequence[Geometry] = (),
    ways: MapWays = NO_WAYS,
) -> Canvas:
    """Draw a map of a width and a height in points, with latitudes to the left and longitudes below.

    Args:
        entities: The entities, with unique names, in any order.
        size: The width and the height.
        highlight: Names with a glow, such as recently changed ones.
        marked: Names with a dashed outline, such as those with a different believed position.
        colours: A colour for each kind; other kinds take one of the palette.
        channel_colours: The same for channels.
        within: The geometries that the view must show, such as all of a run, so that its maps are alike; by default the
            entities.
        ways: The regions of entities, which a property is about.
    """
    in_order = sorted(entities, key=lambda entity: entity.name)
    inner = size[0] - LATITUDES, size[1] - LONGITUDES
    scene, writing = composed(in_order, inner, colours or {}, (highlight, marked), within, ways)
    canvas = Canvas(*size)
    canvas.put(_draw_sheet(scene, writing, channel_colours or {}), (LATITUDES, 0.0), clipped=True)
    canvas.rectangle((LATITUDES, 0.0), inner, FRAME)
    meridians, parallels = _grid(scene.sheet)
    for x, text in meridians:
        canvas.text((LATITUDES + x, inner[1] + 10.0), text, Words(7.5, QUIET, anchor="middle"))
    for y, text in parallels:
        canvas.text((LATITUDES - 4.0, inner[1] - y + 2.5), text, Words(7.5, QUIET, anchor="end"))
    return canvas


def _draw_sheet(scene: Scene, writing: Writing, channel_colours: Mapping[str, str]) -> Canvas:
    """Draw the map without its margins."""
    sheet = scene.sheet
    canvas = Canvas(sheet.width, sheet.height, upwards=True)
    meridians, parallels = _grid(sheet)
    draw_ground(canvas, SEA if shows_coasts(sheet) else PAPER, scene.land)
    draw_grid(canvas, [x for x, _ in meridians], [y for y, _ in parallels])
    _draw_polygons(canvas, scene)
    draw_regions(canvas, scene)
    _draw_channels(canvas, scene, channel_colours)
    for name, curve in _flights(scene):
        draw_flight(canvas, curve, scene.colour(name))
    _draw_markers(canvas, scene)
    write_labels(canvas, scene, writing)
    return canvas


def composed(
    entities: Sequence[MapEntity],
    size: Spot,
    colours: Mapping[str, str],
    looks: tuple[Collection[str], Collection[str]],
    within: Sequence[Geometry],
    ways: MapWays = NO_WAYS,
) -> tuple[Scene, Writing]:
    """Return the scene with the fewest folded markers in which all marker names fit beside them."""
    plain = scene_of(entities, size, colours, *looks, within, ways)
    for reach in REACHES:
        scene = arranged(plain, reach)
        curves = [curve for _, curve in (*_channels(scene), *_flights(scene))]
        writing = writing_of(
            scene, [*(spot for curve in curves for spot in samples(curve)), *way_samples(scene)]
        )
        if all(scene.is_polygon(name) for name in writing.unnamed):
            break
    return scene, writing


def _grid(sheet: Sheet) -> tuple[list[tuple[float, str]], list[tuple[float, str]]]:
    south, west = sheet.plane.degrees((sheet.view.left, sheet.view.bottom))
    north, east = sheet.plane.degrees((sheet.view.right, sheet.view.top))
    most = max(2, int(sheet.width / 85)), max(2, int(sheet.height / 65))
    steps = tick_step(east - west, most[0]), tick_step(north - south, most[1])
    metres = sheet.plane.scale
    meridians = [
        (
            sheet.spot(((longitude - sheet.plane.longitude) * metres[0], 0.0))[0],
            degrees_text(longitude, steps[0], "EW"),
        )
        for longitude in ticks(west, east, most[0])
    ]
    parallels = [
        (sheet.at((latitude, sheet.plane.longitude))[1], degrees_text(latitude, steps[1], "NS"))
        for latitude in ticks(max(south, -90.0), min(north, 90.0), most[1])
    ]
    return meridians, parallels


def _draw_polygons(canvas: Canvas, scene: Scene) -> None:
    polygons = [name for name in scene.near() if scene.is_polygon(name)]
    for name in sorted(polygons, key=lambda each: (-area_of(scene.outlines[each]), each)):
        outline = scene.outlines[name]
        if name in scene.highlight:
            draw_polygon_halo(canvas, outline)
        strength = 0.09 if scene.entities[name].place else 0.32
        draw_polygon(canvas, outline, scene.colour(name), strength=strength)
        if name in scene.marked:
            draw_polygon_mark(canvas, outline)


def _draw_channels(canvas: Canvas, scene: Scene, colours: Mapping[str, str]) -> None:
    curves = _channels(scene)
    own = kind_colours(channel for channel, _ in curves) | dict(colours)
    for channel, curve in curves:
        draw_curve(canvas, curve, own[channel])


def _channels(scene: Scene) -> list[tuple[str, Curve]]:
    """Return the curves of all channels, lines between their members."""
    channels = sorted({channel for entity in scene.entities.values() for channel in entity.channels})
    return [
        # Channels between the same two members would hide each other.
        (channel, arc(min(start, end), max(start, end), BULGES[rank % len(BULGES)]))
        for rank, channel in enumerate(channels)
        for start, end in _lines_of(scene, channel)
    ]


def _lines_of(scene: Scene, channel: str) -> list[tuple[Spot, Spot]]:
    """Return the lines of a channel: a star around the member in its name, else the shortest tree."""
    spots = {name: scene.middle(name) for name, each in scene.entities.items() if channel in each.channels}
    station = spots.get(channel.rpartition(":")[2])
    if station is None:
        return _shortest_tree(sorted(set(spots.values())))
    return [(station, end) for end in sorted(set(spots.values())) if math.dist(station, end) > 1.0]


def _shortest_tree(spots: Sequence[Spot]) -> list[tuple[Spot, Spot]]:
    """Return the shortest tree between spots (Prim), without lines between coinciding spots."""
    joined, lines = list(spots[:1]), []
    waiting = list(spots[1:])
    while waiting:
        start, end = min(((a, b) for a in joined for b in waiting), key=lambda line: (math.dist(*line), line))
        waiting.remove(end)
        joined.append(end)
        if math.dist(start, end) > 1.0:
            lines.append((start, end))
    return lines


def _flights(scene: Scene) -> Iterator[tuple[str, Curve]]:
    """Yield the paths of entities in transit: a bow, or straight legs by the places of the way."""
    for name in scene.near():
        entity = scene.entities[name]
        if name not in scene.ways.flying and entity.destination is not None:
            stops = [bounds(scene.sheet.outline(each)).centre for each in (*entity.via, entity.destination)]
            for here, there in pairwise([scene.middle(name), *stops]):
                yield name, arc(here, there, 0.0 if entity.via else -0.1)


def _draw_markers(canvas: Canvas, scene: Scene) -> None:
    for spot, true in scene.moved():
        draw_leader(canvas, spot, true)
    for name in scene.near():
        if scene.is_polygon(name):
            continue
        spot = scene.middle(name)
        if name in scene.highlight:
            draw_halo(canvas, spot)
        draw_icon(
            canvas,
            spot,
            scene.shape(name),
            scene.colour(name),
            hollow=scene.entities[name].towards is not None,
        )
        if name in scene.marked:
            draw_mark(canvas, spot)
