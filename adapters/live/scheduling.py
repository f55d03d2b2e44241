"""Choose the next step: agents take turns at a limited pace, requests are served first come, first served."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from semantics.bigactor_rules import migrate, rcv_msg, req_mgr, req_snd, snd, spawn
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


@dataclass(frozen=True, slots=True)
class Pace:
    """The number of own steps that an agent may take at once, as of a time."""

    tokens: float
    at: float

    def spent(self) -> Pace:
        """Return the pace after one step."""
        return replace(self, tokens=self.tokens - 1)


@dataclass(frozen=True, slots=True)
class AgentProgress:
    """How far the agents of a run have come.

    Attributes:
        idle: Agents without own steps: they wait for an observation, a message, or for ever.
        failed: Agents whose computation failed.
        paces: The pace of each agent.
        last: The agent that took the last step: the next turn begins with the one after it.
        quiet: The configuration in which no more requests could be served, None if that is not known.
    """

    idle: frozenset[Name] = frozenset()
    failed: frozenset[Name] = frozenset()
    paces: Mapping[Name, Pace] = field(default_factory=dict)
    last: Name = ""
    quiet: Configuration | None = None

    def pace(self, agent: Name, now: float) -> Pace:
        """Return an agent's pace as of now."""
        known = self.paces.get(agent)
        if known is None:
            return Pace(BURST, now)
        return Pace(min(BURST, known.tokens + max(0.0, now - known.at) * STEPS_PER_SECOND), now)

    def paced(self, agent: Name, pace: Pace) -> AgentProgress:
        """Return the value with an agent's pace."""
        return replace(self, paces={**self.paces, agent: pace})

    def woken(self, agents: Iterable[Name]) -> AgentProgress:
        """Return the value in which some agents may have steps again."""
        idle = self.idle.difference(agents)
        return self if len(idle) == len(self.idle) else replace(self, idle=idle)

    def resting(self, agent: Name) -> AgentProgress:
        """Return the value in which an agent has no own steps."""
        return replace(self, idle=self.idle | {agent})

    def failing(self, agent: Name) -> AgentProgress:
        """Return the value in which an agent's computation has failed."""
        return replace(self, failed=self.failed | {agent})

    def after(self, agent: Name) -> AgentProgress:
        """Return the value after an agent's turn."""
        return self if agent == self.last else replace(self, last=agent)

    def quiet_in(self, c: Configuration) -> AgentProgress:
        """Return the value in which no more requests can be served in a configuration."""
        return self if self.quiet is c else replace(self, quiet=c)

    def looking_again(self) -> AgentProgress:
        """Return the value in which pending requests may be served again."""
        return self if self.quiet is None else replace(self, quiet=None)


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
