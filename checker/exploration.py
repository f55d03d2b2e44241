"""The reference explorer: breadth-first, exact and simple; the yardstick for every faster one.

It visits each configuration once, in the order of its distance from the first, so a path to it is a shortest one.
"""

import time
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from enum import Enum

from checker.edges import Edges
from semantics.configuration import Configuration, Transition
from semantics.successors import Expansion, expand

MOST_PENDING = 64
"""Requests of one agent, or messages in one mailbox, beyond which a configuration is not explored further."""

INTERRUPTION = "an interruption"
"""The bound that is met where the user has asked for the end."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Where an exploration stops: then it is *incomplete*, and says so.

    Attributes:
        configurations: How many are visited at most.
        seconds: For how long.
        pending: How many requests an agent may have pending, or messages in its mailbox.
        spent: How many of the seconds are gone already.
    """

    configurations: int | None = 2_000_000
    seconds: float | None = None
    pending: int = MOST_PENDING
    spent: float = 0.0


@dataclass(frozen=True, slots=True)
class Progress:
    """How far an exploration has come; `rate` is in configurations a second."""

    configurations: int
    transitions: int
    depth: int
    frontier: int
    rate: float


class Engine(Enum):
    """How configurations are expanded; the results are the same."""

    REFERENCE = "reference"
    FAST = "fast"


Inspect = Callable[[int, Configuration, Expansion], None]
"""What looks at each configuration as it is expanded, given its number."""


@dataclass(slots=True)
class Exploration:
    """What was explored.

    Attributes:
        configurations: In the order of discovery; the first is the initial one.
        origins: For each, the number of the one that it was first reached from (of the initial one, its own).
        depth: How far the farthest is from the initial one.
        expanded: How many of them were expanded: all, unless time ran out.
        transitions: How many transitions there are.
        rules: How many transitions each rule has.
        bounds: The limits that were met; empty where the exploration is complete.
        seconds: How long it took.
        rule_runs: How often an actor's rules were run in Python, where they were learned.
        edges: Every transition, where they were asked for.
    """

    configurations: Sequence[Configuration]
    origins: Sequence[int]
    depth: int = 0
    expanded: int = 0
    transitions: int = 0
    rules: Counter[str] = field(default_factory=Counter)
    bounds: list[str] = field(default_factory=list)
    seconds: float = 0.0
    rule_runs: int | None = None
    edges: Edges | None = None

    @property
    def complete(self) -> bool:
        """Whether everything reachable was visited."""
        return not self.bounds

    def path(self, number: int) -> tuple[int, ...]:
        """Return the numbers of the configurations on a shortest path to one, both ends included."""
        path = [number]
        while path[-1] > 0:
            path.append(int(self.origins[path[-1]]))
        return tuple(reversed(path))


Report = Callable[[Progress], None]
"""What is told of the progress."""


def explore(  # noqa: PLR0913 - each is optional, and named where it is used
    initial: Configuration,
    inspect: Iterable[Inspect] = (),
    limits: Limits | None = None,
    report: Report | None = None,
    every: float = 0.5,
    engine: Engine = Engine.REFERENCE,
    *,
    edges: bool = False,
) -> Exploration:
    """Visit everything that is reachable, breadth-first.

    Args:
        initial: Where to start.
        inspect: Called with each configuration as it is expanded, in the order of discovery.
        limits: Where to stop.
        report: Called about once in `every` seconds.
        every: Seconds.
        engine: Whether the rules are run everywhere, or once for each way in which they look at cells.
        edges: Whether every transition is kept, as temporal properties need: by the reference explorer alone.
    """
    if engine is Engine.FAST and not edges:
        from checker.fast.explorer import explore_fast  # noqa: PLC0415  # numba takes its time to load

        return explore_fast(initial, tuple(inspect), limits or Limits(), report, every)
    explorer = _Explorer(initial, tuple(inspect), limits or Limits(), report, every)
    explorer.found.edges = Edges() if edges else None
    return explorer.run()


class _Explorer:
    def __init__(
        self,
        initial: Configuration,
        inspect: tuple[Inspect, ...],
        limits: Limits,
        report: Report | None,
        every: float,
    ) -> None:
        self.configurations = [initial]
        self.origins = [0]
        self.depths = [0]
        self.found = Exploration(self.configurations, self.origins)
        self.numbers = {initial: 0}
        self.inspect = inspect
        self.limits = limits
        self.report = report
        self.every = every

    def run(self) -> Exploration:
        started = time.monotonic()
        try:
            self.visit_all(started)
        except KeyboardInterrupt:
            self.bound(INTERRUPTION)
        self.found.seconds = time.monotonic() - started
        self.found.depth = self.depths[-1]
        self.found.bounds.sort()
        return self.found

    def visit_all(self, started: float) -> None:
        reported = started
        for number, configuration in enumerate(self.configurations):  # grows while it is gone through
            now = time.monotonic()
            most = self.limits.seconds
            if most is not None and now - started + self.limits.spent > most:
                self.bound(time_met(most))
                break
            if self.report is not None and now - reported >= self.every:
                self.report(self.progress(number, now - started))
                reported = now
            self.expand(number, configuration)

    def expand(self, number: int, configuration: Configuration) -> None:
        expansion = expand(configuration)
        self.found.expanded = number + 1
        for look in self.inspect:
            look(number, configuration, expansion)
        if crowded(configuration, self.limits.pending):
            self.bound(crowd_met(self.limits.pending))
            self.missing(number)
        else:
            for transition in expansion.transitions:
                self.follow(number, transition)
        if self.found.edges is not None:
            self.found.edges.close()

    def follow(self, number: int, transition: Transition) -> None:
        found, label = self.found, transition.label
        found.transitions += 1
        found.rules[label.rule] += 1
        target = self.numbers.get(transition.target)
        if target is None:
            most = self.limits.configurations
            if most is not None and len(self.configurations) >= most:
                self.bound(limit_met(most))
                self.missing(number)
                return
            target = self.numbers[transition.target] = len(self.configurations)
            self.configurations.append(transition.target)
            self.origins.append(number)
            self.depths.append(self.depths[number] + 1)
        if found.edges is not None:
            found.edges.add(label, target)

    def missing(self, number: int) -> None:
        if self.found.edges is not None:
            self.found.edges.partial.add(number)

    def bound(self, reason: str) -> None:
        if reason not in self.found.bounds:
            self.found.bounds.append(reason)

    def progress(self, number: int, seconds: float) -> Progress:
        found = self.found
        total, rate = len(self.configurations), number / max(seconds, 1e-9)
        return Progress(total, found.transitions, self.depths[number], total - number, rate)


def limit_met(most: int) -> str:
    """Say that there are more configurations than were to be visited."""
    return f"the limit of {most:,} configurations"


def time_met(seconds: float) -> str:
    """Say that the time was over."""
    return f"the time limit of {seconds:g} s"


def crowd_met(most: int) -> str:
    """Say that more is pending than is followed."""
    return f"more than {most} requests or messages of one agent pending"


def crowded(c: Configuration, most: int) -> bool:
    """Tell whether some agent has more pending requests or messages than are explored."""
    return any(len(c.eta.of(a)) > most or len(c.alpha.mailbox(a)) > most for a in c.alpha.names())
