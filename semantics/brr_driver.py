"""From a reaction to mobility commands: the paper's BRR Driver (3.2.3)."""

from collections.abc import Iterator
from typing import NamedTuple

from physical import Band, Geometry, MobilityCommand, Waypoint, rechannel, waypoint
from semantics.control import Realisation
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, PhysicalModel, Placed, channels_cell, placement_cell
from semantics.state.signature import REGION, Name


class WaypointStop(NamedTuple):
    """A place that a vehicle flies to or passes, the waypoint there, and the vehicle's altitudes, if known."""

    place: Name
    point: Geometry
    altitude: Band | None


def mobility_commands(c: Configuration, found: Realisation) -> tuple[MobilityCommand, ...]:
    """Return the mobility commands of a realisation: waypoints of its vehicles, and channel changes.

    A waypoint keeps the vehicle's altitude. A vehicle without one gets the altitude of the place.
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


def stops(c: Configuration, found: Realisation, node: Name, place: Name) -> Iterator[WaypointStop]:
    """Yield the stops of a vehicle in a realisation: the places of its VIA, then its destination.

    The waypoint of the destination is the centroid of its polygon, or the nearest point at which the reactum holds. A
    vehicle that boards a carrier flies to the carrier's position.
    """
    physical = c.structure.physical
    placement = found.physical[placement_cell(node)]
    target = physical.position(placement.by) if isinstance(placement, Carried) else placement
    assert isinstance(target, Placed)
    gates = (via for via in found.via if physical.position(via) is not None)
    for via, at in zip(gates, passed(c, found), strict=True):
        yield WaypointStop(via, at, target.altitude)
    yield WaypointStop(place, waypoint(target.geometry), target.altitude)


def passed(c: Configuration, found: Realisation) -> tuple[Geometry, ...]:
    """Return the current waypoints of the places of the VIA."""
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
