"""Containment among many places: which contain which, and whether they nest (paper §3.2.2).

An STRtree finds candidates by their bounds; it holds each place three times, shifted by a turn of longitude. `contains`
and `overlaps` decide.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import shapely

from physical.altitude import Band, band_contains
from physical.frame import TURN
from physical.geometry_measures import area
from physical.shape import Geometry, beside, contains, equal, overlaps, planar

_TOUCHING: Final = "share a border: neither is inside the other"


@dataclass(frozen=True, slots=True)
class Place:
    """A geometry that may contain others, with a band of altitudes."""

    geometry: Geometry
    altitude: Band | None = None


class PlaceIndex:
    """Answers containment queries over named places; immutable."""

    __slots__ = ("_names", "_places", "_tree")

    def __init__(self, places: Mapping[str, Place | Geometry]) -> None:
        self._names: Final = tuple(sorted(places))
        self._places: Final = {name: _as_place(places[name]) for name in self._names}
        self._tree: Final = shapely.STRtree(
            [_bounds(place.geometry, turn) for place in self._places.values() for turn in (-TURN, 0, TURN)]
        )

    def near(self, geometry: Geometry) -> tuple[str, ...]:
        """Return the names of the places whose bounds meet those of a geometry, sorted."""
        found = self._tree.query(_bounds(geometry, 0))
        return tuple(self._names[i] for i in sorted({int(entry) // 3 for entry in found}))

    def containers(self, geometry: Geometry, altitude: Band | None = None) -> tuple[str, ...]:
        """Return all places that contain a geometry, smallest first, ties by name."""
        inner = Place(geometry, altitude)
        found = [name for name in self.near(geometry) if holds(self._places[name], inner)]
        return tuple(sorted(found, key=lambda name: (area(self._places[name].geometry), name)))

    def smallest(self, geometry: Geometry, altitude: Band | None = None) -> str | None:
        """Return the smallest place that contains a geometry: its parent."""
        return next(iter(self.containers(geometry, altitude)), None)

    def minimal(self, geometry: Geometry, altitude: Band | None = None) -> tuple[str, ...]:
        """Return the containers that contain no other container, sorted: the parents, with sharing."""
        found = {name: self._places[name] for name in self.containers(geometry, altitude)}
        above = {
            name for name, place in found.items() if any(holds(place, inner) for inner in found.values())
        }
        return tuple(sorted(found.keys() - above))


def holds(outer: Place, inner: Place) -> bool:
    """Whether a place contains another: on the ground, and in altitude if both have a band."""
    return contains(outer.geometry, inner.geometry) and band_contains(outer.altitude, inner.altitude)


@dataclass(frozen=True, slots=True, order=True)
class Conflict:
    """Two places that do not nest: they overlap, and neither contains the other.

    Attributes:
        first: The first place by name.
        second: The other place.
        reason: Why they do not nest.
        outer: The place that would contain the other without their common border; may be empty.
    """

    first: str
    second: str
    reason: str
    outer: str = ""

    def __str__(self) -> str:
        """Return the conflict as a sentence with both names."""
        return f"{self.first} and {self.second} {self.reason}"

    @property
    def hint(self) -> str:
        """A remedy."""
        if self.outer:
            return f"a place inside another touches no border: make {self.outer} a little larger"
        return "places must nest or be apart: change one of the two"


def check_places(places: Mapping[str, Place | Geometry]) -> tuple[Conflict, ...]:
    """Return all pairs of places that do not nest, sorted; a world with sharing needs no check.

    >>> from physical.shape import box
    >>> room = box((0, 0), (1, 1))
    >>> for conflict in check_places({"a": room, "b": room, "c": box((0.5, 0.5), (2, 2))}):
    ...     print(conflict)
    a and b are the same place
    a and c partly overlap
    b and c partly overlap
    """
    index = PlaceIndex(places)
    known = {name: _as_place(place) for name, place in places.items()}
    pairs = ((a, b) for a in sorted(known) for b in index.near(known[a].geometry) if a < b)
    reasons = ((a, b, _reason(known[a], known[b])) for a, b in pairs)
    return tuple(
        Conflict(a, b, reason, _outer(a, b, known) if reason == _TOUCHING else "")
        for a, b, reason in reasons
        if reason
    )


def _outer(a: str, b: str, known: Mapping[str, Place]) -> str:
    """Return the place that covers the other, if one does."""
    fixed = planar(known[a].geometry)
    other = beside(fixed, planar(known[b].geometry))
    return a if fixed.covers(other) else b if other.covers(fixed) else ""


def _reason(a: Place, b: Place) -> str:
    if holds(a, b) or holds(b, a) or not _bands_meet(a.altitude, b.altitude):
        return ""
    if equal(a.geometry, b.geometry) and not a.geometry.is_point:
        return "are the same place" if a.altitude == b.altitude else "have one border and overlap in altitude"
    if contains(a.geometry, b.geometry) or contains(b.geometry, a.geometry):
        return "nest on the ground, but not in altitude"
    if overlaps(a.geometry, b.geometry):
        return "partly overlap" if _cross(a.geometry, b.geometry) else _TOUCHING
    return ""


def _cross(a: Geometry, b: Geometry) -> bool:
    fixed = planar(a)
    return bool(shapely.overlaps(fixed, beside(fixed, planar(b))))


def _bands_meet(a: Band | None, b: Band | None) -> bool:
    return a is None or b is None or a == b or (a.low < b.high and b.low < a.high)


def _as_place(place: Place | Geometry) -> Place:
    return Place(place) if isinstance(place, Geometry) else place


def _bounds(geometry: Geometry, turn: int) -> shapely.Geometry:
    west, south, east, north = planar(geometry).bounds
    return shapely.box(west + turn, south, east + turn, north)
