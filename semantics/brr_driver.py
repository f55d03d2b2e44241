"""From a reaction to mobility commands: the paper's BRR Driver (3.2.3)."""

from physical import Geometry, MobilityCommand, Waypoint, rechannel, waypoint
from semantics.control import Realisation
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, Placed, channels_cell, placement_cell


def mobility_commands(c: Configuration, found: Realisation) -> tuple[MobilityCommand, ...]:
    """Return what the vehicles of a realisation are told: where to go, and which channels to change.

    The waypoint is the centroid of the target's polygon, or the point nearest to it at which the reactum is true; for
    what is to go aboard, where the carrier is. The waypoints of what is passed on the way come before.
    """
    physical = c.structure.physical
    told: list[MobilityCommand] = []
    for node, _ in found.flying:
        placement = found.physical[placement_cell(node)]
        target = physical.position(placement.by) if isinstance(placement, Carried) else placement
        assert isinstance(target, Placed)
        told.extend(Waypoint(node, at, target.altitude) for at in passed(c, found))
        told.append(Waypoint(node, waypoint(target.geometry), target.altitude))
    for cell, channels in sorted(found.physical.items()):
        if cell == channels_cell(cell[-1]):
            told.extend(rechannel(cell[-1], physical.channels(cell[-1]), channels))
    return tuple(told)


def passed(c: Configuration, found: Realisation) -> tuple[Geometry, ...]:
    """Return the waypoints of the places that are passed on the way, as these are now."""
    places = map(c.structure.physical.position, found.via)
    return tuple(waypoint(place.geometry) for place in places if place is not None)
