"""Turn publications of plugins into placements: the newest within its time limit, compared with P."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

from adapters.live.batch import Heard
from adapters.live.plan import Plan
from adapters.live.state import Sighting
from adapters.plugin import Aged, Gone
from physical import Geometry, PhysicalError, PhysicalProperty, translate_to
from semantics.behaviours.statements import Spawn
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, PhysicalModel, Placed, Placement, encloses
from semantics.state.setting import Setting
from semantics.state.signature import NO_ENTITIES, Name

MOST_AHEAD = 5.0
"""Seconds by which a time stamp may lie in the future: clocks differ."""


@dataclass(frozen=True, slots=True)
class Refusal:
    """A rejected message, and the reason."""

    entity: Name
    reason: str


def sighting_of(heard: Heard, known: Sighting | None, plan: Plan, now: float) -> Sighting | Refusal | None:
    """Return the sighting in a message, a Refusal if it is rejected, None if a newer sighting is known."""
    published = heard.published
    said = published.property if isinstance(published, Aged) else published
    owner = plan.vehicles.get(said.entity)
    if owner is not None and heard.plugin not in (owner, plan.peers):
        return Refusal(
            said.entity, f"'{heard.plugin}' speaks of {said.entity}, which is the vehicle of '{owner}'"
        )
    if said.entity in plan.first.alpha or said.entity in _no_entities(plan.first.setting):
        return Refusal(
            said.entity, f"'{heard.plugin}' speaks of {said.entity}, which the mission has as no entity"
        )
    kind = plan.first.setting.kinds.get(said.entity) or (known.property.kind if known is not None else None)
    if kind is not None and not isinstance(said, Gone) and said.kind != kind:
        return Refusal(
            said.entity, f"'{heard.plugin}' speaks of {said.entity} as {said.kind}, and it is of kind {kind}"
        )
    time = now if said.time is None else said.time
    if not math.isfinite(time) or time > now + MOST_AHEAD:
        ahead = f"gives times more than {MOST_AHEAD:g} s ahead"
        return Refusal(said.entity, f"'{heard.plugin}' {ahead} for {said.entity}: set its clock")
    if known is not None and time < known.time:
        return None
    if isinstance(said, Gone):
        before = _declared(plan, said.entity) if known is None else known.property
        return None if before is None else Sighting(before, time, -math.inf)
    until = time + published.time_to_live if isinstance(published, Aged) else math.inf
    return Sighting(said, time, until) if until > now else None


@lru_cache(maxsize=1 << 4)
def _no_entities(setting: Setting) -> frozenset[Name]:
    """Return the names that belong to no entity: the region, kinds, and bigActors that may be spawned."""
    spawned = (each.name for each in setting.program.statements if isinstance(each, Spawn))
    return frozenset({*NO_ENTITIES, *setting.signature.kinds, *spawned})


def _declared(plan: Plan, entity: Name) -> PhysicalProperty | None:
    """Return a mission's own placement of an entity that no plugin has reported yet."""
    position = plan.first.structure.physical.position(entity)
    return (
        None
        if position is None
        else PhysicalProperty(entity, plan.first.setting.kind(entity), position.geometry)
    )


def placement_seen(c: Configuration, shape: Placed | None, sighting: Sighting) -> Placement | None:
    """Return the placement of a sighting in P, None if the entity's shape does not fit there.

    If the mission gives the entity an extent, an observed point is its centre. An altitude band counts only if the
    mission gives one.
    """
    said = sighting.property
    geometry = said.geometry
    if shape is not None and geometry.is_point and not shape.geometry.is_point:
        try:
            geometry = _moved(shape.geometry, geometry)
        except PhysicalError:
            return None
    banded = shape is not None and shape.altitude is not None
    placed = Placed(geometry, (said.altitude or shape.altitude) if shape is not None and banded else None)
    by = said.carried_by
    return Carried(by, placed) if by is not None and _may_carry(c, by, said.entity) else placed


def _may_carry(c: Configuration, by: Name, entity: Name) -> bool:
    """Return whether a carrier of such a kind exists: no entity carries itself, directly or through others."""
    known = by in c.setting.kinds and c.setting.carries(by, entity)
    return known and entity not in (by, *c.structure.physical.carriers(by))


def _moved(shape: Geometry, to: Geometry) -> Geometry:
    return translate_to(shape, to)


# --- relations ----------------------------------------------------------------------------------------

Bounds = tuple[int, int, int, int]


@lru_cache(maxsize=1 << 12)
def bounds(geometry: Geometry) -> Bounds | None:
    """Return the south, north, west and east of a polygon, None for one across the antimeridian."""
    norths, easts = zip(*geometry.ring, strict=True)
    wide = max(easts) - min(easts) > 1_800_000_000
    return None if wide else (min(norths), max(norths), min(easts), max(easts))


Fence = tuple[Name, Placed, Bounds | None]
"""A place with a position, and its bounds."""


class Fences:
    """The places of one configuration, as an index for the containers of entities."""

    def __init__(self, c: Configuration) -> None:
        self.c = c
        self._of: dict[str, list[Fence]] = {}

    def holders(self, entity: Name, kind: str, placement: Placement | None) -> frozenset[Name]:
        """Return all containers and carriers of an entity at a placement: A(P)'s knowledge of its position."""
        if placement is None:
            return frozenset()
        if isinstance(placement, Carried):
            return frozenset({placement.by})
        assert isinstance(placement, Placed)
        north, east = placement.geometry.ring[0]
        found = []
        for place, position, limits in self._fences(kind):
            if limits and not (limits[0] < north < limits[1] and limits[2] < east < limits[3]):
                continue  # the bounds exclude most places
            if place != entity and encloses(position, placement):
                found.append(place)
        return frozenset(found)

    def _fences(self, kind: str) -> list[Fence]:
        if kind not in self._of:
            physical = self.c.structure.physical
            placed = ((name, physical.placement(name)) for name in self.c.setting.containers(kind))
            self._of[kind] = [
                (name, at, bounds(at.geometry))
                for name, at in placed
                if isinstance(at, Placed) and not at.geometry.is_point
            ]
        return self._of[kind]


def contents(physical: PhysicalModel, place: Name, placement: Placement | None) -> frozenset[Name]:
    """Return the contents of a place at a placement; entities in transit are in no place."""
    if not isinstance(placement, Placed) or placement.geometry.is_point:
        return frozenset()
    setting = physical.sorting
    holding = setting.signature[setting.kind(place)].contains
    among = (name for name in physical.entities() if name != place and setting.kind(name) in holding)
    positions = ((name, physical.position(name)) for name in among if physical.transit(name) is None)
    return frozenset(name for name, at in positions if at is not None and encloses(placement, at))
