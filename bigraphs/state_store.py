"""The growing result of an exploration: numbered states, transitions and the queue of unexpanded states."""

from __future__ import annotations

from array import array
from bisect import bisect_left
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Final

from bigraphs.compact_lists import Column, DictionaryColumn, Numbering, Texts, spilled
from bigraphs.engine.frontier import Frontier
from bigraphs.engine.machine import Machine
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.state_arrays import Key
from bigraphs.system import SystemKind
from bigraphs.transitions import TransitionKind, TransitionSystem

if TYPE_CHECKING:
    from bigraphs.file_columns import FileColumn

MOST_REMEMBERED: Final = 200_000
"""The largest number of cached state numbers; the cache saves the computation of canonical keys."""


@dataclass(slots=True)
class _Merged:
    """The merged occurrences that lead to one state by one action."""

    weight: float = 0.0
    count: int = 0
    rules: set[int] = field(default_factory=set)


class StateStore:
    """States and transitions found so far, up to an optional limit of states.

    Attributes:
        visited: The states by their canonical keys.
        remembered: A cache of state numbers by raw (non-canonical) keys.
        keys: The raw key of each state when it was first found (`State.key`).
        start: The initial state.
        in_files: The columns in files.
        waiting: The unexpanded states, by number.

    The other attributes are those of a `TransitionSystem`.
    """

    def __init__(self, machine: Machine, max_states: int | None = None) -> None:
        self.machine, self.max_states = machine, max_states
        self.visited = Numbering()
        self.remembered: dict[Key, int] = {}
        self.keys = self.visited.texts if machine.world.plain else Texts()
        self.found_from: Column = array("I")
        self.holding: DictionaryColumn[tuple[int, ...]] = DictionaryColumn()
        self.first: Column = array("Q", (0,))
        self.targets: Column = array("I")
        self.kinds: DictionaryColumn[TransitionKind] = DictionaryColumn()
        self.rule_sets: dict[frozenset[int], tuple[str, ...]] = {}
        self.occurrences = 0
        self.start = machine.first()
        self.waiting = Frontier(self.start)
        self.in_files: tuple[FileColumn, ...] = ()

    def __len__(self) -> int:
        return len(self.keys)

    @property
    def expanded(self) -> int:
        """The number of expanded states; these are the first ones."""
        return len(self.first) - 1

    @property
    def reached(self) -> int:
        """The number of states that the expanded ones lead to; a state that is being expanded may have added more."""
        return bisect_left(self.found_from, self.expanded) or 1

    def begin(self) -> None:
        """Add the initial state."""
        self.start, self.occurrences = self.machine.start()
        self.number(self.start, 0)

    def number(self, spot: Spot, source: int) -> int:
        """Return the number of a state, a new one for a new state; -1 if it exceeds the limit."""
        raw = spot.state.key()
        if self.machine.world.plain:
            found = self.visited.find(raw)
            return found if found >= 0 else self._append(spot, raw, raw, source)
        known = self.remembered.get(raw)
        if known is not None:
            return known
        key = self.machine.labelling.canonical_of(raw)
        found = self.visited.find(key)
        if found < 0:
            found = self._append(spot, key, raw, source)
        if found >= 0:
            self.remember(raw, found)
        return found

    def _append(self, spot: Spot, key: Key, raw: Key, source: int) -> int:
        if self.full():
            return -1
        found = self.add(key, raw, source, tuple(sorted(self.machine.holding(spot.state))))
        self.waiting.append(spot)
        return found

    def full(self) -> bool:
        """Return whether the limit of states is reached."""
        return self.max_states is not None and len(self.keys) >= self.max_states

    def add(self, key: Key, raw: Key, source: int, holding: tuple[int, ...]) -> int:
        """Number a new state."""
        found = self.visited.add(key)
        if self.keys is not self.visited.texts:
            self.keys.append(raw)
        self.found_from.append(source)
        self.holding.append(holding)
        return found

    def remember(self, raw: Key, number: int) -> None:
        """Cache the number of a state by its raw key."""
        if len(self.remembered) >= MOST_REMEMBERED:
            self.remembered.clear()
        self.remembered[raw] = number

    def expand_next(self) -> bool:
        """Expand the state that has waited longest; it waits until all its transitions are added."""
        if not self.expand(self.waiting.peek(), self.expanded):
            return False
        self.waiting.popleft()
        return True

    def expand(self, spot: Spot, state: int) -> bool:
        """Add the transitions of a state; return whether the limit allowed all their targets."""
        merged: dict[tuple[int, str | None], _Merged] = {}
        occurrences = 0
        for step in self.machine.steps(spot):
            self.machine.pause()
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
        self._keep(merged)
        return True

    def _keep(self, merged: dict[tuple[int, str | None], _Merged]) -> None:
        """Add merged transitions, with the weights that the kind of the system requires."""
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
            self.kinds.append(
                TransitionKind(weight, self._labels(frozenset(group.rules)), group.count, action)
            )
        self.first.append(len(self.targets))

    def _labels(self, rules: frozenset[int]) -> tuple[str, ...]:
        """Return the labels of rules, sorted."""
        found = self.rule_sets.get(rules)
        if found is None:
            found = tuple(sorted(self.machine.reactions[rule].label for rule in rules))
            self.rule_sets[rules] = found
        return found

    def spill(self, folder: Path) -> None:
        """Move states and transitions to files in a folder; the index and the interned subtrees stay in memory.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        self.found_from = found_from = spilled(self.found_from, folder)
        self.first, self.targets = first, targets = spilled(self.first, folder), spilled(self.targets, folder)
        coded = self.holding.spill(folder), self.kinds.spill(folder), self.waiting.spill(folder)
        texts = {id(each): each for each in (self.keys, self.visited.texts)}.values()
        files = (file for each in texts for file in each.spill(folder))
        self.in_files = (found_from, first, targets, *coded, *files)

    def write(self) -> None:
        """Write additions to the files, if they are large; raises OSError if a file has no room."""
        for column in self.in_files:
            column.write()

    def result(self, seconds: float, reason: str) -> TransitionSystem:
        """Return the transition system, found in `seconds`; a nonempty reason marks it as incomplete."""
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
            seconds=seconds,
            reason=reason,
        )
