"""Mobility: the entities that can move, and the nesting of those that can't."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from physical import Geometry, Place, check_places
from physical.geometry_measures import metres_text
from physical.outliers import ON_DRY_LAND, all_swapped, is_swapped, lonely_points, outliers
from semantics.environment import Clause, Placing
from semantics.state.physical_model import Carried, Placed
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.names import Names
from specs.elaboration.world import InitialWorld

_AFLOAT: Final = re.compile(r"(?i)vessel|tanker|drifter|boat|ship|ferry|buoy|raft|swimmer")


@dataclass(slots=True)
class Mobility:
    """The entities that move, by the way in which they do.

    Attributes:
        drifting: Entities that drift.
        coming: Entities that appear or vanish.
        carried: Entities that may be carried, initially or when they appear.
    """

    drifting: set[str] = field(default_factory=set)
    coming: set[str] = field(default_factory=set)
    carried: set[str] = field(default_factory=set)


def elaborate_mobility(mission: s.Mission, names: Names, world: InitialWorld) -> Mobility:
    """Collect the moving entities from the world and the environment section."""
    clauses = [clause for section in mission.each(s.Environment) for clause in section.clauses]
    found = Mobility()
    found.drifting = {
        each.entity.text for each in clauses if isinstance(each, s.DriftsAmong | s.DriftsWithin)
    }
    found.coming = {each.entity.text for each in clauses if isinstance(each, s.Appears | s.Vanishes)}
    found.carried = {name for name, placement in world.placements.items() if isinstance(placement, Carried)}
    for each in clauses:
        if isinstance(each, s.Appears):
            aboard = (carries(names, spot.text, each.entity.text) for spot in _named(each.placements))
            found.carried |= {each.entity.text} if any(aboard) else set()
    return found


def _named(spots: Iterable[s.Placement | s.Name]) -> Iterator[s.Name]:
    return (spot for spot in spots if isinstance(spot, s.Name))


def carries(names: Names, carrier: str, name: str) -> bool:
    """Whether one entity's kind carries another's."""
    kind = names.kinds.get(carrier)
    return kind is not None and names.kinds.get(name) in names.signature[kind].carries


def moves(name: str, names: Names, mobility: Mobility) -> bool:
    """Whether an entity may move after the start: by being driven, carried or drifting."""
    kind = names.kinds[name]
    return names.signature[kind].driven or name in mobility.drifting or name in mobility.carried


def fixed_entities(names: Names, mobility: Mobility) -> frozenset[str]:
    """Return the entities whose place neither agents nor the environment can ever change."""
    return frozenset(
        name for name in names.kinds if name not in mobility.coming and not moves(name, names, mobility)
    )


def check_nesting(names: Names, world: InitialWorld, mobility: Mobility) -> None:
    """Report each pair of immobile places that neither nest nor are disjoint."""
    places = {
        name: Place(placement.geometry, placement.altitude)
        for name, placement in world.placements.items()
        if isinstance(placement, Placed)
        and not placement.geometry.is_point
        and names.signature[names.kinds[name]].contains
        and not moves(name, names, mobility)
    }
    for conflict in check_places(places):
        spans = [names.spans["entity", name] for name in (conflict.first, conflict.second)]
        names.findings.add(Code.PLACES_OVERLAP, max(spans), str(conflict), conflict.hint)


def warn_of_outliers(names: Names, world: InitialWorld, clauses: Iterable[tuple[Clause, s.Span]]) -> None:
    """Warn of positions so far from all others that their latitude and longitude may be exchanged."""
    geometries = dict(_geometries(names, world, clauses))
    _warn_of_all(names, geometries)
    found = outliers(geometries) or lonely_points(geometries)
    rest = [geometry for key, geometry in geometries.items() if key not in found]
    for (span, words), metres in found.items():
        swapped = is_swapped(geometries[span, words], rest, metres)
        hint = "are latitude and longitude swapped? exchanged, it would be near" if swapped else ""
        message = f"{words} lies {metres_text(metres)} from everything else"
        hint = hint or "check its coordinates: missions use (latitude, longitude)"
        names.findings.warn(Code.FAR_FROM_THE_REST, span, message, hint)


def _warn_of_all(names: Names, geometries: Mapping[tuple[s.Span, str], Geometry]) -> None:
    """Warn if latitude and longitude of the whole world seem to be exchanged."""
    afloat = [key for key in geometries if _AFLOAT.search(names.kinds.get(key[1], ""))]
    where = all_swapped(geometries.values(), (geometries[key] for key in afloat))
    if where:
        on_land = where == ON_DRY_LAND
        span, words = afloat[0] if on_land else next(iter(geometries))
        what = f"{'whatever floats' if on_land else 'everything'} {where}"
        hint = "are latitude and longitude swapped? missions use (latitude, longitude), GeoJSON [longitude, latitude]"
        names.findings.warn(Code.PROBABLY_SWAPPED, span, f"{what}, such as {words}", hint)


def _geometries(
    names: Names, world: InitialWorld, clauses: Iterable[tuple[Clause, s.Span]]
) -> Iterator[tuple[tuple[s.Span, str], Geometry]]:
    """Yield the initial and possible geometries of each entity, with the span and the description of each."""
    for name, placement in world.placements.items():
        if isinstance(placement, Placed):
            yield (names.spans["entity", name], name), placement.geometry
    for clause, span in clauses:
        if isinstance(clause, Placing):
            for words, placement in zip(clause.words, clause.placements, strict=True):
                if isinstance(placement, Placed):
                    yield (span, f"where {words}"), placement.geometry
