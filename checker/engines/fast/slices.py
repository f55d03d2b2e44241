"""Slices of a space's rows that are expanded ahead of what is stored, by what was known when each was begun."""

from typing import Protocol

from checker.engines.fast import kernel
from checker.engines.fast.kernel import AT, GATHERED, PUT_OFF, SEEN, SIFTED
from checker.engines.fast.pages import Pages
from checker.engines.fast.pipeline import Pipeline, Slice
from checker.engines.fast.rows import Rows

FEW = 1 << 6
"""Rows of the first slice, and of the next one where what was found ahead turned out to be worth nothing."""

LATER_ROWS = 1 << 10
"""How many rows of a slice may be put off."""


class Storing(Protocol):
    """What stores what slices find, and learns what is not known: a `Space`, whose attributes these are."""

    rows: Rows
    table: Pages
    batch: kernel.Batch
    state: kernel.State
    actors: int
    stored: int

    @property
    def size(self) -> int:
        """How many rows there are."""

    @property
    def expanded(self) -> int:
        """How many of them were expanded."""

    @property
    def epoch(self) -> int:
        """A number that changes whenever what was found ahead may be worth nothing."""

    def known(self) -> kernel.Model:
        """Return what is known, as other threads may read it while more is learned."""

    def show(self) -> None:
        """Let other threads look up what is stored by now."""

    def new_batch(self, successors: int = 0, later: int = 0) -> kernel.Batch:
        """Return an empty batch that may put off so many rows."""

    def store(self, batch: kernel.Batch, steps: tuple[int, int], found: tuple[int, int], at: int) -> None:
        """Store some transitions of the rows before one, and successors that may be new."""

    def expand_here(self, until: int) -> None:
        """Expand rows up to a number in this thread, learning on the way."""


class Slices:
    """The slices of a space that are ahead: they are begun, expanded and sifted in any thread, and stored in this one.

    Attributes:
        space: Stores what they find, and learns what is not known.
        pipeline: Runs them.
        pace: How many rows the next slice has, if one has not too many successors.
        breadth: How many successors a row of the last slice had.
        spare: Batches of slices that were stored.
    """

    def __init__(self, space: Storing, threads: int) -> None:
        self.space = space
        self.pipeline = Pipeline(threads, self._expand, self._sift)
        self.pace, self.breadth = FEW, 1.0
        self.spare: list[kernel.Batch] = []

    def advance(self, end: int) -> None:
        """Store what the next slice found, and let others go ahead; no slice lies on both sides of some end."""
        self._commit(self._next(end))

    def _next(self, end: int) -> Slice:
        """Return the slice that comes next, expanded; let others go ahead, as far as rows are stored."""
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

    def _slice(self, begin: int, end: int) -> Slice:
        """Return rows as a slice, to be expanded by what is known now."""
        space = self.space
        known = space.known()
        space.show()
        state = space.state.copy()
        state[[AT, GATHERED, PUT_OFF]] = begin, 0, 0
        batch = self.spare.pop() if self.spare else space.new_batch(later=LATER_ROWS)
        return Slice(begin, end, space.epoch, known, batch, state)

    def _expand(self, part: Slice) -> None:
        """Expand a slice, in any thread."""
        rows = self.space.rows
        folded = rows.shown
        kernel.gather(part.model, rows.words, folded, part.batch, part.state, part.end)
        if folded is None:
            kernel.drop_repeated(part.batch, part.state)
        else:  # looking them up takes no longer
            part.state[SIFTED] = part.state[GATHERED]

    def _sift(self, part: Slice) -> None:
        """Leave of a slice only what is none of the rows that are stored."""
        space = self.space
        part.state[SEEN] = space.stored
        kernel.sift(space.rows.words, space.table.room, part.batch, part.state)

    def _commit(self, part: Slice) -> None:
        """Store what was found in a slice; rows that were put off are expanded when their turn comes."""
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
