"""Time limits of requests, and the fallback after each."""

from __future__ import annotations

from collections.abc import Mapping

from adapters.live.due_times import HeadRequest
from adapters.live.fallbacks import fall_back, vehicles_of
from adapters.live.scheduling import in_turn
from adapters.live.turn_in_progress import Turning
from semantics.behaviours.durations import duration_text
from semantics.live_policy import Fallback, TimeLimit
from semantics.state.configuration import Configuration
from semantics.state.requests import SND


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
