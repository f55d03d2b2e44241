"""Chunks of the frontier, expanded ahead of the stored rows with the tables known at their start."""

from typing import Any, Protocol

from checker.engines.fast.model.learned_model import (
    AT,
    GATHERED,
    PUT_OFF,
    SEEN,
    SIFTED,
    LearnedModel,
    SuccessorBatch,
)
from checker.engines.fast.search.expander import Expander
from checker.engines.fast.search.pipeline import ChunkMark, Pipeline, RowChunk
from checker.engines.fast.store import kernel

FEW = 1 << 6
"""The number of rows of the first chunk, and of the next one after results ahead were void."""

WORTH = 1 << 8
"""The least number of rows for another thread."""

LATER_ROWS = 1 << 10
"""The greatest number of deferred rows in a chunk."""


class ChunkSteps(Protocol):
    """The steps that are followed from the rows of a chunk: all of them (`AllSteps`), or some (`ChosenSteps`)."""

    def tables(self, *, is_alone: bool) -> Any:
        """Return the learned tables, as copies unless this thread is alone: learning changes them."""

    def new_batch(self) -> Any:
        """Return an empty batch for the results of a chunk."""

    def gather(self, part: RowChunk) -> None:
        """Gather the successors of a chunk's rows, in any thread."""

    def sift(self, part: RowChunk) -> None:
        """Drop successors that are stored rows, in any thread."""

    def add(self, part: RowChunk, begin: ChunkMark, end: ChunkMark) -> None:
        """Store part of a chunk, as long as it is not void."""

    def expand_next(self) -> None:
        """Expand the next row at its turn, or learn its missing rule."""


class AllSteps:
    """All steps of the rows."""

    def __init__(self, expander: Expander) -> None:
        self.expander = expander
        self.store = expander.store

    def tables(self, *, is_alone: bool) -> tuple[LearnedModel, Any]:
        """Return the learned tables, as copies unless this thread is alone: learning changes them."""
        model = self.expander.model
        return (model.loops, model.symmetry[0]) if is_alone else model.snapshot()

    def new_batch(self) -> SuccessorBatch:
        """Return an empty batch."""
        return self.expander.new_batch(later=LATER_ROWS)

    def gather(self, part: RowChunk) -> None:
        """Gather the successors of a chunk's rows, in any thread."""
        rows = self.store.rows
        (model, exchanges), desk = part.tables, self.expander.model.symmetry[1]
        kernel.gather(model, exchanges, desk, rows.words, rows.shown, part.batch, part.state, part.end)
        if rows.shown is None:
            kernel.drop_repeated(part.batch, part.state)
        else:  # a look-up takes no longer than this check
            part.state[SIFTED] = part.state[GATHERED]

    def sift(self, part: RowChunk) -> None:
        """Drop the successors of a chunk that are stored rows."""
        part.state[SEEN] = self.store.shown
        kernel.sift(self.store.rows.words, self.store.table.room, part.batch, part.state)

    def add(self, part: RowChunk, begin: ChunkMark, end: ChunkMark) -> None:
        """Store part of a chunk."""
        self.expander.add(part.batch, (begin.steps, end.steps), (begin.found, end.found), end.row)

    def expand_next(self) -> None:
        """Expand the next row at its turn, or learn its missing rule."""
        self.expander.expand(self.store.expanded + 1)


class FrontierChunks:
    """The chunks that are ahead: any thread expands and sifts them, this thread stores them.

    Attributes:
        steps: Gathers the successors of their rows, stores them and learns missing rules.
        pipeline: Runs them.
        pace: The number of rows of the next chunk, if their successors fit its batch.
        breadth: The number of successors for each row of the last chunk.
        spare: Reusable batches of stored chunks.
        shape: The shape of these batches.
    """

    def __init__(self, expander: Expander, steps: ChunkSteps, threads: int) -> None:
        self.expander = expander
        self.steps = steps
        self.store = expander.store
        self.pipeline = self.store.readers = Pipeline[RowChunk](threads, steps.gather, steps.sift, WORTH)
        self.pace, self.breadth = FEW, 1.0
        self.spare: list[Any] = []
        self.shape = expander.shape

    def advance(self, end: int) -> None:
        """Store the results of the next chunk, while others go ahead; no chunk crosses `end`."""
        self._commit(self._next(end))

    def _next(self, end: int) -> RowChunk:
        """Return the next chunk, expanded; let other chunks go ahead up to the stored rows."""
        pipeline, store = self.pipeline, self.store
        if pipeline.ahead and pipeline.ahead[0].epoch != self.expander.model.epoch:
            pipeline.drop()
        if pipeline.begin is not None and pipeline.begin > store.expanded:  # a batch was full before its end
            pipeline.ahead.appendleft(self._chunk(store.expanded, pipeline.begin))
        begin = store.expanded if pipeline.end is None else pipeline.end
        most = self.expander.successors // 2
        while not pipeline.is_full and begin < (stop := end if begin < end else store.size):
            rows = min(self.pace, int(most / self.breadth), pipeline.fair(stop - begin))
            part = self._chunk(begin, min(begin + max(rows, 1), stop))
            pipeline.add(part)
            begin = part.end
        return pipeline.take()

    def _chunk(self, begin: int, end: int) -> RowChunk:
        """Return rows as a chunk, with the tables known now."""
        store = self.store
        tables = self.steps.tables(is_alone=self.pipeline.threads == 1)
        store.show()
        state = store.state.copy()
        state[[AT, GATHERED, SIFTED, PUT_OFF]] = begin, 0, 0, 0
        batch = self._batch()
        return RowChunk(begin, end, self.expander.model.epoch, self.shape, tables, batch, state)

    def _batch(self) -> Any:
        """Return an empty batch."""
        if self.shape != self.expander.shape:
            self.spare.clear()
            self.shape = self.expander.shape
        return self.spare.pop() if self.spare else self.steps.new_batch()

    def _commit(self, part: RowChunk) -> None:
        """Store the results of a chunk; deferred rows are expanded at their turn."""
        model, store, done, stop = self.expander.model, self.store, ChunkMark(part.begin), part.stop
        for mark in (*part.put_off(), stop):
            self.steps.add(part, done, mark)
            done = mark
            while mark is not stop and store.expanded == mark.row:
                self.steps.expand_next()
            if model.epoch != part.epoch:
                self.pipeline.drop()
                self.pace = FEW
                return
        self.breadth = max(stop.steps / (stop.row - part.begin), 0.5)
        self.pace = min(2 * self.pace, self.expander.successors)
        if part.shape == self.expander.shape:
            self.spare.append(part.batch)
