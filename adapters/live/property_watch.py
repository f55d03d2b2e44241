"""Watch the invariants about ways: compare them with what is seen, and report the broken ones."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import reduce
from typing import Final, assert_never

from adapters.live.fallbacks import breaks
from adapters.live.seen_regions import SeenWorld
from adapters.live.turn_in_progress import Turning
from adapters.live.watched import Position, WatchedInvariant
from physical import Geometry, Located, PhysicalError, centroid, nearest, possible_point
from physical.geodesic_areas import area_of, disc_of
from physical.geodesic_distances import greatest_distance_of
from physical.gnomonic import Disc, around
from physical.region_clearances import outermost
from semantics.properties.property import Property
from semantics.properties.propositions import And, Atom, Not, Or, Proposition, atoms_of, holds
from semantics.properties.region_atoms import (
    ApartFrom,
    PossiblyIn,
    RegionAtom,
    SurelyIn,
    WithinRangeOf,
    operands,
)
from semantics.regions.region_truth import relates
from semantics.state.signature import Name

PAUSE: Final = 0.2
"""The least seconds between two looks."""

MOST_COMPARED: Final = 50
"""The most pairs of entities, of those near each other, that one look measures: the others wait for the next."""

CALM: Final = 10.0
"""Seconds for which a broken invariant must hold until it is reported again."""

DOUBT: Final = 10.0
"""Metres, more than the error of all figures."""

MOST_MEASURED: Final = 3
"""The number of pairs, the nearest by rough bounds, that are measured for a figure."""


def watch_properties(turning: Turning) -> None:
    """Compare the invariants about ways with what is seen, and report those that are newly broken."""
    asked = turning.plan.invariants
    if not asked or turning.now < turning.watched.again:
        return
    look = PropertyComparison(_seen_world(turning))
    look.compare((atom for each in asked for atom in atoms_of(each.formula)), turning.watched.compared)
    broken, standings = dict(turning.watched.broken), []
    for each in asked:
        standing = look.standing(each)
        standings.append(standing)
        last = broken.get(each.name)
        if not standing.holds:
            broken[each.name] = turning.now
            if last is None:
                _report(turning, standing)
        elif last is not None and turning.now - last >= CALM:
            del broken[each.name]
    again = turning.now + PAUSE
    turning.watched = turning.watched.looked(tuple(standings), broken, look.compared, again)


def _seen_world(turning: Turning) -> SeenWorld:
    return SeenWorld(
        turning.plan, turning.c, turning.sightings, turning.commanded, turning.overrides, turning.now
    )


def _report(turning: Turning, standing: WatchedInvariant) -> None:
    spots = [f"({latitude:.5f}, {longitude:.5f})" for latitude, longitude in standing.points]
    where = f"; such as at {spots[0]}" if len(spots) == 1 else f"; from {' to '.join(spots)}" if spots else ""
    message = f"invariant '{standing.property}' is broken: {standing.figure}{where}"
    about = next((name for name in standing.entities if name in turning.plan.vehicles), "")
    fallback = turning.plan.precautions.on_broken_property
    breaks(turning, message, about, "broken property", fallback)


@dataclass(frozen=True, eq=False)
class PropertyComparison:
    """One look at the invariants.

    Attributes:
        world: What is seen.
        truths: The truth of each atom.
        compared: The truth of the atoms that rough bounds do not decide, and the time of its computation.
        discs: A disc around the region of each entity, if it has one.
    """

    world: SeenWorld
    truths: dict[RegionAtom, bool] = field(default_factory=dict)
    compared: dict[RegionAtom, tuple[bool, float]] = field(default_factory=dict)
    discs: dict[Name, Disc | None] = field(default_factory=dict)

    def compare(self, atoms: Iterable[Atom], before: Mapping[RegionAtom, tuple[bool, float]]) -> None:
        """Compute the truth of atoms about ways.

        Rough bounds decide most of them. Of the others those that were compared longest ago are measured, at most so
        many that the run goes on; the rest keep their last truth, or are harmless until they are measured.
        """
        left = []
        for atom in dict.fromkeys(atoms):
            if isinstance(atom, RegionAtom):
                roughly = self._by_discs(atom)
                if roughly is None:
                    left.append(atom)
                else:
                    self.truths[atom] = roughly
        if len(left) > MOST_COMPARED:
            left.sort(
                key=lambda atom: (before[atom][1] if atom in before else -math.inf, self._roughly(atom))
            )
        for count, atom in enumerate(left):
            known = before.get(atom)
            if count < MOST_COMPARED:
                u, v = map(self.world.located, operands(atom))
                known = is_true(atom, u, v), self.world.now
            if known is not None:
                self.compared[atom] = known
            self.truths[atom] = not isinstance(atom, PossiblyIn) if known is None else known[0]

    def standing(self, asked: Property) -> WatchedInvariant:
        """Return how an invariant stands."""
        is_true = self.holds(asked.formula)
        atoms = tuple(dict.fromkeys(self._deciding(asked.formula, wanted=is_true)))
        if not atoms:
            return WatchedInvariant(asked.name, is_true)
        atom = min(sorted(atoms, key=self._roughly)[:MOST_MEASURED], key=self._exactly)
        figure = self._figure(atom)
        return WatchedInvariant(asked.name, is_true, figure.words, operands(atom), figure.points)

    def holds(self, formula: Proposition) -> bool:
        """Whether a formula is true, with regions as they are seen."""
        match formula:
            case Not(inner):
                return not self.holds(inner)
            case And(parts):
                return all(map(self.holds, parts))
            case Or(parts):
                return any(map(self.holds, parts))
            case PossiblyIn() | SurelyIn() | ApartFrom() | WithinRangeOf():
                return self.truths[formula]
        return holds(formula, self.world.c)

    def _by_discs(self, atom: RegionAtom) -> bool | None:
        """Return the truth of an atom as far as the discs around both regions decide it."""
        least = self._least(*operands(atom))
        match atom:
            case ApartFrom(distance=distance) if least >= distance:
                return True
            case PossiblyIn() if least > DOUBT:
                return False
        return None

    def _least(self, one: Name, other: Name) -> float:
        """Return a rough lower bound of the metres between two entities; negative where one may be anywhere."""
        a, b = self._disc(one), self._disc(other)
        return -math.inf if a is None or b is None else a.least(b)

    def _disc(self, entity: Name) -> Disc | None:
        if entity not in self.discs:
            found = self.world.located(entity)
            parts = () if found is None else found.region.parts
            self.discs[entity] = reduce(around, map(disc_of, parts)) if parts else None
        return self.discs[entity]

    def _deciding(self, formula: Proposition, *, wanted: bool) -> Iterator[RegionAtom]:
        """Yield the atoms that give a formula its truth value."""
        match formula:
            case Not(inner):
                yield from self._deciding(inner, wanted=not wanted)
            case And(parts) | Or(parts):
                for part in parts:
                    if self.holds(part) is wanted:
                        yield from self._deciding(part, wanted=wanted)
            case PossiblyIn() | SurelyIn() | ApartFrom() | WithinRangeOf():
                yield formula

    # --- figures --------------------------------------------------------------------------------------

    def _roughly(self, atom: RegionAtom) -> float:
        """Return a rough measure of how near an atom is to its limit, for a choice among many."""
        return _beyond(atom, self._least(*operands(atom)))

    def _exactly(self, atom: RegionAtom) -> float:
        u, v = map(self.world.located, operands(atom))
        if u is None or v is None:
            return -math.inf
        try:
            return _beyond(atom, nearest_distance(u, v))
        except PhysicalError:
            return -math.inf

    def _figure(self, atom: RegionAtom) -> Figure:
        one, other = operands(atom)
        u, v = self.world.located(one), self.world.located(other)
        for name, located in ((one, u), (other, v)):
            if located is None:
                return Figure(f"{self._lost(name)}; {atom}")
        assert u is not None
        assert v is not None
        try:
            return figure(atom, u, v, holds=self.truths[atom])
        except PhysicalError as error:
            return Figure(f"{error.message}; {atom}")

    def _lost(self, entity: str) -> str:
        age = self.world.age(entity)
        if age is None:
            return f"{entity} is not seen and may be anywhere"
        return f"{entity} was seen {age:.0f} s ago, and nothing bounds its speed"


def _beyond(atom: RegionAtom, metres: float) -> float:
    """Return by how much a distance is beyond an atom's limit; the least one is shown."""
    match atom:
        case ApartFrom(distance=distance):
            return metres - distance
        case PossiblyIn():
            return metres
    return -metres


def is_true(atom: RegionAtom, u: Located | None, v: Located | None) -> bool:
    """Whether an atom is true of two entities, None for one that may be anywhere; in doubt only `possibly` is."""
    if u is None or v is None:
        known = u or v
        absent = known is not None and not known.region
        return not absent if isinstance(atom, PossiblyIn) else absent and isinstance(atom, ApartFrom)
    try:
        return relates(atom, u, v)
    except PhysicalError:
        return isinstance(atom, PossiblyIn)


@dataclass(frozen=True, slots=True)
class Figure:
    """A figure in words, and the points that show it."""

    words: str
    points: tuple[Position, ...] = ()


def figure(atom: RegionAtom, u: Located, v: Located, *, holds: bool) -> Figure:
    """Return the figure of an atom: a distance, and the points where it is measured.

    Raises:
        PhysicalError: The regions are too large for figures.
    """
    match atom:
        case ApartFrom():
            return _apart(atom, u, v)
        case PossiblyIn(one, place):
            found = possible_point(u, v)
            if found is not None:
                return Figure(f"{one} may be in {place}", (_position(found),))
            words = f"{one} may be in {place}" if holds else f"{one} keeps out of {place}"
            near = nearest(u, v) if not holds else None
            return Figure(words if near is None else f"{one} is {near.metres:.0f} m from {place}")
        case SurelyIn(one, place):
            if holds:
                return Figure(f"{one} is surely in {place}")
            outside = outermost(u, v)
            if outside is None:
                return Figure(f"{one} may be outside {place}")
            words = f"{one} may be up to {math.ceil(outside.metres)} m outside {place}"
            return Figure(words, (_position(outside.point),))
        case WithinRangeOf(one, other, distance):
            if not u.region or not v.region:
                return Figure(f"{one if not u.region else other} is absent")
            farthest = greatest_distance(u, v)
            word = "is at most" if holds else "may be"
            return Figure(
                f"{one} {word} {farthest:.0f} m from {other}; within {distance:g} m", _middles(u, v)
            )
        case _:
            assert_never(atom)


def _apart(atom: ApartFrom, u: Located, v: Located) -> Figure:
    one, other, least = atom.entity, atom.other, f"at least {atom.distance:g} m"
    if atom.height is not None:
        least += f" or {atom.height:g} m up"
    for name, located in ((one, u), (other, v)):
        if not located.region:
            return Figure(f"{name} is absent")
    if u.bearer == v.bearer:
        return Figure(f"{one} and {other} are carried together; {least}")
    up = atom.distance if atom.height is None else atom.height
    found = nearest(u, v, up) or nearest(u, v)
    assert found is not None
    beside = f", {found.gap:.0f} m above or below" if found.gap else ""
    near = "may meet" if found.metres < 1 and not found.gap else f"may come within {int(found.metres)} m of"
    words = f"{one} {near} {other}{beside}; {least}"
    return Figure(words, (_position(found.first), _position(found.second)))


def _middles(u: Located, v: Located) -> tuple[Position, ...]:
    sources = [each.region.parts[0].sources[0] for each in (u, v)]
    return tuple(_position(centroid(source)) for source in sources if isinstance(source, Geometry))


def nearest_distance(u: Located, v: Located) -> float:
    """Return the metres between two regions on the ground."""
    found = nearest(u, v)
    return math.inf if found is None else found.metres


def greatest_distance(u: Located, v: Located) -> float:
    """Return the metres within which all points of two regions lie of each other."""
    return max(
        greatest_distance_of(area_of(a), area_of(b)) + a.margin + b.margin
        for a in u.region.parts
        for b in v.region.parts
    )


def _position(point: Geometry) -> Position:
    ((latitude, longitude),) = point.vertices
    return latitude, longitude
