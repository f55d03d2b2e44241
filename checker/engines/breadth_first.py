"""Breadth-first search of states of any kind, within limits: the loop of the reference engine and of users' models."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable
from typing import Generic, TypeVar

from checker.engines.contract import Options, Progress
from checker.engines.edges import Edges
from checker.engines.estimate import estimate
from checker.limits import Bound, Stop, is_full
from semantics.state.configuration import Label

State = TypeVar("State")


class BreadthFirst(Generic[State]):
    """States in the order of discovery, expanded in that order; so a path along `origins` is a shortest one.

    Attributes:
        states: The states; the first is the initial one.
        numbers: The number of each state.
        origins: For each state the number of its predecessor; the initial one has its own.
        depths: For each state its distance from the initial one.
        layers: The number of states at each distance.
        edges: Every transition, if the options keep them.
        transitions: The number of transitions.
        rules: The number of transitions by each rule.
        expanded: The number of expanded states.
        bounds: The bounds that were met.
        seconds: The duration.
    """

    def __init__(self, initial: State, options: Options) -> None:
        self.options = options
        self.limits = options.limits
        self.states = [initial]
        self.numbers = {initial: 0}
        self.origins = [0]
        self.depths = [0]
        self.layers = [1]
        self.edges = Edges() if options.edges else None
        self.transitions = 0
        self.rules: Counter[str] = Counter()
        self.expanded = 0
        self.bounds: list[Bound] = []
        self.seconds = 0.0

    def run(self, expand: Callable[[int, State], None]) -> None:
        """Expand each state, given with its number, until the end or a bound; `expand` calls `follow`."""
        started = time.monotonic()
        self._visit_all(expand, started)
        self.seconds = time.monotonic() - started
        self.bounds.sort(key=str)

    def _visit_all(self, expand: Callable[[int, State], None], started: float) -> None:
        reported = started
        for number, state in enumerate(self.states):  # grows during the loop
            now = time.monotonic()
            if (end := self.limits.end(now - started)) is not None:
                self.bound(end)
                return
            if number % 1024 == 0 and is_full(self.limits):
                self.bound(self.limits.bound(Stop.MEMORY))
                return
            if self.options.report is not None and now - reported >= self.options.every:
                self.options.report(self.progress(number, now - started))
                reported = now
            self.expanded = number + 1
            expand(number, state)
            if self.edges is not None:
                self.edges.close()

    def follow(self, number: int, label: Label, reached: State) -> bool:
        """Record a transition from a state, and return whether its target is a new state."""
        self.transitions += 1
        self.rules[label.rule] += 1
        target = self.numbers.get(reached)
        is_new = target is None
        if target is None:
            most = self.limits.configurations
            if most is not None and len(self.states) >= most:
                self.bound(self.limits.bound(Stop.CONFIGURATIONS))
                self.missing(number)
                return False
            target = self._add(reached, number)
        if self.edges is not None:
            self.edges.add(label, target)
        return is_new

    def _add(self, state: State, origin: int) -> int:
        number = self.numbers[state] = len(self.states)
        depth = self.depths[origin] + 1
        self.states.append(state)
        self.origins.append(origin)
        self.depths.append(depth)
        if depth == len(self.layers):
            self.layers.append(0)
        self.layers[depth] += 1
        return number

    def missing(self, number: int) -> None:
        """Record that successors of a state are left out."""
        if self.edges is not None:
            self.edges.partial.add(number)

    def bound(self, bound: Bound) -> None:
        """Record a bound that was met."""
        if bound not in self.bounds:
            self.bounds.append(bound)

    def progress(self, number: int, seconds: float) -> Progress:
        """Return the progress when a state is about to be expanded."""
        total, depth, rate = len(self.states), self.depths[number], number / max(seconds, 1e-9)
        guess = estimate(self.layers[: depth + 1])
        return Progress(total, self.transitions, depth, total - number, rate, guess)
