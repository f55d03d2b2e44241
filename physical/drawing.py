"""Draw a physical model as a map: places, movers, channels and flights on the earth, with a scale.

matplotlib draws; where things go is decided by `map_view` and `map_labels`, which are pure.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import shapely

from physical.frame import Position
from physical.map_labels import Box, Spot, Wanted, around, place_labels
from physical.map_marks import (
    MARK_RADIUS,
    RADIUS,
    SPACING,
    Line,
    arc,
    block_size,
    draw_block,
    draw_curve,
    draw_flight,
    draw_grid,
    draw_halo,
    draw_icon,
    draw_leader,
    draw_mark,
    draw_pointer,
    draw_polygon,
    draw_polygon_halo,
    draw_polygon_mark,
    draw_scale,
    samples,
)
from physical.map_style import INK, QUIET, Outline, darker, kind_colours, kind_shapes, text_width
from physical.map_view import (
    Plane,
    bounds,
    degrees_text,
    focus,
    metres_text,
    plane_of,
    scale_length,
    tick_step,
    ticks,
    view_of,
)
from physical.measure import distance
from physical.shape import Geometry, point

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_CARRIED: Final = 8
"""Of what an entity carries, so many are named."""

SMALLEST_POLYGON: Final = 7.0
"""Points under which a polygon is drawn as a marker."""


@dataclass(frozen=True, slots=True)
class MapEntity:
    """One entity to be drawn.

    Attributes:
        name: Its name.
        kind: Its kind: gives the colour, and the shape of the marker.
        geometry: Where it is, or took off; None for what is carried, and for what is absent.
        place: Whether it is a place that stays where it is, rather than something that moves.
        channels: The channels that it is on.
        carried_by: The name of what carries it.
        towards: The name of what it is in transit to.
        destination: Where that is, if that can be told.
    """

    name: str
    kind: str
    geometry: Geometry | None
    place: bool = False
    channels: tuple[str, ...] = ()
    carried_by: str | None = None
    towards: str | None = None
    destination: Geometry | None = None


@dataclass(frozen=True, slots=True)
class Sheet:
    """A map's paper: where positions lie on axes whose units are points."""

    plane: Plane
    view: Box
    width: float
    height: float

    @property
    def box(self) -> Box:
        """The whole sheet."""
        return Box(0.0, 0.0, self.width, self.height)

    def spot(self, metres: Spot) -> Spot:
        """Return where a spot of the plane lies."""
        scale = self.width / self.view.width
        return ((metres[0] - self.view.left) * scale, (metres[1] - self.view.bottom) * scale)

    def at(self, position: Position) -> Spot:
        """Return where a position lies."""
        return self.spot(self.plane.metres(position))

    def outline(self, geometry: Geometry) -> tuple[Spot, ...]:
        """Return where a geometry's vertices lie."""
        return tuple(map(self.spot, self.plane.outline(geometry)))


@dataclass(frozen=True, slots=True)
class _Scene:
    """What is drawn where: everything that is present, by name, with its outline on the sheet."""

    sheet: Sheet
    entities: Mapping[str, MapEntity]
    outlines: Mapping[str, tuple[Spot, ...]]
    far: frozenset[str]
    colours: Mapping[str, str]
    shapes: Mapping[str, Outline]
    absent: tuple[str, ...]
    highlight: Collection[str]
    marked: Collection[str]

    def colour(self, name: str) -> str:
        return self.colours[self.entities[name].kind]

    def shape(self, name: str) -> Outline:
        return self.shapes[self.entities[name].kind]

    def is_polygon(self, name: str) -> bool:
        """Tell whether an entity is drawn as an area: it has one, and it can be seen."""
        around = bounds(self.outlines[name])
        return len(self.outlines[name]) > 1 and max(around.width, around.height) >= SMALLEST_POLYGON

    def near(self) -> list[str]:
        return [name for name in self.outlines if name not in self.far]

    def middle(self, name: str) -> Spot:
        """Return the middle of the outermost carrier's outline."""
        return bounds(self.outlines[self.outermost(name)]).centre

    def outermost(self, name: str) -> str:
        while name not in self.outlines:
            name = str(self.entities[name].carried_by)
        return name

    def cargo(self, carrier: str, depth: int = 0) -> list[tuple[int, str]]:
        """Return what an entity carries, at any depth, each with its depth."""
        held = [name for name, entity in self.entities.items() if self.carrier(entity) == carrier]
        return [each for name in held for each in [(depth, name), *self.cargo(name, depth + 1)]]

    def carrier(self, entity: MapEntity) -> str | None:
        return None if entity.name in self.outlines else entity.carried_by


def draw_map(
    entities: Iterable[MapEntity],
    axes: Axes,
    *,
    highlight: Collection[str] = frozenset(),
    marked: Collection[str] = frozenset(),
    colours: Mapping[str, str] | None = None,
    channel_colours: Mapping[str, str] | None = None,
) -> Sheet:
    """Draw a map that fills the axes, whose place in the figure must not change afterwards.

    Args:
        entities: What there is, each name once, in any order.
        axes: Empty axes. Their units become points.
        highlight: Names that glow, such as those that have just changed.
        marked: Names with a dashed outline, such as those that are believed to be elsewhere.
        colours: A colour for each kind; other kinds take one of the palette.
        channel_colours: The same for channels.

    Returns:
        The sheet: where positions lie on the axes, for whoever draws more on them.
    """
    scene = _scene(sorted(entities, key=lambda entity: entity.name), axes, colours or {}, highlight, marked)
    sheet = scene.sheet
    axes.set(xlim=(0, sheet.width), ylim=(0, sheet.height), aspect="equal")
    draw_grid(axes, *_grid(sheet))
    _draw_polygons(axes, scene)
    lines = _draw_channels(axes, scene, channel_colours or {}) + _draw_flights(axes, scene)
    _draw_markers(axes, scene)
    _write_labels(axes, scene, lines)
    return sheet


def _scene(
    entities: Sequence[MapEntity],
    axes: Axes,
    colours: Mapping[str, str],
    highlight: Collection[str],
    marked: Collection[str],
) -> _Scene:
    known = {entity.name: entity for entity in entities}
    placed = {
        entity.name: entity.geometry for entity in entities if entity.geometry and not entity.carried_by
    }
    goals = [entity.destination for entity in entities if entity.destination and entity.name in placed]
    plane = plane_of([*placed.values(), *goals])
    boxes = [bounds(plane.outline(geometry)) for geometry in [*placed.values(), *goals]]
    seen = focus(boxes)
    window = axes.get_window_extent()
    width, height = (size * 72.0 / axes.figure.dpi for size in (window.width, window.height))
    view = view_of([boxes[each] for each in seen] or [Box(0, 0, 0, 0)], width / height)
    sheet = Sheet(plane, view, width, height)
    outlines = {name: sheet.outline(geometry) for name, geometry in placed.items()}
    far = {name for rank, name in enumerate(placed) if rank not in seen}
    kinds = [entity.kind for entity in entities]
    return _Scene(
        sheet,
        {name: entity for name, entity in known.items() if name in placed or _rides(entity, known, placed)},
        outlines,
        frozenset(name for name in far if sheet.box.shared(bounds(outlines[name]).grown(0.1)) == 0.0),
        kind_colours(kinds) | dict(colours),
        kind_shapes(kinds),
        tuple(name for name in known if name not in placed and not _rides(known[name], known, placed)),
        highlight,
        marked,
    )


def _rides(entity: MapEntity, known: Mapping[str, MapEntity], placed: Mapping[str, Geometry]) -> bool:
    """Tell whether something that is placed carries an entity, at any depth."""
    passed = {entity.name}
    while entity.carried_by in known and entity.carried_by not in passed:
        if entity.carried_by in placed:
            return True
        passed.add(entity.carried_by)
        entity = known[entity.carried_by]
    return False


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


def _draw_polygons(axes: Axes, scene: _Scene) -> None:
    polygons = [name for name in scene.near() if scene.is_polygon(name)]
    for name in sorted(polygons, key=lambda each: (-_area(scene.outlines[each]), each)):
        outline = scene.outlines[name]
        if name in scene.highlight:
            draw_polygon_halo(axes, outline)
        strength = 0.09 if scene.entities[name].place else 0.32
        draw_polygon(axes, outline, scene.colour(name), strength=strength)
        if name in scene.marked:
            draw_polygon_mark(axes, outline)


def _area(outline: Sequence[Spot]) -> float:
    return bounds(outline).width * bounds(outline).height


def _draw_channels(axes: Axes, scene: _Scene, colours: Mapping[str, str]) -> list[Spot]:
    """Draw each channel as a star around its station; return spots along the lines."""
    channels = sorted({channel for entity in scene.entities.values() for channel in entity.channels})
    own = kind_colours(channels) | dict(colours)
    lines: list[Spot] = []
    for channel in channels:
        for start, end in _spokes(scene, channel):
            curve = arc(start, end)
            draw_curve(axes, curve, own[channel])
            lines += samples(curve)
    return lines


def _spokes(scene: _Scene, channel: str) -> list[tuple[Spot, Spot]]:
    """Return the lines from a channel's station, the member that it is named for or the most central one."""
    members = [name for name, entity in scene.entities.items() if channel in entity.channels]
    spots = {name: scene.middle(name) for name in members}
    middle = (
        sum(x for x, _ in spots.values()) / len(spots),
        sum(y for _, y in spots.values()) / len(spots),
    )
    central = min(members, key=lambda name: (round(math.dist(spots[name], middle), 3), name))
    station = channel.rpartition(":")[2]
    hub = spots[station if station in spots else central]
    ends = sorted({spot for spot in spots.values() if math.dist(hub, spot) > 1.0})
    return [(hub, end) for end in ends]


def _draw_flights(axes: Axes, scene: _Scene) -> list[Spot]:
    """Draw the ways of what is in transit; return spots along them."""
    lines: list[Spot] = []
    for name in scene.near():
        destination = scene.entities[name].destination
        if destination is not None:
            end = bounds(scene.sheet.outline(destination)).centre
            curve = arc(scene.middle(name), end, -0.1)
            draw_flight(axes, curve, scene.colour(name))
            lines += samples(curve)
    return lines


def _draw_markers(axes: Axes, scene: _Scene) -> None:
    for name in scene.near():
        if scene.is_polygon(name):
            continue
        spot = scene.middle(name)
        if name in scene.highlight:
            draw_halo(axes, spot)
        draw_icon(
            axes,
            spot,
            scene.shape(name),
            scene.colour(name),
            hollow=scene.entities[name].towards is not None,
        )
        if name in scene.marked:
            draw_mark(axes, spot)


# --- labels ---------------------------------------------------------------------------------------


def _write_labels(axes: Axes, scene: _Scene, lines: Sequence[Spot]) -> None:
    """Write all names, and the scale bar, so that nothing is written over anything else."""
    markers = [around(scene.middle(n), (2 * RADIUS + 3,) * 2) for n in scene.near() if not scene.is_polygon(n)]
    pointers = {name: _pointer(scene, name) for name in sorted(scene.far)}
    markers += [around(at, (18.0, 18.0)) for at, _ in pointers.values()]
    notes = _draw_notes(axes, scene, markers)
    borders = [spot for name in scene.near() if scene.is_polygon(name) for spot in _along(scene.outlines[name])]
    names = sorted(scene.outlines, key=lambda name: (_freedom(scene, name), name))
    blocks = {name: _block(scene, name) for name in names}
    wanted = [_wanted(scene, name, block_size(blocks[name]), pointers) for name in names]
    boxes = place_labels(wanted, [*markers, *notes], [*lines, *borders], scene.sheet.box.grown(-3.0))
    for name, want, box in zip(names, wanted, boxes, strict=True):
        draw_block(axes, box, blocks[name])
        _lead(axes, scene, name, box, want)
    for name, (at, towards) in pointers.items():
        draw_pointer(axes, at, towards, scene.colour(name))


def _draw_notes(axes: Axes, scene: _Scene, markers: Sequence[Box]) -> list[Box]:
    """Draw the scale bar, and name what is absent; return what they take up."""
    sheet = scene.sheet
    metres = scale_length(sheet.view.width)
    length, text = metres * sheet.width / sheet.view.width, metres_text(metres)
    scale = _corner(sheet, (max(length, text_width(text, 7.5)), 16.0), markers)
    draw_scale(axes, scale, length, text)
    if not scene.absent:
        return [scale]
    lines = [Line(line, 7.0, ink=QUIET) for line in _wrapped(["not in P:", *scene.absent], sheet.width / 2)]
    note = _corner(sheet, block_size(lines), [*markers, scale])
    draw_block(axes, note, lines)
    return [scale, note]


def _wrapped(words: Sequence[str], width: float) -> list[str]:
    lines = [words[0]]
    for word in words[1:]:
        longer = f"{lines[-1]} {word}"
        if text_width(longer, 7.0) <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def _lead(axes: Axes, scene: _Scene, name: str, box: Box, want: Wanted) -> None:
    """Draw a hair line to what a label names, where it does not stand in it or beside it."""
    named = shapely.Point(want.at)
    if scene.is_polygon(name) and name not in scene.far:
        named = shapely.Polygon(scene.outlines[name])
    gap = shapely.shortest_line(shapely.box(*box), named)
    if gap.length > want.clearance + 9.0 or (scene.is_polygon(name) and gap.length > 9.0):
        draw_leader(axes, *gap.coords)


def _freedom(scene: _Scene, name: str) -> float:
    """Order labels: markers first, then polygons, small before large, since large ones have the most room."""
    return _area(scene.outlines[name]) if name not in scene.far and scene.is_polygon(name) else -1.0


def _block(scene: _Scene, name: str) -> list[Line]:
    """Return the lines of a label: the name, where it is bound for, how far it is, what it carries."""
    entity = scene.entities[name]
    lines = [Line(name, ink=darker(scene.colour(name)) if entity.place else INK)]
    if entity.towards is not None:
        lines.append(Line(f"→ {entity.towards}", 7.0, ink=QUIET))
    if name in scene.far and entity.geometry is not None:
        centre = point(*_middle_of(scene.sheet))
        lines.append(Line(f"{metres_text(distance(centre, entity.geometry))} away", 7.0, ink=QUIET))
    cargo = scene.cargo(name)
    for depth, each in cargo[:MOST_CARRIED]:
        icon = (scene.shape(each), scene.colour(each))
        looks = {"lit": each in scene.highlight, "marked": each in scene.marked}
        lines.append(Line(each, 7.0, ink=QUIET, indent=8.0 * depth, icon=icon, **looks))
    if len(cargo) > MOST_CARRIED:
        lines.append(Line(f"and {len(cargo) - MOST_CARRIED} more", 7.0, ink=QUIET, indent=9.0))
    return lines


def _middle_of(sheet: Sheet) -> Position:
    latitude, longitude = sheet.plane.degrees(sheet.view.centre)
    return (min(max(latitude, -90.0), 90.0), (longitude + 180.0) % 360.0 - 180.0)


def _wanted(
    scene: _Scene, name: str, size: Spot, pointers: Mapping[str, tuple[Spot, Spot]]
) -> Wanted:
    if name in pointers:
        return Wanted(pointers[name][0], size, 9.0)
    if not scene.is_polygon(name):
        ringed = name in scene.highlight or name in scene.marked
        return Wanted(scene.middle(name), size, MARK_RADIUS if ringed else RADIUS + 1.5)
    outline = scene.outlines[name]
    box = bounds(outline)
    return Wanted(
        box.centre, size, min(box.width, box.height) / 2, _inside(outline, size, scene.sheet.box.grown(-3.0))
    )


def _inside(outline: Sequence[Spot], size: Spot, view: Box) -> tuple[Spot, ...]:
    """Return middles of a label that lies inside a polygon and the view: near its corners first."""
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
    """Return spots along a border, some points apart."""
    spots: list[Spot] = []
    for (x1, y1), (x2, y2) in pairwise([*outline, outline[0]]):
        parts = min(max(1, round(math.dist((x1, y1), (x2, y2)) / SPACING)), 200)
        spots += [(x1 + (x2 - x1) * part / parts, y1 + (y2 - y1) * part / parts) for part in range(parts)]
    return spots


def _pointer(scene: _Scene, name: str) -> tuple[Spot, Spot]:
    """Return the spot at the border of the sheet towards something far, and a spot on the way back."""
    frame, (x, y) = scene.sheet.box.grown(-14.0), scene.sheet.box.centre
    far_x, far_y = scene.middle(name)
    across = abs(far_x - x) / (frame.width / 2)
    along = abs(far_y - y) / (frame.height / 2)
    share = 1.0 / max(across, along, 1.0)
    return ((x + (far_x - x) * share, y + (far_y - y) * share), (x, y))


def _corner(sheet: Sheet, size: Spot, taken: Sequence[Box]) -> Box:
    """Return where the scale bar or a note goes: the corner where it is least in the way."""
    box, (wide, high) = sheet.box.grown(-12.0), size
    corners = [
        Box(left, bottom, left + wide, bottom + high)
        for bottom in (box.bottom, box.top - high)
        for left in (box.right - wide, box.left)
    ]
    return min(corners, key=lambda corner: sum(corner.grown(4.0).shared(each) for each in taken))
