"""Flights: their ends, changes of their destinations, and their state in a resumed run."""

from __future__ import annotations

from dataclasses import replace

from adapters.live.command_planning import journey, needed_hand_overs, renewed
from adapters.live.commanded import GivenCommand
from adapters.live.scheduling import in_turn
from adapters.live.step_taking import observe
from adapters.live.turn_in_progress import Turning
from adapters.live.way_watch import is_level, keeps_near
from adapters.plugin import Accepted, Arrived, Follow, GoTo, HandOver
from physical import Geometry, centroid, leads_straight, standing
from semantics.control import commits, realisations
from semantics.observed_steps import Sight, arriving
from semantics.state.physical_model import Placed, placement_cell
from semantics.state.requests import CTR, FLY, Request
from semantics.state.signature import Name


def arrive(turning: Turning, entity: Name) -> bool:
    """Commit the flight of a vehicle if it and all its companions were seen at their destinations.

    A vehicle may cross its destination for other reasons, such as a return to its home. So it must show that it follows
    its command. A vehicle on a path must have reported the end of the path. The remaining way to its waypoint must be
    straight: after the arrival it crosses no border.
    """
    transit, given = turning.c.structure.physical.transit(entity), turning.commanded.flights.get(entity)
    at = turning.where_seen(entity)
    if transit is None or given is None or at is None:
        return False
    if not given.obeyed or (isinstance(given.command, Follow) and not given.through):
        return False
    if transit.to not in turning.around(entity, turning.c.setting.kind(entity), at):
        return False  # most positions are of vehicles on their way: don't check their companions
    flights = turning.commanded.flights
    together = sorted(name for name, each in flights.items() if each.agent == given.agent)
    if not all(flies(turning, other) and flights[other].obeyed for other in together):
        return False
    if not all(_is_there(turning, other) for other in together):
        return False
    sight = Sight(
        f"{entity} arrives", {placement_cell(other): turning.where_seen(other) for other in together}
    )
    if not observe(turning, sight, arriving(turning.c, given.agent, sight)):
        return False
    turning.commanded = turning.commanded.arrived(together)
    return True


def flies(turning: Turning, entity: Name) -> bool:
    """Return whether the command of a vehicle in flight is still valid."""
    given = turning.commanded.flights.get(entity)
    if given is None or given.refused or entity in turning.overrides.taken:
        return False
    return not turning.overrides.stops(given.agent)


def _is_there(turning: Turning, entity: Name) -> bool:
    """Return whether the straight way from a vehicle's last position to its waypoint keeps to its surroundings.

    It must also be in its band, and as near to its waypoint as the mission says that it strays.
    """
    given, at = turning.commanded.flights[entity], turning.where_seen(entity)
    if not isinstance(at, Placed) or not isinstance(given.command, GoTo | Follow):
        return True
    assert given.way is not None
    if not keeps_near(turning, entity, at.geometry, given.way.end) or not is_level(turning, entity):
        return False
    assert given.goal is not None
    around = replace(given.command.around, inside=(given.goal, *given.command.around.inside))
    to = given.waypoint or standing(at.geometry, given.goal, around, 0.0)
    return given.goal.is_point or (to is not None and leads_straight(at.geometry, at.geometry, to, around))


def obey(turning: Turning, entity: Name, report: Accepted | Arrived) -> None:
    """Record that a vehicle follows the command of a request, or has completed it."""
    before = turning.commanded
    turning.commanded = before.obeyed(entity, report)
    if turning.commanded is not before:
        arrive(turning, entity)


def doubt(turning: Turning, entity: Name) -> None:
    """Record that it is unknown whether a vehicle still follows its command."""
    turning.commanded = turning.commanded.doubted(entity)


def refuse(turning: Turning, entity: Name, request: str) -> None:
    """Record that the command of a request was refused."""
    turning.commanded = turning.commanded.refused(entity, request)


def ask_anew(turning: Turning, entity: Name) -> None:
    """Command a vehicle again after it was given back, if its request is still pending."""
    turning.commanded = turning.commanded.handed_over(entity)  # the hand-over is ordered again in its turn
    given = turning.commanded.flights.get(entity)
    if given is None or turning.overrides.stops(given.agent):
        return
    fly = _flight(turning, given)
    if fly is None or isinstance(given.command, HandOver):
        return
    going = renewed(turning.c, fly, given.command, turning.plan.first) or given.command
    command = replace(going, request=turning.request_of(given.agent))
    again = GivenCommand(command, given.agent, given.since, begin=_seen_at(turning, entity))
    turning.commanded = turning.commanded.flying(entity, again)
    turning.command(command)


def renew(turning: Turning, place: Name) -> None:
    """Redirect vehicles when a place on their path, or one that they must keep out of, has moved.

    If a place has moved over a vehicle, the vehicle arrives once it shows that it goes to the place's new position.
    """
    for entity, given in sorted(turning.commanded.flights.items()):
        if turning.c.structure.physical.transit(entity) is not None and flies(turning, entity):
            _send_on(turning, entity, given, place)


def _send_on(turning: Turning, entity: Name, given: GivenCommand, place: Name) -> None:
    fly, transit = _flight(turning, given), turning.c.structure.physical.transit(entity)
    if fly is None or transit is None or isinstance(given.command, HandOver):
        return
    if place not in (transit.to, *fly.reaction.via) and isinstance(given.command, Follow):
        return  # it would fly its whole way again
    command = renewed(turning.c, fly, given.command, turning.plan.first)
    if command is not None:
        renewed_from = _seen_at(turning, entity) or given.begin
        again = GivenCommand(command, given.agent, given.since, begin=renewed_from)
        turning.commanded = turning.commanded.flying(entity, again)
        turning.command(command)


def begin_of(turning: Turning, entity: Name) -> Geometry | None:
    """Return the point from which a new command leads a vehicle: its last point, the mission's, or where it is seen."""
    rest = turning.commanded.rests.get(entity)
    if rest is not None:
        return rest.end
    return turning.commanded.begins.get(entity) or _seen_at(turning, entity)


def _seen_at(turning: Turning, entity: Name) -> Geometry | None:
    at = turning.where_seen(entity)
    return centroid(at.geometry) if isinstance(at, Placed) else None


def _flight(turning: Turning, given: GivenCommand) -> FLY | None:
    fly = next((p.request for p in in_turn(turning.c) if p.request.agent == given.agent), None)
    return fly if isinstance(fly, FLY) else None


def remember(turning: Turning, request: Request) -> None:
    """Adopt another run's command for a request; a vehicle that confirms it is not commanded again."""
    if isinstance(request, FLY):
        _remember_flight(turning, request)
    elif isinstance(request, CTR):
        way = next(realisations(turning.c, request), None)
        vehicles = frozenset(turning.plan.vehicles)
        for each in needed_hand_overs(turning.c, request, way, vehicles) if way is not None else ():
            command = replace(each, request=turning.request_of(request.agent))
            turning.commanded = turning.commanded.handing_over(
                each.entity, GivenCommand(command, request.agent, turning.now)
            )


def _remember_flight(turning: Turning, fly: FLY) -> None:
    found = commits(turning.c, fly)
    for node, place in found.flying if found is not None else ():
        assert found is not None
        going = journey(turning.c, found, node, place, turning.request_of(fly.agent), turning.plan.first)
        if going is not None:
            rest, transit = turning.commanded.rests.get(node), turning.c.structure.physical.transit(node)
            origin = None if transit is None else centroid(transit.origin.geometry)
            begin = origin if rest is None else rest.end
            given = GivenCommand(going, fly.agent, turning.now, begin=begin)
            turning.commanded = turning.commanded.flying(node, given)
