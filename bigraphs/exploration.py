"""Explore a system: its full transition system, breadth first."""

from __future__ import annotations

import time
from array import array
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from bigraphs.columns import Column, Numbering, Texts
from bigraphs.engine.machine import Machine
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.state import Key
from bigraphs.engine.waiting import Waiting
from bigraphs.system import System, SystemKind
from bigraphs.transitions import Kind, TransitionSystem

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
        self.visited = Numbering()
        self.remembered: dict[Key, int] = {}
        self.keys = self.visited.texts if self.machine.world.plain else Texts()
        self.found_from = array("I")
        self.holding: Column[tuple[int, ...]] = Column()
        self.first, self.targets = array("Q", (0,)), array("I")
        self.kinds: Column[Kind] = Column()
        self.rule_sets: dict[frozenset[int], tuple[str, ...]] = {}
        self.occurrences = 0

    def check_time(self) -> None:
        if self.end is not None and time.monotonic() > self.end:
            raise OutOfTime

    def run(self) -> str:
        """Explore; return why it ended early, or nothing."""
        try:
            first, count = self.machine.start()
            self.occurrences += count
            self.waiting = Waiting(first)
            self.number(first, 0)
            while self.waiting:
                if not self.expand(self.waiting.popleft()):
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
        return Progress(len(self.keys), len(self.targets), len(self.waiting), seconds)

    def number(self, spot: Spot, source: int) -> int:
        """Return the number of a state, a new one if it has not been seen; -1 if that is one too many."""
        raw = spot.state.key()
        if self.machine.world.plain:
            found = self.visited.find(raw)
            return found if found >= 0 else self.add(raw, raw, spot, source)
        known = self.remembered.get(raw)
        if known is not None:
            return known
        key = self.machine.labelling.canonical(spot.state)
        found = self.visited.find(key)
        if found < 0:
            found = self.add(key, raw, spot, source)
        if len(self.remembered) >= MOST_REMEMBERED:
            self.remembered.clear()
        if found >= 0:
            self.remembered[raw] = found
        return found

    def add(self, key: Key, raw: Key, spot: Spot, source: int) -> int:
        """Number a new state, unless there are as many as there may be."""
        if self.max_states is not None and len(self.keys) >= self.max_states:
            return -1
        found = self.visited.add(key)
        if self.keys is not self.visited.texts:
            self.keys.append(raw)
        self.found_from.append(source)
        self.holding.append(tuple(sorted(self.machine.holding(spot.state))))
        self.waiting.append(spot)
        return found

    def expand(self, spot: Spot) -> bool:
        """Add the transitions of the next state; say whether there was room for all that they lead to."""
        merged: dict[tuple[int, str | None], _Merged] = {}
        state, occurrences = len(self.first) - 1, 0
        for step in self.machine.steps(spot):
            self.check_time()
            target = self.number(step.target, state)
            if target < 0:
                return False
            rule = step.reaction.rule
            group = merged.setdefault((target, rule.action), _Merged())
            group.weight += 1.0 if rule.weight is None else rule.weight
            group.count += 1
            group.rules.add(step.reaction.number)
            occurrences += step.reactions
        self.occurrences += occurrences
        self.keep(merged)
        return True

    def keep(self, merged: dict[tuple[int, str | None], _Merged]) -> None:
        """Add merged transitions, their weights as the kind of the system wants them."""
        kind, totals = self.machine.system.kind, dict[str | None, float]()
        for (_, action), group in merged.items():
            totals[action] = totals.get(action, 0.0) + group.weight
        for (target, action), group in merged.items():
            weight = group.weight
            if kind is SystemKind.BRS:
                weight = 1.0
            elif kind is not SystemKind.SBRS:
                weight /= totals[action]
            self.targets.append(target)
            self.kinds.append(Kind(weight, self.labels(frozenset(group.rules)), group.count, action))
        self.first.append(len(self.targets))

    def labels(self, rules: frozenset[int]) -> tuple[str, ...]:
        """Return the labels of rules, sorted."""
        found = self.rule_sets.get(rules)
        if found is None:
            found = tuple(sorted(self.machine.reactions[rule].label for rule in rules))
            self.rule_sets[rules] = found
        return found

    def result(self, reason: str) -> TransitionSystem:
        return TransitionSystem(
            system=self.machine.system,
            world=self.machine.world,
            keys=self.keys,
            holding=self.holding,
            first=self.first,
            targets=self.targets,
            kinds=self.kinds,
            found_from=self.found_from,
            occurrences=self.occurrences,
            seconds=time.monotonic() - self.begun,
            reason=reason,
        )
