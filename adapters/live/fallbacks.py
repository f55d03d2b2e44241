"""Broken assumptions and late requests, and the mission's fallback: it commands vehicles to hold or to return."""

from __future__ import annotations

from collections.abc import Mapping

from adapters.live.command_planning import is_authority, stopping
from adapters.live.due_times import HeadRequest
from adapters.live.overrides import StandingOrder
from adapters.live.scheduling import in_turn
from adapters.live.turn_in_progress import Turning
from semantics.behaviours.durations import duration_text
from semantics.live_policy import Fallback, TimeLimit
from semantics.state.configuration import Configuration
from semantics.state.requests import SND
from semantics.state.signature import Name
from semantics.state.station_partition import HERE, is_parted


def breaks(
    turning: Turning,
    assumption: str,
    about: Name,
    kind: str = "broken assumption",
    response: Fallback | None = None,
) -> None:
    """Report a broken assumption, or another end of a flight, and respond with a fallback: by default the mission's."""
    if not answers_for(turning, about):
        return
    fallback = turning.plan.precautions.on_broken if response is None else response
    found = turning.find(kind, about, assumption, fallback.value, once=True)
    if found and not turning.overrides.suspended:
        fall_back(turning, fallback, tuple(sorted(turning.plan.vehicles)))
        if fallback is not Fallback.CONTINUE:
            turning.overrides = turning.overrides.suspending()


def fall_back(turning: Turning, fallback: Fallback, entities: tuple[Name, ...]) -> None:
    """Command the mission's fallback to vehicles; a vehicle on its way home does not stop."""
    if fallback is Fallback.CONTINUE:
        return
    for entity in entities:
        if not answers_for(turning, entity):
            continue
        if fallback is Fallback.HOLD and flies_home(turning, entity):
            message = f"{entity} is not commanded to hold: it was commanded to return before"
            turning.find("trouble", entity, message, once=True)
        elif entity in turning.overrides.taken:
            message = f"{entity} is not commanded to {fallback.value}: {_override(turning, entity)}"
            turning.find("taken over", entity, message, once=True)
        else:
            _command(turning, fallback, entity)


def _override(turning: Turning, entity: Name) -> str:
    """Return the reason why the mission does not command a vehicle."""
    order = turning.overrides.orders.get(entity)
    return "it was taken over" if order is None else f"{order.orderer} ordered it to {order.action}"


def _command(turning: Turning, fallback: Fallback, entity: Name) -> None:
    """Command a fallback; it ends a hand-over, which the vehicle's agent may order again."""
    command = stopping(fallback, turning.request_of("fallback"), entity)
    turning.overrides = turning.overrides.ordered(entity, StandingOrder(command, by=None))
    turning.command(command)
    if entity in turning.commanded.hand_overs:
        turning.commanded = turning.commanded.handed_over(entity)
        turning.agents = turning.agents.looking_again()


def due_fallback(turning: Turning, entity: Name) -> Fallback:
    """Return the mission's standing fallback for a vehicle; `CONTINUE` if the mission commands its flight."""
    due = {turning.plan.precautions.on_broken} if turning.overrides.suspended else set()
    agents = [agent for agent in turning.overrides.grounded if entity in vehicles_of(turning, agent)]
    if agents:
        limits = turning.plan.precautions.limits
        due |= {limit.fallback for limit in limits if limit.agent in (None, *agents)}
    return next((each for each in (Fallback.RETURN, Fallback.HOLD) if each in due), Fallback.CONTINUE)


def flies_home(turning: Turning, entity: Name) -> bool:
    """Return whether the mission's fallback sends a vehicle home."""
    return entity in turning.plan.vehicles and due_fallback(turning, entity) is Fallback.RETURN


def vehicles_of(turning: Turning, agent: Name) -> tuple[Name, ...]:
    """Return the vehicles of an agent's request: those that it has sent, else its host."""
    sent = turning.commanded.serving(agent)
    host = {turning.c.alpha.host(agent)} if agent in turning.c.alpha else set()
    return tuple(sorted(sent or host & turning.plan.vehicles.keys()))


def answers_for(turning: Turning, entity: Name) -> bool:
    """Return whether this station alone commands a vehicle and reports on it."""
    if not is_parted(turning.c) or entity not in turning.plan.vehicles:
        return True
    if turning.plan.vehicles[entity] == turning.plan.peers:
        return False
    physical = turning.before.configuration.structure.physical
    authority = set(filter(is_authority, physical.channels(entity)))
    return not authority or not authority.isdisjoint(physical.channels(turning.c.read(HERE)))


def check_limits(turning: Turning) -> None:
    """Report the requests that have waited too long, and take the mission's fallback."""
    limits = turning.plan.precautions.limits
    if not limits:
        return
    turning.due = turning.due.with_heads(heads_of(turning.c, turning.due.heads, turning.now))
    for agent, waiting in sorted(turning.due.heads.items()):
        kind = type(waiting.request).__name__
        for limit in (each for each in limits if each.covers(kind, waiting.request.agent)):
            _check(turning, agent, waiting, limit)


def heads_of(c: Configuration, known: Mapping[str, HeadRequest], now: float) -> dict[str, HeadRequest]:
    """Return the start of each request's wait at the head of its agent's line, and of each message in transit."""
    found = {}
    for pending in in_turn(c):
        request = pending.request
        key = f"{request.agent} {request}" if isinstance(request, SND) else request.agent
        before = known.get(key)
        same = before is not None and before.request == request
        found[key] = before if before is not None and same else HeadRequest(request, now)
    return found


def _check(turning: Turning, key: str, waiting: HeadRequest, limit: TimeLimit) -> None:
    due = waiting.since + limit.seconds
    if limit.seconds in waiting.late:
        return
    if turning.now < due:
        turning.wake(due)
        return
    agent = waiting.request.agent
    message = (
        f"{waiting.request} waits for {turning.now - waiting.since:.0f} s, "
        f"longer than {duration_text(limit.seconds)}"
    )
    turning.find("late", agent, message, limit.fallback.value)
    turning.due = turning.due.late(key, limit.seconds)
    if limit.fallback is not Fallback.CONTINUE:
        fall_back(turning, limit.fallback, vehicles_of(turning, agent))
        turning.overrides = turning.overrides.grounding(agent)
