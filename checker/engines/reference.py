"""The reference explorer: breadth-first, exact and simple; the oracle for the faster ones.

It visits each configuration once, in the order of distance from the initial one, so a path to it is a shortest one.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from checker.engines.contract import Exploration, Inspect, Options, Progress, sample
from checker.engines.edges import Edges
from checker.engines.estimate import estimate
from checker.limits import Bound, BoundMet, CheckPart, Stop, bounded, is_full, look
from checker.reduction.cycle_proviso import Paths
from semantics.state.configuration import Configuration, Transition
from semantics.successors import Expansion, expand

if TYPE_CHECKING:
    from checker.reduction.reducer import Reduced


def explore_one_by_one(initial: Configuration, inspect: tuple[Inspect, ...], options: Options) -> Exploration:
    """Visit the reachable configurations, running the rules in each."""
    explorer = _Explorer(initial, inspect, options)
    if options.reduce is None:
        return explorer.run()
    explorer.reduce_by(options.reduce)
    began = time.monotonic()
    found = explorer.run()
    try:
        with bounded(options.limits, began):
            for number in sample(found.expanded, options.keeping.doubted):
                look()
                options.reduce.hold(found.configurations[number])
    except BoundMet as met:
        explorer.bound(met.bound.met_in(CheckPart.LOOKING))
    return found


class _Explorer:
    def __init__(self, initial: Configuration, inspect: tuple[Inspect, ...], options: Options) -> None:
        self.configurations = [initial]
        self.origins = [0]
        self.depths = [0]
        self.layers = [1]
        self.found = Exploration(self.configurations, self.origins, edges=Edges() if options.edges else None)
        self.numbers = {initial: 0}
        self.inspect = inspect
        self.options = options
        self.limits = options.limits
        self.represent: Callable[[Configuration], Configuration] = _itself
        self.paths = Paths()

    def reduce_by(self, reducer: Reduced) -> None:
        self.found.reducer, self.found.start = reducer, self.configurations[0]
        self.configurations[0] = reducer.representative(self.configurations[0])
        self.numbers = {self.configurations[0]: 0}
        self.represent = reducer.representative
        self.paths = reducer.paths()

    def run(self) -> Exploration:
        started = time.monotonic()
        self.visit_all(started)
        self.found.seconds = time.monotonic() - started
        self.found.depth = self.depths[-1]
        self.found.bounds.sort(key=str)
        return self.found

    def visit_all(self, started: float) -> None:
        reported = started
        for number, configuration in enumerate(self.configurations):  # grows during the loop
            now = time.monotonic()
            if (end := self.limits.end(now - started)) is not None:
                self.bound(end)
                break
            if number % 1024 == 0 and is_full(self.limits):
                self.bound(self.limits.bound(Stop.MEMORY))
                break
            if self.options.report is not None and now - reported >= self.options.every:
                self.options.report(self.progress(number, now - started))
                reported = now
            self.expand(number, configuration)

    def expand(self, number: int, configuration: Configuration) -> None:
        expansion = expand(configuration)
        self.found.expanded = number + 1
        for inspection in self.inspect:
            inspection(number, configuration, expansion)
        if crowded(configuration, self.limits.pending):
            self.bound(self.limits.bound(Stop.PENDING))
            self.missing(number)
        else:
            self.found.allowed += len(expansion.transitions)
            if self.found.reducer is None:
                self.follow_all(number, expansion.transitions)
            else:
                self.reduced(number, configuration, expansion, self.found.reducer)
        if self.found.edges is not None:
            self.found.edges.close()

    def reduced(self, number: int, c: Configuration, expansion: Expansion, reducer: Reduced) -> None:
        """Follow the chosen transitions, and record the target of the onward one for the cycle proviso."""
        followed = reducer.choose(c, expansion, number, self.reached, self.paths)
        self.follow_all(number, followed.steps)
        if followed.onward is not None and (target := self.reached(followed.onward)) is not None:
            self.paths.lead(number, target, followed.taken)

    def reached(self, transition: Transition) -> int | None:
        """Return the number of a transition's target, None if it is new."""
        return self.numbers.get(self.represent(transition.target))

    def follow_all(self, number: int, transitions: Iterable[Transition]) -> None:
        for transition in transitions:
            self.follow(number, transition)

    def follow(self, number: int, transition: Transition) -> None:
        found, label = self.found, transition.label
        found.transitions += 1
        found.rules[label.rule] += 1
        reached = self.represent(transition.target)
        target = self.numbers.get(reached)
        if target is None:
            most = self.limits.configurations
            if most is not None and len(self.configurations) >= most:
                self.bound(self.limits.bound(Stop.CONFIGURATIONS))
                self.missing(number)
                return
            target = self.numbers[reached] = len(self.configurations)
            self.configurations.append(reached)
            self.origins.append(number)
            self.depths.append(self.depths[number] + 1)
            self.paths.movers[target] = label.agent
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

    def bound(self, bound: Bound) -> None:
        if bound not in self.found.bounds:
            self.found.bounds.append(bound)

    def progress(self, number: int, seconds: float) -> Progress:
        found = self.found
        total, depth, rate = len(self.configurations), self.depths[number], number / max(seconds, 1e-9)
        guess = estimate(self.layers[: depth + 1])
        return Progress(total, found.transitions, depth, total - number, rate, guess)


def _itself(c: Configuration) -> Configuration:
    return c


def crowded(c: Configuration, most: int) -> bool:
    """Return whether some agent has more pending requests or messages than the limit."""
    return any(c.eta.count(a) > most or len(c.alpha.mailbox(a)) > most for a in c.alpha.names())
