"""W of a mission's entities: all geometries that each may ever have, computed once per mission.

An entity has its placements, those of its clauses and those of its possible carriers. One that a control may move also
has those of all to which, or by which, it may be sent, and everything between.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Final

from physical.altitude import Band, band_contains
from physical.entity_motions import EntityMotion
from physical.face_covers import standing_for
from physical.geometry_measures import area, centroid
from physical.gnomonic import RegionError
from physical.part_relations import meet_or_touch
from physical.place_nesting import Place
from physical.placement import nearest_placement, outline, still, template
from physical.regions import RegionKind, RegionPart
from physical.shape import Geometry, contains, share_interior
from physical.standing import Surroundings, standing

SMALLEST: Final = 0.5
"""A circle under this diameter in metres is none."""


class PossibleGeometries:
    """W(x) and its consequences, for each entity x of a mission."""

    def __init__(self, motions: Iterable[EntityMotion]) -> None:
        self.motions: Final = {motion.name: motion for motion in motions}
        self._wholes: Final[dict[str, RegionPart | None]] = {}
        self._arrivals: Final[dict[tuple[str, str], frozenset[Geometry] | None]] = {}

    def motion(self, entity: str) -> EntityMotion:
        """Return the facts about an entity; none about an unknown one."""
        return self.motions.get(entity) or EntityMotion(entity)

    def whole(self, entity: str) -> RegionPart | None:
        """Return the hull of W(x), grown by all that its entities may stray; None if x is never anywhere."""
        if entity not in self._wholes:
            self._wholes[entity] = self._whole(entity)
        return self._wholes[entity]

    def _whole(self, entity: str) -> RegionPart | None:
        names = sorted(self.kin(entity))
        sources = {source for name in names for source in _sources(self.motion(name))}
        if not sources:
            return None
        margin = sum(self._strays(name) for name in names)
        return RegionPart(tuple(sorted(sources)), spanned=True, margin=margin, kind=RegionKind.LEG)

    def kin(self, entity: str) -> frozenset[str]:
        """Return the entities of W(x): x, its carriers, and its targets if it may be moved."""
        found, waiting = {entity}, [entity]
        while waiting:
            motion = self.motion(waiting.pop())
            near = motion.carriers | ((motion.targets | motion.via) if motion.targets else frozenset())
            waiting += near - found
            found |= near
        return frozenset(found)

    def _strays(self, entity: str) -> float:
        """Return the metres by which an entity may be outside the hull of all geometries in W."""
        motion = self.motion(entity)
        if not motion.targets and not motion.carriers:
            return 0.0
        return motion.margin + self.radius(entity)

    def radius(self, entity: str) -> float:
        """Return the greatest distance of a point of an entity from its centroid; 0 for a point."""
        return max((_radius(form.geometry) for form in self.motion(entity).forms), default=0.0)

    def is_fixed(self, entity: str) -> bool:
        """Whether an entity has one geometry, whenever it has any."""
        whole, motion = self.whole(entity), self.motion(entity)
        return whole is not None and len(whole.sources) == 1 and not motion.targets and motion.drift is None

    def is_steady(self, entity: str) -> bool:
        """Whether an entity is always present at one geometry, and nothing carries it."""
        motion = self.motion(entity)
        return self.is_fixed(entity) and not motion.may_be_absent and not motion.carriers

    def geometry(self, entity: str) -> Geometry:
        """Return the geometry of a fixed entity."""
        whole = self.whole(entity)
        assert whole is not None
        assert isinstance(whole.sources[0], Geometry)
        return whole.sources[0]

    def is_near(self, entity: str, at: Geometry) -> bool:
        """Whether an entity may ever be at a position, or around it."""
        whole = self.whole(entity)
        return whole is not None and _may_touch(RegionPart((at,)), whole)

    def bands(self, entity: str) -> tuple[Band | None, ...]:
        """Return the altitudes that an entity may have; all if nothing is known."""
        bands = {form.altitude for form in self.motion(entity).forms}
        return tuple(sorted(bands, key=repr)) or (None,)

    # --- where a control puts an entity ---------------------------------------------------------------

    def arrivals(self, entity: str, place: str) -> frozenset[Geometry] | None:
        """Return the placements that P may have after an entity's arrival in a place; None if there are too many."""
        key = (entity, place)
        if key not in self._arrivals:
            self._arrivals[key] = self._arrivals_in(entity, place)
        return self._arrivals[key]

    def _arrivals_in(self, entity: str, place: str) -> frozenset[Geometry] | None:
        motion = self.motion(entity)
        if place in motion.carriers:
            return frozenset()
        if not self.is_steady(place) or not motion.forms:
            return None
        target, forms = self.geometry(place), motion.forms
        if target.is_point:
            return frozenset()
        holes = self._holes(entity, place, target)
        if holes is None:
            return self._central(entity, place)
        found = {nearest_placement(form.geometry, target, _levelled(holes, form.altitude)) for form in forms}
        return frozenset(each for each in found if each is not None)

    def _inner(self, entity: str, place: str, target: Geometry) -> Iterator[str]:
        """Yield the possible containers of an entity that may reach into a place at some geometry."""
        whole = RegionPart((target,))
        for name in sorted(self.motion(entity).containers - {entity, place}):
            other = self.whole(name)
            if self.is_steady(name):
                if share_interior(self.geometry(name), target):
                    yield name
            elif other is not None and _may_touch(other, whole):
                yield name

    def _holes(self, entity: str, place: str, target: Geometry) -> tuple[Place, ...] | None:
        """Return the smaller containers in a place at some geometry; None if they are not always the same."""
        inner = tuple(self._inner(entity, place, target))
        if not all(self.is_steady(name) and len(set(self.motion(name).placements)) == 1 for name in inner):
            return None
        order = (area(target), place)
        return tuple(
            self.motion(name).placements[0] for name in inner if (area(self.geometry(name)), name) < order
        )

    def _central(self, entity: str, place: str) -> frozenset[Geometry] | None:
        """Return the central placement in a place if it is always free, else None."""
        target = self.geometry(place)
        if any(not form.geometry.is_point for form in self.motion(entity).forms):
            return None
        middle = centroid(target)
        if any(self.is_near(name, middle) for name in self._inner(entity, place, target)):
            return None
        return frozenset({middle}) if contains(target, middle) else None

    def destination(self, entity: str, shape: Geometry, place: str) -> Geometry | None:
        """Return the one point (or placement) to which `run` always sends an entity in a place, None if unknown.

        It is the centre of a steady place where nothing moves in it, and where the entity's circle has room.
        """
        if not self.is_steady(place):
            return None
        target = self.geometry(place)
        if place in self.motion(entity).carriers:
            return target if target.is_point else None
        return self._centre(entity, shape, place, target)

    def is_destination(self, entity: str, at: Geometry) -> bool:
        """Whether `run` surely sends an entity to a point wherever P has it there: the centre of a target."""
        motion, middle = self.motion(entity), centroid(at)
        for place in sorted(motion.targets - motion.carriers):
            for here in self.motion(place).placements:
                if centroid(here.geometry) is middle:
                    shapes = {form.geometry for form in motion.forms} or {middle}
                    return all(self._centre(entity, shape, place, here.geometry) for shape in shapes)
        return False

    def _centre(self, entity: str, shape: Geometry, place: str, target: Geometry) -> Geometry | None:
        """Return an entity's placement at the centre of a place at some geometry, if `run` sends it there."""
        holes = None if target.is_point else self._holes(entity, place, target)
        if holes is None:
            return None
        outside = tuple(sorted({hole.geometry for hole in holes}))
        middle = nearest_placement(still(shape), target, outside)
        if middle is None or centroid(middle) is not centroid(target):
            return None
        room = max(self.motion(entity).circle, SMALLEST)
        return middle if standing(shape, target, Surroundings(outside=outside), room) is middle else None

    def may_come_to(self, entity: str, at: Geometry) -> bool:
        """Whether a control may have put an entity at a placement; true in doubt."""
        return self.may_fly_to(entity, at) or bool(self.bringers(entity, at))

    def may_fly_to(self, entity: str, at: Geometry) -> bool:
        """Whether P may have an entity at a placement after a flight; true in doubt."""
        return any(self.may_arrive_at(entity, place, at) for place in sorted(self.motion(entity).targets))

    def may_arrive_at(self, entity: str, place: str, at: Geometry) -> bool:
        """Whether P may have an entity at a placement after a flight to a place; true in doubt."""
        middle = centroid(at)
        if self.is_steady(place) and not contains(self.geometry(place), middle):
            return False  # most places
        arrivals = self.arrivals(entity, place)
        if arrivals is None:
            return self.is_near(place, middle)
        return any(centroid(each) is middle for each in arrivals)

    def bringers(self, entity: str, at: Geometry) -> tuple[str, ...]:
        """Return the entities that may have carried an entity to a placement and put it down there, sorted."""
        carriers = sorted(self.kin_of_carriers(entity) - {entity})
        return tuple(name for name in carriers if self._may_stop_at(name, centroid(at)))

    def _may_stop_at(self, carrier: str, middle: Geometry) -> bool:
        """Whether P may have a carrier's centroid at a point while it does not fly; in flight it puts nothing down."""
        motion = self.motion(carrier)
        if any(centroid(place.geometry) is middle for place in motion.placements):
            return True
        drifts = motion.drift is not None and standing_for(motion.drift, middle) is not None
        return drifts or self.may_fly_to(carrier, middle)

    def kin_of_carriers(self, entity: str) -> frozenset[str]:
        """Return an entity with all that may carry it, directly or not."""
        found, waiting = {entity}, [entity]
        while waiting:
            near = self.motion(waiting.pop()).carriers - found
            waiting += near
            found |= near
        return frozenset(found)


def _sources(motion: EntityMotion) -> Iterator[Geometry]:
    yield from (place.geometry for place in motion.placements)
    if motion.drift is not None:
        yield motion.drift.within


def _may_touch(a: RegionPart, b: RegionPart) -> bool:
    """Whether two parts may touch; true in doubt, hence also if one is too large."""
    try:
        return meet_or_touch(a, b)
    except RegionError:
        return True


def _radius(geometry: Geometry) -> float:
    if geometry.is_point:
        return 0.0
    return max(math.hypot(*offset) for offset in outline(template(geometry)))


def _levelled(holes: Iterable[Place], altitude: Band | None) -> tuple[Geometry, ...]:
    return tuple(sorted({hole.geometry for hole in holes if band_contains(hole.altitude, altitude)}))
