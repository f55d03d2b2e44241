"""The lengths of legs: the shortest and the longest line from where a vehicle begins to where it flies to."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

from physical.geodesic_areas import GeodesicArea, area_of
from physical.geodesic_distances import greatest_distance_of, nearest_line
from physical.regions import RegionPart
from physical.resting_regions import GroundPatch


class LegLength(NamedTuple):
    """The metres of a leg, from the least to the most; `most` is None if the vehicle may fly detours."""

    least: float
    most: float | None


class FlightLeg(NamedTuple):
    """A leg of a flight: its part of the region, and the length of the line in its middle, in metres."""

    part: RegionPart
    least: float
    most: float | None


def length_between(begins: Sequence[GroundPatch], ends: Sequence[GroundPatch]) -> LegLength:
    """Return the length of the shortest lines from a point of one patch to a point of another, margins aside."""
    pairs = [(_area(begin), _area(end)) for begin, end in product(begins, ends)]
    if not pairs:
        return LegLength(0.0, None)
    least = min(nearest_line(begin, end).metres for begin, end in pairs)
    return LegLength(least, max(least, *(greatest_distance_of(begin, end) for begin, end in pairs)))


def _area(patch: GroundPatch) -> GeodesicArea:
    return area_of(RegionPart(patch.sources, patch.spanned))
