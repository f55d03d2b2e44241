"""Slices of a space's rows, expanded ahead of the stored rows with the trees known at their start."""

from typing import Any, Protocol

from checker.engines.fast import kernel
from checker.engines.fast.learned_model import (
    AT,
    GATHERED,
    PUT_OFF,
    SEEN,
    SIFTED,
    LearnedModel,
    State,
    SuccessorBatch,
)
from checker.engines.fast.mapped_arrays import Pages
from checker.engines.fast.pipeline import Pipeline, RowSlice
from checker.engines.fast.rows import Rows

FEW = 1 << 6
"""The number of rows of the first slice, and of the next one after results ahead were void."""

LATER_ROWS = 1 << 10
"""The greatest number of deferred rows in a slice."""


class Storing(Protocol):
    """The interface of the space that stores the results of slices and learns missing rules."""

    rows: Rows
    table: Pages
    batch: SuccessorBatch
    state: State
    actors: int
    stored: int

    @property
    def size(self) -> int:
        """The number of rows."""

    @property
    def expanded(self) -> int:
        """The number of expanded rows."""

    @property
    def epoch(self) -> int:
        """A number that changes when results found ahead become void."""

    @property
    def symmetry(self) -> tuple[Any, Any]:
        """The symmetry tables, and this thread's scratch space; None without symmetry reduction."""

    def known(self) -> tuple[LearnedModel, Any]:
        """Return a snapshot of trees and symmetry tables that other threads may read during learning."""

    def show(self) -> None:
        """Publish the stored rows to other threads."""

    def new_batch(self, successors: int = 0, later: int = 0) -> SuccessorBatch:
        """Return an empty batch with room for `later` deferred rows."""

    def store(self, batch: SuccessorBatch, steps: tuple[int, int], found: tuple[int, int], at: int) -> None:
        """Store transitions and possibly new successors of the rows before row `at`."""

    def expand_here(self, until: int) -> None:
        """Expand rows until row `until` in this thread, learning on the way."""


class Slices:
    """The slices of a space that are ahead: any thread expands and sifts them, this thread stores them.

    Attributes:
        space: Stores their results and learns missing rules.
        pipeline: Runs them.
        pace: The number of rows of the next slice, if their successors fit its batch.
        breadth: The number of successors for each row of the last slice.
        spare: Reusable batches of stored slices.
    """

    def __init__(self, space: Storing, threads: int) -> None:
        self.space = space
        self.pipeline = Pipeline(threads, self._expand, self._sift)
        self.pace, self.breadth = FEW, 1.0
        self.spare: list[SuccessorBatch] = []

    def advance(self, end: int) -> None:
        """Store the results of the next slice, while others go ahead; no slice crosses `end`."""
        self._commit(self._next(end))

    def _next(self, end: int) -> RowSlice:
        """Return the next slice, expanded; let other slices go ahead up to the stored rows."""
        pipeline, space = self.pipeline, self.space
        if pipeline.begin is not None and pipeline.begin > space.expanded:  # a batch was full before its end
            pipeline.ahead.appendleft(self._slice(space.expanded, pipeline.begin))
        elif pipeline.ahead and pipeline.ahead[0].epoch != self.space.epoch:
            pipeline.drop()
        begin = space.expanded if pipeline.end is None else pipeline.end
        while not pipeline.is_full and begin < (stop := end if begin < end else space.size):
            rows = min(
                self.pace, int(len(space.batch.hashes) / 2 / self.breadth), pipeline.fair(stop - begin)
            )
            part = self._slice(begin, min(begin + max(rows, 1), stop))
            pipeline.add(part)
            begin = part.end
        return pipeline.take()

    def _slice(self, begin: int, end: int) -> RowSlice:
        """Return rows as a slice, with the trees known now."""
        space = self.space
        model, exchanges = space.known()
        space.show()
        state = space.state.copy()
        state[[AT, GATHERED, PUT_OFF]] = begin, 0, 0
        batch = self.spare.pop() if self.spare else space.new_batch(later=LATER_ROWS)
        return RowSlice(begin, end, space.epoch, model, exchanges, batch, state)

    def _expand(self, part: RowSlice) -> None:
        """Expand a slice, in any thread."""
        rows = self.space.rows
        folded = rows.shown
        desk = self.space.symmetry[1]
        kernel.gather(part.model, part.exchanges, desk, rows.words, folded, part.batch, part.state, part.end)
        if folded is None:
            kernel.drop_repeated(part.batch, part.state)
        else:  # a look-up takes no longer than this check
            part.state[SIFTED] = part.state[GATHERED]

    def _sift(self, part: RowSlice) -> None:
        """Drop the successors of a slice that are stored rows."""
        space = self.space
        part.state[SEEN] = space.stored
        kernel.sift(space.rows.words, space.table.room, part.batch, part.state)

    def _commit(self, part: RowSlice) -> None:
        """Store the results of a slice; deferred rows are expanded at their turn."""
        space, steps, found = self.space, 0, 0
        for row, steps_before, found_before in part.put_off():
            space.store(part.batch, (steps, steps_before), (found, found_before), row)
            steps, found = steps_before, found_before
            while space.expanded == row:
                space.expand_here(row + 1)
            if self.space.epoch != part.epoch:
                self.pipeline.drop()
                self.pace = FEW
                return
        space.store(part.batch, (steps, part.gathered), (found, part.sifted), part.at)
        self.breadth = max(part.gathered / (part.at - part.begin), 0.5)
        self.pace = min(2 * self.pace, len(part.batch.hashes))
        if len(part.batch.leaves) == space.actors:
            self.spare.append(part.batch)
