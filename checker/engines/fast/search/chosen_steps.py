"""Chunks of the frontier under partial-order reduction: any thread chooses ample sets, this thread stores them."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.model.learned_model import (
    AT,
    GATHERED,
    PUT_OFF,
    SIFTED,
    LearnedModel,
    State,
    SuccessorBatch,
)
from checker.engines.fast.reduce.actor_tables import EVERYBODY, Members
from checker.engines.fast.reduce.ample_kernel import gather_chosen
from checker.engines.fast.reduce.chosen_rows import ENDS, REJECTED, Chosen, store_chosen
from checker.engines.fast.reduce.partial_order import Choosing
from checker.engines.fast.reduce.proviso_paths import AT_ITS_TURN
from checker.engines.fast.search import frontier_chunks
from checker.engines.fast.search.expander import Expander
from checker.engines.fast.search.pipeline import ChunkMark, RowChunk
from checker.engines.fast.store import kernel


class ChunkTables(NamedTuple):
    """The tables learned at the start of a chunk; `actors` are the first fields of `Members`."""

    model: LearnedModel
    exchanges: Any
    actors: tuple[Any, ...]


class ChosenBatch(NamedTuple):
    """The chosen successors of a chunk, with scratch space for one row.

    Attributes:
        chosen: The chosen successors.
        row: All successors of one row.
        room: The last fields of `Members`.
    """

    chosen: Chosen
    row: SuccessorBatch
    room: tuple[Any, ...]

    @property
    def later(self) -> State:
        """The deferred rows (see `SuccessorBatch`)."""
        return self.chosen.into.later


class ChosenSteps:
    """The steps of ample sets.

    Args:
        expander: Knows rules and rows.
        choosing: Knows the actors of rows.
        threads: The number of threads.
    """

    def __init__(self, expander: Expander, choosing: Choosing, threads: int = 1) -> None:
        self.expander = expander
        self.store = expander.store
        self.choosing = choosing
        # A single thread had better learn missing rules at once.
        self.deferred = frontier_chunks.LATER_ROWS if threads > 1 else 1
        self._own: tuple[tuple[int, int, int], ChosenBatch] | None = None

    def tables(self, *, is_alone: bool) -> ChunkTables:
        """Return the learned tables, as copies unless this thread is alone: learning changes them."""
        model = self.expander.model
        loops, exchanges = (model.loops, model.symmetry[0]) if is_alone else model.snapshot()
        return ChunkTables(loops, exchanges, self.choosing.learned)

    def new_batch(self, *, deferred: int | None = None) -> ChosenBatch:
        """Return an empty batch, with room for so many deferred rows."""
        expander, count = self.expander, self.expander.successors
        row = expander.new_batch()
        into = row._replace(
            words=row.words[:0],
            kept=np.zeros(self.store.rows.kept * count, np.uint64),
            hashes=np.zeros(count, np.uint64),
            origins=np.zeros(count, np.int64),
            steps=np.zeros(count, np.int32),
            later=expander.new_batch(1, self.deferred if deferred is None else deferred).later,
        )
        taken = np.zeros(self.choosing.wide * count, np.uint64)
        rows = (np.zeros(count, np.int32), np.zeros(ENDS * count, np.int64), np.zeros(count, np.int64), taken)
        return ChosenBatch(Chosen(into, *rows), row, self.choosing.new_room(count))

    # --- chunks -----------------------------------------------------------------------------------------------------

    def gather(self, part: RowChunk) -> None:
        """Choose ample sets for a chunk's rows, and gather their successors, in any thread."""
        self._gather(part.tables, part.batch, part.begin, part.end, part.state, AT_ITS_TURN)

    def sift(self, part: RowChunk) -> None:
        """Drop nothing: the cycle proviso looks at successors that are stored rows."""

    def add(self, part: RowChunk, begin: ChunkMark, end: ChunkMark) -> None:
        """Store part of a chunk; a row whose set is not ample is expanded anew, which may void the rest."""
        model, row = self.expander.model, begin.row
        while row < end.row and model.epoch == part.epoch:
            if self._store(part.batch.chosen, part.begin, end.row, is_decided=False) == REJECTED:
                row = self.store.expanded
                while self.store.expanded == row:
                    self.expand_next()
            row = self.store.expanded

    def expand_next(self) -> None:
        """Expand the next row at its turn, or learn its missing rule."""
        state, begin, batch = self.store.state, self.store.expanded, self._own_batch()
        state[[AT, GATHERED, SIFTED, PUT_OFF]] = begin, 0, 0, 0
        known = self._gather(self.tables(is_alone=True), batch, begin, begin + 1, state, 0)
        end, state[GATHERED] = int(state[AT]), 0
        while self.store.expanded < end:
            self._store(batch.chosen, begin, end, is_decided=True)
        if not known:
            self.expander.learn()

    def gather_divided(self, until: int, end: int) -> tuple[bool, SuccessorBatch, NDArray[np.bool_]]:
        """Choose ample sets for rows from the state's on, in a search that is divided among workers.

        Args:
            until: The end of the rows.
            end: The first row of the next layer.

        Returns:
            False at something not learned yet; the chosen successors; for each row, whether some step is left out.
        """
        state, batch = self.store.state, self._own_batch()
        begin = int(state[AT])
        state[[GATHERED, SIFTED, PUT_OFF]] = 0
        known = self._gather(self.tables(is_alone=True), batch, begin, until, state, end)
        chosen, count = batch.chosen, int(state[GATHERED])
        kernel.count(chosen.into.steps, 0, count, self.expander.met.room)
        state[GATHERED] = 0  # of the expander's own batch
        reduced = chosen.onward[: int(state[AT]) - begin] != EVERYBODY
        return known, chosen.into._replace(steps=chosen.steps), reduced

    def _own_batch(self) -> ChosenBatch:
        """Return the batch of this thread, without room for deferred rows."""
        shape = self.expander.shape
        if self._own is None or self._own[0] != shape:
            self._own = shape, self.new_batch(deferred=0)
        return self._own[1]

    def _gather(
        self, tables: ChunkTables, batch: ChosenBatch, begin: int, end: int, state: State, decided: int
    ) -> bool:
        """Choose ample sets for rows; the cycle proviso is decided as `Trails.end` says."""
        store, desk = self.store, self.expander.model.symmetry[1]
        members, trails = members_of(tables.actors, batch.room), self.choosing.paths.trails(decided)
        known = (tables.model, members, tables.exchanges, desk, trails)
        folded = store.rows.shown if decided == AT_ITS_TURN else store.folded
        rows = (store.rows.words, folded, store.table.room, batch.row, batch.chosen)
        end = min(end, begin + len(batch.chosen.onward))
        return bool(gather_chosen(*known, *rows, begin, end, state))

    def _store(self, chosen: Chosen, begin: int, at: int, *, is_decided: bool) -> int:
        """Store the chosen successors of rows before row `at`; return why that ended (see `store_chosen`)."""
        store, expander, choosing = self.store, self.expander, self.choosing
        store.make_room(len(chosen.steps))
        if choosing.paths.lacks_room(store.rows.room):
            store.readers.rest()
            choosing.paths.reserve(store.rows.room)
        words, origins, table = store.arrays
        known = (*expander.model.making, choosing.paths.trails(), words, store.folded, origins, table)
        rows = (chosen, choosing.movers.room, begin, at, is_decided)
        ended = store_chosen(*known, *rows, expander.met.room, expander.counts.room, store.state)
        store.show()
        return int(ended)


def members_of(learned: tuple[Any, ...], room: tuple[Any, ...]) -> Members:
    """Return the tables of actors with scratch space, which grows with the number of actors."""
    members = Members._make((*learned, *room))
    if len(members.place) < len(members.part):
        members = members._replace(place=np.zeros(len(members.part), np.int32))
    return members
