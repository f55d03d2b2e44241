"""The finite quotient of a drift within a place (semantics.md, *The environment*).

The borders of all places cut the possible positions of a point mover into cells. For a convex polygon, the borders of
their Minkowski erosions by the mover do so. Within one *cell* of this arrangement all relations of the mover are equal.
Two cells are adjacent if they share a border of positive length. The borders themselves are left out.

A mover may carry others. They share its position, but have their own shapes and their own places. So the borders of
those places, eroded by those shapes, also cut the drift (`Aboard`).

**Cells with equal relations.** Two separate cells may have equal relations, such as the two sides of a channel. Merging
them would let the mover cross the channel without being seen in it: sound for safety, but not exact. Only bisimilar
cells, which no sequence of moves distinguishes, are merged. So the quotient is exact, and the coarsest exact one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations, pairwise
from typing import Final

import shapely

from physical.errors import GeometryError
from physical.frame import E7, METRES_PER_DEGREE, TURN, PositionE7, local_frame, rounded
from physical.geometry_measures import centroid, deep_spot
from physical.place_nesting import PlaceIndex
from physical.placement import is_convex, outline, placed, room, still, template, translate_to
from physical.shape import Geometry, beside, contains, intern, planar

GRID: Final = 0.02
"""Metres between the spots at which borders may meet: coordinates and edges are exact to half of it."""

CLEARANCE: Final = 0.05
"""Metres between the representative of a face and all borders; a cell without such room is a sliver."""


Places = Mapping[str, Geometry]
"""Places by name."""

Aboard = Mapping[Geometry, Places]
"""Shapes that may share the mover's centroid, each with the places that may contain it."""


NOTHING_ABOARD: Final[Aboard] = {}

Relations = tuple[tuple[str, ...], ...]
"""For each shape at the mover's position, the mover first, the places that contain it."""


@dataclass(frozen=True, slots=True)
class Face:
    """A class of indistinguishable placements, with a representative.

    Attributes:
        representative: The mover, placed well inside.
        relations: The names of the places that contain it, sorted; then those of each other shape aboard.
        adjacent: The faces into which it may drift from here, by index, ascending.
    """

    representative: Geometry
    relations: Relations
    adjacent: tuple[int, ...]

    @property
    def inside(self) -> tuple[str, ...]:
        """The names of the places that contain the mover, sorted."""
        return self.relations[0]


@dataclass(frozen=True, slots=True)
class Cell:
    """A connected cell of the arrangement, in the frame of the surrounding place."""

    shape: shapely.Polygon
    representative: Geometry
    relations: Relations


@dataclass(frozen=True, slots=True)
class Quotient:
    """Cells, the face of each, and the faces."""

    cells: tuple[Cell, ...]
    face_of: tuple[int, ...]
    faces: tuple[Face, ...]


def drift_faces(
    mover: Geometry, within: Geometry, places: Places, aboard: Aboard = NOTHING_ABOARD
) -> tuple[Face, ...]:
    """Return the faces of a mover's drift within a place, sorted by representative; empty if it doesn't fit.

    The faces are exact for one mover among stationary polygons. Faces narrower than 10 cm are left out.

    Raises:
        GeometryError: If the mover or a shape aboard is a polygon that is not convex, or `within` is a point.
    """
    return quotient(mover, within, places, aboard).faces


def face_at(mover: Geometry, within: Geometry, places: Places, aboard: Aboard = NOTHING_ABOARD) -> int | None:
    """Return the index of a mover's present face; None if it isn't within the place.

    On a border it is the nearest face with the same relations.
    """
    if not contains(within, mover):
        return None
    found = quotient(mover, within, places, aboard)
    shapes = _shapes(mover, places, aboard)
    here, relations = shapely.Point(_plane(within, shapes).spot(mover)), _relations(mover, _indexed(shapes))
    alike = [i for i, cell in enumerate(found.cells) if cell.relations == relations]
    if not alike:
        return None
    return found.face_of[min(alike, key=lambda i: (found.cells[i].shape.distance(here), i))]


def quotient(mover: Geometry, within: Geometry, places: Places, aboard: Aboard = NOTHING_ABOARD) -> Quotient:
    """Return the cells and the faces of a drift; they do not depend on the mover's present position."""
    _check(mover, within, aboard)
    return _quotient(within, _shapes(mover, places, aboard))


Shapes = tuple[tuple[Geometry, tuple[tuple[str, Geometry], ...]], ...]
"""The mover, then each other shape aboard, unmoved, with the polygons that may contain it."""


def _shapes(mover: Geometry, places: Places, aboard: Aboard) -> Shapes:
    own, among = still(mover), dict[Geometry, dict[str, Geometry]]()
    for shape, containers in ((mover, places), *aboard.items()):
        polygons = {name: place for name, place in containers.items() if not place.is_point}
        among.setdefault(still(shape), {}).update(polygons)
    return tuple(
        (shape, tuple(sorted(among[shape].items()))) for shape in (own, *sorted(among.keys() - {own}))
    )


Indexed = tuple[tuple[Geometry, PlaceIndex], ...]


def _indexed(shapes: Shapes) -> Indexed:
    return tuple((shape, PlaceIndex(dict(places))) for shape, places in shapes)


def _relations(mover: Geometry, shapes: Indexed) -> Relations:
    """Return the containers of the mover, and of each shape aboard at the mover's centroid."""
    (_, own), *aboard = shapes
    put = [(translate_to(shape, centroid(mover)), among) for shape, among in aboard]
    return tuple(tuple(sorted(among.containers(at))) for at, among in [(mover, own), *put])


@lru_cache(maxsize=1 << 8)
def _quotient(within: Geometry, shapes: Shapes) -> Quotient:
    plane, indexed = _plane(within, shapes), _indexed(shapes)
    pieces = _pieces(plane, within, shapes)
    spots = {i: deep_spot(piece, CLEARANCE) for i, piece in enumerate(pieces)}
    put = {i: plane.put(*spot) for i, spot in spots.items() if spot is not None}
    cells = {
        i: Cell(pieces[i], representative, _relations(representative, indexed))
        for i, representative in put.items()
        if contains(within, representative)
    }
    links = _shared_edges(pieces)
    slivers = frozenset(spots.keys() - put.keys())
    return _merged(cells, links | _across(slivers, cells, links))


def _check(mover: Geometry, within: Geometry, aboard: Aboard) -> None:
    if within.is_point:
        raise GeometryError("drift", f"no entity can drift within {within!r}", "drift within a polygon")
    if not all(shape.is_point or is_convex(outline(template(shape))) for shape in (mover, *aboard)):
        raise GeometryError(
            "not-convex",
            "an entity that drifts within a place, and its cargo, is a point or convex: faces are known for those only",
            "list its placements (drifts among), or give its convex hull",
        )


# --- the arrangement ------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class MetricPlane:
    """The plane of an arrangement, in metres.

    Attributes:
        room: The positions of a shape's centroid at which it is inside a place.
        put: The mover with its centroid at a spot.
        spot: The spot of a geometry's centroid.
        position: The position of a spot.
    """

    room: Callable[[Geometry, Geometry], shapely.Geometry]
    put: Callable[[float, float], Geometry]
    spot: Callable[[Geometry], tuple[float, float]]
    position: Callable[[float, float], PositionE7]


def plane_of(mover: Geometry, within: Geometry, aboard: Aboard = NOTHING_ABOARD) -> MetricPlane:
    """Return the plane of a drift."""
    return _plane(within, _shapes(mover, {}, aboard))


def _plane(within: Geometry, shapes: Shapes) -> MetricPlane:
    """Return the plane for a mover and the shapes aboard.

    If one of them is a polygon, it is the metric frame in which the polygon moves rigidly. For points alone it is a
    plane affine to latitude and longitude, approximately metric, in which edges stay exactly straight.
    """
    mover = shapes[0][0]
    if all(shape.is_point for shape, _ in shapes):
        return _affine(centroid(within).ring[0], planar(within))
    frame = local_frame(centroid(within).ring[0])

    def room_of(place: Geometry, shape: Geometry) -> shapely.Geometry:
        space = frame.project(planar(place))
        return space if shape.is_point else room(space, shape)

    return MetricPlane(
        room_of,
        lambda x, y: placed(mover, frame, x, y),
        lambda at: frame.metres(centroid(at).ring[0]),
        frame.position,
    )


def _affine(centre: PositionE7, near: shapely.Geometry) -> MetricPlane:
    north, east = centre
    up = METRES_PER_DEGREE / E7
    across = up * max(math.cos(math.radians(north / E7)), 0.01)
    east += TURN * round((near.centroid.x - east) / TURN)

    def flat(place: Geometry) -> shapely.Geometry:
        return shapely.transform(beside(near, planar(place)), lambda at: (at - (east, north)) * (across, up))

    def position(x: float, y: float) -> PositionE7:
        return rounded((north + y / up) / E7, (east + x / across) / E7)

    return MetricPlane(
        lambda place, _: flat(place),
        lambda x, y: intern((position(x, y),)),
        lambda at: flat(centroid(at)).coords[0],
        position,
    )


def _pieces(plane: MetricPlane, within: Geometry, shapes: Shapes) -> list[shapely.Polygon]:
    """Return the polygons into which all borders cut the plane, as far as they meet the surrounding place."""
    space = plane.room(within, shapes[0][0])
    rooms = [plane.room(place, shape) for shape, places in shapes for _, place in places]
    borders = [shape.boundary for shape in (space, *rooms) if shape.intersects(space)]
    cut = shapely.union_all(borders, grid_size=GRID)
    return [piece for piece in shapely.get_parts(shapely.polygonize([cut])) if piece.intersects(space)]


# --- adjacency ------------------------------------------------------------------------------------

Links = frozenset[tuple[int, int]]
"""Adjacent pieces, by index, the lesser first."""


def _shared_edges(pieces: Sequence[shapely.Polygon]) -> Links:
    """Return the pieces that share an edge; the arrangement is cut at every vertex."""
    owners: dict[frozenset[tuple[float, float]], list[int]] = {}
    for i, piece in enumerate(pieces):
        for ring in (piece.exterior, *piece.interiors):
            for edge in pairwise(ring.coords):
                owners.setdefault(frozenset(edge), []).append(i)
    return frozenset((min(pair), max(pair)) for pair in owners.values() if len(pair) == 2)


def _across(slivers: frozenset[int], cells: Mapping[int, Cell], links: Links) -> Links:
    """Return the pairs of cells that face each other across a sliver, along about a metre."""
    beside_one = sorted({i for link in links if slivers & set(link) for i in link if i in cells})
    reach = 4 * CLEARANCE
    grown = {i: cells[i].shape.buffer(reach) for i in beside_one}
    return frozenset(
        (i, j)
        for i, j in combinations(beside_one, 2)
        if grown[i].intersects(cells[j].shape) and grown[i].intersection(cells[j].shape).area > 4 * reach**2
    )


# --- faces from cells -----------------------------------------------------------------------------


def _merged(cells: Mapping[int, Cell], links: Links) -> Quotient:
    near = {i: frozenset(a + b - i for a, b in links if i in (a, b)) & cells.keys() for i in cells}
    classes = _bisimilar(cells, near)
    largest = {
        name: max((i for i in cells if classes[i] == name), key=lambda i: (round(cells[i].shape.area), -i))
        for name in set(classes.values())
    }
    order = sorted(largest, key=lambda name: cells[largest[name]].representative)
    rank = {name: position for position, name in enumerate(order)}
    faces = tuple(
        _face(cells[largest[name]], {rank[classes[j]] for j in near[largest[name]]}) for name in order
    )
    kept = sorted(cells)
    return Quotient(tuple(cells[i] for i in kept), tuple(rank[classes[i]] for i in kept), faces)


def _face(cell: Cell, adjacent: set[int]) -> Face:
    return Face(cell.representative, cell.relations, tuple(sorted(adjacent)))


def _bisimilar(cells: Mapping[int, Cell], near: Mapping[int, frozenset[int]]) -> dict[int, int]:
    """Return the class of each cell: equal relations, and moves into the same classes."""
    classes: dict[int, int] = {}
    signatures: dict[int, object] = {i: cells[i].relations for i in cells}
    while len(set(signatures.values())) > len(set(classes.values())):
        numbers: dict[object, int] = {}
        classes = {i: numbers.setdefault(signatures[i], len(numbers)) for i in sorted(cells)}
        signatures = {i: (classes[i], frozenset(classes[j] for j in near[i])) for i in cells}
    return classes
