"""Leaves of decision trees as arrays: the transitions for the answers on the path, with their writes."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from checker.engines.fast.compiled.arrays import Growing
from checker.engines.fast.model.columns import Writes

CROWDED = 1
"""The flag of a leaf with a crowded agent: it has more requests or messages than the exploration follows."""

NO_TURN = -1
UNLIKE = -1

LEAF, STEP, PAIR = 4, 8, 2
"""The numbers of a leaf: its first transition, the end of its transitions, its flags, and a spare one.

A transition has its turn, the number of its label, and the bounds of its copies, parts and writes. A write has a column
and its code. A copy has its target column and its source column.
"""

FIRST, END, FLAGS, _SPARE = range(LEAF)
TURN, ALIKE, COPIES, COPIES_END, PARTS, PARTS_END, WRITES, WRITES_END = range(STEP)


@dataclass(slots=True)
class Effect:
    """The writes of one transition, or of one part of it.

    Attributes:
        writes: Columns with their new codes.
        copies: Target columns with their source columns.
        parts: The trees with the remaining writes at their leaves, part by part.
    """

    writes: Writes
    copies: list[tuple[int, int]] = field(default_factory=list)
    parts: list[int] = field(default_factory=list)


class LeafStep(NamedTuple):
    """One transition of a leaf.

    Attributes:
        effect: Its writes.
        rule: The number of its rule.
        turn: The position in the queue of the request that it serves; `NO_TURN` if it waits for none.
        alike: The number of its label if another transition of the configuration may share it, else `UNLIKE`.
    """

    effect: Effect
    rule: int = 0
    turn: int = NO_TURN
    alike: int = UNLIKE


class LeafTables:
    """All leaves of an exploration: `LEAF` numbers a leaf, `STEP` a transition, `PAIR` a write or copy.

    Attributes:
        rule: The number of each transition's rule.
        part: The trees of parts.
    """

    __slots__ = ("copies", "leaves", "part", "rule", "steps", "writes")

    def __init__(self) -> None:
        self.leaves, self.steps, self.writes = (Growing(np.int32, shared=True) for _ in range(3))
        self.copies, self.part = (Growing(np.int32, shared=True) for _ in range(2))
        self.rule = Growing(np.int32)

    def add(self, steps: Sequence[LeafStep], flags: int = 0) -> int:
        """Add a leaf and return its number."""
        first = len(self.rule)
        for step in steps:
            self._add(step)
        return self.leaves.append(first, len(self.rule), flags, 0) // LEAF

    def rank_of(self, step: int) -> int:
        """Return the index of a transition within its leaf."""
        firsts = self.leaves.used[FIRST::LEAF]
        return step - int(firsts[np.searchsorted(firsts, step, side="right") - 1])

    def steps_of(self, leaf: int) -> range:
        """Return the numbers of a leaf's transitions."""
        return range(*map(int, self.leaves.room[LEAF * leaf + FIRST : LEAF * leaf + END + 1]))

    def _add(self, step: LeafStep) -> None:
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
