"""Choose the next step: agents take turns at a limited pace, requests are served first come, first served."""

from __future__ import annotations

from collections.abc import Iterator

from adapters.live.state import Pace
from semantics.extension import migrate, rcv_msg, req_mgr, req_snd, snd, spawn
from semantics.rules import Rule, actuate, command, fun, rcv_obs, req_ctr, req_obs, sense
from semantics.state.configuration import Configuration, Transition
from semantics.state.eta import PendingRequest
from semantics.state.requests import CTR, FLY, MGR, OBS, READY, SND
from semantics.state.signature import Name
from semantics.successors import remembered

OWN: tuple[Rule, ...] = (fun, req_obs, rcv_obs, req_ctr, req_snd, rcv_msg, req_mgr, spawn)
"""The rules of an agent's own steps; they do not wait in the queue of requests."""

SERVING: dict[type, tuple[Rule, ...]] = {
    OBS: (sense,),
    CTR: (actuate, command),
    SND: (snd,),
    MGR: (migrate,),
}
"""The rules that serve each kind of request. A flight ends by an observation."""

STEPS_PER_SECOND = 8.0
"""The most own steps of an agent a second: one that observes in a loop observes about twice a second."""

PATIENCE = 0.02
"""The shortest wait, in seconds, of an agent that is too fast."""

BURST = 100.0
"""The most own steps of an agent at once."""


def own_steps(c: Configuration, a: Name) -> tuple[Transition, ...]:
    """Return an agent's own possible steps; raises Fault if its computation fails."""
    found = (transition for rule in OWN for transition in rule(c, a))
    return tuple(dict.fromkeys(found))


def in_turn(c: Configuration) -> Iterator[PendingRequest]:
    """Yield the requests that may be served, oldest first: the head of each agent's line, and all messages."""
    headed: set[Name] = set()
    for pending in c.eta.all():
        request = pending.request
        if isinstance(request, SND):
            yield pending
        elif not isinstance(request, READY) and request.agent not in headed:
            headed.add(request.agent)
            yield pending


def to_serve(c: Configuration) -> Iterator[PendingRequest]:
    """Yield the requests in turn that rules serve, from the queue alone: flights end by themselves, and can be many."""
    headed: set[Name] = set()
    for pending in c.eta.queued():
        agent = pending.request.agent
        if isinstance(pending.request, SND):
            yield pending
        elif agent not in headed:
            headed.add(agent)
            if not any(isinstance(each.request, FLY) for each in c.eta.own(agent)):
                yield pending


def served(c: Configuration, pending: PendingRequest) -> tuple[Transition, ...]:
    """Return the transitions that serve a request."""
    rules = SERVING.get(type(pending.request), ())
    found = (transition for rule in rules for transition in rule(c, pending.request.agent))
    return tuple(dict.fromkeys(remembered(c, t) for t in found if t.served == pending))


def flights(c: Configuration) -> Iterator[FLY]:
    """Yield the flights that may end: those at the heads of their lines."""
    for pending in in_turn(c):
        if isinstance(pending.request, FLY):
            yield pending.request


def refilled(pace: Pace | None, now: float) -> Pace:
    """Return an agent's pace as of now."""
    if pace is None:
        return Pace(BURST, now)
    return Pace(min(BURST, pace.tokens + max(0.0, now - pace.at) * STEPS_PER_SECOND), now)
