"""Geometry on the WGS 84 earth: interned, canonical values and the relations between them.

**The frame.** An edge is a straight line in latitude and longitude (RFC 7946 §3.1.1), the shorter way around;
coordinates are integers of 1e-7 degree. So every containment is decided in one plane, where both operands are exact.
Only metres need a projection (`measure`, `placement`). A world shifted around the earth behaves the same. A polygon
that encloses a pole or reaches half around the earth does not fit this plane and is refused.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import accumulate, islice, pairwise
from threading import Lock
from typing import Any, Final
from weakref import WeakValueDictionary

import shapely
from shapely.affinity import translate

from physical.errors import GeometryError
from physical.frame import E7, TURN, Position, PositionE7, geod, normal_longitude, rounded
from physical.long_edges import check_edges

MAX_VERTICES: Final = 10_000
CIRCLE_VERTICES: Final = 64
SMALLEST_RADIUS: Final = 0.5
LARGEST_RADIUS: Final = 10_000_000.0
SHOWN_VERTICES: Final = 8
MEMO: Final = 1 << 14
"""The size of caches for polygons; points are not cached, since live feeds bring ever new ones."""


@dataclass(frozen=True, slots=True, eq=False, repr=False, weakref_slot=True)
class Geometry:
    """A point or a polygon; equal geometries are one object, so `==` and `hash` are free.

    Only `point`, `polygon`, `circle`, `box` and the functions that move them (`physical.placement`) create geometries.

    Attributes:
        ring: Latitudes and longitudes in 1e-7 degree. A point has one pair. A polygon has its vertices
            counter-clockwise from the least one, without those amid a straight edge; the first is not repeated.
        template: The original polygon of a moved one, else None. Every placement is computed from its template, so
            moving there and back gives the same value.
        anchor: The position of the template's centroid in this placement.
        key: The hash, the same in every process.
    """

    ring: tuple[PositionE7, ...]
    template: Geometry | None
    anchor: PositionE7 | None
    key: int

    def __hash__(self) -> int:
        return self.key

    def __lt__(self, other: Geometry) -> bool:
        return self.order() < other.order()

    def __reduce__(self) -> tuple[object, ...]:
        return intern, (self.ring, self.template, self.anchor)

    def __copy__(self) -> Geometry:
        return self

    def __deepcopy__(self, memo: dict[int, object]) -> Geometry:
        return self

    def __repr__(self) -> str:
        """Return the call that creates it; long polygons are elided.

        >>> box((37.04, -8.59), (36.94, -8.79))
        polygon([(36.94, -8.79), (36.94, -8.59), (37.04, -8.59), (37.04, -8.79)])
        """
        if self.is_point:
            return f"point({self.vertices[0][0]}, {self.vertices[0][1]})"
        shown = ", ".join(map(str, self.vertices[:SHOWN_VERTICES]))
        more = len(self.ring) - SHOWN_VERTICES
        return f"polygon([{shown}{f', ... {more} more' if more > 0 else ''}])"

    def order(self) -> tuple[object, ...]:
        """Return a sort key: vertices first."""
        return (self.ring, self.anchor or (), () if self.template is None else self.template.order())

    @property
    def is_point(self) -> bool:
        """Whether this is a point: it has no interior and contains nothing."""
        return len(self.ring) == 1

    @property
    def vertices(self) -> tuple[Position, ...]:
        """Latitudes and longitudes in degrees."""
        return tuple((latitude / E7, longitude / E7) for latitude, longitude in self.ring)


_INTERNED: Final[WeakValueDictionary[tuple[object, ...], Geometry]] = WeakValueDictionary()
_LOCK: Final = Lock()


def intern(
    ring: tuple[PositionE7, ...], template: Geometry | None = None, anchor: PositionE7 | None = None
) -> Geometry:
    """Return the unique geometry with these (canonical) fields."""
    fields = (ring, template, anchor)
    with _LOCK:
        known = _INTERNED.get(fields)
        if known is None:
            # None hashes by address before Python 3.12, hence the zero.
            key = hash((ring, 0 if template is None else template.key, anchor or ()))
            known = _INTERNED[fields] = Geometry(ring, template, anchor, key)
        return known


# --- construction ---------------------------------------------------------------------------------


def point(latitude: float, longitude: float) -> Geometry:
    """Return a point, given in degrees.

    >>> point(-0.0, 180) is point(0, -180.0)
    True
    """
    return intern((_position(latitude, longitude),))


def polygon(vertices: Iterable[Sequence[float]]) -> Geometry:
    """Return the polygon with these (latitude, longitude) vertices, in either direction, closed or not.

    >>> polygon([(0, 0), (0, 1), (0, 2), (1, 2), (0, 0)]) is polygon([(1, 2), (0, 2), (0, 0)])
    True
    """
    listed = list(islice(vertices, MAX_VERTICES + 2))
    if len(listed) > MAX_VERTICES + 1:
        raise GeometryError(
            "too-many-vertices",
            f"the polygon has more than {MAX_VERTICES} vertices",
            "simplify it: coordinates hold 1 cm, a border rarely needs them all",
        )
    return canonical([_position(*_pair(vertex)) for vertex in listed])


def box(corner: Sequence[float], opposite: Sequence[float]) -> Geometry:
    """Return the box along parallels and meridians between opposite corners (paper, Example 1: NE and SW)."""
    (south, west), (north, east) = _position(*_pair(corner)), _position(*_pair(opposite))
    check_edges((corner, opposite), closed=False)
    if south == north or west == east:
        raise GeometryError(
            "zero-area", "the box has no area: its corners lie on one line", "give two opposite corners"
        )
    return canonical([(south, west), (south, east), (north, east), (north, west)])


def circle(centre: Sequence[float], radius: float, vertices: int = CIRCLE_VERTICES) -> Geometry:
    """Return the polygon of points at a geodesic distance of `radius` metres from a centre."""
    latitude, longitude = (coordinate / E7 for coordinate in _position(*_pair(centre)))
    _check_radius(radius, latitude)
    _check_vertex_count(vertices)
    azimuths = [360.0 * step / vertices for step in range(vertices)]
    lons, lats, _ = geod().fwd(
        [longitude] * vertices, [latitude] * vertices, azimuths, [float(radius)] * vertices
    )
    return canonical([rounded(lat, lon) for lat, lon in zip(lats, lons, strict=True)])


def canonical(
    positions: Sequence[PositionE7], template: Geometry | None = None, anchor: PositionE7 | None = None
) -> Geometry:
    """Return the polygon around positions in 1e-7 degree, checked and in canonical form."""
    ring = [here for here, after in pairwise([*positions, *positions[:1]]) if here != after]
    if len(ring) < 3:
        raise GeometryError(
            "too-few-vertices",
            f"a polygon needs at least 3 different vertices; {len(ring)} given",
            "write a place of no extent as a point",
        )
    plane = _unrolled(ring)
    _check_simple(plane)
    kept = _without_straight(plane)
    if _twice_area(kept) < 0:
        kept.reverse()
    normal = [(north, normal_longitude(east)) for north, east in kept]
    start = normal.index(min(normal))
    return intern((*normal[start:], *normal[:start]), template, anchor)


def _pair(value: Sequence[float]) -> Sequence[float]:
    try:
        if len(value) == 2 and not isinstance(value, str | bytes):
            return value
    except TypeError:
        pass
    raise GeometryError(
        "not-a-position", f"{value!r:.60} is no position", "write (latitude, longitude), in degrees"
    )


def _position(latitude: float, longitude: float) -> PositionE7:
    for name, value, limit in (("latitude", latitude, 90), ("longitude", longitude, 180)):
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise GeometryError(
                "not-a-number", f"the {name} {value!r:.60} is not a number", "write it in degrees"
            )
        if not -limit <= value <= limit:  # also rejects NaN
            # An int may be too long to print or to convert to float.
            shown = value if isinstance(value, float) or abs(value) < E7 else "given"
            swapped = name == "latitude" and -180 <= latitude <= 180 and isinstance(longitude, int | float)
            doubt = "are they swapped? " if swapped and -90 <= longitude <= 90 else ""
            raise GeometryError(
                "not-finite" if isinstance(value, float) and not math.isfinite(value) else name,
                f"the {name} {shown} is not between -{limit} and {limit}",
                f"{doubt}positions are (latitude, longitude), in degrees, north and east positive",
            )
    return rounded(latitude, longitude)


def _check_radius(radius: float, latitude: float) -> None:
    if isinstance(radius, bool) or not isinstance(radius, int | float) or not math.isfinite(radius):
        raise GeometryError("radius", f"the radius {radius!r:.60} is not a number", "write it in metres")
    if radius < SMALLEST_RADIUS:
        raise GeometryError(
            "radius",
            f"the radius {radius!r} m is under {SMALLEST_RADIUS} m",
            "coordinates hold 1 cm; write a place of no extent as a point",
        )
    if radius >= LARGEST_RADIUS:
        raise GeometryError(
            "hemisphere", f"the radius {radius!r} m reaches half around the earth", "the radius is in metres"
        )
    _, _, to_pole = geod().inv(0.0, latitude, 0.0, math.copysign(90.0, latitude))
    if radius >= to_pole:
        raise _pole()


def _check_vertex_count(vertices: int) -> None:
    if not 3 <= vertices <= MAX_VERTICES:
        raise GeometryError(
            "vertices", f"a circle of {vertices} vertices", f"give it between 3 and {MAX_VERTICES}"
        )


def _pole() -> GeometryError:
    return GeometryError(
        "pole",
        "the polygon encloses a pole",
        "cut it along a meridian: places may touch a pole, not go around it",
    )


def _unrolled(ring: Sequence[PositionE7]) -> list[PositionE7]:
    """Return a ring with continuous longitudes, the western-most in [-180, 180) degrees."""
    steps = [normal_longitude(there[1] - here[1]) for here, there in pairwise([*ring, ring[0]])]
    if sum(steps) != 0:
        raise _pole()
    easts = list(accumulate(steps[:-1], initial=ring[0][1]))
    west = min(easts)
    if max(easts) - west >= TURN // 2:
        raise GeometryError(
            "hemisphere",
            "the polygon reaches half around the earth or more",
            "split it into places that span less than 180 degrees of longitude",
        )
    shift = normal_longitude(west) - west
    return [(vertex[0], east + shift) for vertex, east in zip(ring, easts, strict=True)]


def _cross(a: PositionE7, b: PositionE7, c: PositionE7) -> int:
    return (b[1] - a[1]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[1] - a[1])


def _check_simple(plane: Sequence[PositionE7]) -> None:
    if all(_cross(plane[0], plane[1], vertex) == 0 for vertex in plane):
        raise GeometryError(
            "zero-area",
            "the polygon has no area: its vertices lie on one line",
            "check the order of the coordinates",
        )
    reason: str = shapely.is_valid_reason(shapely.Polygon([(east, north) for north, east in plane]))
    if reason == "Valid Geometry":
        return
    found = re.search(r"\[(\S+) (\S+)\]", reason)
    at = f" at ({float(found[2]) / E7:.7f}, {_degrees(float(found[1])):.7f})" if found else ""
    raise GeometryError(
        "self-intersection",
        f"the polygon's border crosses or touches itself{at}",
        "list the vertices in order around the border, each once",
    )


def _degrees(east: float) -> float:
    return (east / E7 + 180.0) % 360.0 - 180.0


def _without_straight(plane: Sequence[PositionE7]) -> list[PositionE7]:
    """Return a simple ring without the vertices amid a straight edge."""
    around = zip([plane[-1], *plane[:-1]], plane, [*plane[1:], plane[0]], strict=True)
    return [here for before, here, after in around if _cross(before, here, after) != 0]


def _twice_area(plane: Sequence[PositionE7]) -> int:
    return sum(a[1] * b[0] - a[0] * b[1] for a, b in pairwise([*plane, plane[0]]))


# --- relations ------------------------------------------------------------------------------------


def planar(geometry: Geometry) -> shapely.Geometry:
    """Return the shape in the plane of longitudes and latitudes (x and y, in 1e-7 degree), a polygon prepared."""
    if geometry.is_point:
        return shapely.Point(geometry.ring[0][1], geometry.ring[0][0])
    return _prepared(geometry)


@lru_cache(maxsize=MEMO)
def _prepared(geometry: Geometry) -> shapely.Geometry:
    shape = shapely.Polygon([(east, north) for north, east in _unrolled(geometry.ring)])
    shapely.prepare(shape)
    return shape


def beside(fixed: shapely.Geometry, shape: shapely.Geometry) -> shapely.Geometry:
    """Return a planar shape, shifted by a turn if that brings it nearer to the fixed one."""
    (west, _, east, _), (from_, _, to, _) = fixed.bounds, shape.bounds
    if from_ > east:
        return _shifted(shape, -TURN)
    return _shifted(shape, TURN) if to < west else shape


def _shifted(shape: shapely.Geometry, by: int) -> shapely.Geometry:
    return translate(shape, by)


@lru_cache(maxsize=MEMO)
def _bounds(geometry: Geometry) -> tuple[int, int, int, int]:
    """Return the bounds of a polygon in the plane: west, south, east, north; edges are straight between vertices."""
    west, south, east, north = planar(geometry).bounds
    return int(west), int(south), int(east), int(north)


def contains(outer: Geometry, inner: Geometry) -> bool:
    """Whether all of `inner`, with its border, lies in the interior of `outer`; a point contains nothing."""
    if outer.is_point or outer is inner:
        return False
    if inner.is_point:
        return _relates(shapely.contains_xy, outer, inner)
    return _contains_polygon(outer, inner)


def covers(outer: Geometry, inner: Geometry) -> bool:
    """Whether a point is inside a polygon or on its border."""
    return _relates(shapely.intersects_xy, outer, inner)


def _relates(relation: Callable[[shapely.Geometry, int, int], Any], outer: Geometry, inner: Geometry) -> bool:
    """Return a relation of a polygon and a point; it is not cached, since a mover is at each point once."""
    (north, east), (left, bottom, right, top) = inner.ring[0], _bounds(outer)
    if not bottom <= north <= top:  # decides most pairs, a hundred times faster
        return False
    if east > right:
        east -= TURN
    elif east < left:
        east += TURN
    return left <= east <= right and bool(relation(planar(outer), east, north))


@lru_cache(maxsize=MEMO)
def _contains_polygon(outer: Geometry, inner: Geometry) -> bool:
    (_, south, _, north), (_, lowest, _, highest) = _bounds(outer), _bounds(inner)
    if lowest <= south or highest >= north:  # decides most pairs
        return False
    fixed = planar(outer)
    return bool(shapely.contains_properly(fixed, beside(fixed, planar(inner))))


@lru_cache(maxsize=MEMO)
def overlaps(a: Geometry, b: Geometry) -> bool:
    """Whether two different polygons share interior, and neither contains the other.

    A common border alone is no overlap. A polygon that touches the border of another from inside is not contained in
    it, hence overlaps it.
    """
    return share_interior(a, b) and not (equal(a, b) or contains(a, b) or contains(b, a))


@lru_cache(maxsize=MEMO)
def share_interior(a: Geometry, b: Geometry) -> bool:
    """Whether two polygons share interior, more than a border; a point has none."""
    if a.is_point or b.is_point:
        return False
    (left, bottom, right, top), (west, south, east, north) = _bounds(a), _bounds(b)
    turn = -TURN if west > right else TURN if east < left else 0
    if north <= bottom or south >= top or east + turn <= left or west + turn >= right:
        return False  # most pairs
    return bool(
        shapely.relate_pattern(planar(a), _shifted(planar(b), turn) if turn else planar(b), "T********")
    )


def equal(a: Geometry, b: Geometry) -> bool:
    """Whether two geometries have the same points, whatever their templates."""
    return a.ring == b.ring
