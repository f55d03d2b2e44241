"""Overflights: flights that may cross a place from which an invariant excludes the vehicle.

`actually` is about the places that contain vehicles, and a vehicle in transit is in no place that it only crosses. So
an invariant that excludes a vehicle, or its cargo, from a place holds even if its path leads through. Unless another
invariant asks for the path (`not possibly u in p`), this module warns if the place meets the hull of two successive
points of a possible flight. An exploration then confirms or refutes it.
"""

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from itertools import islice, pairwise, product
from typing import TypeVar

from physical import Geometry
from physical.extents import extent, least_distance, span
from semantics.environment import Appears, Drifts
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import And, Inside, Not, Or, Proposition
from semantics.properties.region_atoms import PossiblyIn
from semantics.regions.possible_moves import possible_moves
from semantics.regions.suspicions import MayCross, SuspectedWay, Suspicion
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried
from semantics.state.setting import Control, Setting
from semantics.state.signature import REGION, Name
from specs import syntax as s
from specs.codes import Code
from specs.diagnostics import Diagnostic
from specs.elaboration.mission_mistakes import Findings
from specs.elaboration.suspicion_warnings import SuspicionWarning

A = TypeVar("A", Inside, PossiblyIn)

Leg = tuple[Name, tuple[Name, ...]]
"""A vehicle, with the places of its VIA and its destination."""

MOST_PARTS = 2_000
"""The most operands of a quantifier that are examined."""

MOST_LEGS = 5_000
"""The most flights that are examined."""

AROUND = "lead it around: MOVE_HOST_TO place VIA gate0, gate1"


def suspected_overflights(
    setting: Setting, begin: Callable[[], Configuration], properties: Iterable[Property], findings: Findings
) -> Iterator[SuspicionWarning]:
    """Yield a warning for each invariant that excludes vehicles from places that their flights may cross."""
    asked = tuple(properties)
    watched = {(atom.entity, atom.place) for each in asked for atom in _denied_of(each, PossiblyIn)}
    kept_out = {
        each: [kept for kept in _kept_out(setting, each) if kept[:2] not in watched] for each in asked
    }
    if setting.control is Control.ATOMIC or not any(kept_out.values()):
        return
    c = begin()
    legs = frozenset((move.entity, (*move.via, move.place)) for move in islice(possible_moves(c), MOST_LEGS))
    flights = [leg for leg in sorted(legs) if setting.signature[setting.kind(leg[0])].driven]
    for invariant, forbidden in kept_out.items():
        suspects: list[MayCross] = []
        first: tuple[MayCross, SuspectedWay] | None = None
        for entity, place, directly in forbidden:
            moving = frozenset({entity}) if directly else _carriers(c, legs, entity)
            carrying = [leg for leg in flights if leg[0] in moving]
            if carrying:
                suspects.append(MayCross(entity, place))
            if first is None:
                ways = filter(None, (_crossing(c, leg, legs, place) for leg in carrying))
                first = next(((suspects[-1], way) for way in ways), None)
        if first is not None:
            warning = partial(_warning, _line(findings, invariant.line))
            yield SuspicionWarning(tuple(suspects), warning(*first), warning)


def _warning(where: s.Span, suspicion: Suspicion, way: SuspectedWay) -> Diagnostic:
    entity, place = suspicion.pair
    aboard = "" if way.vehicle == entity else f", aboard {way.vehicle},"
    whereabouts = f"on its way from {way.begins} to {way.to}" if way.begins else f"while it is in {way.to}"
    hint = f"'actually' is about its place, not its way; ask for its way: not possibly {entity} in {place}"
    message = f"{entity}{aboard} may cross {place} {whereabouts}"
    return Diagnostic(Code.MAY_CROSS, where, message, f"{hint}; {AROUND}")


def _line(findings: Findings, number: int) -> s.Span:
    lines = findings.source.text.split("\n")
    start = sum(len(line) + 1 for line in lines[: number - 1])
    text = lines[number - 1]
    return s.Span(start + len(text) - len(text.lstrip()), start + len(text.rstrip()))


def _kept_out(setting: Setting, asked: Property) -> Iterator[tuple[Name, Name, bool]]:
    """Yield each entity with a place from which an invariant excludes it in P, and whether its cargo does not count."""
    for atom in _denied_of(asked, Inside):
        if atom.actually and atom.node in setting.kinds and atom.place in setting.kinds:
            yield atom.node, atom.place, atom.directly


def _carriers(c: Configuration, legs: Iterable[Leg], entity: Name) -> frozenset[Name]:
    """Return an entity with all that may carry it: from the start, where it appears, or by a control, at any depth."""
    clauses = (each for each in c.setting.environment if isinstance(each, Appears))
    carried = [(each.entity, at.by) for each in clauses for at in each.placements if isinstance(at, Carried)]
    carried += [(node, stops[-1]) for node, stops in legs if _takes(c, stops[-1], node)]
    found, waiting = {entity}, [entity]
    while waiting:
        name = waiting.pop()
        by = {c.structure.physical.carrier(name), *(holder for node, holder in carried if node == name)}
        new = {each for each in by if each is not None} - found
        found |= new
        waiting += new
    return frozenset(found)


def _denied_of(asked: Property, sort: type[A]) -> tuple[A, ...]:
    """Return the atoms of a sort that an invariant of the mission denies."""
    if asked.kind is not PropertyKind.INVARIANT or asked.line == 0:
        return ()
    denied = dict.fromkeys(_denied(asked.formula, negated=False))
    return tuple(atom for atom in denied if isinstance(atom, sort))


def _denied(formula: Proposition, *, negated: bool) -> Iterator[Inside | PossiblyIn]:
    """Yield the atoms that must be false for a formula to be true."""
    match formula:
        case Inside() | PossiblyIn() if negated:
            yield formula
        case Not(inner):
            yield from _denied(inner, negated=not negated)
        case And(parts) if not negated:
            for part in islice(parts, MOST_PARTS):
                yield from _denied(part, negated=negated)
        case Or(parts) if negated:
            for part in islice(parts, MOST_PARTS):
                yield from _denied(part, negated=negated)


def _takes(c: Configuration, holder: Name, entity: Name) -> bool:
    return holder in c.setting.kinds and c.setting.carries(holder, entity)


def _crossing(c: Configuration, leg: Leg, legs: Iterable[Leg], place: Name) -> SuspectedWay | None:
    """Return the part of a flight that may cross a place; None if there is none."""
    vehicle, stops = leg
    begins = [vehicle, *sorted({each[1][-1] for each in legs if each[0] == vehicle} - {stops[-1]})]
    ways = [(begin, stops[0]) for begin in begins] + list(pairwise(stops))
    shapes = _shapes(c, place)
    for one, other in ways:
        if place not in (one, other) and _meets(_shapes(c, one), _shapes(c, other), shapes):
            return SuspectedWay(vehicle, "its start" if one == vehicle else one, other)
    return None


def _meets(begins: list[Geometry], ends: list[Geometry], places: list[Geometry]) -> bool:
    """Whether some path meets a place."""
    paths = (span([extent(begin), extent(end)]) for begin, end in product(begins, ends))
    return any(least_distance(path, extent(place)) == 0 for path, place in product(paths, places))


def _shapes(c: Configuration, entity: Name) -> list[Geometry]:
    """Return the initial and the listed geometries of an entity."""
    if entity == REGION:
        return []
    at = c.structure.physical.position(entity)
    clauses = [each for each in c.setting.environment if isinstance(each, Drifts | Appears)]
    listed = [where for each in clauses if each.entity == entity for where in each.placements]
    found = [where.geometry for where in listed if not isinstance(where, Carried)]
    return ([] if at is None else [at.geometry]) + found
