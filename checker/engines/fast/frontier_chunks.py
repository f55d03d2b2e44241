"""Chunks of the frontier, expanded ahead of the stored rows with the trees known at their start."""

from checker.engines.fast import kernel
from checker.engines.fast.expander import Expander
from checker.engines.fast.learned_model import AT, GATHERED, PUT_OFF, SEEN, SIFTED, SuccessorBatch
from checker.engines.fast.pipeline import Pipeline, RowChunk

FEW = 1 << 6
"""The number of rows of the first chunk, and of the next one after results ahead were void."""

LATER_ROWS = 1 << 10
"""The greatest number of deferred rows in a chunk."""


class FrontierChunks:
    """The chunks that are ahead: any thread expands and sifts them, this thread stores them.

    Attributes:
        expander: Stores their results and learns missing rules.
        pipeline: Runs them.
        pace: The number of rows of the next chunk, if their successors fit its batch.
        breadth: The number of successors for each row of the last chunk.
        spare: Reusable batches of stored chunks.
        shape: The shape of these batches.
    """

    def __init__(self, expander: Expander, threads: int) -> None:
        self.expander = expander
        self.store = expander.store
        self.pipeline = self.store.readers = Pipeline(threads, self._expand, self._sift)
        self.pace, self.breadth = FEW, 1.0
        self.spare: list[SuccessorBatch] = []
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
        """Return rows as a chunk, with the trees known now."""
        model, store = self.expander.model, self.store
        known = (model.loops, model.symmetry[0]) if self.pipeline.threads == 1 else model.snapshot()
        store.show()
        state = store.state.copy()
        state[[AT, GATHERED, PUT_OFF]] = begin, 0, 0
        return RowChunk(begin, end, model.epoch, *known, self._batch(), state)

    def _batch(self) -> SuccessorBatch:
        """Return an empty batch."""
        if self.shape != self.expander.shape:
            self.spare.clear()
            self.shape = self.expander.shape
        return self.spare.pop() if self.spare else self.expander.new_batch(later=LATER_ROWS)

    def _expand(self, part: RowChunk) -> None:
        """Expand a chunk, in any thread."""
        rows = self.store.rows
        folded, desk = rows.shown, self.expander.model.symmetry[1]
        kernel.gather(part.model, part.exchanges, desk, rows.words, folded, part.batch, part.state, part.end)
        if folded is None:
            kernel.drop_repeated(part.batch, part.state)
        else:  # a look-up takes no longer than this check
            part.state[SIFTED] = part.state[GATHERED]

    def _sift(self, part: RowChunk) -> None:
        """Drop the successors of a chunk that are stored rows."""
        part.state[SEEN] = self.store.shown
        kernel.sift(self.store.rows.words, self.store.table.room, part.batch, part.state)

    def _commit(self, part: RowChunk) -> None:
        """Store the results of a chunk; deferred rows are expanded at their turn."""
        expander, steps, found = self.expander, 0, 0
        for row, steps_before, found_before in part.put_off():
            expander.add(part.batch, (steps, steps_before), (found, found_before), row)
            steps, found = steps_before, found_before
            while self.store.expanded == row:
                expander.expand(row + 1)
            if expander.model.epoch != part.epoch:
                self.pipeline.drop()
                self.pace = FEW
                return
        expander.add(part.batch, (steps, part.gathered), (found, part.sifted), part.at)
        self.breadth = max(part.gathered / (part.at - part.begin), 0.5)
        self.pace = min(2 * self.pace, len(part.batch.hashes))
        if len(part.batch.leaves) == expander.model.actors:
            self.spare.append(part.batch)
