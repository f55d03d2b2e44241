"""Turn publications of plugins into placements: the newest within its time limit, compared with P."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache

from adapters.live.batch import Heard
from adapters.live.plan import Plan
from adapters.plugin import Aged, Gone
from physical import Geometry, PhysicalError, PhysicalProperty, translate_to
from semantics.behaviours.statements import Spawn
from semantics.state.cell_values import Cell
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, PhysicalModel, Placed, Placement, encloses
from semantics.state.setting import Setting
from semantics.state.signature import NO_ENTITIES, Name

MOST_AHEAD = 5.0
"""Seconds by which a time stamp may lie in the future: clocks differ."""


@dataclass(frozen=True, slots=True)
class Sighting:
    """The newest observation of an entity, and the end of its validity in P."""

    property: PhysicalProperty
    time: float
    until: float


@dataclass(frozen=True, slots=True)
class Sightings:
    """The observations of a run.

    Attributes:
        newest: The newest sighting of each entity that the mission names or has admitted.
        expires: Time at which the first sighting becomes too old.
        lost: Vehicles whose link is lost.
        missing: Cells of P whose removal broke an assumption, with their values: their return breaks no other.
        unseen: Entities that are no longer seen, and that an observation may miss: they stay in P.
        admitted: The number of strangers admitted from each plugin, and of those that are places.
    """

    newest: Mapping[Name, Sighting] = field(default_factory=dict)
    expires: float = math.inf
    lost: frozenset[Name] = frozenset()
    missing: Mapping[Cell, object] = field(default_factory=dict)
    unseen: frozenset[Name] = frozenset()
    admitted: Mapping[str, tuple[int, int]] = field(default_factory=dict)

    def with_newest(self, found: Mapping[Name, Sighting]) -> Sightings:
        """Return the value with newer sightings of some entities."""
        if not found:
            return self
        expires = min(self.expires, *(each.until for each in found.values()))
        newest = {**self.newest, **found}
        return replace(self, newest=newest, expires=expires, unseen=self.unseen.difference(found))

    def expired(self, now: float) -> frozenset[Name]:
        """Return the entities whose sighting is too old."""
        return frozenset(name for name, each in self.newest.items() if each.until <= now)

    def without(self, entities: frozenset[Name]) -> Sightings:
        """Return the value without the sightings of some entities."""
        newest = {name: each for name, each in self.newest.items() if name not in entities}
        expires = min((each.until for each in newest.values()), default=math.inf)
        return replace(self, newest=newest, expires=expires)

    def unseeing(self, entity: Name) -> Sightings:
        """Return the value in which an entity is no longer seen, and observations miss it."""
        return replace(self, unseen=self.unseen | {entity})

    def losing(self, entity: Name) -> Sightings:
        """Return the value in which the link to a vehicle is lost."""
        return replace(self, lost=self.lost | {entity})

    def restored(self, entity: Name) -> Sightings:
        """Return the value in which a vehicle is heard again."""
        return replace(self, lost=self.lost - {entity})

    def with_missing(self, cell: Cell, value: object) -> Sightings:
        """Return the value with a cell of P whose removal broke an assumption."""
        return replace(self, missing={**self.missing, cell: value})

    def found(self, cell: Cell) -> Sightings:
        """Return the value in which a cell is no longer missing."""
        if cell not in self.missing:
            return self
        return replace(self, missing={each: value for each, value in self.missing.items() if each != cell})

    def admitting(self, plugin: str, *, is_place: bool) -> Sightings:
        """Return the value after the admission of one more stranger from a plugin."""
        taken, places = self.admitted.get(plugin, (0, 0))
        return replace(self, admitted={**self.admitted, plugin: (taken + 1, places + is_place)})

    def later(self, seconds: float) -> Sightings:
        """Return the value with all ages shifted by a time without listening."""
        newest = {name: replace(each, until=each.until + seconds) for name, each in self.newest.items()}
        return replace(self, newest=newest, expires=self.expires + seconds)


@dataclass(frozen=True, slots=True)
class Refusal:
    """A rejected message, and the reason."""

    entity: Name
    reason: str


def sighting_of(heard: Heard, known: Sighting | None, plan: Plan, now: float) -> Sighting | Refusal | None:
    """Return the sighting in a message, a Refusal if it is rejected, None if a newer sighting is known."""
    published = heard.published
    observed = published.property if isinstance(published, Aged) else published
    owner = plan.vehicles.get(observed.entity)
    if owner is not None and heard.plugin not in (owner, plan.peers):
        return Refusal(
            observed.entity,
            f"'{heard.plugin}' reports {observed.entity}, which is the vehicle of '{owner}'",
        )
    if observed.entity in plan.first.alpha or observed.entity in _no_entities(plan.first.setting):
        return Refusal(
            observed.entity,
            f"'{heard.plugin}' reports {observed.entity}, which is no entity of the mission",
        )
    kind = plan.first.setting.kinds.get(observed.entity) or (
        known.property.kind if known is not None else None
    )
    if kind is not None and not isinstance(observed, Gone) and observed.kind != kind:
        return Refusal(
            observed.entity,
            f"'{heard.plugin}' reports {observed.entity} as {observed.kind}, but it is of kind {kind}",
        )
    time = now if observed.time is None else observed.time
    if not math.isfinite(time) or time > now + MOST_AHEAD:
        ahead = f"gives times more than {MOST_AHEAD:g} s ahead"
        return Refusal(observed.entity, f"'{heard.plugin}' {ahead} for {observed.entity}: set its clock")
    if known is not None and time < known.time:
        return None
    if isinstance(observed, Gone):
        before = _declared(plan, observed.entity) if known is None else known.property
        return None if before is None else Sighting(before, time, -math.inf)
    until = time + published.time_to_live if isinstance(published, Aged) else math.inf
    return Sighting(observed, time, until) if until > now else None


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
    observed = sighting.property
    geometry = observed.geometry
    if shape is not None and geometry.is_point and not shape.geometry.is_point:
        try:
            geometry = _moved(shape.geometry, geometry)
        except PhysicalError:
            return None
    banded = shape is not None and shape.altitude is not None
    placed = Placed(geometry, (observed.altitude or shape.altitude) if shape is not None and banded else None)
    by = observed.carried_by
    return Carried(by, placed) if by is not None and _may_carry(c, by, observed.entity) else placed


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
