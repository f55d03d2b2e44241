"""Time limits of requests, and the fallback after each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from adapters.live.scheduling import in_turn
from adapters.live.state import Waiting
from adapters.live.turn import Turning
from semantics.behaviours.durations import duration_text
from semantics.contingencies import Fallback, TimeLimit
from semantics.state.configuration import Configuration
from semantics.state.requests import SND
from semantics.state.signature import Name


def check_limits(turning: Turning) -> None:
    """Report the requests that have waited too long, and fall back as the mission says."""
    limits = turning.plan.precautions.limits
    if not limits:
        return
    turning.heads = heads_of(turning.c, turning.heads, turning.now)
    for agent, waiting in sorted(turning.heads.items()):
        kind = type(waiting.request).__name__
        for limit in (each for each in limits if each.covers(kind, waiting.request.agent)):
            _check(turning, agent, waiting, limit)


def heads_of(c: Configuration, known: Mapping[str, Waiting], now: float) -> dict[str, Waiting]:
    """Return since when each request is at the head of its agent's line, and each message in transit."""
    found = {}
    for pending in in_turn(c):
        request = pending.request
        key = f"{request.agent} {request}" if isinstance(request, SND) else request.agent
        before = known.get(key)
        same = before is not None and before.request == request
        found[key] = before if before is not None and same else Waiting(request, now)
    return found


def _check(turning: Turning, key: str, waiting: Waiting, limit: TimeLimit) -> None:
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
    turning.heads[key] = replace(turning.heads[key], late=(*turning.heads[key].late, limit.seconds))
    if limit.fallback is not Fallback.CONTINUE:
        turning.grounded.add(agent)
        turning.fall_back(limit.fallback, vehicles_of(turning, agent))


def due_fallback(turning: Turning, entity: Name) -> Fallback:
    """Return what the mission has a vehicle do whose flight it does not command any more; else to continue."""
    if turning.suspended:
        return turning.plan.precautions.on_broken
    agents = [agent for agent in turning.grounded if entity in vehicles_of(turning, agent)]
    limits = (
        [limit for limit in turning.plan.precautions.limits if limit.agent in (None, *agents)]
        if agents
        else []
    )
    asked = {limit.fallback for limit in limits}
    return next((each for each in (Fallback.RETURN, Fallback.HOLD) if each in asked), Fallback.CONTINUE)


def vehicles_of(turning: Turning, agent: Name) -> tuple[Name, ...]:
    """Return the vehicles of an agent's request: those that it has sent, else its host."""
    sent = {entity for entity, order in turning.orders.items() if order.agent == agent}
    sent |= {entity for entity, order in turning.handing.items() if order.agent == agent}
    host = {turning.c.alpha.host(agent)} if agent in turning.c.alpha else set()
    return tuple(sorted(sent or host & turning.plan.vehicles.keys()))
