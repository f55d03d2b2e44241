"""The reference explorer: breadth-first, exact and simple; the oracle for the faster ones.

It visits each configuration once, in the order of distance from the initial one, so a path to it is a shortest one.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from checker.engines.breadth_first import BreadthFirst
from checker.engines.contract import Exploration, Inspect, Options, sample
from checker.limits import BoundMet, CheckPart, Stop, bounded, look
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
    began = time.monotonic()
    found = explorer.run()
    found.reducer, found.start = options.reduce, initial
    try:
        with bounded(options.limits, began):
            for number in sample(found.expanded, options.keeping.doubted):
                look()
                options.reduce.hold(found.configurations[number])
    except BoundMet as met:
        explorer.search.bound(met.bound.met_in(CheckPart.LOOKING))
    return found


class _Explorer:
    """Expands configurations by the rules, or by a reduction's choice of them."""

    def __init__(self, initial: Configuration, inspect: tuple[Inspect, ...], options: Options) -> None:
        self.inspect = inspect
        self.reducer = options.reduce
        self.represent: Callable[[Configuration], Configuration] = _itself
        self.paths = Paths()
        if self.reducer is not None:
            self.represent = self.reducer.representative
            self.paths = self.reducer.paths()
        self.search = BreadthFirst(self.represent(initial), options)
        self.allowed = 0

    def run(self) -> Exploration:
        search = self.search
        search.run(self.expand)
        return Exploration(
            search.states,
            search.origins,
            search.depths[-1],
            search.expanded,
            search.transitions,
            search.rules,
            search.bounds,
            search.seconds,
            edges=search.edges,
            allowed=self.allowed,
        )

    def expand(self, number: int, configuration: Configuration) -> None:
        expansion, search = expand(configuration), self.search
        for inspection in self.inspect:
            inspection(number, configuration, expansion)
        if crowded(configuration, search.limits.pending):
            search.bound(search.limits.bound(Stop.PENDING))
            search.missing(number)
            return
        self.allowed += len(expansion.transitions)
        if self.reducer is None:
            self.follow_all(number, expansion.transitions)
        else:
            self.reduced(number, configuration, expansion, self.reducer)

    def reduced(self, number: int, c: Configuration, expansion: Expansion, reducer: Reduced) -> None:
        """Follow the chosen transitions, and record the target of the onward one for the cycle proviso."""
        followed = reducer.choose(c, expansion, number, self.reached, self.paths)
        self.follow_all(number, followed.steps)
        if followed.onward is not None and (target := self.reached(followed.onward)) is not None:
            self.paths.lead(number, target, followed.taken)

    def reached(self, transition: Transition) -> int | None:
        """Return the number of a transition's target, None if it is new."""
        return self.search.numbers.get(self.represent(transition.target))

    def follow_all(self, number: int, transitions: Iterable[Transition]) -> None:
        search = self.search
        for transition in transitions:
            label = transition.label
            if search.follow(number, label, self.represent(transition.target)):
                self.paths.movers[len(search.states) - 1] = label.agent


def _itself(c: Configuration) -> Configuration:
    return c


def crowded(c: Configuration, most: int) -> bool:
    """Return whether some agent has more pending requests or messages than the limit."""
    return any(c.eta.count(a) > most or len(c.alpha.mailbox(a)) > most for a in c.alpha.names())
