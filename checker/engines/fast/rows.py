"""The rows of a space with their parents, as one value: both have the same capacity. Wide rows are folded."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast import folding
from checker.engines.fast.kernel import repack
from checker.engines.fast.origins import OriginPages, Rising
from checker.engines.fast.pages import Pages, more

BLOCK = 1 << 12
"""Rows that are unfolded at once."""


class Rows:
    """Rows one after another, so many words each, and their origins.

    Attributes:
        width: How many words a row has.
        kept: How many words are kept of each: of rows that are folded two.
        origins: From which row each was first reached.
    """

    __slots__ = ("_folding", "_words", "kept", "origins", "width")

    def __init__(self, width: int, room: int, origins: type[OriginPages] = Rising) -> None:
        self.width = self.kept = width
        self._words = Pages(np.uint64, room * width)
        self.origins = origins(room)
        self._folding: folding.Folding | None = None

    @property
    def words(self) -> NDArray[np.uint64]:
        """What is kept of all rows, with their room; growing makes another array: don't keep it."""
        return self._words.room

    @property
    def folded(self) -> folding.Folded | None:
        """What folds and unfolds rows, None where they are not folded; making room makes another: don't keep it."""
        return None if self._folding is None else self._folding.folded

    @property
    def shown(self) -> folding.Folded | None:
        """The same for threads that only look up, as it was shown last."""
        return None if self._folding is None else self._folding.shown

    def show(self) -> None:
        """Let all threads look up what rows are folded into by now."""
        if self._folding is not None:
            self._folding.show()

    @property
    def interned(self) -> tuple[NDArray[np.uint64], NDArray[np.uint64]]:
        """The pieces and nodes of rows that are folded, none of others."""
        none = np.zeros(0, np.uint64)
        into = self._folding
        return (none, none) if into is None else (into.pieces.words, into.nodes.words)

    @property
    def room(self) -> int:
        """How many rows it has room for."""
        return min(len(self.words) // self.kept, self.origins.rows)

    @property
    def spilled(self) -> bool:
        """Whether both are in files."""
        return self._words.spilled and self.origins.spilled

    @property
    def bytes_each(self) -> float:
        """How many bytes of memory a row more takes, if all that it is folded into is there."""
        return 0.0 if self.spilled else self.words.itemsize * self.kept + self.origins.bytes_each

    def held(self, used: int) -> int:
        """Return how many bytes it takes if only so many first rows were written."""
        folded = 0 if self._folding is None else self._folding.held
        return self._words.held(used * self.kept) + self.origins.held(used) + folded

    def row(self, number: int) -> NDArray[np.uint64]:
        """Return the words of a row."""
        kept = self.words[number * self.kept : (number + 1) * self.kept]
        return self._whole(kept)

    def blocks(self, size: int) -> Iterator[tuple[int, NDArray[np.uint64]]]:
        """Yield the words of so many first rows, some at a time, with the number of the first of them."""
        for begin in range(0, size, BLOCK):
            kept = self.words[begin * self.kept : min(begin + BLOCK, size) * self.kept]
            yield begin, self._whole(kept)

    def _whole(self, kept: NDArray[np.uint64]) -> NDArray[np.uint64]:
        if self._folding is None:
            return kept
        words = np.zeros(len(kept) // self.kept * self.width, np.uint64)
        folding.unfold_rows(self._folding.folded, kept, self.width, words)
        return words

    # --- room -----------------------------------------------------------------------------------------------------

    def has_room(self, rows: int) -> bool:
        """Tell whether there is room for so many rows in all, and for what one more is folded into."""
        return rows <= self.room and (self._folding is None or self._folding.has_room)

    def reserve(self, rows: int) -> None:
        """Make that room, and more than that where some must be made; meanwhile no other thread looks at rows.

        Raises:
            OSError: There is no room for them.
        """
        if rows > self.room:
            self._grow(max(rows, more(self.room)), self.kept)
        if self._folding is not None:
            self._folding.reserve()

    def widen(self, width: int) -> None:
        """Give each row so many words, no fewer than it has; the caller moves what stands in them.

        Raises:
            OSError: There is no room for them; rows are as wide as before.
        """
        self._grow(self.room, width)
        self.width = self.kept = width

    def _grow(self, rows: int, kept: int) -> None:
        self._words.grow(rows * kept)
        self.origins.grow(rows)

    def spill(self, folder: Path, used: int) -> None:
        """Go over to files in a folder, with the first so many rows; what they are folded into stays in memory.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        self._words.spill(folder, used * self.kept)
        self.origins.spill(folder, used)

    # --- another packing ------------------------------------------------------------------------------------------

    def repack(self, size: int, moves: NDArray[np.uint64], width: int, *, fold: bool) -> None:
        """Pack so many rows anew, each into so many words, no fewer than it has.

        What moves is told by `columns.shifts`.

        Raises:
            OSError: There is no room for them.
        """
        if not fold:
            before = self.width
            self.widen(width)
            repack(self.words, size, moves, before, width)
            return
        into, kept = folding.Folding(width), Pages(np.uint64, folding.PAIR * self.room)
        for begin, block in self.blocks(size):
            count = len(block) // self.width
            words = np.zeros(count * width, np.uint64)
            words[: len(block)] = block
            repack(words, count, moves, self.width, width)
            _fold(into, words, kept.room[folding.PAIR * begin : folding.PAIR * (begin + count)])
        if self.spilled:
            self._words.grow(len(kept.room))  # rows may have had one word
            self.words[: folding.PAIR * size] = kept.room[: folding.PAIR * size]
        else:
            self._words = kept
        self._folding, self.width, self.kept = into, width, folding.PAIR

    @classmethod
    def of(
        cls,
        width: int,
        size: int,
        kept: NDArray[np.uint64],
        origins: NDArray[np.uint64],
        *interned: NDArray[np.uint64],
    ) -> "Rows":
        """Return so many rows as they were kept elsewhere, with what they are folded into (see `interned`).

        Raises:
            ValueError: They have not so many words each, what they are folded into is not there, or is there twice, or
                their origins are not those of any search.
        """
        into = folding.Folding(width, *interned) if any(map(len, interned)) else None
        found = cls(
            width if into is None else folding.PAIR,
            len(kept) // (width if into is None else folding.PAIR) or 1,
        )
        if len(kept) != size * found.kept or not (into is None or into.are_rows(kept)):
            raise ValueError("it has other rows")
        found.width, found._folding = width, into
        found.words[: len(kept)] = kept
        found.origins.restore(origins, size)
        return found


def _fold(into: folding.Folding, words: NDArray[np.uint64], kept: NDArray[np.uint64]) -> None:
    done = 0
    while (done := folding.fold_rows(into.folded, words, into.width, kept, done)) < len(kept) // folding.PAIR:
        into.reserve()
