"""From a reaction to mobility commands: the paper's BRR Driver (3.2.3)."""

from collections.abc import Iterator
from typing import NamedTuple

from physical import Band, Geometry, MobilityCommand, Waypoint, rechannel, waypoint
from semantics.control import Realisation
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, PhysicalModel, Placed, channels_cell, placement_cell
from semantics.state.signature import REGION, Name


class Stop(NamedTuple):
    """A place that a vehicle is sent to or by, the waypoint there, and the vehicle's altitudes where it has any."""

    place: Name
    point: Geometry
    altitude: Band | None


def mobility_commands(c: Configuration, found: Realisation) -> tuple[MobilityCommand, ...]:
    """Return what the vehicles of a realisation are told: where to go, and which channels to change.

    A vehicle keeps its altitude; one of which none is known is told that of the place.
    """
    physical = c.structure.physical
    told: list[MobilityCommand] = []
    for node, place in found.flying:
        told.extend(
            Waypoint(node, stop.point, stop.altitude or _level(physical, stop.place))
            for stop in stops(c, found, node, place)
        )
    for cell, channels in sorted(found.physical.items()):
        if cell == channels_cell(cell[-1]):
            told.extend(rechannel(cell[-1], physical.channels(cell[-1]), channels))
    return tuple(told)


def stops(c: Configuration, found: Realisation, node: Name, place: Name) -> Iterator[Stop]:
    """Yield where a vehicle of a realisation goes: through what it passes on the way, then to its place.

    The waypoint is the centroid of the target's polygon, or the point nearest to it at which the reactum is true; for
    what is to go aboard, where the carrier is.
    """
    physical = c.structure.physical
    placement = found.physical[placement_cell(node)]
    target = physical.position(placement.by) if isinstance(placement, Carried) else placement
    assert isinstance(target, Placed)
    gates = (via for via in found.via if physical.position(via) is not None)
    for via, at in zip(gates, passed(c, found), strict=True):
        yield Stop(via, at, target.altitude)
    yield Stop(place, waypoint(target.geometry), target.altitude)


def passed(c: Configuration, found: Realisation) -> tuple[Geometry, ...]:
    """Return the waypoints of the places that are passed on the way, as these are now."""
    places = map(c.structure.physical.position, found.via)
    return tuple(waypoint(place.geometry) for place in places if place is not None)


def _level(physical: PhysicalModel, place: Name) -> Band | None:
    """Return the band of altitudes of a place, or of the smallest place around it that has one."""
    while place != REGION:
        at = physical.position(place)
        if at is not None and at.altitude is not None:
            return at.altitude
        place = physical.abstract_parent(place)
    return None
