"""The words of reports about regions: the figure of an atom, the whereabouts of both entities, and the points."""

import math
from collections.abc import Iterator

from physical import Geometry, Located, Nearest, RegionError, centroid, nearest, possible_point
from physical.region_clearances import outermost
from semantics.properties.propositions import And, Instances, Not, Or, Proposition, holds
from semantics.properties.region_atoms import (
    ApartFrom,
    PossiblyIn,
    RegionAtom,
    SurelyIn,
    WithinRangeOf,
    operands,
)
from semantics.regions.region_truth import facts_of, flights, is_true, located
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, InTransit, Placed, encloses
from semantics.state.signature import REGION, Name

MOST_LINES = 4
"""The most atoms that a report explains."""


def region_lines(formula: Proposition, c: Configuration) -> tuple[str, ...]:
    """Return in words why a proposition is false, as far as regions decide it; one line for each atom."""
    lines: list[str] = []
    for atom in dict.fromkeys(deciding(formula, c, wanted=False)):
        if len(lines) < MOST_LINES:
            lines.append(f"{_figure(atom, c)}: {_whereabouts(atom, c)}{_points(atom, c)}")
    return tuple(lines)


def deciding(formula: Proposition, c: Configuration, *, wanted: bool) -> Iterator[RegionAtom]:
    """Yield the atoms about regions that give a formula its truth value; of a quantifier, those of one instance."""
    match formula:
        case Not(inner):
            yield from deciding(inner, c, wanted=not wanted)
        case And(parts) | Or(parts):
            one_decides = isinstance(formula, Or) is wanted
            some = (part for part in parts if holds(part, c) is wanted)
            chosen = some if not (one_decides or isinstance(parts, Instances)) else _first(some)
            for part in chosen:
                yield from deciding(part, c, wanted=wanted)
        case PossiblyIn() | SurelyIn() | ApartFrom() | WithinRangeOf():
            yield formula


def _first(some: Iterator[Proposition]) -> Iterator[Proposition]:
    found = next(some, None)
    if found is not None:
        yield found


def _figure(atom: RegionAtom, c: Configuration) -> str:
    """Return the meaning of a true atom in words, or the possible event behind a false one."""
    one, other = operands(atom)
    is_so = is_true(atom, c)
    match atom:
        case PossiblyIn():
            return f"{one} may be in {other}" if is_so else f"{one} cannot be in {other}"
        case SurelyIn():
            return f"{one} is surely in {other}" if is_so else f"{one} may be outside {other}"
        case WithinRangeOf(distance=distance):
            verb = "cannot" if is_so else "may"
            return f"{one} {verb} be farther than {_length(distance)} from {other}"
        case ApartFrom(distance=distance) if is_so:
            return f"{one} cannot be nearer than {_length(distance)} to {other}"
        case ApartFrom():
            found = _nearest(atom, c)
            if found is None and one == other:
                return f"{one} is compared with itself, which `x != y -> ...` leaves out"
            if found is None:
                return f"{one} and {other} are at one place, aboard one carrier"
            meets = found.metres < 1 and not found.gap
            near = (
                f"{one} may meet {other}"
                if meets
                else f"{one} may come within {int(found.metres):,} m of {other}"
            )
            return f"{near}, {found.gap:g} m above or below" if found.gap else near


def _points(atom: RegionAtom, c: Configuration) -> str:
    """Return the points that show it, as latitude and longitude."""
    if isinstance(atom, ApartFrom):
        found = _nearest(atom, c)
        return "" if found is None else f"; nearest at {_spot(found.first)} and {_spot(found.second)}"
    one, other = (located(c, name) for name in operands(atom))
    if isinstance(atom, SurelyIn):
        return _outside(one, other)
    point = possible_point(one, other) if isinstance(atom, PossiblyIn) else None
    return "" if point is None else f"; such as at {_spot(point)}"


def _outside(one: Located, place: Located) -> str:
    try:
        found = outermost(one, place)
    except RegionError:
        return ""
    return "" if found is None else f"; up to {math.ceil(found.metres):,} m, at {_spot(found.point)}"


def _length(metres: float) -> str:
    return f"{metres / 1000:g} km" if metres >= 1000 else f"{metres:g} m"


def _nearest(atom: ApartFrom, c: Configuration) -> Nearest | None:
    """Return the nearest points that count: those of parts whose altitudes are not apart."""
    up = atom.distance if atom.height is None else atom.height
    return nearest(located(c, atom.entity), located(c, atom.other), up)


def _spot(point: Geometry) -> str:
    latitude, longitude = point.vertices[0]
    return f"({latitude:.5f}, {longitude:.5f})"


def _whereabouts(atom: RegionAtom, c: Configuration) -> str:
    if isinstance(atom, PossiblyIn | SurelyIn) and facts_of(c).ways.is_fixed(atom.place):
        return _where(c, atom.entity)
    return ", ".join(_where(c, name) for name in dict.fromkeys(operands(atom)))


def _where(c: Configuration, entity: Name) -> str:
    """Return where an entity is in P, in words."""
    physical = c.structure.physical
    match physical.placement(entity):
        case None:
            return f"{entity} absent"
        case Carried(by):
            return f"{entity} aboard {by}, {_where(c, by)}"
        case InTransit(origin, to):
            start = _around(c, entity, origin)
            via = sorted({plan.via for plan in flights(c, entity)} - {()})
            by = f" by {', '.join(via[0])}" if via else ""
            return f"{entity} between {start or 'its start'} and {to}{by}"
        case Placed(geometry):
            parent = physical.abstract_parent(entity)
            return f"{entity} at {_spot(centroid(geometry))}" if parent == REGION else f"{entity} in {parent}"


def _around(c: Configuration, entity: Name, at: Placed) -> Name:
    """Return the smallest place around a position; empty if there is none."""
    holders = c.structure.physical.holders(entity)
    return next((place for _, place, around in holders if encloses(around, at)), "")
