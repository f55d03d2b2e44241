"""The surroundings of a vehicle in flight: it stays in the places of its point in P, and out of all others."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from itertools import islice, product
from typing import Final

from physical import Geometry, Surroundings, band_contains, share_interior, surroundings_of
from semantics.drive import reach
from semantics.environment import Placing
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Placed, Placement, encloses, placement_cell
from semantics.state.setting import Setting
from semantics.state.signature import Name

MOST_COMBINATIONS: Final = 500
"""The most combinations of the positions of movers in a check before take-off."""


def surroundings(
    c: Configuration, node: Name, spot: Placed, target: Geometry, first: Configuration
) -> Surroundings:
    """Return the places that a vehicle must stay in or out of, within its target place.

    They are all places that may hold it, at their current positions and at those that the mission lists.
    """
    holders = sorted(c.setting.containers(c.setting.kind(node)))
    stands = {each for name in holders for each in _stands(c, first, name, spot)} - {target}
    return surroundings_of(spot.geometry, (each for each in stands if share_interior(each, target)))


def _stands(c: Configuration, first: Configuration, place: Name, spot: Placed) -> Iterator[Geometry]:
    """Yield the possible positions of a place at the height of a vehicle.

    The mission's positions count as long as the place is at one of them: a place seen elsewhere may go anywhere.
    """
    for at in (c.structure.physical.placement(place), *_listed(c, first, place)):
        if isinstance(at, Placed) and not at.geometry.is_point and band_contains(at.altitude, spot.altitude):
            yield at.geometry


def _listed(c: Configuration, first: Configuration, place: Name) -> tuple[Placement, ...]:
    """Return the mission's positions of a place, or none if it was seen elsewhere."""
    here, begins = c.structure.physical.placement(place), first.structure.physical.placement(place)
    listed = (*(() if begins is None else (begins,)), *_placements(c.setting, place))
    return listed if here is None or here in listed else ()


@lru_cache(maxsize=1 << 10)
def _placements(setting: Setting, place: Name) -> tuple[Placed, ...]:
    clauses = (each for each in setting.environment if isinstance(each, Placing) and each.entity == place)
    return tuple(at for clause in clauses for at in clause.placements if isinstance(at, Placed))


@lru_cache(maxsize=1 << 6)
def _movers(setting: Setting, kind: str) -> tuple[Name, ...]:
    """Return the movable containers for entities of a kind."""
    return tuple(name for name in sorted(setting.containers(kind)) if _placements(setting, name))


def separating_place(c: Configuration, node: Name, here: Placed, seen: Placed, first: Configuration) -> str:
    """Return a place that holds a vehicle at only one of two points, at a listed position; or an empty text."""
    for place in _movers(c.setting, c.setting.kind(node)):
        for at in _listed(c, first, place):
            if isinstance(at, Placed) and encloses(at, here) != encloses(at, seen):
                return place
    return ""


def spots(first: Configuration, node: Name, place: Name) -> Iterator[tuple[Geometry, Surroundings]]:
    """Yield each geometry of a place with its surroundings, for all positions of the other places.

    Of very many combinations of positions, only the first are considered.
    """
    movers = sorted({place, *first.setting.containers(first.setting.kind(node))})
    physical = first.structure.physical
    where = {name: (physical.placement(name), *_placements(first.setting, name)) for name in movers}
    several = {name: tuple(dict.fromkeys(at)) for name, at in where.items() if len(set(at)) > 1}
    seen = set()
    for chosen in islice(product(*several.values()), MOST_COMBINATIONS):
        c = first.with_({placement_cell(name): at for name, at in zip(several, chosen, strict=True)})
        target, spot = c.structure.physical.position(place), reach(c.structure.physical, node, place)
        if target is None or not isinstance(spot, Placed):
            continue
        found = target.geometry, surroundings(c, node, spot, target.geometry, first)
        if found not in seen:
            seen.add(found)
            yield found
