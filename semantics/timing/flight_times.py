"""The duration of flights: an interval of ticks from geometry and speeds, rounded outwards.

The lower bound is the straight path at the greatest speed, counted from the `command`. The path leads from the
vehicle's position at the `command` through the possible positions of its VIA to those of its destination.

The upper bound is the path at the least speed, plus one circle at each point of it. The path starts at that position,
or at any point that the vehicle was sent to since, and leads through all VIA to the waypoint. The upper bound restarts
whenever the flight's targets change.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise, starmap
from typing import Final

from physical import Band, band_contains
from physical.extents import Extent, extent, greatest_distance, least_distance
from semantics.state.configuration import Configuration
from semantics.state.requests import FLY
from semantics.state.signature import Name
from semantics.timing.flight_history import Memory, Voyage, memory_cell, travelling, waypoints, whereabouts
from semantics.timing.intervals import ANY_TIME, Interval
from semantics.timing.timing import Motion

ROUNDING: Final = 1e-12
"""A generous bound on the relative error of a floating-point quotient."""


def interval_of_flight(c: Configuration, fly: FLY) -> Interval:
    """Return the duration of a flight in ticks; if several vehicles fly by one request, the maximum of both bounds.

    `lo` counts from the `command`. `hi` counts from the `command`, and again from each change of the flight's `aim`.
    """
    intervals = [_interval(c, fly, vehicle, place) for vehicle, place in travelling(c, fly)]
    if not intervals:
        return ANY_TIME
    most = [each.hi for each in intervals if each.hi is not None]
    return Interval(max(each.lo for each in intervals), max(most) if len(most) == len(intervals) else None)


def aim(c: Configuration, fly: FLY) -> tuple[object, ...]:
    """Return the current targets of a flight: when they change, `hi` is counted again."""
    physical = c.structure.physical
    return tuple(
        (vehicle, tuple(map(physical.position, (*fly.reaction.via, place))), waypoints(c, fly, vehicle))
        for vehicle, place in travelling(c, fly)
    )


def _interval(c: Configuration, fly: FLY, vehicle: Name, place: Name) -> Interval:
    timing = c.setting.timing
    motion = None if timing is None else timing.motion(vehicle)
    voyage: Memory = c.read(memory_cell(vehicle))
    names = (*fly.reaction.via, place)
    found = [whereabouts(c, name) for name in names]
    where = [each for each in found if each is not None]
    if timing is None or motion is None or not isinstance(voyage, Voyage):
        return ANY_TIME
    if voyage.hull is None or len(where) < len(
        found
    ):  # a target drifts within a place, or is absent: its position is unknown
        return ANY_TIME
    least = sum(starmap(least_distance, pairwise([voyage.origin, *where])))
    most = _longest(voyage, _aims(c, fly, vehicle, names, where), motion)
    quickest, slowest = least / motion.speed[1], most / motion.speed[0]
    levels = _levels(c, vehicle, names)
    if levels and motion.climb is not None:
        quickest = max(quickest, _climb(levels, _gap) / motion.climb[1])
        slowest += _climb(levels, _reach) / motion.climb[0]
    elif levels:
        slowest = math.inf
    return Interval(
        _ticks(quickest, timing.tick), None if math.isinf(slowest) else -_ticks(-slowest, timing.tick)
    )


def _ticks(seconds: float, tick: int) -> int:
    """Return whole ticks, rounded down."""
    return math.floor(seconds * 1000 / tick - ROUNDING * abs(seconds))


def _aims(
    c: Configuration, fly: FLY, vehicle: Name, names: Sequence[Name], where: Sequence[Extent]
) -> list[Extent]:
    """Return the targets of the flight in order: the waypoint of a place, all possible points of a mobile target.

    The list is empty if a target is itself in transit, or the flight can't end now.
    """
    physical, signature = c.structure.physical, c.setting.signature
    points = waypoints(c, fly, vehicle)
    if len(points) < len(names) or any(map(physical.transit, names)):
        return []
    mobile = [signature[c.setting.kind(name)].driven or physical.carrier(name) for name in names]
    return [
        each if may_move else extent(point)
        for each, point, may_move in zip(where, points, mobile, strict=True)
    ]


def _longest(voyage: Voyage, aims: Sequence[Extent], motion: Motion) -> float:
    """Return an upper bound in metres of a flight from its last change of aim; infinite if unknown."""
    if not aims:
        return math.inf
    begins = [voyage.origin, *map(extent, voyage.waypoints)]
    first = max(greatest_distance(begin, aims[0]) for begin in begins)
    then = sum(starmap(greatest_distance, pairwise(aims)))
    return first + then + len(aims) * math.pi * motion.circle


# --- altitudes ------------------------------------------------------------------------------------


def _levels(c: Configuration, vehicle: Name, names: Sequence[Name]) -> list[Band]:
    """Return the altitude bands along the path, in order; empty if the vehicle's own band lies within all of them."""
    positions = [c.structure.physical.position(name) for name in (vehicle, *names)]
    own, *others = [None if at is None else at.altitude for at in positions]
    if all(band_contains(other, own) for other in others):
        return []
    return [band for band in (own, *others) if band is not None]


def _climb(levels: Sequence[Band], metres: Callable[[Band, Band], float]) -> float:
    return sum(starmap(metres, pairwise(levels)))


def _gap(a: Band, b: Band) -> float:
    return max(0.0, b.low - a.high, a.low - b.high)


def _reach(a: Band, b: Band) -> float:
    return max(b.high - a.low, a.high - b.low)
