"""The rows of a store with their origins, growing together; wide rows are tree-compressed."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.mapped_arrays import Pages, more
from checker.engines.fast.store import tree_compression
from checker.engines.fast.store.origins import OriginPages, Rising
from checker.engines.fast.store.repacking import repack

BLOCK = 1 << 12
"""The number of rows that are decompressed at once."""


class Rows:
    """Rows one after another, of equal width, and their origins.

    Attributes:
        width: The number of words of a row.
        kept: The number of words of its stored form: two for compressed rows.
        origins: The row from which each was first reached.
    """

    __slots__ = ("_folding", "_words", "kept", "origins", "width")

    def __init__(self, width: int, room: int, origins: type[OriginPages] = Rising) -> None:
        self.width = self.kept = width
        self._words = Pages(np.uint64, room * width)
        self.origins = origins(room)
        self._folding: tree_compression.Folding | None = None

    @property
    def words(self) -> NDArray[np.uint64]:
        """The stored form of all rows, with spare capacity. Growing replaces it: don't keep it."""
        return self._words.room

    @property
    def folded(self) -> tree_compression.FoldedTable | None:
        """The tables of tree compression, None for plain rows. Growing replaces them: don't keep them."""
        return None if self._folding is None else self._folding.folded

    @property
    def shown(self) -> tree_compression.FoldedTable | None:
        """The same tables for reading threads, as last published."""
        return None if self._folding is None else self._folding.shown

    def show(self) -> None:
        """Publish the present tables to all threads."""
        if self._folding is not None:
            self._folding.show()

    @property
    def interned(self) -> tuple[NDArray[np.uint64], NDArray[np.uint64]]:
        """The pieces and nodes of compressed rows; empty for plain rows."""
        none = np.zeros(0, np.uint64)
        into = self._folding
        return (none, none) if into is None else (into.pieces.words, into.nodes.words)

    @property
    def room(self) -> int:
        """The number of rows for which there is room."""
        return min(len(self.words) // self.kept, self.origins.rows)

    @property
    def spilled(self) -> bool:
        """Whether rows and origins are in files."""
        return self._words.spilled and self.origins.spilled

    @property
    def bytes_each(self) -> float:
        """The bytes of memory for one more row, apart from new pieces."""
        return 0.0 if self.spilled else self.words.itemsize * self.kept + self.origins.bytes_each

    def held(self, used: int) -> int:
        """Return the bytes taken if only the first `used` rows were written."""
        folded = 0 if self._folding is None else self._folding.held
        return self._words.held(used * self.kept) + self.origins.held(used) + folded

    def row(self, number: int) -> NDArray[np.uint64]:
        """Return the words of a row."""
        kept = self.words[number * self.kept : (number + 1) * self.kept]
        return self._whole(kept)

    def blocks(self, size: int) -> Iterator[tuple[int, NDArray[np.uint64]]]:
        """Yield the words of the first `size` rows, block by block, with the number of the first row of each."""
        for begin in range(0, size, BLOCK):
            yield begin, self.plain(begin, min(begin + BLOCK, size))

    def plain(self, begin: int, end: int) -> NDArray[np.uint64]:
        """Return the words of a range of rows."""
        return self._whole(self.words[begin * self.kept : end * self.kept])

    def _whole(self, kept: NDArray[np.uint64]) -> NDArray[np.uint64]:
        if self._folding is None:
            return kept
        words = np.zeros(len(kept) // self.kept * self.width, np.uint64)
        tree_compression.unfold_rows(self._folding.folded, kept, self.width, words)
        return words

    # --- room -----------------------------------------------------------------------------------------------------

    def has_room(self, rows: int) -> bool:
        """Return whether there is room for `rows` rows in all, and for the pieces of one more."""
        return rows <= self.room and (self._folding is None or self._folding.has_room)

    def reserve(self, rows: int) -> None:
        """Make room for `rows` rows in all, or for more; no other thread may read rows meanwhile.

        Raises:
            OSError: Memory or the files have no room.
        """
        if rows > self.room:
            self._grow(max(rows, more(self.room)), self.kept)
        if self._folding is not None:
            self._folding.reserve()

    def widen(self, width: int) -> None:
        """Give each row at least as many words as before; the caller moves the contents.

        Raises:
            OSError: There is no room; rows are as wide as before.
        """
        self._grow(self.room, width)
        self.width = self.kept = width

    def _grow(self, rows: int, kept: int) -> None:
        self._words.grow(rows * kept)
        self.origins.grow(rows)

    def spill(self, folder: Path, used: int) -> None:
        """Move rows and origins to files in a folder; the pieces and nodes of compressed rows stay in memory.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        self._words.spill(folder, used * self.kept)
        self.origins.spill(folder, used)

    # --- another packing ------------------------------------------------------------------------------------------

    def repack(self, size: int, moves: NDArray[np.uint64], width: int, *, fold: bool) -> None:
        """Repack `size` rows into `width` words each, at least as many as before, and compress them if `fold`.

        `moves` come from `columns.shifts`.

        Raises:
            OSError: There is no room.
        """
        if not fold:
            before = self.width
            self.widen(width)
            repack(self.words, size, moves, before, width)
            return
        into, kept = tree_compression.Folding(width), Pages(np.uint64, tree_compression.PAIR * self.room)
        for begin, block in self.blocks(size):
            count = len(block) // self.width
            words = np.zeros(count * width, np.uint64)
            words[: len(block)] = block
            repack(words, count, moves, self.width, width)
            _fold(
                into,
                words,
                kept.room[tree_compression.PAIR * begin : tree_compression.PAIR * (begin + count)],
            )
        if self.spilled:
            self._words.grow(len(kept.room))  # rows may have had one word
            self.words[: tree_compression.PAIR * size] = kept.room[: tree_compression.PAIR * size]
        else:
            self._words = kept
        self._folding, self.width, self.kept = into, width, tree_compression.PAIR

    @classmethod
    def of(
        cls,
        reached: type[OriginPages],
        width: int,
        size: int,
        kept: NDArray[np.uint64],
        origins: NDArray[np.uint64],
        *interned: NDArray[np.uint64],
    ) -> "Rows":
        """Return the rows of their stored form, with the pieces and nodes of compressed rows (see `interned`).

        Raises:
            ValueError: The rows have another width, pieces or nodes are missing or repeated, or no search has these
                origins.
        """
        into = tree_compression.Folding(width, *interned) if any(map(len, interned)) else None
        found = cls(
            width if into is None else tree_compression.PAIR,
            len(kept) // (width if into is None else tree_compression.PAIR) or 1,
            reached,
        )
        if len(kept) != size * found.kept or not (into is None or into.are_rows(kept)):
            raise ValueError("it has other rows")
        found.width, found._folding = width, into
        found.words[: len(kept)] = kept
        found.origins.restore(origins, size)
        return found


def _fold(into: tree_compression.Folding, words: NDArray[np.uint64], kept: NDArray[np.uint64]) -> None:
    done = 0
    while (done := tree_compression.fold_rows(into.folded, words, into.width, kept, done)) < len(
        kept
    ) // tree_compression.PAIR:
        into.reserve()
