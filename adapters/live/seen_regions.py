"""Regions from sightings: an entity's last position, grown by its age, and the rest of its way.

A vehicle flies at most at the speed that the mission gives it, or at the speed that it reported. Without the mission's
speed it may gain speed, by `STRONGEST`. The region of an entity whose position is unknown is everything: None.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Final

from adapters.live.commanded import Commanded
from adapters.live.flown_ways import FlownWay
from adapters.live.fresh_placements import Sighting, Sightings, placement_seen
from adapters.live.overrides import Overrides
from adapters.live.plan import Plan
from physical import Band, Geometry, Located, PhysicalError, Region, RegionKind, RegionPart, Velocity
from physical.geodesic_areas import disc_of
from physical.regions import NOWHERE
from semantics.environment import Vanishes
from semantics.regions.possible_moves import possible_ways
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, Placed
from semantics.state.signature import Name

STRONGEST: Final = 9.81
"""The greatest acceleration of a vehicle whose greatest speed is unknown, in metres per square second."""


@dataclass(frozen=True, eq=False)
class SeenWorld:
    """All that a run knows at a time of the positions of entities.

    Attributes:
        plan: The constants of the run.
        c: The configuration.
        sightings: Who is seen.
        commanded: The mission's commands to vehicles.
        overrides: Who is taken over, or ordered to stop.
        now: The time.
    """

    plan: Plan
    c: Configuration
    sightings: Sightings
    commanded: Commanded
    overrides: Overrides
    now: float
    _known: dict[Name, Located | None] = field(default_factory=dict, init=False, repr=False)

    def located(self, entity: Name) -> Located | None:
        """Return an entity with its region and its carriers; None if it may be anywhere."""
        if entity not in self._known:
            self._known[entity] = self._located(entity)
        return self._known[entity]

    def age(self, entity: Name) -> float | None:
        """Return the seconds since an entity was seen, None if that is not known."""
        sighting = self.sightings.newest.get(entity)
        return None if sighting is None else max(0.0, self.now - sighting.time)

    def _located(self, entity: Name) -> Located | None:
        physical = self.c.structure.physical
        carriers = tuple(physical.carriers(entity))
        region = self._region(carriers[-1] if carriers else entity)
        if region is None:
            return None
        if carriers:
            region = Region(region.parts, is_area=_is_area(self.plan, entity))
        return Located(entity, region, carriers)

    def _region(self, entity: Name) -> Region | None:
        """Return the region of an entity that nothing carries."""
        sighting = self.sightings.newest.get(entity)
        if entity in self.plan.vehicles or self._is_driven(entity):
            return self._of_vehicle(entity, sighting)
        at = self.c.structure.physical.placement(entity)
        if at is None:
            return NOWHERE
        if not isinstance(at, Placed) or (sighting is None and entity not in self.plan.fixed):
            return None
        margin = 0.0 if sighting is None else self._drifted(sighting)
        part = RegionPart((at.geometry,), margin=margin, altitude=at.altitude)
        return _measured(Region((part,), certain=margin == 0.0, is_area=not at.geometry.is_point))

    def _is_driven(self, entity: Name) -> bool:
        return self.c.setting.signature[self.c.setting.kind(entity)].driven

    def _drifted(self, sighting: Sighting) -> float:
        """Return the metres by which a thing that is no vehicle may have moved since, at the speed that it reported."""
        velocity = sighting.property.velocity
        return 0.0 if velocity is None else velocity.speed * max(0.0, self.now - sighting.time)

    def _of_vehicle(self, entity: Name, sighting: Sighting | None) -> Region | None:
        if sighting is None:
            is_gone = entity not in self.c.structure.physical and _may_vanish(self.plan, entity)
            return NOWHERE if is_gone else None
        shape = _shape(self.plan, entity)
        seen = placement_seen(self.c, shape, sighting)
        reach = reach_after(
            max(0.0, self.now - sighting.time), self._fastest(entity), sighting.property.velocity
        )
        if reach is None or not isinstance(seen, Placed):
            return None
        band = _altitude(shape, sighting)
        here = RegionPart((seen.geometry,), margin=reach, altitude=band)
        parts = (here, *self._ahead(entity, seen.geometry, band))
        return _measured(Region(parts, is_area=not seen.geometry.is_point))

    def _fastest(self, entity: Name) -> float | None:
        timing = self.c.setting.timing
        motion = None if timing is None else timing.motion(entity)
        return None if motion is None else motion.speed[1]

    # --- the way ahead --------------------------------------------------------------------------------

    def _ahead(self, entity: Name, at: Geometry, band: Band | None) -> Iterator[RegionPart]:
        """Yield the parts of the way that a vehicle has still to fly, and of its place to stay."""
        way = way_of(entity, self.commanded, self.overrides)
        strays, margin = self.plan.first.setting.strays.get(entity), margin_of(self.plan, entity)
        if way is None:
            yield from self._sent_elsewhere(entity, at, margin, band)
            return
        begin = at if strays is None else _foot(way, at, strays)
        ahead = (begin, *way.remaining())
        names = ["", *[""] * (len(ahead) - 2), way.to]
        for i in range(1, len(ahead)):
            sources = tuple(sorted({ahead[i - 1], ahead[i]}))
            ends = (names[i - 1], names[i])
            yield RegionPart(sources, True, margin, band, RegionKind.LEG, ends)

    def _sent_elsewhere(
        self, entity: Name, at: Geometry, margin: float, band: Band | None
    ) -> Iterator[RegionPart]:
        """Yield the way of a vehicle that another station has sent: by the VIA of any control that may have done so."""
        if entity in self.commanded.flights or self.overrides.is_overridden(entity):
            return
        to = self.c.structure.physical.going_to(entity)
        vias = possible_ways(self.c.setting, entity, to) if to else frozenset()
        if vias is None:
            everywhere = {at, *(spot for _, spot in self._spots(self.c.setting.kinds))}
            yield RegionPart(tuple(sorted(everywhere)), True, margin, band, RegionKind.LEG, ("", to))
            return
        for stops in (self._spots((*via, to)) for via in sorted(vias)):
            legs = [(("", at), stop) for stop in stops]  # it may have passed any number of them
            for (begin, here), (end, there) in (*legs, *pairwise(stops)):
                sources = tuple(sorted({here, there}))
                yield RegionPart(sources, True, margin, band, RegionKind.LEG, (begin, end))

    def _spots(self, names: Iterable[Name]) -> list[tuple[Name, Geometry]]:
        """Return the entities that have a position, each with its geometry."""
        found = ((name, self.c.structure.physical.position(name)) for name in names)
        return [(name, at.geometry) for name, at in found if at is not None]


def _foot(way: FlownWay, at: Geometry, strays: float) -> Geometry:
    """Return the point of a way beside a vehicle."""
    try:
        return way.beside(at, strays).at
    except PhysicalError:
        return at


def way_of(entity: Name, commanded: Commanded, overrides: Overrides) -> FlownWay | None:
    """Return the way of a vehicle that the mission commands; None if it was sent nowhere, or obeys others."""
    if overrides.is_overridden(entity):
        return None
    given = commanded.flights.get(entity)
    if given is None:
        return commanded.rests.get(entity)
    return None if given.refused or overrides.stops(given.agent) else given.way


def margin_of(plan: Plan, entity: Name) -> float:
    """Return the metres r by which a vehicle's way is grown: those of `strays`, else the mission's circle."""
    setting = plan.first.setting
    motion = None if setting.timing is None else setting.timing.motion(entity)
    return setting.strays.get(entity, 0.0 if motion is None else motion.circle)


def reach_after(seconds: float, fastest: float | None, velocity: Velocity | None) -> float | None:
    """Return the metres that a vehicle may have flown in a time, None if nothing bounds its speed."""
    if seconds == 0.0:
        return 0.0
    if fastest is not None:
        return max(fastest, 0.0 if velocity is None else velocity.speed) * seconds
    return None if velocity is None else velocity.speed * seconds + STRONGEST * seconds * seconds / 2


def _measured(region: Region) -> Region | None:
    """Return a region, None for one that is too large for its figures."""
    try:
        for part in region.parts:
            disc_of(part)
    except PhysicalError:
        return None
    return region


def _altitude(shape: Placed | None, sighting: Sighting) -> Band | None:
    """Return the altitudes of a vehicle: its band in the mission, widened to the altitude at which it is seen."""
    band, seen = None if shape is None else shape.altitude, sighting.property.altitude
    if band is None or seen is None:
        return band
    return Band(min(band.low, seen.low), max(band.high, seen.high))


def _shape(plan: Plan, entity: Name) -> Placed | None:
    placement = plan.first.structure.physical.placement(entity)
    if isinstance(placement, Carried):
        return placement.shape
    return placement if isinstance(placement, Placed) else None


def _is_area(plan: Plan, entity: Name) -> bool:
    shape = _shape(plan, entity)
    return shape is not None and not shape.geometry.is_point


def _may_vanish(plan: Plan, entity: Name) -> bool:
    clauses = plan.first.setting.environment
    return any(isinstance(each, Vanishes) and each.entity == entity for each in clauses)
