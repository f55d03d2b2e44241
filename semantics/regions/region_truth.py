"""The truth of atoms about regions, and the figures that a report shows."""

from physical import CarriedBy, FlightPlan, Located, Place, Transit, at_least, possibly_in, surely_in, within
from physical.entity_motions import Standpoint
from semantics.behaviours.reaction_rules import moved
from semantics.properties.region_atoms import (
    ApartFrom,
    PossiblyIn,
    RegionAtom,
    SurelyIn,
    WithinRangeOf,
    operands,
)
from semantics.regions.region_facts import RegionFacts
from semantics.state.configuration import Configuration
from semantics.state.eta import line_cell
from semantics.state.physical_model import Carried, InTransit, Placed, Placement
from semantics.state.requests import FLY, Request
from semantics.state.signature import REGION, Name


def is_true(atom: RegionAtom, c: Configuration) -> bool:
    """Whether an atom is true of a configuration.

    Raises:
        ValueError: The configuration's setting has no facts about regions.
    """
    one, other = operands(atom)
    u = located(c, one)
    if isinstance(atom, ApartFrom) and not u.region:  # the other one is not read
        return True
    return relates(atom, u, located(c, other))


def relates(atom: RegionAtom, u: Located, v: Located) -> bool:
    """Whether an atom is true of its two entities where they are."""
    match atom:
        case PossiblyIn():
            return possibly_in(u, v)
        case SurelyIn():
            return surely_in(u, v)
        case ApartFrom(distance=distance, height=height):
            return at_least(u, v, distance, height)
        case WithinRangeOf(distance=distance):
            return within(u, v, distance)


def located(c: Configuration, entity: Name) -> Located:
    """Return an entity with its region and its carriers."""
    facts = facts_of(c)
    return facts.ways.located(
        entity, lambda name: standpoint(c.structure.physical.placement(name)), lambda name: flights(c, name)
    )


def facts_of(c: Configuration) -> RegionFacts:
    """Return the facts about regions of a configuration's setting."""
    if c.setting.regions is None:
        raise ValueError("a property asks for regions: begin with watching(initial, properties)")
    return c.setting.regions


def standpoint(at: Placement | None) -> Standpoint:
    """Return a placement in the terms of regions."""
    match at:
        case None:
            return None
        case Placed(geometry, altitude):
            return Place(geometry, altitude)
        case InTransit(origin, to):
            return Transit(Place(origin.geometry, origin.altitude), to)
        case Carried(by):
            return CarriedBy(by)


def flights(c: Configuration, entity: Name) -> frozenset[FlightPlan]:
    """Return the flights that move an entity; η is read only if its placement does not determine them."""
    movers = facts_of(c).movers[entity]
    if not movers:
        to = c.structure.physical.going_to(entity)
        return frozenset({FlightPlan(to)} if to else ())
    return frozenset(plan for agent in movers for plan in c.ask(line_cell(agent), plans_of, entity))


def plans_of(line: tuple[Request, ...] | None, entity: Name) -> tuple[FlightPlan, ...]:
    """Return the flights in an agent's line that move an entity; a question about a cell."""
    return tuple(
        FlightPlan(to, each.reaction.via, _start(each, entity))
        for each in line or ()
        if isinstance(each, FLY)
        for node, to in moved(each.reaction, each.match)
        if node == entity
    )


def _start(fly: FLY, entity: Name) -> Name:
    """Return the parent that an entity leaves; empty if the flight does not name it."""
    before = {fly.match[node]: fly.match[place] for node, place in fly.reaction.redex.parents}
    start = before.get(entity, REGION)
    return "" if start == REGION else start
