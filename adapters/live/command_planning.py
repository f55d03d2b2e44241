"""Turn requests into commands to vehicles, and decide when a command is done."""

from __future__ import annotations

from adapters.live.surroundings import surroundings
from adapters.plugin import Follow, GoTo, HandOver, Hold, Return
from semantics.behaviours.reaction_rules import CONTROL_AUTHORITY, moved, relinked
from semantics.brr_driver import passed
from semantics.control import Realisation, commits
from semantics.live_policy import Fallback
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, InTransit, Placed, placement_cell
from semantics.state.requests import CTR, FLY
from semantics.state.signature import Name


def journey(
    c: Configuration, found: Realisation, node: Name, place: Name, request: str, first: Configuration
) -> GoTo | Follow | None:
    """Return the command to go into a place by way of others, at their current positions; `first` is the mission's."""
    going = destination(c, found, node, place, request, first)
    if going is None or not found.via:
        return going
    path = (*passed(c, found), going.place)
    return Follow(request, node, path, going.altitude, place, going.around, going.shape)


def destination(
    c: Configuration, found: Realisation, node: Name, place: Name, request: str, first: Configuration
) -> GoTo | None:
    """Return the command to go into a place at its current position, or to the node's future carrier.

    The vehicle must keep to the surroundings of the point that `drive` found. Then no rule can distinguish its real
    position from its point in P.
    """
    spot = found.physical.get(placement_cell(node))
    target = c.structure.physical.position(place)
    if target is None or spot is None:
        return None
    if isinstance(spot, Carried):
        return GoTo(request, node, target.geometry, None, place)
    assert isinstance(spot, Placed)
    around = surroundings(c, node, spot, target.geometry, first)
    shape = None if spot.geometry.is_point else spot.geometry
    return GoTo(request, node, target.geometry, spot.altitude, place, around, shape)


def renewed(c: Configuration, fly: FLY, given: GoTo | Follow, first: Configuration) -> GoTo | Follow | None:
    """Return the command with its places' current positions, None if it is the same or they are unknown."""
    found = commits(c, fly)
    transit = c.structure.physical.placement(given.entity)
    if found is None or not isinstance(transit, InTransit):
        return None
    command = journey(c, found, given.entity, transit.to, given.request, first)
    return command if command != given else None


def stopping(fallback: Fallback, request: str, entity: Name) -> Hold | Return:
    """Return the command that ends a vehicle's flight: hold, or return."""
    return Hold(request, entity) if fallback is Fallback.HOLD else Return(request, entity)


def needed_hand_overs(
    c: Configuration, request: CTR, found: Realisation, vehicles: frozenset[Name]
) -> tuple[HandOver, ...]:
    """Return the link changes that vehicles must confirm: changes of control authority."""
    needed = []
    for node, lost, gained in relinked(request.reaction, found.match, c.structure.logical):
        leave, join = _authority(lost), _authority(gained)
        if node in vehicles and leave and join:
            needed.append(HandOver("", node, leave, join))
    return tuple(needed)


def unshown(c: Configuration, request: CTR, found: Realisation, vehicles: frozenset[Name]) -> str:
    """Return the part of a control whose completion no report would ever show, or an empty text.

    A traveller is seen to arrive, and a vehicle shows its controlling station. No report shows that a load was put
    down, or that a channel was joined.
    """
    travelling = {node for node, _ in found.flying}
    for node, place in moved(request.reaction, found.match):
        if node not in travelling:
            return f"no report can confirm that {node} is put into {place}"
    for node, lost, gained in relinked(request.reaction, found.match, c.structure.logical):
        handed = node in vehicles and all(map(is_authority, lost | gained)) and len(lost) == len(gained) == 1
        if not lost and gained.issubset(c.structure.logical.links(node)):
            continue
        if not handed or travelling:
            while_flying = " while others travel" if travelling else ""
            return f"no report can confirm that {node} joins or leaves {', '.join(sorted(lost | gained))}{while_flying}"
    return ""


def _authority(channels: frozenset[Name]) -> Name:
    return next((each for each in sorted(channels) if is_authority(each)), "")


def is_authority(channel: Name) -> bool:
    """Return whether a channel is a control authority, which autopilots confirm."""
    return channel.partition(":")[0] == CONTROL_AUTHORITY


def is_done(hand_over: HandOver, channels: tuple[Name, ...]) -> bool:
    """Return whether a vehicle was seen on the channels of a completed hand-over."""
    return hand_over.join in channels and hand_over.leave not in channels
