"""Outliers: entities suspiciously far from all others; maps show their distance, checks warn of them."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Mapping
from itertools import islice, product
from typing import Final, TypeVar

from physical.frame import Position
from physical.geometry_measures import distance
from physical.land import land_share
from physical.shape import Geometry, point

CELL: Final = 500_000.0
"""The edge in metres of the cubes that divide space: entities in neighbouring cubes are near each other."""

RADIUS: Final = 6_371_000.0

REMOTE: Final = 1_000_000.0
"""The distance in metres from everything else at which a position is probably a mistake."""

LONELY: Final = 50_000.0
"""The distance in metres from all else at which a point is probably a mistake, if all else lies close together."""

MOST_COMPARED: Final = 1_000
"""The most vertices of a world whose points are compared one by one."""

MOST: Final = 20
"""The largest number of reported outliers; each is measured against all other entities."""

WIDEST: Final = 5.0
"""The largest extent in degrees of a world that is checked for a wrong position as a whole."""

ON_DRY_LAND: Final = "stands on land"
ON_LAND: Final = 0.02
"""The radius in degrees of a window: if it is all land, nothing floats at its centre on a sea or a lake."""

RIVER: Final = 1.0
"""The radius in degrees of a window: if it is all land, a river harbour at its centre is unlikely (some 100 km)."""

FAR_OUT: Final = 1.0
"""Degrees of latitude to the nearest coast that few missions exceed: some 100 km."""

NEAR: Final = 0.2
"""Degrees to a coast within which most missions at sea are."""

Key = TypeVar("Key", bound=Hashable)
Cube = tuple[int, ...]

AROUND: Final[tuple[Cube, ...]] = tuple(product((-1, 0, 1), repeat=3))


def apart(geometry: Geometry, rest: Iterable[Geometry]) -> float:
    """Return the metres to the nearest of the others, infinity without any."""
    return min((distance(geometry, each) for each in rest), default=math.inf)


def outliers(geometries: Mapping[Key, Geometry]) -> dict[Key, float]:
    """Return the entities at least a thousand kilometres from the majority, with their distance to it in metres.

    Of two equal groups the first is the majority. At most twenty are returned.
    """
    parts = _parts(geometries)
    most = max(parts, key=len, default=[])
    rest = [geometries[key] for key in most]
    others = [key for part in parts if part is not most for key in part]
    # An ocean's corners are far from everything, but it contains everything.
    rest += [
        geometries[key]
        for key in others
        if _is_wide(geometries[key]) and apart(geometries[key], rest) < REMOTE
    ]
    found = {key: apart(geometries[key], rest) for key in others[:MOST]}
    return {key: metres for key, metres in found.items() if metres >= REMOTE}


def lonely_points(geometries: Mapping[Key, Geometry]) -> dict[Key, float]:
    """Return the points far from all else, and twice as far as all else extends, with their distance in metres."""
    spots = {key: [_spot(vertex) for vertex in geometry.vertices] for key, geometry in geometries.items()}
    if sum(map(len, spots.values())) > MOST_COMPARED:
        return {}
    found = {}
    for key, (spot, *more) in spots.items():
        others = [each for other, of in spots.items() if other != key for each in of]
        if more or not others or min(math.dist(spot, each) for each in others) < LONELY:
            continue
        metres = apart(geometries[key], (each for other, each in geometries.items() if other != key))
        extent = _diagonal(others)
        if extent > 0 and metres >= max(LONELY, 2 * extent):
            found[key] = metres
    return found


def _diagonal(spots: Iterable[tuple[float, float, float]]) -> float:
    """Return the diagonal of the box around points in space."""
    return math.hypot(*(max(axis) - min(axis) for axis in zip(*spots, strict=True)))


def is_swapped(geometry: Geometry, rest: Iterable[Geometry], metres: float) -> bool:
    """Whether a distant entity would be near with its latitude and longitude exchanged."""
    latitude, longitude = geometry.vertices[0]
    return abs(longitude) <= 90 and apart(point(longitude, latitude), rest) < metres / 10


def all_swapped(geometries: Iterable[Geometry], afloat: Iterable[Geometry]) -> str:
    """Return why all latitudes and longitudes of a small world seem to be exchanged; empty if they do not.

    There are two signs of an exchange. First, all floating entities are on land, 100 km from any water, and exchanged
    they would be on water near a coast. Second, all entities are far from any coast, and exchanged they would be near
    one. The data on coasts and lakes are accurate to a kilometre; there are none on rivers and canals.
    """
    spots = [vertex for geometry in geometries for vertex in geometry.vertices]
    floating = [geometry.vertices[0] for geometry in islice(afloat, MOST)]
    if not spots or _extent(spots) > WIDEST or any(abs(longitude) > 89 for _, longitude in spots):
        return ""
    exchanged = [(longitude, latitude) for latitude, longitude in spots]
    if floating and all(_share([spot], ON_LAND) == 1 for spot in floating):
        inland = all(_share([spot], RIVER) == 1 for spot in floating)
        return ON_DRY_LAND if inland and all(_is_coastal(spot[::-1]) for spot in floating) else ""
    at_sea = _share(spots, FAR_OUT) == 0
    return (
        f"is more than {FAR_OUT * 100:.0f} km from any coast"
        if at_sea and _share(exchanged, NEAR) > 0
        else ""
    )


def _is_coastal(spot: Position) -> bool:
    """Whether a position is on water, and near a coast."""
    return _share([spot], ON_LAND) < 1 and _share([spot], FAR_OUT) > 0


def _extent(spots: list[Position]) -> float:
    latitudes, longitudes = zip(*spots, strict=True)
    return float(max(max(latitudes) - min(latitudes), max(longitudes) - min(longitudes)))


def _share(spots: list[Position], around: float) -> float:
    """Return the share of land in a window around positions, extended by some degrees of latitude on each side."""
    latitudes, longitudes = zip(*spots, strict=True)
    wide = around / max(0.1, math.cos(math.radians(max(map(abs, latitudes)))))
    south_west = max(-90.0, min(latitudes) - around), min(longitudes) - wide
    return land_share(south_west, (min(90.0, max(latitudes) + around), max(longitudes) + wide))


def _parts(geometries: Mapping[Key, Geometry]) -> list[list[Key]]:
    """Return groups of near entities, in the given order; cubes make this fast for thousands."""
    cubes = {key: {_cube(vertex) for vertex in geometry.vertices} for key, geometry in geometries.items()}
    holding: dict[Cube, list[Key]] = {}
    for key, of in cubes.items():
        for cube in of:
            holding.setdefault(cube, []).append(key)
    parts, seen = list[list[Key]](), set[Key]()
    for key in geometries:
        if key in seen:
            continue
        seen.add(key)
        part = [key]
        for near in part:  # the list grows during the loop
            for cube in cubes[near]:
                for shift in AROUND:
                    found = holding.pop(tuple(map(sum, zip(cube, shift, strict=True))), [])
                    part += [each for each in dict.fromkeys(found) if each not in seen]
                    seen.update(found)
        parts.append(part)
    return parts


def _is_wide(geometry: Geometry) -> bool:
    return len(set(map(_cube, geometry.vertices))) > 1


def _cube(position: Position) -> Cube:
    """Return the cube of space that contains a position."""
    return tuple(math.floor(each / CELL) for each in _spot(position))


def _spot(position: Position) -> tuple[float, float, float]:
    """Return a position as metres in space."""
    latitude, longitude = map(math.radians, position)
    ring = RADIUS * math.cos(latitude)
    return (ring * math.cos(longitude), ring * math.sin(longitude), RADIUS * math.sin(latitude))
