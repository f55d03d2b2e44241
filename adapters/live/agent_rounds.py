"""Let agents take own steps, one each in turn, and serve their requests."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import replace

from adapters.live.command_planning import is_done, journey, needed_hand_overs, unshown
from adapters.live.commanded import GivenCommand
from adapters.live.flying import begin_of
from adapters.live.scheduling import PATIENCE, STEPS_PER_SECOND, own_steps, served, to_serve
from adapters.live.step_taking import take
from adapters.live.turn_in_progress import Turning
from adapters.plugin import HandOver
from semantics.behaviours.expressions import Fault
from semantics.behaviours.process_conversion import next_statement
from semantics.behaviours.statements import React
from semantics.bigactor_rules import timeout
from semantics.control import Realisation, obstacle, realisations
from semantics.state.configuration import Configuration, Transition
from semantics.state.eta import PendingRequest
from semantics.state.requests import CTR
from semantics.state.signature import REGION, Name
from semantics.state.station_partition import is_here

Service = tuple[tuple[Transition, ...], bool]
"""The transitions that serve a request now, and whether it could be served but for a vehicle or an operator."""


def serve(turning: Turning) -> bool:
    """Serve the first request that can be served, oldest first; return whether there was one."""
    if turning.agents.quiet is turning.c:
        return False
    for pending in to_serve(turning.c):
        found, waits = _service(turning, pending)
        if found:
            take(turning, found[0], found)
            return True
        if waits and turning.plan.strict:
            return False
    turning.agents = turning.agents.quiet_in(turning.c)
    return False


def _service(turning: Turning, pending: PendingRequest) -> Service:
    request = pending.request
    found = served(turning.c, pending)
    if not isinstance(request, CTR):
        unseen = turning.sightings.unseen  # each answer misses more entities than those before
        return tuple(each for each in reversed(found) if unseen.issuperset(each.label.missed)), False
    if turning.overrides.stops(request.agent):
        return (), bool(found)
    if not found:
        _blocked(turning, request)
        return (), False
    ways = realisations(turning.c, request)
    way = next(way for way in ways if not (way.flying and way.waits(turning.c)))
    return _controlled(turning, request, way, found)


def _blocked(turning: Turning, request: CTR) -> None:
    reason = obstacle(turning.c, request)
    if reason is not None:
        message = f"{request} is {reason.value}{_astray(turning.c, request)}; it stays pending"
        turning.find("blocked", request.agent, message, once=True)


def _astray(c: Configuration, request: CTR) -> str:
    """Return where L and P have the nodes that a control moves, as a suffix; empty if they agree."""
    logical, physical = c.structure.logical, c.structure.physical
    moved = [node for node, _ in request.reaction.moves if isinstance(node, str)]
    known = [node for node in moved if node in logical and node in physical]
    pairs = [(node, logical.parent(node), physical.abstract_parent(node)) for node in known]
    return "".join(
        f": {node} is believed in {_named(believed)} and is in {_named(actual)}"
        for node, believed, actual in pairs
        if believed != actual
    )


def _named(place: Name | None) -> str:
    return "none of the places" if place is None or place == REGION else place


def _controlled(turning: Turning, request: CTR, way: Realisation, found: tuple[Transition, ...]) -> Service:
    """Give the commands of a control, and return its transition once it may be taken."""
    unseen = unshown(turning.c, request, way, frozenset(turning.plan.vehicles))
    if unseen:
        turning.find("blocked", request.agent, f"{request}: {unseen}; it stays pending", once=True)
        return (), True
    goes = _set_out(turning, request, way) if way.flying else _hand_over(turning, request, way)
    return (found, False) if goes else ((), True)


def _set_out(turning: Turning, request: CTR, way: Realisation) -> bool:
    """Command the flights of a control; return whether all vehicles hear, and know where to go."""
    for node, _ in way.flying:
        if not _hears(turning, node):
            return False
    for node, place in way.flying:
        name, first = turning.request_of(request.agent), turning.plan.first
        going = journey(turning.c, way, node, place, name, first)
        if going is None:
            return False
        given = GivenCommand(going, request.agent, turning.now, begin=begin_of(turning, node))
        turning.commanded = turning.commanded.flying(node, given)
        turning.command(going)
    return True


def _hand_over(turning: Turning, request: CTR, way: Realisation) -> bool:
    """Command the hand-overs of a control; return whether all are confirmed."""
    needed = needed_hand_overs(turning.c, request, way, frozenset(turning.plan.vehicles))
    waiting = [each for each in needed if not _confirmed(turning, each)]
    for each in waiting:
        _command_hand_over(turning, each, request.agent)
    if waiting:
        return False
    for each in needed:
        turning.commanded = turning.commanded.handed_over(each.entity)
    return True


def _hears(turning: Turning, node: Name) -> bool:
    """Return whether a vehicle is heard and obeys the mission; report a node that is no vehicle of this station."""
    owner = turning.plan.vehicles.get(node)
    if owner is None or owner == turning.plan.peers:
        here = "" if owner is None else " at this station"
        message = f"no vehicle takes commands as {node}{here}: give --vehicle {node}=..."
        turning.find("blocked", node, message, once=True)
        return False
    heard = node in turning.sightings.newest and node not in turning.sightings.lost
    return heard and node not in turning.overrides.taken


def _confirmed(turning: Turning, hand_over: HandOver) -> bool:
    sighting = turning.sightings.newest.get(hand_over.entity)
    return sighting is not None and is_done(hand_over, sighting.property.channels)


def _command_hand_over(turning: Turning, hand_over: HandOver, agent: Name) -> None:
    """Command a hand-over, unless it was commanded before or the vehicle does not hear."""
    entity = hand_over.entity
    if entity not in turning.commanded.hand_overs and _hears(turning, entity):
        command = replace(hand_over, request=turning.request_of(agent))
        given = GivenCommand(command, agent, turning.now)
        turning.commanded = turning.commanded.handing_over(entity, given)
        turning.command(command)


def go_on(turning: Turning, most: int) -> None:
    """Let every agent take a step in turn and serve one request, until nothing more can be done now."""
    ended = []
    for agent, until in turning.due.timeouts.items():
        if until > turning.now:
            turning.wake(until)
        else:
            ended.append(agent)
    turning.agents = turning.agents.woken(ended)
    left = most
    while left > 0:
        taken = _own_steps(turning, left)
        taken += serve(turning)
        if not taken:
            return
        left -= taken
    turning.wake(turning.now)


def _own_steps(turning: Turning, most: int) -> int:
    """Let agents take one step each, beginning after the last one that took a step."""
    agents = turning.agents
    able = (a for a in turning.c.alpha.names() if a not in agents.idle and a not in agents.failed)
    going = [a for a in able if is_here(turning.c, a)]
    first = bisect_right(going, agents.last)
    taken, last = 0, agents.last
    for a in going[first:] + going[:first]:
        if taken >= most:
            break
        taken += _own_step(turning, a)
        last = a
    turning.agents = turning.agents.after(last)
    return taken


def _own_step(turning: Turning, a: Name) -> bool:
    """Let an agent take one step of its own, if its pace allows one."""
    pace = turning.agents.pace(a, turning.now)
    if pace.tokens < 1:
        turning.wake(turning.now + max(PATIENCE, (1 - pace.tokens) / STEPS_PER_SECOND))
        return False
    try:
        found = own_steps(turning.c, a) or _timeout(turning, a)
    except Fault as fault:
        turning.agents = turning.agents.failing(a)
        turning.find("failed", a, f"the computation of {a} fails: {fault}")
        return False
    if not found:
        turning.agents = turning.agents.resting(a)
        return False
    turning.agents = turning.agents.paced(a, pace.spent())
    take(turning, found[turning.number % len(found)], found)
    return True


def _timeout(turning: Turning, a: Name) -> tuple[Transition, ...]:
    """Return the timeout of an agent that has waited long enough; schedule it for one that still waits."""
    found = tuple(timeout(turning.c, a))
    if not found:
        turning.due = turning.due.waited(a)
        return ()
    react = next_statement(turning.c, a)
    assert isinstance(react, React)
    assert react.after is not None
    turning.due = turning.due.timing_out(a, turning.now + react.after.seconds)
    until = turning.due.timeouts[a]
    if turning.now < until:
        turning.wake(until)
        return ()
    return found
