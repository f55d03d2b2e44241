"""The scene of a map: the drawn objects, and their positions on the sheet."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import shapely

from physical.frame import Position
from physical.land import ACCURACY, land_within
from physical.map_crowds import HIDING, fanned, folded
from physical.map_labels import Box, Spot
from physical.map_regions import NO_WAYS, MapWays
from physical.map_style import INK, Outline, kind_colours, kind_shapes
from physical.map_view import Plane, bounds, focus, plane_of, view_of
from physical.shape import Geometry

NARROWEST_COAST: Final = 10.0 * ACCURACY
"""The smallest width in metres of a map with coasts; on a smaller map they would mislead."""

SMALLEST_POLYGON: Final = 7.0
"""The size in points below which a polygon is drawn as a marker."""


Land = tuple[tuple[tuple[Spot, ...], ...], ...]
"""Polygons, each its border and then its lakes."""


@dataclass(frozen=True, slots=True)
class MapEntity:
    """One entity to be drawn.

    Attributes:
        name: Its name.
        kind: Its kind, which determines the colour and the shape of the marker.
        geometry: Its position, or its take-off position; None if it is carried or absent.
        place: Whether it is a stationary place, rather than a mover.
        channels: Its channels.
        carried_by: The name of its carrier.
        towards: The name of its destination, in transit.
        destination: The position of its destination, if known.
        via: The positions by which it flies there.
    """

    name: str
    kind: str
    geometry: Geometry | None
    place: bool = False
    channels: tuple[str, ...] = ()
    carried_by: str | None = None
    towards: str | None = None
    destination: Geometry | None = None
    via: tuple[Geometry, ...] = ()


@dataclass(frozen=True, slots=True)
class Sheet:
    """A map's paper: the coordinates of positions on it, in points to the right and up."""

    plane: Plane
    view: Box
    width: float
    height: float

    @property
    def box(self) -> Box:
        """The whole sheet."""
        return Box(0.0, 0.0, self.width, self.height)

    def spot(self, metres: Spot) -> Spot:
        """Return the sheet coordinates of a spot of the plane."""
        scale = self.width / self.view.width
        return ((metres[0] - self.view.left) * scale, (metres[1] - self.view.bottom) * scale)

    def at(self, position: Position) -> Spot:
        """Return the sheet coordinates of a position."""
        return self.spot(self.plane.metres(position))

    def outline(self, geometry: Geometry) -> tuple[Spot, ...]:
        """Return the sheet coordinates of a geometry's vertices."""
        return tuple(map(self.spot, self.plane.outline(geometry)))


@dataclass(frozen=True, slots=True)
class Scene:
    """The drawn entities by name, with their outlines on the sheet.

    Attributes:
        spots: The positions of markers; fanned-out markers stand beside their true positions.
        members: The names that a marker represents, by its own name.
    """

    sheet: Sheet
    entities: Mapping[str, MapEntity]
    outlines: Mapping[str, tuple[Spot, ...]]
    far: frozenset[str]
    colours: Mapping[str, str]
    shapes: Mapping[str, Outline]
    absent: tuple[str, ...]
    highlight: Collection[str]
    marked: Collection[str]
    land: Land
    spots: Mapping[str, Spot]
    members: Mapping[str, tuple[str, ...]]
    ways: MapWays = NO_WAYS

    def colour_of(self, name: str) -> str:
        """Return the colour of an entity that may not be on the map."""
        return self.colour(name) if name in self.entities else INK

    def colour(self, name: str) -> str:
        """Return the colour of an entity's kind."""
        return self.colours[self.entities[name].kind]

    def shape(self, name: str) -> Outline:
        """Return the outline of an entity's marker."""
        return self.shapes[self.entities[name].kind]

    def is_polygon(self, name: str) -> bool:
        """Whether an entity is drawn as an area: it has one, and it is large enough."""
        around = bounds(self.outlines[name])
        return len(self.outlines[name]) > 1 and max(around.width, around.height) >= SMALLEST_POLYGON

    def near(self) -> list[str]:
        """Return the names visible on the sheet, one for each marker."""
        hidden = {name for names in self.members.values() for name in names[1:]}
        return [name for name in self.outlines if name not in self.far and name not in hidden]

    def middle(self, name: str) -> Spot:
        """Return the centre of the outermost carrier: of its outline, or of the marker that represents it."""
        carrier = self.outermost(name)
        first = next((first for first, names in self.members.items() if carrier in names), carrier)
        return self.spots.get(first) or bounds(self.outlines[carrier]).centre

    def moved(self) -> list[tuple[Spot, Spot]]:
        """Return the drawn and the true spot of each displaced marker."""
        true = {name: bounds(self.outlines[name]).centre for name in self.spots if name not in self.members}
        return [(self.spots[name], at) for name, at in true.items() if math.dist(self.spots[name], at) > 2.0]

    def outermost(self, name: str) -> str:
        """Return the outermost carrier of an entity, or itself."""
        while name not in self.outlines:
            name = str(self.entities[name].carried_by)
        return name

    def cargo(self, carrier: str, depth: int = 0) -> list[tuple[int, str]]:
        """Return an entity's cargo at any depth, each with its depth."""
        held = [name for name, entity in self.entities.items() if self.carrier(entity) == carrier]
        return [each for name in held for each in [(depth, name), *self.cargo(name, depth + 1)]]

    def carrier(self, entity: MapEntity) -> str | None:
        """Return the carrier of an entity, None if it has its own position on the sheet."""
        return None if entity.name in self.outlines else entity.carried_by


def scene_of(  # noqa: PLR0913, PLR0917 - each is one aspect of the map
    entities: Sequence[MapEntity],
    size: Spot,
    colours: Mapping[str, str],
    highlight: Collection[str],
    marked: Collection[str],
    within: Sequence[Geometry] = (),
    ways: MapWays = NO_WAYS,
) -> Scene:
    """Return the scene of entities with unique names, on a sheet of this width and height in points.

    The sheet shows `within`, or all entities if that is empty, and the regions of `ways`.
    """
    known = {entity.name: entity for entity in entities}
    placed = {
        entity.name: entity.geometry
        for entity in entities
        if entity.geometry and entity.carried_by not in known
    }
    goals = [entity.destination for entity in entities if entity.destination and entity.name in placed]
    shown = list(within) or [*placed.values(), *goals]
    plane = plane_of(shown)
    boxes = [bounds(plane.outline(geometry)) for geometry in shown]
    seen = focus(boxes)
    regions = [plane.metres(at) for at in ways.positions()]
    around = [*(boxes[each] for each in seen), *([bounds(regions)] if regions else [])]
    view = view_of(around or [Box(0, 0, 0, 0)], size[0] / size[1])
    sheet = Sheet(plane, view, *size)
    outlines = {name: sheet.outline(geometry) for name, geometry in placed.items()}
    far = {name for rank, name in enumerate(placed) if within or rank not in seen}
    kinds = [entity.kind for entity in entities]
    scene = Scene(
        sheet,
        {name: entity for name, entity in known.items() if name in placed or _rides(entity, known, placed)},
        outlines,
        frozenset(name for name in far if sheet.box.shared(bounds(outlines[name]).grown(0.1)) == 0.0),
        kind_colours(kinds) | dict(colours),
        kind_shapes(kinds),
        tuple(name for name in known if name not in placed and not _rides(known[name], known, placed)),
        highlight,
        marked,
        _land(sheet),
        {},
        {},
        ways,
    )
    return arranged(scene, HIDING)


def arranged(scene: Scene, reach: float) -> Scene:
    """Return the scene with markers folded and fanned out.

    Markers of one kind in the same places are folded if they are within `reach` points. Other markers that hide each
    other are fanned out.
    """
    scene = replace(scene, spots={}, members={})
    markers = [name for name in scene.near() if not scene.is_polygon(name)]
    spots = {name: scene.middle(name) for name in markers}
    polygons = [shapely.Polygon(scene.outlines[name]) for name in scene.near() if scene.is_polygon(name)]
    alike = {
        name: (scene.entities[name].kind, *(polygon.contains(shapely.Point(spot)) for polygon in polygons))
        for name, spot in spots.items()
        if not _stands_out(scene, name)
    }
    left, members = folded(spots, alike, reach)
    return replace(scene, spots=fanned(left), members=members)


def _stands_out(scene: Scene, name: str) -> bool:
    """Whether the label of an entity has more than its name."""
    told = name in scene.highlight or name in scene.marked or scene.entities[name].towards is not None
    return told or bool(scene.cargo(name))


def shows_coasts(sheet: Sheet) -> bool:
    """Whether a sheet is wide enough for coasts."""
    return sheet.view.width >= NARROWEST_COAST


def _land(sheet: Sheet) -> Land:
    if not shows_coasts(sheet):
        return ()
    around = sheet.view.grown(sheet.view.width / 50)  # hence no coast along the border of the sheet
    corners = ((around.left, around.bottom), (around.right, around.top))
    south_west, north_east = map(sheet.plane.degrees, corners)
    (east, north), plane = sheet.plane.scale, sheet.plane

    def spot(at: Position) -> Spot:
        return sheet.spot(((at[1] - plane.longitude) * east, (at[0] - plane.latitude) * north))

    found = land_within(south_west, north_east)
    return tuple(tuple(tuple(map(spot, ring)) for ring in polygon) for polygon in found)


def _rides(entity: MapEntity, known: Mapping[str, MapEntity], placed: Mapping[str, Geometry]) -> bool:
    """Whether an entity is carried, at any depth, by a placed one."""
    passed = {entity.name}
    while (carrier := entity.carried_by) is not None and carrier in known and carrier not in passed:
        if carrier in placed:
            return True
        passed.add(carrier)
        entity = known[carrier]
    return False


def area_of(outline: Sequence[Spot]) -> float:
    """Return the area of the box around an outline."""
    return bounds(outline).width * bounds(outline).height
