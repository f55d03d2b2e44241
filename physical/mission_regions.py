"""Reg(u) of a mission's entities, from their placements and flights.

`Ways` takes the facts about each entity (`EntityMotion`) once. A region then depends on the placement
of the entity's outermost carrier (or of itself) and on the flights that move it, and on nothing else. Where the past
matters, everything counts that the mission allows:

- A place that may be absent is not *steady*. While it is, a vehicle may fly to the centre of a larger one, so the
  smallest steady place around it counts. A VIA leaves out an absent place, and is flown again when the place
  returns, so such a way is one hull.
- An entity that drifts within a place may be anywhere in its face from its first placement on.
- Cargo that a drifting carrier has put down may be anywhere in the carrier's face, however little it strays.
- A mover may be outside the hull of its targets by its margin, and by its own size.
- A point counts in place of its place only where `run` surely sends the vehicle to it (`is_destination`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from typing import Final, TypeVar

from physical.altitude import Band
from physical.entity_motions import CarriedBy, EntityMotion, FlightPlan, Standpoint, Transit
from physical.geodesic_areas import disc_of
from physical.geodesic_distances import MOST_KNOWN
from physical.geometry_measures import waypoint
from physical.gnomonic import RegionError
from physical.leg_lengths import FlightLeg, length_between
from physical.place_nesting import Place
from physical.possible_geometries import PossibleGeometries
from physical.regions import NOWHERE, Located, Region, RegionKind, RegionPart, Source
from physical.resting_regions import GroundPatch, RestingPlaces
from physical.shape import Geometry

Result = TypeVar("Result")

ORIGIN: Final = ""
"""The name, among the ends of a leg, of the position at which the flight began."""


class Ways:
    """The regions of a mission's entities; immutable, and its answers are cached."""

    def __init__(self, motions: Iterable[EntityMotion]) -> None:
        self._of: Final = PossibleGeometries(motions)
        self._resting: Final = RestingPlaces(self._of)
        self._known: Final = lru_cache(maxsize=MOST_KNOWN)(self._region)

    def is_fixed(self, entity: str) -> bool:
        """Whether an entity has one geometry in all configurations in which it is present."""
        return self._of.is_fixed(entity)

    def may_arrive_at(self, entity: str, place: str, at: Geometry) -> bool:
        """Whether a flight of an entity to a place may have ended at a placement; true in doubt."""
        return place in self._of.motion(entity).targets and self._of.may_arrive_at(entity, place, at)

    def check(self, entity: str) -> None:
        """Raise RegionError if some region of an entity may be too large, or may cover a pole."""
        whole = self._of.whole(entity)
        if whole is not None:
            _named(entity, lambda: disc_of(whole))

    def located(
        self,
        entity: str,
        placement_of: Callable[[str], Standpoint],
        flights_of: Callable[[str], frozenset[FlightPlan]],
    ) -> Located:
        """Return an entity with its region; reads the placements of it and its carriers, and the bearer's flights."""
        carriers: list[str] = []
        at = placement_of(entity)
        while isinstance(at, CarriedBy) and at.carrier not in carriers:
            carriers.append(at.carrier)
            at = placement_of(at.carrier)
        bearer = carriers[-1] if carriers else entity
        if at is None or isinstance(at, CarriedBy):
            return Located(entity, NOWHERE, tuple(carriers))
        region = self.region(bearer, at, flights_of(bearer) if isinstance(at, Transit) else frozenset())
        if carriers:
            region = replace(region, certain=False, is_area=self.is_area(entity))
        return Located(entity, region, tuple(carriers))

    def is_area(self, entity: str) -> bool:
        """Whether an entity has an area of its own."""
        return any(not form.geometry.is_point for form in self._of.motion(entity).forms)

    def region(
        self, entity: str, at: Place | Transit | None, flights: frozenset[FlightPlan] = frozenset()
    ) -> Region:
        """Return Reg(u) of an entity that nothing carries.

        Raises:
            RegionError: If it reaches over 1,000 km from its middle, or covers a pole.
        """
        return NOWHERE if at is None else _named(entity, lambda: self._known(entity, at, flights))

    def _region(self, entity: str, at: Place | Transit, flights: frozenset[FlightPlan]) -> Region:
        is_area = self.is_area(entity)
        if isinstance(at, Transit):
            parts = self._in_transit(entity, at, tuple(sorted(flights)))
        elif self._is_certain(entity, at):
            return Region((RegionPart((at.geometry,), altitude=at.altitude),), certain=True, is_area=is_area)
        else:
            parts = self._at_rest(entity, at)
        for part in parts:
            if not part.is_exact:
                disc_of(part)  # refuse it here
        return Region(tuple(dict.fromkeys(parts)), is_area=is_area)

    # --- at rest --------------------------------------------------------------------------------------

    def _is_certain(self, entity: str, at: Place) -> bool:
        motion = self._of.motion(entity)
        if motion.drift is not None and self._resting.face(entity, at.geometry):
            return False
        if not motion.targets and not motion.carriers:
            return True
        given = any(place.geometry is at.geometry for place in motion.placements)
        return given and not self._of.may_come_to(entity, at.geometry)

    def _at_rest(self, entity: str, at: Place) -> list[RegionPart]:
        faces = self._resting.face(entity, at.geometry)
        if faces:
            return [RegionPart((face,), altitude=at.altitude, kind=RegionKind.FACE) for face in faces]
        margin = self._resting.margin(entity, at.geometry)
        altitude = self._altitude(at, self._of.bringers(entity, at.geometry))
        return [
            RegionPart(each.sources, each.spanned, each.margin + margin, altitude, each.kind)
            for each in self._resting.stay(entity, at)
        ]

    def _altitude(self, at: Place, carriers: Iterable[str]) -> Band | None:
        """Return the altitudes from the lowest to the highest of an entity and carriers; all if one has no band."""
        bands = [at.altitude, *(band for name in carriers for band in self._of.bands(name))]
        known = [band for band in bands if band is not None]
        if len(known) < len(bands):
            return None
        return Band(min(band.low for band in known), max(band.high for band in known))

    # --- in transit -----------------------------------------------------------------------------------

    def _in_transit(self, entity: str, at: Transit, flights: Sequence[FlightPlan]) -> list[RegionPart]:
        begin, margin = self._begin(entity, at.origin)
        bearers = self._carriers_in(entity, at, flights).union(self._of.bringers(entity, at.origin.geometry))
        altitude = self._altitude(at.origin, sorted(bearers))
        stops = self._stops(entity, at.origin, flights)
        if stops is not None:
            points = [begin, *([stop] for stop in stops)]
            legs = zip(pairwise(points), pairwise([ORIGIN, *flights[0].stops]), strict=True)
            return [_leg([*here, *there], margin, altitude, ends) for (here, there), ends in legs]
        steps = sorted({name for flight in flights for name in flight.stops})
        wholes = [self._of.whole(name) for name in steps or [entity]]
        ends = [GroundPatch(whole.sources, True, whole.margin) for whole in wholes if whole is not None]
        if any(flight.via for flight in flights) or not steps:
            ends = [replace(each, margin=each.margin + self._of.radius(entity)) for each in ends]
        return [_leg([*begin, *ends], margin, altitude, (ORIGIN, *steps))]

    def _stops(self, entity: str, origin: Place, flights: Sequence[FlightPlan]) -> list[GroundPatch] | None:
        """Return where an entity flies to, stop by stop; None if several flights or renewals change the order."""
        if len(flights) != 1 or not all(map(self._of.is_steady, flights[0].stops)):
            return None
        *via, to = flights[0].stops
        return [
            *(self._stop(entity, origin, name, False) for name in via),
            self._stop(entity, origin, to, True),
        ]

    def legs(self, entity: str, at: Transit, flights: frozenset[FlightPlan]) -> tuple[FlightLeg, ...]:
        """Return the legs of a flight, each with its length; one from end to end if its way is not known.

        Raises:
            RegionError: If one reaches over 1,000 km from its middle, or covers a pole.
        """
        parts = {part.between: part for part in self.region(entity, at, flights).parts}
        begin, _ = self._begin(entity, at.origin)
        plans = tuple(sorted(flights))
        stops = self._stops(entity, at.origin, plans)
        if stops is None:
            (whole,) = parts.values()
            goal = self._of.whole(at.to)
            patch = [] if goal is None else [GroundPatch(goal.sources, True)]
            return (FlightLeg(whole, *length_between(begin, patch)._replace(most=None)),)
        steps = pairwise(
            [(ORIGIN, begin), *((name, [at]) for name, at in zip(plans[0].stops, stops, strict=True))]
        )
        return tuple(
            FlightLeg(parts[a, b], *length_between(begins, ends)) for (a, begins), (b, ends) in steps
        )

    def length(self, entity: str, at: Transit, flights: frozenset[FlightPlan]) -> tuple[float, float] | None:
        """Return the least and the greatest metres of an entity's way from stop to stop, without its margin.

        It is None if a renewal may send the entity over a part of its way again.
        """
        legs = self.legs(entity, at, flights)
        most = [leg.most for leg in legs if leg.most is not None]
        return (sum(leg.least for leg in legs), sum(most)) if len(most) == len(legs) else None

    def _begin(self, entity: str, origin: Place) -> tuple[list[GroundPatch], float]:
        """Return where a flight begins, and the metres r by which its legs are grown."""
        if self._is_certain(entity, origin):
            return [GroundPatch((origin.geometry,))], self._of.motion(entity).margin
        faces = self._resting.face(entity, origin.geometry)
        if faces:
            return [GroundPatch((face,)) for face in faces], self._of.motion(entity).margin
        return list(self._resting.stay(entity, origin)), self._resting.margin(entity, origin.geometry)

    def _carriers_in(self, entity: str, at: Transit, flights: Iterable[FlightPlan]) -> frozenset[str]:
        """Return the carriers that an entity leaves or boards by its flights, as far as these name them."""
        carriers = self._of.motion(entity).carriers
        ends = {at.to, *(name for flight in flights for name in (flight.to, flight.start))}
        return frozenset(ends & carriers)

    def _stop(self, entity: str, origin: Place, place: str, is_last: bool) -> GroundPatch:
        """Return where an entity flies to: a point if `run` always sends it there, else the whole place."""
        radius = 0.0 if is_last else self._of.radius(entity)
        whole = self._of.whole(place)
        assert whole is not None  # a steady place
        if self._of.motion(entity).strays is None:
            return GroundPatch(whole.sources, True, radius)
        if not is_last:
            return GroundPatch((waypoint(self._of.geometry(place)),), margin=radius)
        spot = self._of.destination(entity, origin.geometry, place)
        return GroundPatch(whole.sources if spot is None else (spot,), True)


def _leg(
    patches: Sequence[GroundPatch], margin: float, altitude: Band | None, ends: tuple[str, ...]
) -> RegionPart:
    """Return the hull of patches, grown by the margin and by the greatest of theirs."""
    sources: set[Source] = {source for each in patches for source in each.sources}
    grown = margin + max(each.margin for each in patches)
    return RegionPart(tuple(sorted(sources, key=_order)), True, grown, altitude, RegionKind.LEG, ends)


def _order(source: Source) -> tuple[object, ...]:
    return (0, source.order()) if isinstance(source, Geometry) else (1, source.shell)


def _named(entity: str, compute: Callable[[], Result]) -> Result:
    """Return a result; an error names the entity."""
    try:
        return compute()
    except RegionError as error:
        raise RegionError(
            error.code, error.message, error.hint, error.where or f"the way of {entity}"
        ) from error
