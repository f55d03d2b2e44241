"""Due times of a run: ends of waits, time limits of requests, and the clocks of the section `timing`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from adapters.live.timing_monitor import Timers, begun
from semantics.state.configuration import Configuration
from semantics.state.requests import Request
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class HeadRequest:
    """The request at the head of an agent's line: its start there, and the limits that it has exceeded."""

    request: Request
    since: float
    late: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class DueTimes:
    """The due times of a run.

    Attributes:
        timeouts: The end of each agent's wait at a `react` with an `after` branch.
        heads: The head of each agent's line.
        timers: The clocks of the mission's timing; None before the start, and in a mission without timing.
        stopped: Start of the standstill of a killed run that is resumed; None otherwise.
    """

    timeouts: Mapping[Name, float] = field(default_factory=dict)
    heads: Mapping[str, HeadRequest] = field(default_factory=dict)
    timers: Timers | None = None
    stopped: float | None = None

    def timing_out(self, agent: Name, until: float) -> DueTimes:
        """Return the value in which an agent's wait ends at a time; a wait that has begun is kept."""
        return self if agent in self.timeouts else replace(self, timeouts={**self.timeouts, agent: until})

    def waited(self, agent: Name) -> DueTimes:
        """Return the value without an agent's wait, which is over."""
        if agent not in self.timeouts:
            return self
        return replace(self, timeouts={name: at for name, at in self.timeouts.items() if name != agent})

    def served(self, agent: Name) -> DueTimes:
        """Return the value after the request at the head of an agent's line is served."""
        if agent not in self.heads:
            return self
        return replace(self, heads={key: each for key, each in self.heads.items() if key != agent})

    def with_heads(self, heads: Mapping[str, HeadRequest]) -> DueTimes:
        """Return the value with the heads of all lines."""
        return replace(self, heads=heads)

    def late(self, key: str, seconds: float) -> DueTimes:
        """Return the value in which a request has exceeded a limit."""
        waiting = self.heads[key]
        return self.with_heads({**self.heads, key: replace(waiting, late=(*waiting.late, seconds))})

    def with_timers(self, timers: Timers) -> DueTimes:
        """Return the value with other clocks."""
        return replace(self, timers=timers)

    def running(self, c: Configuration, now: float) -> DueTimes:
        """Return the value with running clocks: begun now, or resumed."""
        if self.timers is None:
            return replace(self, timers=begun(c, now), stopped=None)
        if self.stopped is None:
            return self
        return replace(self, timers=self.timers.resting(self.stopped, now), stopped=None)

    def later(self, seconds: float) -> DueTimes:
        """Return the value with all times shifted by a time without listening."""
        timeouts = {agent: at + seconds for agent, at in self.timeouts.items()}
        heads = {name: replace(each, since=each.since + seconds) for name, each in self.heads.items()}
        timers = None if self.timers is None else self.timers.later(seconds)
        return DueTimes(timeouts, heads, timers, self.stopped)
