"""The view of a map, apart from drawing: the plane, the extent, the ticks and the scale bar."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from typing import Final

from physical.frame import Position
from physical.map_labels import Box, Spot, union
from physical.shape import Geometry

SEMI_MAJOR: Final = 6_378_137.0
ECCENTRICITY_SQUARED: Final = 0.006_694_379_990_14
STEEPEST: Final = 89.5
"""The highest latitude for the plane's scale: at a pole a degree of longitude has no length."""

NARROWEST: Final = 400.0
"""The smallest width of a view in metres."""

FAR: Final = 4.0
"""The factor by which the view must shrink for far entities to be left out."""

STEPS: Final = (1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0)
FINE_STEPS: Final = tuple(digit * 10.0**-power for power in range(7, 0, -1) for digit in (1, 2, 5))


@dataclass(frozen=True, slots=True)
class Plane:
    """Metres to the east and north of a position, with the length of a degree at that position everywhere.

    So edges, straight in latitude and longitude, stay straight, and so do parallels and meridians.
    """

    latitude: float
    longitude: float

    @property
    def scale(self) -> Spot:
        """Metres per degree of longitude and of latitude."""
        latitude = math.radians(min(max(self.latitude, -STEEPEST), STEEPEST))
        flat = 1.0 - ECCENTRICITY_SQUARED * math.sin(latitude) ** 2
        across = SEMI_MAJOR / math.sqrt(flat)
        along = across * (1.0 - ECCENTRICITY_SQUARED) / flat
        return (math.radians(across * math.cos(latitude)), math.radians(along))

    def metres(self, position: Position) -> Spot:
        """Return the spot of a position; the world is cut opposite to the plane's centre."""
        east, north = self.scale
        return (turned(position[1] - self.longitude) * east, (position[0] - self.latitude) * north)

    def degrees(self, spot: Spot) -> Position:
        """Return latitude and longitude; the longitude is not normalised to [-180, 180)."""
        east, north = self.scale
        return (self.latitude + spot[1] / north, self.longitude + spot[0] / east)

    def outline(self, geometry: Geometry) -> tuple[Spot, ...]:
        """Return the vertices of a geometry, in one piece across the antimeridian."""
        east, north = self.scale
        vertices = geometry.vertices
        steps = [turned(there[1] - here[1]) for here, there in pairwise(vertices)]
        longitudes = accumulate(steps, initial=turned(vertices[0][1] - self.longitude))
        return tuple(
            (x * east, (latitude - self.latitude) * north)
            for (latitude, _), x in zip(vertices, longitudes, strict=True)
        )


def turned(longitude: float) -> float:
    """Return a longitude normalised to [-180, 180).

    >>> turned(190.0)
    -170.0
    """
    return (longitude + 180.0) % 360.0 - 180.0


def plane_of(geometries: Sequence[Geometry]) -> Plane:
    """Return the plane around the middle of geometries, cut in the largest gap between their longitudes."""
    positions = [vertex for geometry in geometries for vertex in geometry.vertices] or [(0.0, 0.0)]
    latitudes = [latitude for latitude, _ in positions]
    longitudes = sorted({turned(longitude) for _, longitude in positions})
    gaps = [there - here for here, there in pairwise([*longitudes, longitudes[0] + 360.0])]
    widest = max(range(len(gaps)), key=gaps.__getitem__)
    east, west = longitudes[widest], longitudes[widest] + gaps[widest] - 360.0
    return Plane((min(latitudes) + max(latitudes)) / 2, turned((west + east) / 2))


def bounds(outline: Sequence[Spot]) -> Box:
    """Return the box around some spots."""
    xs, ys = zip(*outline, strict=True)
    return Box(min(xs), min(ys), max(xs), max(ys))


def focus(boxes: Sequence[Box]) -> tuple[int, ...]:
    """Return the boxes that a view should hold, sorted: all but at most a quarter, the farthest ones.

    As few as possible are left out, and only if the view shrinks to less than a quarter.
    """
    everything = tuple(range(len(boxes)))
    if len(boxes) < 4:
        return everything
    middle = (_median([box.centre[0] for box in boxes]), _median([box.centre[1] for box in boxes]))
    by_distance = sorted(everything, key=lambda each: (math.dist(boxes[each].nearest(middle), middle), each))
    whole = _span(boxes)
    for left_out in range(1, len(boxes) // 4 + 1):
        kept = by_distance[: len(boxes) - left_out]
        if max(_span([boxes[each] for each in kept]), NARROWEST) * FAR < whole:
            return tuple(sorted(kept))
    return everything


def _median(values: Sequence[float]) -> float:
    return sorted(values)[len(values) // 2]


def _span(boxes: Sequence[Box]) -> float:
    around = union(boxes)
    return max(around.width, around.height)


def view_of(boxes: Sequence[Box], aspect: float, margin: float = 0.1) -> Box:
    """Return the view around boxes with an aspect (width by height) and a margin, a share of its size."""
    around = union(boxes)
    room = 1.0 - 2.0 * margin
    width = max(around.width / room, around.height / room * aspect, NARROWEST)
    (x, y), height = around.centre, width / aspect
    return Box(x - width / 2, y - height / 2, x + width / 2, y + height / 2)


# --- ticks and the scale bar ----------------------------------------------------------------------


def tick_step(span: float, most: int) -> float:
    """Return the finest round number of degrees that divides a span into at most `most` parts."""
    return next((step for step in (*FINE_STEPS, *STEPS) if span <= step * most), STEPS[-1])


def ticks(low: float, high: float, most: int) -> tuple[float, ...]:
    """Return the round degrees between two, at most `most` plus one."""
    step = tick_step(high - low, most)
    return tuple(index * step for index in range(math.ceil(low / step), math.floor(high / step) + 1))


def degrees_text(degrees: float, step: float, letters: str) -> str:
    """Return a latitude or longitude as text, with the digits that its step needs.

    >>> degrees_text(-8.8, 0.05, "EW"), degrees_text(36.95, 0.05, "NS"), degrees_text(190, 10, "EW")
    ('8.80°W', '36.95°N', '170°W')
    """
    value = turned(degrees) if letters == "EW" else degrees
    digits = max(0, math.ceil(-math.log10(step) - 1e-9))
    shown = f"{abs(value):.{digits}f}"
    letter = "" if float(shown) in (0.0, 180.0) else letters[value < 0]
    return f"{shown}°{letter}"


def scale_length(width: float) -> float:
    """Return the longest round number of metres, at most a quarter of a view's width."""
    power = 10.0 ** math.floor(math.log10(width / 4))
    return max(digit * power for digit in (1, 2, 5) if digit * power <= width / 4)
