"""The successors of rows, made in batches: list the steps of a row, make its successors, map them to representatives.

A batch is gathered, and then added to the store or looked up there. What a loop does not know is learned on the way.
"""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.arrays import Growing
from checker.engines.fast.model.learned_model import (
    AT,
    CROWDS,
    EXPANDED,
    FULL,
    GATHERED,
    KEPT,
    LATER,
    NODE,
    WIDE,
    SuccessorBatch,
)
from checker.engines.fast.search.rule_model import RuleModel
from checker.engines.fast.store import kernel
from checker.engines.fast.store.rows import BLOCK
from checker.limits import look

if TYPE_CHECKING:
    from checker.engines.fast.reduce.partial_order import Choosing

BATCH = 1 << 15
"""The number of successors in a batch; rows are expanded until half of it is full."""

Transitions = tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int64]]
"""Transitions: their origins, their steps, and their targets (less than 0: none)."""


class Expander:
    """Makes the successors of the rows of a store.

    Attributes:
        model: The rules; it knows the store.
        choosing: What chooses some of the successors of a row; None for all of them.
        batch: The successors that are being gathered.
        shape: A value that differs for batches of other sizes.
        counts, met: How often each transition was followed, and how often enabled; equal unless some are chosen.
    """

    batch: SuccessorBatch

    def __init__(self, model: RuleModel, choosing: "Choosing | None" = None) -> None:
        self.model = model
        self.store = model.store
        self.state = model.store.state
        self.choosing = choosing
        self.counts = Growing(np.int64)
        self.met = self.counts if choosing is None else Growing(np.int64)
        self.successors = BATCH
        self.shape = (0, 0, 0)
        self._plain = (-1, 0, 0, np.zeros(0, np.uint64))
        model.followers.append(self.see)

    @property
    def is_crowded(self) -> bool:
        """Whether some rows were not expanded because an agent is crowded."""
        return bool(self.state[CROWDS])

    # --- expanding ------------------------------------------------------------------------------------------------

    def gather(self, until: int) -> bool:
        """Gather the successors of rows, or their representatives; return False at something not learned yet."""
        rows, state, first = self.store.rows, self.state, 0
        begin, words, folded = state[GATHERED], rows.words, self.store.folded
        if folded is None and rows.folded is not None:
            first, until, words = self._unfolded(int(state[AT]), until)
            state[AT], state[KEPT] = state[AT] - first, rows.width
        known = kernel.gather(*self.model.making, words, folded, self.batch, state, until - first)
        self.batch.origins[begin : state[GATHERED]] += first
        state[AT], state[KEPT] = state[AT] + first, rows.kept
        return bool(known)

    def _unfolded(self, row: int, until: int) -> tuple[int, int, NDArray[np.uint64]]:
        """Return the bounds of some rows before row `until`, from a row on or from before it, and their plain words."""
        changes, first, end, words = self._plain
        if changes != self.store.changes or not first <= row < end:
            first, end = row, min(row + BLOCK, self.store.size)
            words = self.store.rows.plain(first, end)
            self._plain = self.store.changes, first, end, words
        return first, min(until, end), words

    def gathered(self) -> int:
        """Return the number of gathered successors, and begin anew."""
        count, self.state[GATHERED] = int(self.state[GATHERED]), 0
        return count

    def learn(self) -> None:
        """Learn the missing rule, or make the missing room, where gathering ended."""
        look()
        if self.state[NODE] == WIDE:
            self.successors *= 2
            self.see()
        elif self.state[NODE] == FULL:
            self.store.make_room(1)
        else:
            self.model.learn_missing()

    def expand(self, until: int) -> None:
        """Expand rows until row `until` or until the batch is full, learning on the way."""
        self.state[AT], self.state[GATHERED] = self.store.expanded, 0
        known = self.gather(until)
        count = self.gathered()
        self.add(self.batch, (0, count), (0, count), int(self.state[AT]))
        if not known:
            self.learn()

    def add(self, batch: SuccessorBatch, steps: tuple[int, int], found: tuple[int, int], at: int) -> None:
        """Store part of a batch: transitions and possibly new successors of the rows before row `at`."""
        kernel.count(batch.steps, *steps, self.counts.room)
        self.store.add(batch, found, self.model.making)
        self.state[EXPANDED] = at
        self.store.show()

    def edges(self, rows: range) -> Iterator[Transitions]:
        """Yield all transitions of expanded rows, batch by batch."""
        self.state[AT] = rows.start
        while self.state[AT] < rows.stop:
            look()
            known = self.gather(rows.stop)
            batch, count = self.batch, self.gathered()
            targets = self.store.look_up(batch, count, self.model.making)
            yield batch.origins[:count].copy(), batch.steps[:count].copy(), targets
            if not known:
                self.learn()

    # --- batches --------------------------------------------------------------------------------------------------

    def see(self) -> None:
        """Keep up with the model, and with the packing of the rows; the batch must hold no gathered successors."""
        for counts in (self.counts, self.met):
            counts.extend(len(self.model.learner.leaves.rule) - len(counts))
        shape = (self.successors, self.model.actors, self.store.changes)
        if shape != self.shape:
            self.shape, self.batch, self.state[GATHERED] = shape, self.new_batch(self.successors), 0
        if self.choosing is not None:
            self.choosing.see(self.model.groups, self.store.packing, self.successors)
            self.model.asked = self.choosing.trees

    def new_batch(self, successors: int | None = None, later: int = 0) -> SuccessorBatch:
        """Return an empty batch for `successors` successors, with room for `later` deferred rows."""
        successors = BATCH if successors is None else successors
        folded, width = self.store.folded, self.store.packing.words
        is_mapped = self.model.exchanging is not None
        makes_words = is_mapped or self.choosing is not None or folded is None
        words = np.zeros(width * successors if makes_words else 0, np.uint64)
        kept = width if folded is None else self.store.rows.kept
        is_stored_as_made = folded is None and not is_mapped
        return SuccessorBatch(
            words,
            words if is_stored_as_made else np.zeros(kept * successors, np.uint64),
            np.zeros(successors, np.uint64),
            np.zeros(successors, np.int64),
            np.zeros(successors, np.int32),
            np.zeros(self.model.actors, np.int32),
            np.zeros(LATER * later, np.int64),
            np.zeros(BATCH if later else 0, np.int32),
        )
