"""The reference explorer: breadth-first, exact and simple; the yardstick for every faster one.

It visits each configuration once, in the order of its distance from the first, so a path to it is a shortest one.
"""

import time
from collections.abc import Callable

from checker.bounding import BoundMet, bounded, look
from checker.engines.contract import Exploration, Inspect, Keeping, Progress, Reducer, Report, sample
from checker.engines.edges import Edges
from checker.engines.estimate import estimate
from checker.limits import Limits, crowd_met, end_met, is_full, limit_met, memory_met
from semantics.state.configuration import Configuration, Transition
from semantics.successors import Expansion, expand


def explore_one_by_one(  # noqa: PLR0913, PLR0917  # as `explore`
    initial: Configuration,
    inspect: tuple[Inspect, ...],
    limits: Limits,
    report: Report | None,
    every: float,
    keeping: Keeping,
    reduce: Reducer | None,
    *,
    edges: bool,
) -> Exploration:
    """Visit everything that is reachable (see `checker.engines.choose.explore`), running the rules everywhere."""
    explorer = _Explorer(initial, inspect, limits, report, every)
    explorer.found.edges = Edges() if edges else None
    if reduce is None:
        return explorer.run()
    explorer.reduce_by(reduce)
    began = time.monotonic()
    found = explorer.run()
    try:
        with bounded(limits, began):
            for number in sample(found.expanded, keeping.doubted):
                look()
                reduce.hold(found.configurations[number])
    except BoundMet as bound:
        explorer.bound(f"{bound}, in looking at what was explored")
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
        self.visit_all(started)
        self.found.seconds = time.monotonic() - started
        self.found.depth = self.depths[-1]
        self.found.bounds.sort()
        return self.found

    def visit_all(self, started: float) -> None:
        reported = started
        for number, configuration in enumerate(self.configurations):  # grows while it is gone through
            now = time.monotonic()
            if (end := end_met(self.limits, now - started)) is not None:
                self.bound(end)
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
        for inspection in self.inspect:
            inspection(number, configuration, expansion)
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
