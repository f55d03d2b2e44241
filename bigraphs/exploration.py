"""Explore a system: its full transition system, breadth first."""

from __future__ import annotations

import time
from array import array
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from bigraphs.engine.machine import Machine
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.state import Key
from bigraphs.system import System, SystemKind
from bigraphs.transitions import TransitionSystem

MOST_REMEMBERED: Final = 200_000
"""How many numberings of states are cached, so that their canonical keys are not computed again."""
LOOK_EVERY: Final = 0.2
"""Seconds between two progress reports."""


class Progress(NamedTuple):
    """How far an exploration has come."""

    states: int
    transitions: int
    waiting: int
    seconds: float


class OutOfTime(Exception):
    """Ends an exploration within a state, whose transitions are then not kept."""


def explore(
    system: System,
    *,
    max_states: int | None = None,
    max_time: float | None = None,
    watch: Callable[[Progress], None] = lambda _: None,
) -> TransitionSystem:
    """Return the transition system of a system; if a limit was reached, one that says that it is incomplete.

    `watch` is told now and then how far it has come; a KeyboardInterrupt ends it with what was found so far. Raises
    BigraphError for a system that cannot be run.
    """
    search = _Search(system, max_states, max_time, watch)
    reason = search.run()
    return search.result(reason)


@dataclass(slots=True)
class _Merged:
    """The occurrences that lead to one state by one action, taken together."""

    weight: float = 0.0
    count: int = 0
    rules: set[int] = field(default_factory=set)


class _Search:
    """One exploration: what is known, and what waits."""

    def __init__(
        self,
        system: System,
        max_states: int | None,
        max_time: float | None,
        watch: Callable[[Progress], None],
    ) -> None:
        self.begun = time.monotonic()
        self.next_look = self.begun + LOOK_EVERY
        self.end = None if max_time is None else self.begun + max_time
        self.max_states, self.max_time, self.watch = max_states, max_time, watch
        self.machine = Machine(system, self.check_time)
        self.numbers: dict[Key, int] = {}
        self.remembered: dict[Key, int] = {}
        self.keys: list[Key] = []
        self.found_from = array("I")
        self.labels = tuple(bytearray() for _ in system.predicates)
        self.waiting: deque[tuple[int, Spot]] = deque()
        self.starts, self.targets, self.rules, self.counts = array("I"), array("I"), array("I"), array("I")
        self.weights, self.actions = array("d"), array("i")
        self.rule_sets: dict[tuple[int, ...], int] = {}
        self.action_numbers = {action.name: number for number, action in enumerate(system.actions)}
        self.expanded = self.occurrences = 0

    def check_time(self) -> None:
        if self.end is not None and time.monotonic() > self.end:
            raise OutOfTime

    def run(self) -> str:
        """Explore; return why it ended early, or nothing."""
        try:
            first, count = self.machine.start()
            self.occurrences += count
            self.number(first, 0)
            while self.waiting:
                state, spot = self.waiting.popleft()
                if not self.expand(state, spot):
                    return f"the limit of {self.max_states:,} states was reached"
                if time.monotonic() >= self.next_look:
                    self.watch(self.progress())
                    self.next_look = time.monotonic() + LOOK_EVERY
        except OutOfTime:
            return f"the limit of {self.max_time:g} seconds was reached"
        except KeyboardInterrupt:
            return "it was interrupted"
        return ""

    def progress(self) -> Progress:
        seconds = time.monotonic() - self.begun
        return Progress(len(self.keys), len(self.starts), len(self.waiting), seconds)

    def number(self, spot: Spot, source: int) -> int:
        """Return the number of a state, a new one if it has not been seen; -1 if that is one too many."""
        raw = spot.state.key()
        known = self.remembered.get(raw) if not self.machine.world.plain else self.numbers.get(raw)
        if known is not None:
            return known
        key = raw if self.machine.world.plain else self.machine.labelling.canonical(spot.state)
        found = self.numbers.get(key)
        if found is None:
            if self.max_states is not None and len(self.keys) >= self.max_states:
                return -1
            found = self.add(key, raw, spot, source)
        if not self.machine.world.plain:
            if len(self.remembered) >= MOST_REMEMBERED:
                self.remembered.clear()
            self.remembered[raw] = found
        return found

    def add(self, key: Key, raw: Key, spot: Spot, source: int) -> int:
        found = self.numbers[key] = len(self.keys)
        self.keys.append(raw)
        self.found_from.append(source)
        holding = self.machine.holding(spot.state)
        for predicate, holds in enumerate(self.labels):
            holds.append(predicate in holding)
        self.waiting.append((found, spot))
        return found

    def expand(self, state: int, spot: Spot) -> bool:
        """Add the transitions of a state; say whether there was room for all that they lead to."""
        merged: dict[tuple[int, int], _Merged] = {}
        occurrences = 0
        for step in self.machine.steps(spot):
            self.check_time()
            target = self.number(step.target, state)
            if target < 0:
                return False
            rule = step.reaction.rule
            action = -1 if rule.action is None else self.action_numbers[rule.action]
            group = merged.setdefault((target, action), _Merged())
            group.weight += 1.0 if rule.weight is None else rule.weight
            group.count += 1
            group.rules.add(step.reaction.number)
            occurrences += step.reactions
        self.occurrences += occurrences
        self.expanded += 1
        self.keep(state, merged)
        return True

    def keep(self, state: int, merged: dict[tuple[int, int], _Merged]) -> None:
        """Add merged transitions, their weights as the kind of the system wants them."""
        kind, totals = self.machine.system.kind, dict[int, float]()
        for (_, action), group in merged.items():
            totals[action] = totals.get(action, 0.0) + group.weight
        for (target, action), group in merged.items():
            weight = group.weight
            if kind is SystemKind.BRS:
                weight = 1.0
            elif kind is not SystemKind.SBRS:
                weight /= totals[action]
            self.starts.append(state)
            self.targets.append(target)
            self.weights.append(weight)
            self.actions.append(action)
            self.counts.append(group.count)
            self.rules.append(self.rule_set(group.rules))

    def rule_set(self, rules: set[int]) -> int:
        return self.rule_sets.setdefault(tuple(sorted(rules)), len(self.rule_sets))

    def result(self, reason: str) -> TransitionSystem:
        labels = [reaction.label for reaction in self.machine.reactions]
        return TransitionSystem(
            system=self.machine.system,
            world=self.machine.world,
            keys=self.keys,
            labels=self.labels,
            starts=self.starts,
            targets=self.targets,
            weights=self.weights,
            actions=self.actions,
            rules=self.rules,
            counts=self.counts,
            rule_sets=tuple(tuple(sorted(labels[rule] for rule in rules)) for rules in self.rule_sets),
            found_from=self.found_from,
            expanded=self.expanded,
            occurrences=self.occurrences,
            seconds=time.monotonic() - self.begun,
            reason=reason,
        )
