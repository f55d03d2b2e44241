"""The geofence of a mission's vehicles, from its world."""

from __future__ import annotations

import math
from collections.abc import Iterator

from bigactors.mistakes import Mistake
from bigraphs.notation.spelling import did_you_mean
from physical import Geometry, area, box, contains
from physical.frame import METRES_PER_DEGREE
from semantics.environment import Placing
from semantics.state.physical_model import Placed
from semantics.state.signature import Name
from specs.elaboration import ElaboratedMission

MARGIN = 500.0
"""Metres around the box: a plane flies past a place before it circles in it."""

NONE, WORLD = "none", "world"


def fence_of(word: str, mission: ElaboratedMission) -> Geometry | None:
    """Return the vehicles' fence: a place, the world's default, or none; raises Mistake."""
    if word == NONE:
        return None
    if word == WORLD:
        return _around(mission)
    at = mission.initial.structure.physical.placement(word) if word in mission.setting.kinds else None
    if not isinstance(at, Placed) or at.geometry.is_point or word not in mission.fixed:
        hint = (
            did_you_mean(word, mission.fixed)
            or f"name a place that has a border and never moves, {WORLD} or {NONE}"
        )
        raise Mistake(f"'{word:.60}' is no fence", hint)
    return at.geometry


def _around(mission: ElaboratedMission) -> Geometry | None:
    """Return the smallest immobile place that contains the reach of all vehicles, else a box around that reach."""
    grounds = tuple(dict.fromkeys(_grounds(mission)))
    physical = mission.initial.structure.physical
    standing = (physical.placement(name) for name in sorted(mission.fixed))
    places = [at.geometry for at in standing if isinstance(at, Placed) and not at.geometry.is_point]
    holding = [
        place for place in places if all(place == ground or contains(place, ground) for ground in grounds)
    ]
    if holding:
        return min(holding, key=area)
    return _box(grounds) if grounds else None


def _grounds(mission: ElaboratedMission) -> Iterator[Geometry]:
    """Yield the vehicles' first placements, and all possible placements of their containers."""
    setting, physical = mission.setting, mission.initial.structure.physical
    driven = setting.driven()
    for vehicle in driven:
        at = physical.position(vehicle)
        if at is not None:
            yield at.geometry
    holders = {place for vehicle in driven for place in setting.containers(setting.kind(vehicle))}
    for place in sorted(holders):
        yield from (at.geometry for at in _placements(place, mission) if not at.geometry.is_point)


def placements_of(place: Name, mission: ElaboratedMission) -> tuple[Geometry, ...]:
    """Return a place's first placement and all others that the mission allows."""
    return tuple(dict.fromkeys(at.geometry for at in _placements(place, mission)))


def _placements(place: Name, mission: ElaboratedMission) -> Iterator[Placed]:
    first = mission.initial.structure.physical.placement(place)
    if isinstance(first, Placed):
        yield first
    for clause in mission.setting.environment:
        if isinstance(clause, Placing) and clause.entity == place:
            yield from (at for at in clause.placements if isinstance(at, Placed))


def _box(grounds: tuple[Geometry, ...]) -> Geometry:
    latitudes, longitudes = zip(*(vertex for ground in grounds for vertex in ground.vertices), strict=True)
    if max(longitudes) - min(longitudes) > 180.0:
        hint = f"name a place: --fence PLACE, or --fence {NONE}"
        raise Mistake(
            "there is no box around the world of this mission: it is on both sides of 180 degrees", hint
        )
    north = MARGIN / METRES_PER_DEGREE
    east = north / max(0.01, math.cos(math.radians(max(map(abs, latitudes)))))
    return box(
        (max(-90.0, min(latitudes) - north), min(longitudes) - east),
        (min(90.0, max(latitudes) + north), max(longitudes) + east),
    )
