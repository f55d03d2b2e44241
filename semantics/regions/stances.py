"""Stances: all that an entity's region depends on in a configuration, and words for it. They need no configuration."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

from physical import CarriedBy, FlightPlan, Located, Place, PlaceIndex, Transit, centroid
from physical.entity_motions import Standpoint
from physical.shape import Geometry
from semantics.regions.region_facts import RegionFacts
from semantics.regions.region_truth import flights, standpoint
from semantics.state.configuration import Configuration
from semantics.state.signature import Name

START: Final = "its start"
"""The words for an origin in no place."""


class Stance(NamedTuple):
    """The placements of an entity and its carriers, the innermost first, and the flights of the outermost.

    Attributes:
        chain: The entity and its carriers, each with its placement.
        plans: The flights that move the outermost, if it is in transit.
    """

    chain: tuple[tuple[Name, Standpoint], ...]
    plans: frozenset[FlightPlan] = frozenset()

    @property
    def entity(self) -> Name:
        """The entity."""
        return self.chain[0][0]

    @property
    def at(self) -> Standpoint:
        """The placement of the entity itself."""
        return self.chain[0][1]

    @property
    def is_flying(self) -> bool:
        """Whether the entity itself is in transit."""
        return isinstance(self.at, Transit)

    def located(self, facts: RegionFacts) -> Located:
        """Return the entity with its region.

        Raises:
            RegionError: If it is too large, or covers a pole.
        """
        known = dict(self.chain)
        return facts.ways.located(self.entity, known.__getitem__, lambda _: self.plans)


def stance_of(c: Configuration, entity: Name) -> Stance:
    """Return the stance of an entity; it reads the placements of it and its carriers, and the outermost's flights."""
    chain = [(entity, standpoint(c.structure.physical.placement(entity)))]
    while isinstance(by := chain[-1][1], CarriedBy) and by.carrier not in dict(chain):
        chain.append((by.carrier, standpoint(c.structure.physical.placement(by.carrier))))
    bearer, at = chain[-1]
    return Stance(tuple(chain), flights(c, bearer) if isinstance(at, Transit) else frozenset())


def standing(entity: Name, c: Configuration) -> Stance | None:
    """Return the stance of an entity, None if it is absent; a question to a configuration."""
    found = stance_of(c, entity)
    return None if found.at is None else found


def flying(entity: Name, c: Configuration) -> Stance | None:
    """Return the stance of an entity in transit, None at rest; a question to a configuration."""
    if not isinstance(standpoint(c.structure.physical.placement(entity)), Transit):
        return None
    return stance_of(c, entity)


def together(one: Name, other: Name, c: Configuration) -> tuple[Stance, Stance] | None:
    """Return the stances of two entities, None unless one is in transit and both are there; a question."""
    first = flying(one, c)
    second = flying(other, c) if first is None else stance_of(c, other)
    if second is None:
        return None
    first = stance_of(c, one) if first is None else first
    return (first, second) if first.at is not None and second.at is not None else None


def present_both(one: Name, other: Name, c: Configuration) -> tuple[Stance, Stance] | None:
    """Return the stances of two entities, None if one is absent; a question to a configuration."""
    first, second = standing(one, c), standing(other, c)
    return None if first is None or second is None else (first, second)


class StanceWords:
    """Words for stances: a position is named by the smallest place around it that never moves."""

    def __init__(self, facts: RegionFacts) -> None:
        self.facts: Final = facts
        self.places: Final = PlaceIndex(dict(fixed_places(facts)))

    def around(self, entity: Name, at: Place) -> Name:
        """Return the smallest possible container around a placement; empty without one."""
        may_hold = self.facts.motions[entity].containers
        found = self.places.containers(at.geometry, at.altitude)
        return next((name for name in found if name in may_hold), "")

    def origin(self, entity: Name, at: Place) -> str:
        """Return the words for the position at which a flight began."""
        return self.around(entity, at) or (START if self._is_first(entity, at) else spot_text(at.geometry))

    def _is_first(self, entity: Name, at: Place) -> bool:
        return any(each.geometry is at.geometry for each in self.facts.motions[entity].placements)

    def words(self, stance: Stance) -> str:
        """Return where an entity is, in words."""
        entity, at = stance.chain[0]
        match at:
            case Transit(origin, to):
                via = ways_by(stance)
                by = f" by {', '.join(via)}" if via else ""
                return f"{entity} between {self.origin(entity, origin)} and {to}{by}"
            case CarriedBy(by):
                return f"{entity} aboard {by}"
            case Place():
                place = self.around(entity, at)
                return f"{entity} in {place}" if place else f"{entity} at {spot_text(at.geometry)}"
            case _:
                return f"{entity} absent"


def ways_by(stance: Stance) -> tuple[Name, ...]:
    """Return the places by which an entity flies, if it has one flight."""
    return next(iter(stance.plans)).via if len(stance.plans) == 1 else ()


def spot_text(at: Geometry) -> str:
    """Return the middle of a geometry as text: latitude and longitude."""
    latitude, longitude = centroid(at).vertices[0]
    return f"({latitude:.5f}, {longitude:.5f})"


def fixed_places(facts: RegionFacts) -> Mapping[Name, Place]:
    """Return the areas of a mission that never change, by name."""
    found = {name: motion.placements for name, motion in facts.motions.items()}
    return {
        name: at[0]
        for name, at in found.items()
        if at and not at[0].geometry.is_point and facts.ways.is_fixed(name)
    }
