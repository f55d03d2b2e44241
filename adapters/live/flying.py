"""Flights: when they end, when their place has moved on, and what is known of them in a run that is resumed."""

from __future__ import annotations

from dataclasses import replace

from adapters.live.orders import hand_overs, journey, renewed
from adapters.live.serving import in_turn
from adapters.live.state import Order
from adapters.live.turning import Turning
from adapters.plugin import Follow, HandOver
from semantics.control import commits, realisations
from semantics.observed import Sight, arriving
from semantics.physical_model import placement_cell
from semantics.requests import CTR, FLY, Request
from semantics.signature import Name


def arrive(turning: Turning, entity: Name) -> bool:
    """Commit the flight of a vehicle if it was seen where it was to go, and whoever flies with it too.

    Who was told a path may come through its destination on the way: it has to have said that the path is behind it.
    """
    transit, order = turning.c.structure.physical.transit(entity), turning.orders.get(entity)
    at = turning.where_seen(entity)
    if transit is None or order is None or at is None or order.agent in turning.grounded:
        return False
    if isinstance(order.command, Follow) and not order.through:
        return False
    if transit.to not in turning.around(entity, turning.c.setting.kind(entity), at):
        return False
    together = sorted(other for other, told in turning.orders.items() if told.agent == order.agent)
    sight = Sight(
        f"{entity} arrives", {placement_cell(other): turning.where_seen(other) for other in together}
    )
    if not turning.observe(sight, arriving(turning.c, order.agent, sight)):
        return False
    for other in together:
        del turning.orders[other]
    return True


def come_through(turning: Turning, entity: Name, request: str) -> None:
    """Note that a vehicle has the path behind it that it was told by a request."""
    order = turning.orders.get(entity)
    if order is not None and order.command.request == request:
        turning.orders[entity] = replace(order, through=True)
        arrive(turning, entity)


def renew(turning: Turning, place: Name) -> None:
    """Send vehicles on where a place that they go to or pass has moved, and let those arrive that it has reached."""
    physical = turning.c.structure.physical
    for entity, order in sorted(turning.orders.items()):
        transit = physical.transit(entity)
        if transit is None or turning.suspended or order.agent in turning.grounded:
            continue
        if transit.to != place or not arrive(turning, entity):
            _send_on(turning, entity, order, place)


def _send_on(turning: Turning, entity: Name, order: Order, place: Name) -> None:
    fly = next((p.request for p in in_turn(turning.c) if p.request.agent == order.agent), None)
    if not isinstance(fly, FLY) or isinstance(order.command, HandOver):
        return
    transit = turning.c.structure.physical.transit(entity)
    if transit is None or place not in (transit.to, *fly.reaction.via):
        return
    command = renewed(turning.c, fly, order.command)
    if command is not None:
        turning.orders[entity] = replace(order, command=command, through=False)
        turning.commands.append(command)


def remember(turning: Turning, request: Request) -> None:
    """Take up what vehicles were told for a request in another run; who confirms it is not told again."""
    if isinstance(request, FLY):
        _remember_flight(turning, request)
    elif isinstance(request, CTR):
        way = next(realisations(turning.c, request), None)
        vehicles = frozenset(turning.plan.vehicles)
        for told in hand_overs(turning.c, request, way, vehicles) if way is not None else ():
            command = replace(told, request=turning.request_of(request.agent))
            turning.handing[told.entity] = Order(command, request.agent, turning.now)


def _remember_flight(turning: Turning, fly: FLY) -> None:
    found = commits(turning.c, fly)
    for node, place in found.flying if found is not None else ():
        assert found is not None
        going = journey(turning.c, found, node, place, turning.request_of(fly.agent))
        if going is not None:
            turning.orders[node] = Order(going, fly.agent, turning.now)
