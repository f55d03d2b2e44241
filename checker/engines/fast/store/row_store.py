"""The store: the rows of an exploration, each once, with their origins and the table that finds them.

It knows nothing of rules: a row has a code for each column, at the column's place in the packing.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.mapped_arrays import Pages
from checker.engines.fast.compiled.table import alone, most_in, rebuild, slots_for, slots_within
from checker.engines.fast.model.columns import WORD, Packing, bits_of, packing, packing_in_order, shifts
from checker.engines.fast.model.learned_model import (
    CUT,
    EXPANDED,
    KEPT,
    LIMIT,
    SIZE,
    STATE,
    WORDS,
    SuccessorBatch,
)
from checker.engines.fast.store import kernel, repacking
from checker.engines.fast.store.origins import OriginPages, Rising
from checker.engines.fast.store.rows import Rows
from checker.engines.fast.store.tree_compression import PAIR, FoldedTable, fold_found

FIRST_ROWS = 1 << 15
MOST_ROWS = (1 << 31) - 1

PLAIN = 2
"""The greatest width in words of rows that are never tree-compressed."""

COMPRESSED_FROM = 1 << 15
"""The number of wide rows from which they are tree-compressed: the loops for it take seconds to compile."""

Making = tuple[Any, Any, Any]
"""The makers of successors: the model's tables, the symmetry tables and this thread's scratch space (None without)."""


@dataclass(frozen=True, slots=True)
class RowFormat:
    """The form in which a store keeps its rows.

    Attributes:
        origins: The form of their origins.
        compressible: Whether rows are tree-compressed once they are wide and many.
        travels: Whether successors are made plain in any case, since they may leave the store.
    """

    origins: type[OriginPages] = Rising
    compressible: bool = True
    travels: bool = False


class Readers(Protocol):
    """The threads that read rows of a store."""

    def rest(self) -> None:
        """Stop reading until this thread lets them go on."""

    def divide(self, work: Callable[[range], Any], parts: int) -> list[Any]:
        """Run some work on ranges of `parts` parts in all threads, and return the results."""


class NoReaders:
    """No other thread reads rows."""

    def rest(self) -> None:
        """Do nothing."""

    def divide(self, work: Callable[[range], Any], parts: int) -> list[Any]:
        """Do the work in this thread."""
        return alone(work, parts)


class RowStore:
    """Rows, their origins and their hash table, growing together.

    Attributes:
        format: The form of the rows.
        state: The numbers that all compiled loops on these rows read and write (see `learned_model`).
        packing: The position of each column in a row.
        rows: The packed rows with their origins; the first is its own origin.
        table: The hash table of row numbers.
        changes: The number of repackings.
        shown: The number of rows that other threads may look up.
        readers: The threads that read rows.
        left: Returns the bytes of memory still available; the table grows less when they run out.
    """

    packing: Packing

    def __init__(self, limit: int | None = None, form: RowFormat | None = None) -> None:
        self.format = RowFormat() if form is None else form
        self.state = np.zeros(STATE, np.int64)
        self.state[LIMIT] = MOST_ROWS if limit is None else min(limit, MOST_ROWS)
        self.rows = Rows(1, FIRST_ROWS, self.format.origins)
        self.table = Pages(np.uint32, 1)
        self.changes = self.shown = 0
        self.readers: Readers = NoReaders()
        self.left: Callable[[], float] = lambda: math.inf

    @property
    def size(self) -> int:
        """The number of rows."""
        return int(self.state[SIZE])

    @property
    def expanded(self) -> int:
        """The number of rows with all successors stored."""
        return int(self.state[EXPANDED])

    @property
    def was_cut(self) -> bool:
        """Whether the limit left rows out."""
        return bool(self.state[CUT])

    @property
    def spilled(self) -> bool:
        """Whether rows and origins are in files."""
        return self.rows.spilled

    @property
    def bytes_used(self) -> int:
        """The bytes of rows, origins and table; unwritten capacity takes none."""
        return self.rows.held(self.size) + self.table.room.nbytes

    @property
    def folded(self) -> FoldedTable | None:
        """The tables by which successors are made compressed; None if they are made plain."""
        return None if self.format.travels else self.rows.folded

    @property
    def arrays(self) -> tuple[Any, Any, Any]:
        """The rows, origins and table for the loops that add rows. Growing replaces them: don't keep them."""
        return self.rows.words, self.rows.origins.loops, self.table.room

    def codes(self, number: int) -> list[int]:
        """Return the code of each column in a row."""
        return self.packing.codes(self.rows.row(number))

    def origin(self, number: int) -> int:
        """Return the row from which a row was first reached."""
        return self.rows.origins.origin(number, self.size)

    # --- adding and finding ---------------------------------------------------------------------------------------

    def begin(self, sizes: Sequence[int], codes: Sequence[int]) -> None:
        """Add the first row; `sizes` are the numbers of values of the columns."""
        where = packing(sizes)
        self.rows.widen(where.words)
        self._take_packing(where)
        self.rows.words[: where.words] = where.packed(codes)
        self.state[SIZE] = 1

    def add(self, batch: SuccessorBatch, found: tuple[int, int], making: Making) -> None:
        """Add the new ones of a range of successors."""
        begin, end = found
        batch = self._stored_form(batch, begin, end, adding=True)
        while begin < end:  # so the time of growth does not depend on the batch
            self.make_room(1)
            known = (*self.arrays, *self._completing(making))
            begin = int(kernel.store(*known, batch, begin, end, self.state))

    def look_up(self, batch: SuccessorBatch, count: int, making: Making) -> NDArray[np.int64]:
        """Return the number of each of the first successors of a batch, less than 0 for those that are no rows."""
        targets = np.zeros(count, np.int64)
        batch = self._stored_form(batch, 0, count, adding=False)
        known = (self.rows.words, self.table.room, *self._completing(making))
        kernel.look_up(*known, batch, targets, self.state)
        return targets

    def _completing(self, making: Making) -> tuple[Any, Any, Any, Any]:
        """Return the tables that complete a compressed successor. Growing replaces them: don't keep them."""
        return (None, None, None, None) if self.folded is None else (*making, self.folded)

    def _stored_form(self, batch: SuccessorBatch, begin: int, end: int, *, adding: bool) -> SuccessorBatch:
        """Return a batch of plain successors with those of a range in the form in which the rows are stored."""
        rows = self.rows
        if rows.folded is None or not self.format.travels:
            return batch
        kept, hashes = np.zeros(PAIR * end, np.uint64), np.zeros(end, np.uint64)
        while begin < end:
            begin = fold_found(rows.folded, rows.words, batch.kept, rows.width, kept, hashes, begin, adding)
            if begin < end:
                self.readers.rest()
                rows.reserve(0)
        return batch._replace(kept=kept, hashes=hashes)

    def show(self) -> None:
        """Publish the rows to other threads."""
        self.rows.show()
        self.shown = self.size

    def adopt(self, where: Packing, rows: Rows, size: int, sizes: Sequence[int]) -> None:
        """Replace the rows by `size` others, in a packing of columns with `sizes` values.

        Raises:
            ValueError: They have other columns or values.
        """
        begins = np.concatenate(([0], np.cumsum(np.array(sizes, np.int64))))
        used = np.zeros(begins[-1], np.bool_)
        if len(where.mask) != len(sizes) or not all(
            repacking.mark_used(words, where.words, where.columns, begins, used)
            for _, words in rows.blocks(size)
        ):
            raise ValueError("it has other columns, or values outside of theirs")
        self.rows = rows
        self._take_packing(where)
        self.state[SIZE] = size
        self.rebuild(slots_for(size))

    def keep(self, size: int) -> None:
        """Keep the first `size` rows, and add no more."""
        self.state[SIZE] = self.state[LIMIT] = size
        self.state[CUT] += 1
        self.rebuild()

    def clear(self) -> None:
        """Discard all rows; their packing and room stay."""
        self.rows = Rows(self.packing.words, self.rows.room, self.format.origins)
        self.state[:] = 0
        self.state[[LIMIT, WORDS, KEPT]] = MOST_ROWS, self.packing.words, self.rows.kept

    # --- packing --------------------------------------------------------------------------------------------------

    def pack(self, sizes: Sequence[int], wanted: Callable[[], tuple[Sequence[int], Sequence[int]]]) -> None:
        """Give each column of the rows enough bits for its number of values.

        Args:
            sizes: The number of values of each column.
            wanted: Returns, for another packing, the number of values to make room for in each column, and the order of
                the columns of wide rows: so a transition changes few pieces of a row.
        """
        self.packing = self.packing.extended(sizes)
        if not self.packing.holds(sizes):
            self._repack(self._wider(*wanted()))

    def compress(self) -> bool:
        """Compress the rows if they are wide and many; return whether they were plain before."""
        if self.rows.folded is not None or not self._is_compressed(self.packing):
            return False
        self._repack(self.packing)
        return True

    def _is_compressed(self, where: Packing) -> bool:
        """Return whether rows of a packing are tree-compressed; rows that once were stay so."""
        wide = where.words > PLAIN and self.format.compressible
        return wide and (self.rows.folded is not None or self.size >= COMPRESSED_FROM)

    def _wider(self, room: Sequence[int], order: Sequence[int]) -> Packing:
        """Return a packing with room for `room` values in each column, in at least as many words as now."""
        if not self.format.compressible or -(-sum(bits_of(room)) // WORD) <= PLAIN:
            new = packing(room, self.packing.words)
            if not self.format.compressible or new.words <= PLAIN:
                return new
        return packing_in_order(room, order, self.packing.words)

    def _repack(self, new: Packing) -> None:
        """Store the rows in another packing, compressed if they are wide and many."""
        self.readers.rest()
        moves = shifts(self.packing, new)
        self.rows.repack(self.size, moves, new.words, fold=self._is_compressed(new))
        self._take_packing(new)
        self.rebuild()

    def _take_packing(self, where: Packing) -> None:
        """Adopt the packing that the rows already have."""
        self.readers.rest()
        self.changes += 1
        self.packing, self.state[WORDS], self.state[KEPT] = where, where.words, self.rows.kept

    # --- room -----------------------------------------------------------------------------------------------------

    def make_room(self, rows: int) -> None:
        """Make room for `rows` new rows."""
        wanted = min(self.size + rows, int(self.state[LIMIT]))
        if not self.rows.has_room(wanted):
            self.readers.rest()
            self.rows.reserve(wanted)
        if most_in(len(self.table.room)) < wanted:
            self.rebuild(self._slots(wanted))

    def _slots(self, rows: int) -> int:
        """Return the size of the next table: for half as many rows more, or for fewer when memory runs out."""
        table = self.table.room
        left = self.left() + table.nbytes
        within = min(slots_for(rows), slots_within(left, self.size, self.rows.bytes_each, table.itemsize))
        return max(int(within), slots_for(rows) * 3 // 4)

    def rebuild(self, slots: int | None = None) -> None:
        """Fill a new table of `slots` slots, by default as many as now."""
        self.readers.rest()
        slots = len(self.table.room) if slots is None else slots
        self.table = Pages(np.uint32, 1)  # give the old one back before the next is taken
        self.table = Pages(np.uint32, slots)
        rebuild(self.rows.words, self.size, self.rows.kept, self.table.room, self.readers.divide)

    def spill(self, folder: Path) -> None:
        """Move rows and origins to files in a folder; the table, with its random accesses, stays in memory.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        self.readers.rest()
        self.rows.spill(folder, self.size)
