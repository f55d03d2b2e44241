"""Leaves of decision trees as arrays: the transitions for the answers on the path, with their writes."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from checker.engines.fast.arrays import Growing
from checker.engines.fast.columns import Writes

CROWDED = 1
"""A leaf of an agent that has more pending than is explored."""

NO_TURN = -1
UNLIKE = -1

LEAF, STEP, PAIR = 4, 8, 2
"""Numbers that a leaf has: its first transition, the end of them, its flags, and one to spare.

A transition has: its turn, the number of its label, where its copies, its parts and its writes begin and end.
A write has a column and its code; a copy has the column that gets and the one that gives.
"""

FIRST, END, FLAGS, _SPARE = range(LEAF)
TURN, ALIKE, COPIES, COPIES_END, PARTS, PARTS_END, WRITES, WRITES_END = range(STEP)


@dataclass(slots=True)
class Effect:
    """What one transition, or one part of it, writes.

    Attributes:
        writes: Columns with the codes that they get.
        copies: Columns with those that they get their codes from.
        parts: The trees whose leaves write the rest, each by itself.
    """

    writes: Writes
    copies: list[tuple[int, int]] = field(default_factory=list)
    parts: list[int] = field(default_factory=list)


class Step(NamedTuple):
    """One transition of a leaf.

    Attributes:
        effect: What it writes.
        rule: The number of its rule.
        turn: Where that stands in the queue, `NO_TURN` where it waits for none.
        alike: The number of its label, where another transition of the same configuration may have it too.
    """

    effect: Effect
    rule: int = 0
    turn: int = NO_TURN
    alike: int = UNLIKE


class Leaves:
    """All leaves of an exploration: `LEAF` numbers a leaf, `STEP` a transition, `PAIR` a write or copy.

    Attributes:
        rule: For each transition the number of its rule.
        part: Trees of parts.
    """

    __slots__ = ("copies", "leaves", "part", "rule", "steps", "writes")

    def __init__(self) -> None:
        self.leaves, self.steps, self.writes = (Growing(np.int32, shared=True) for _ in range(3))
        self.copies, self.part = (Growing(np.int32, shared=True) for _ in range(2))
        self.rule = Growing(np.int32)

    def add(self, steps: Sequence[Step], flags: int = 0) -> int:
        """Add a leaf and return its number."""
        first = len(self.rule)
        for step in steps:
            self._add(step)
        return self.leaves.append(first, len(self.rule), flags, 0) // LEAF

    def rank_of(self, step: int) -> int:
        """Return which a transition is among those of its leaf."""
        firsts = self.leaves.used[FIRST::LEAF]
        return step - int(firsts[np.searchsorted(firsts, step, side="right") - 1])

    def steps_of(self, leaf: int) -> range:
        """Return the numbers of a leaf's transitions."""
        return range(*map(int, self.leaves.room[LEAF * leaf + FIRST : LEAF * leaf + END + 1]))

    def _add(self, step: Step) -> None:
        begins = [len(each) // PAIR for each in (self.copies, self.writes)]
        parts = len(self.part)
        for pairs, all_of in ((step.effect.copies, self.copies), (step.effect.writes, self.writes)):
            for pair in pairs:
                all_of.append(*pair)
        self.part.append(*step.effect.parts)
        ends = [len(each) // PAIR for each in (self.copies, self.writes)]
        self.rule.append(step.rule)
        self.steps.append(
            step.turn, step.alike, begins[0], ends[0], parts, len(self.part), begins[1], ends[1]
        )

    def parts_of(self, step: int) -> list[int]:
        """Return the trees of a transition's parts."""
        record = self.steps.room[STEP * step : STEP * (step + 1)]
        parts: list[int] = self.part.room[record[PARTS] : record[PARTS_END]].tolist()
        return parts
