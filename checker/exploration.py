"""The reference explorer: breadth-first, exact and simple; the yardstick for every faster one.

It visits each configuration once, in the order of its distance from the first, so a path to it is a shortest one.
"""

import time
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from random import Random
from typing import TYPE_CHECKING, Protocol

from checker.edges import Edges
from checker.estimate import Estimate, estimate
from checker.limits import INTERRUPTION, Limits, crowd_met, is_full, limit_met, memory_met, time_met
from semantics.configuration import Configuration, Transition
from semantics.propositions import Proposition
from semantics.requests import Request
from semantics.successors import Expansion, expand

if TYPE_CHECKING:
    from checker.graph import Bools, Graph, Numbers
    from checker.reduction.ample import Ample


class MachineError(Exception):
    """What the machine does not give: workers that start in time and stay, room for an engine. Nothing is decided."""


class CheckpointError(Exception):
    """A checkpoint that can't be read, or that is of something else."""


@dataclass(frozen=True, slots=True)
class Keeping:
    """What is kept of an exploration, and what is doubted.

    Attributes:
        folder: Where checkpoints are written; None for nowhere.
        resumed: Whether it goes on from the checkpoint that is there.
        digest: What the checkpoint is of.
        every: Seconds between two checkpoints.
        doubted: Of how many configurations it is asked once more what follows, and whether what reductions take for
            granted is so (`--paranoid`).
        compact: How many bits of a hash stand for each configuration, where none is compared with another: some may be
            taken for others then (`--hash-compact`).
    """

    folder: str | None = None
    resumed: bool = False
    digest: str = ""
    every: float = 60.0
    doubted: int = 0
    compact: int | None = None


@dataclass(frozen=True, slots=True)
class Progress:
    """How far an exploration has come.

    Attributes:
        configurations: How many were met.
        transitions: How many were followed.
        depth: The distance of those that are being expanded.
        frontier: How many wait to be expanded.
        rate: How many are expanded in a second.
        estimate: How many there may be in all; None while nobody can say.
    """

    configurations: int
    transitions: int
    depth: int
    frontier: int
    rate: float
    estimate: Estimate | None = None

    @property
    def left(self) -> tuple[float, float] | None:
        """How many seconds it may go on, at least and at most, if layers and rate go on as they do."""
        if self.estimate is None or self.rate <= 0:
            return None
        more = self.estimate.most - self.configurations
        return self.frontier / self.rate, (self.frontier + more) / self.rate


class Engine(Enum):
    """How configurations are expanded; the results are the same."""

    REFERENCE = "reference"
    FAST = "fast"
    RAY = "ray"


@dataclass(frozen=True, slots=True)
class Cluster:
    """With whom `Engine.RAY` explores.

    Attributes:
        workers: How many processes, from 2 on.
        address: The Ray cluster that is joined (`auto` for the one of this machine); None for one of its own, here.
    """

    workers: int = 2
    address: str | None = None


class Reducer(Protocol):
    """What lets an exploration visit less: see `checker.reduction`."""

    @property
    def ample(self) -> "Ample | None":
        """What chooses the transitions that are followed, None where all are."""

    @property
    def putting_off(self) -> bool:
        """Whether steps are put off: then a trace need not be a shortest one."""

    def representative(self, c: Configuration) -> Configuration:
        """Return the configuration that stands for one."""

    def choose(
        self, c: Configuration, expansion: Expansion, later: Callable[[Transition], bool]
    ) -> tuple[Transition, ...]:
        """Return the transitions to be followed; `later` tells of one whether its target is yet to be expanded."""

    def run_to(
        self, found: "Exploration", number: int, by: Transition | None = None
    ) -> tuple[Transition, ...]:
        """Return a run of the rules to what a visited configuration stands for, and then `by`."""

    def told(self, found: "Exploration", number: int, text: str) -> str:
        """Return what is said of a visited configuration as it is said of the one that the run leads to."""

    def hold(self, c: Configuration) -> None:
        """Hold a configuration to what is taken for granted of all; raises where it is not so."""


class Surveyed(Protocol):
    """What temporal properties ask of an exploration whose configurations are not at hand one by one."""

    def graph(self) -> "Graph":
        """Return every transition of the configurations that were expanded."""

    def valuation(self, asked: Iterable[Proposition]) -> "Mapping[Proposition, Bools]":
        """Return where each proposition is true."""

    def pending(self) -> "Mapping[Request, Numbers]":
        """Return for each request the configurations in which it is pending, in their order."""


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
        edges: Every transition, where they were asked for and the reference explorer kept them.
        survey: What explorers with rows can be asked; None of the reference explorer.
        allowed: How many transitions the visited configurations allow; more than `transitions` where it was reduced.
        reducer: What made it visit less, None where it visited everything.
        start: What it started from, where another configuration stands for it.
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
    survey: Surveyed | None = None
    allowed: int = 0
    reducer: Reducer | None = None
    start: Configuration | None = None

    @property
    def size(self) -> int:
        """How many configurations were visited."""
        return len(self.configurations)

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

SEED = 20260


def sample(size: int, count: int) -> list[int]:
    """Return so many of the numbers below a size, the same in every run."""
    return sorted(Random(SEED).sample(range(size), min(count, size)))


def explore(  # noqa: PLR0913 - each is optional, and named where it is used
    initial: Configuration,
    inspect: Iterable[Inspect] = (),
    limits: Limits | None = None,
    report: Report | None = None,
    every: float = 0.5,
    engine: Engine = Engine.REFERENCE,
    *,
    edges: bool = False,
    reduce: Reducer | None = None,
    keeping: Keeping | None = None,
    cluster: Cluster | None = None,
) -> Exploration:
    """Visit everything that is reachable, breadth-first.

    Args:
        initial: Where to start.
        inspect: Called with each configuration as it is expanded, in the order of discovery.
        limits: Where to stop.
        report: Called about once in `every` seconds.
        every: Seconds.
        engine: Whether the rules are run everywhere, or once for each way in which they look at cells.
        edges: Whether every transition is kept, as temporal properties need; the fast explorer finds them again.
        reduce: What lets it visit less; by symmetry only the reference explorer can.
        keeping: What the fast explorer keeps on the way, and what is doubted.
        cluster: With whom, on several processes or machines.
    """
    if engine is Engine.RAY:
        from checker.cluster.ray_crew import explore_with_ray  # noqa: PLC0415  # Ray is an extra

        together = cluster or Cluster()
        return explore_with_ray(initial, tuple(inspect), limits or Limits(), report, every, keeping, together)
    if engine is Engine.FAST:
        from checker.fast.explorer import explore_fast  # noqa: PLC0415  # numba takes its time to load

        return explore_fast(
            initial, tuple(inspect), limits or Limits(), report, every, keeping or Keeping(), reduce
        )
    explorer = _Explorer(initial, tuple(inspect), limits or Limits(), report, every)
    explorer.found.edges = Edges() if edges else None
    if reduce is not None:
        explorer.reduce_by(reduce)
    found = explorer.run()
    if reduce is not None and keeping is not None:
        for number in sample(found.expanded, keeping.doubted):
            reduce.hold(found.configurations[number])
    return found


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
        self.layers = [1]
        self.found = Exploration(self.configurations, self.origins)
        self.numbers = {initial: 0}
        self.inspect = inspect
        self.limits = limits
        self.report = report
        self.every = every
        self.represent: Callable[[Configuration], Configuration] = _itself

    def reduce_by(self, reducer: Reducer) -> None:
        self.found.reducer, self.found.start = reducer, self.configurations[0]
        self.configurations[0] = reducer.representative(self.configurations[0])
        self.numbers = {self.configurations[0]: 0}
        self.represent = reducer.representative

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
            if number % 1024 == 0 and is_full(self.limits):
                self.bound(memory_met(self.limits))
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
            self.found.allowed += len(expansion.transitions)
            for transition in self.chosen(number, configuration, expansion):
                self.follow(number, transition)
        if self.found.edges is not None:
            self.found.edges.close()

    def chosen(self, number: int, c: Configuration, expansion: Expansion) -> tuple[Transition, ...]:
        """Return the transitions to be followed. Expansion is in the order of numbers: the later has the greater."""
        if self.found.reducer is None:
            return expansion.transitions
        numbers, represent = self.numbers, self.represent
        return self.found.reducer.choose(
            c, expansion, lambda each: numbers.get(represent(each.target), number + 1) > number
        )

    def follow(self, number: int, transition: Transition) -> None:
        found, label = self.found, transition.label
        found.transitions += 1
        found.rules[label.rule] += 1
        reached = self.represent(transition.target)
        target = self.numbers.get(reached)
        if target is None:
            most = self.limits.configurations
            if most is not None and len(self.configurations) >= most:
                self.bound(limit_met(most))
                self.missing(number)
                return
            target = self.numbers[reached] = len(self.configurations)
            self.configurations.append(reached)
            self.origins.append(number)
            self.depths.append(self.depths[number] + 1)
            self.count(self.depths[-1])
        if found.edges is not None:
            found.edges.add(label, target)

    def count(self, depth: int) -> None:
        """Count a configuration into its layer."""
        if depth == len(self.layers):
            self.layers.append(0)
        self.layers[depth] += 1

    def missing(self, number: int) -> None:
        if self.found.edges is not None:
            self.found.edges.partial.add(number)

    def bound(self, reason: str) -> None:
        if reason not in self.found.bounds:
            self.found.bounds.append(reason)

    def progress(self, number: int, seconds: float) -> Progress:
        found = self.found
        total, depth, rate = len(self.configurations), self.depths[number], number / max(seconds, 1e-9)
        guess = estimate(self.layers[: depth + 1])
        return Progress(total, found.transitions, depth, total - number, rate, guess)


def _itself(c: Configuration) -> Configuration:
    return c


def crowded(c: Configuration, most: int) -> bool:
    """Tell whether some agent has more pending requests or messages than are explored."""
    return any(len(c.eta.of(a)) > most or len(c.alpha.mailbox(a)) > most for a in c.alpha.names())
