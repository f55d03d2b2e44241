"""Corridors: the ways of flights with their lengths, and their distances from places and from one another."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Final

from checker.limits import BoundMet, look
from checker.properties.flown_stances import FlownStances
from physical import Located, Region, RegionError, RegionPart, Transit
from physical.part_relations import least_bound
from physical.region_clearances import Clearance, PlaceSide, clearance, reach
from physical.region_relations import nearest
from physical.shape import Geometry
from semantics.regions.region_facts import RegionFacts
from semantics.regions.stances import Stance, StanceWords, ways_by
from semantics.state.signature import Name

if TYPE_CHECKING:
    from physical.leg_lengths import FlightLeg


@dataclass(frozen=True, slots=True)
class PlaceDistance:
    """The distance of a way from a place.

    Attributes:
        place: The place.
        clearance: How near it comes to the place, or how far inside it stays; None if the place is never there.
        reach: The greatest distance in metres, for a place in a property `within`.
    """

    place: Name
    clearance: Clearance | None
    reach: float | None = None


@dataclass(frozen=True, slots=True)
class WayLeg:
    """A leg of a flight, or a whole flight: between two stops.

    Attributes:
        origin: The words for its begin.
        to: Its end.
        least: The least length of the line in its middle, in metres.
        most: The greatest; None if it is not known.
        places: Its distances from the named places.
    """

    origin: str
    to: Name
    least: float
    most: float | None
    places: tuple[PlaceDistance, ...] = ()


@dataclass(frozen=True, slots=True)
class FlightWay:
    """A flight of a vehicle, whenever it is made.

    Attributes:
        vehicle: The vehicle.
        whole: The flight from its begin to its end.
        via: The places by which it leads.
        legs: Its legs, if there are several.
        margin: The metres by which its corridor is grown.
        low: The least altitude in metres, None if it is not known.
        high: The greatest.
    """

    vehicle: Name
    whole: WayLeg
    via: tuple[Name, ...] = ()
    legs: tuple[WayLeg, ...] = ()
    margin: float = 0.0
    low: float | None = None
    high: float | None = None

    @property
    def key(self) -> tuple[object, ...]:
        """Its words."""
        return self.vehicle, self.whole.origin, self.via, self.whole.to


@dataclass(frozen=True, slots=True)
class PairDistance:
    """The least distance of two vehicles.

    Attributes:
        vehicles: The vehicles.
        both_fly: Whether both are under way; else one is at rest.
        metres: The metres on the ground, rounded down.
        gap: The metres of altitude between them; 0 if their altitudes meet.
        where: Where both are, in words.
        points: The nearest points.
    """

    vehicles: tuple[Name, Name]
    both_fly: bool
    metres: float
    gap: float
    where: tuple[str, str]
    points: tuple[Geometry, Geometry]

    @property
    def rank(self) -> tuple[object, ...]:
        """The order of distances: the least first."""
        return self.metres, self.where


@dataclass(frozen=True, slots=True)
class SeenPart:
    """A part of the region of an entity, in some configuration.

    Attributes:
        entity: The entity.
        part: The part.
        between: The words for its ends, if the entity flies there.
    """

    entity: Name
    part: RegionPart
    between: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Corridors:
    """The ways of a mission's flights over all runs.

    Attributes:
        places: The places that properties about ways name.
        flights: The flights, by vehicle.
        pairs: The least distances of vehicles that may be under way together.
        parts: All parts of the regions of vehicles and of named entities that may change, each once.
        complete: Whether everything was explored and measured.
        notes: What was left out, and why.
    """

    places: tuple[Name, ...] = ()
    flights: tuple[FlightWay, ...] = ()
    pairs: tuple[PairDistance, ...] = ()
    parts: tuple[SeenPart, ...] = ()
    complete: bool = True
    notes: tuple[str, ...] = ()


MOST_NOTES: Final = 5
"""The most notes on omitted ways."""

LEVEL: Final = 1e-9
"""Metres of altitude from which two bands do not meet."""


def measured(facts: RegionFacts, seen: FlownStances, *, complete: bool) -> Corridors:
    """Return the corridors of the stances that were seen; where a bound omits some, there is a note."""
    return _Measuring(facts, seen).run(complete=complete and not seen.bounds)


class _Measuring:
    def __init__(self, facts: RegionFacts, seen: FlownStances) -> None:
        self.facts, self.seen = facts, seen
        self.whereabouts = StanceWords(facts)
        self.notes: dict[str, None] = {}

    def run(self, *, complete: bool) -> Corridors:
        flights: dict[tuple[object, ...], FlightWay] = {}
        pairs: list[PairDistance] = []
        parts: dict[SeenPart, None] = {}
        self.notes |= dict.fromkeys(f"some ways were not seen: {bound}" for bound in self.seen.bounds)
        try:
            for way in self._flights():
                known = flights.get(way.key)
                flights[way.key] = way if known is None else joined(known, way)
            pairs += self._pairs()
            parts |= dict.fromkeys(self._parts())
        except BoundMet as met:
            self.notes[f"some ways were not measured: {met.bound}"] = None
        return Corridors(
            self.seen.named,
            tuple(sorted(flights.values(), key=lambda way: str(way.key))),
            tuple(pairs),
            tuple(parts),
            complete and not self.notes,
            tuple(self.notes)[:MOST_NOTES],
        )

    # --- flights ----------------------------------------------------------------------------------

    def _flights(self) -> Iterator[FlightWay]:
        for vehicle, stances in sorted(self.seen.flown().items()):
            for stance in sorted(stances, key=self.whereabouts.words):
                look()
                try:
                    yield self._flight(vehicle, stance)
                except RegionError as error:
                    self._leave_out(error)

    def _flight(self, vehicle: Name, stance: Stance) -> FlightWay:
        at = stance.at
        assert isinstance(at, Transit)
        located = stance.located(self.facts)
        legs = self.facts.ways.legs(vehicle, at, stance.plans)
        names = (self.whereabouts.origin(vehicle, at.origin), *ways_by(stance), at.to)
        ends = list(pairwise(names)) if len(legs) == len(names) - 1 else [(names[0], at.to)]
        steps = tuple(self._leg(stance, leg, *end) for leg, end in zip(legs, ends, strict=True))
        most = None if any(each.most is None for each in steps) else sum(each.most or 0.0 for each in steps)
        places = tuple(self._from(stance, located.region, place) for place in self.seen.named)
        whole = WayLeg(names[0], at.to, sum(each.least for each in steps), most, places)
        band = located.region.parts[0].altitude
        low, high = (None, None) if band is None else (band.low, band.high)
        margin = max(part.margin for part in located.region.parts)
        return FlightWay(vehicle, whole, names[1:-1], steps if len(steps) > 1 else (), margin, low, high)

    def _leg(self, stance: Stance, leg: FlightLeg, origin: str, to: Name) -> WayLeg:
        region = Region((leg.part,))
        places = tuple(self._from(stance, region, place) for place in self.seen.named)
        return WayLeg(origin, to, leg.least, leg.most, places)

    def _from(self, stance: Stance, region: Region, place: Name) -> PlaceDistance:
        """Return the distance of a flight, or of one of its legs, from all that a place may be at the same time."""
        vehicle = Located(stance.entity, region)
        pairs = self.seen.together.get((stance.entity, place), ())
        found = PlaceDistance(place, None)
        for other in sorted({other for one, other in pairs if one == stance}, key=self.whereabouts.words):
            try:
                there = other.located(self.facts)
                far = reach(vehicle, there) if place in self.seen.ranged else None
                found = nearer(found, PlaceDistance(place, clearance(vehicle, there), far))
            except RegionError as error:
                self._leave_out(error)
        return found

    def _parts(self) -> Iterator[SeenPart]:
        """Yield the parts of all regions; one that something carries is in its carrier's."""
        steady = {name for name in self.seen.named if self.facts.ways.is_fixed(name)}
        for entity, stances in sorted(self.seen.alone.items()):
            for stance in () if entity in steady else sorted(stances, key=self.whereabouts.words):
                look()
                try:
                    located = stance.located(self.facts)
                except RegionError:  # it is noted already
                    continue
                at = stance.at
                begin = self.whereabouts.origin(entity, at.origin) if isinstance(at, Transit) else ""
                for part in () if located.carriers else located.region.parts:
                    yield SeenPart(entity, part, tuple(name or begin for name in part.between))

    def _leave_out(self, error: RegionError) -> None:
        where = f"{error.where}: " if error.where else ""
        self.notes[f"{where}not measured: {error.message}"] = None

    # --- pairs ------------------------------------------------------------------------------------

    def _pairs(self) -> Iterator[PairDistance]:
        vehicles = set(self.seen.vehicles)
        for pair, several in sorted(self.seen.together.items()):
            if vehicles.issuperset(pair):
                yield from self._nearest_of(several)

    def _nearest_of(self, several: Iterable[tuple[Stance, Stance]]) -> Iterator[PairDistance]:
        """Yield the least distances of two vehicles: both under way or one, at one altitude or apart."""
        best: dict[tuple[bool, bool], PairDistance] = {}
        for one, other in sorted(several, key=lambda pair: tuple(map(self.whereabouts.words, pair))):
            look()
            try:
                for found in self._apart(one, other, best):
                    sort = (not found.both_fly, found.gap > 0.0)
                    if sort not in best or found.rank < best[sort].rank:
                        best[sort] = found
            except RegionError as error:
                self._leave_out(error)
        for sort, found in sorted(best.items()):
            level = best.get((sort[0], False))
            if not sort[1] or level is None or found.metres < level.metres:
                yield found

    def _apart(
        self, one: Stance, other: Stance, best: dict[tuple[bool, bool], PairDistance]
    ) -> Iterator[PairDistance]:
        u, v = one.located(self.facts), other.located(self.facts)
        both_fly = one.is_flying and other.is_flying
        known = [best.get((not both_fly, apart)) for apart in (False, True)]
        farthest = None if None in known else max(each.metres for each in known if each is not None)
        if farthest is not None and _bound(u, v) > farthest:
            return
        names = one.entity, other.entity
        for found in filter(None, (nearest(u, v), nearest(u, v, LEVEL))):
            where = self.whereabouts.words(one), self.whereabouts.words(other)
            yield PairDistance(names, both_fly, found.metres, found.gap, where, (found.first, found.second))


def _bound(u: Located, v: Located) -> float:
    parts = ((a, b) for a in u.region.parts for b in v.region.parts)
    return min((least_bound(a, b) for a, b in parts), default=0.0)


def joined(one: FlightWay, other: FlightWay) -> FlightWay:
    """Return a flight that is made in two ways, under the same words."""
    legs = tuple(_joined(a, b) for a, b in zip(one.legs, other.legs, strict=False))
    return replace(
        one,
        whole=_joined(one.whole, other.whole),
        legs=legs,
        margin=max(one.margin, other.margin),
        low=None if None in (one.low, other.low) else min(one.low or 0.0, other.low or 0.0),
        high=None if None in (one.high, other.high) else max(one.high or 0.0, other.high or 0.0),
    )


def _joined(one: WayLeg, other: WayLeg) -> WayLeg:
    most = None if one.most is None or other.most is None else max(one.most, other.most)
    places = tuple(map(nearer, one.places, other.places))
    return replace(one, least=min(one.least, other.least), most=most, places=places)


def nearer(one: PlaceDistance, other: PlaceDistance) -> PlaceDistance:
    """Return the worse of two distances from one place."""
    clearances = [each.clearance for each in (one, other) if each.clearance is not None]
    reaches = [each.reach for each in (one, other) if each.reach is not None]
    worst = min(clearances, key=_badness, default=None)
    if {each.side for each in clearances} == {PlaceSide.INSIDE, PlaceSide.OUTSIDE}:
        worst = Clearance(PlaceSide.ACROSS, 0.0)
    return PlaceDistance(one.place, worst, max(reaches, default=None))


def _badness(each: Clearance) -> tuple[object, ...]:
    return each.side is not PlaceSide.ACROSS, each.gap > 0.0, each.metres
