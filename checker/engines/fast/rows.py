"""The rows of a space with their parents, as one value: both have the same capacity."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.pages import Pages, more


class Rows:
    """Rows one after another, so many words each, and their origins.

    Attributes:
        width: How many words a row has.
    """

    __slots__ = ("_origins", "_words", "width")

    def __init__(self, width: int, room: int, origin: type[np.generic] = np.uint32) -> None:
        self.width = width
        self._words = Pages(np.uint64, room * width)
        self._origins = Pages(origin, room)

    @property
    def words(self) -> NDArray[np.uint64]:
        """The words of all rows, with their room; growing makes another array: don't keep it."""
        return self._words.room

    @property
    def origins(self) -> NDArray[Any]:
        """The origins of all rows, with their room; growing makes another array: don't keep it."""
        return self._origins.room

    @property
    def room(self) -> int:
        """How many rows it has room for."""
        return min(len(self.words) // self.width, len(self.origins))

    @property
    def spilled(self) -> bool:
        """Whether both are in files."""
        return self._words.spilled and self._origins.spilled

    def held(self, used: int) -> int:
        """Return how many bytes it takes if only so many first rows were written."""
        return self._words.held(used * self.width) + self._origins.held(used)

    def reserve(self, rows: int) -> None:
        """Make room for so many rows in all, and for more than that where some must be made.

        Raises:
            OSError: There is no room for them.
        """
        if rows > self.room:
            self._grow(max(rows, more(self.room)), self.width)

    def widen(self, width: int) -> None:
        """Give each row so many words, no fewer than it has; the caller moves what stands in them.

        Raises:
            OSError: There is no room for them; rows are as wide as before.
        """
        self._grow(self.room, width)
        self.width = width

    def _grow(self, rows: int, width: int) -> None:
        self._words.grow(rows * width)
        self._origins.grow(rows)

    def spill(self, folder: Path, used: int) -> None:
        """Go over to files in a folder, with the first so many rows.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        self._words.spill(folder, used * self.width)
        self._origins.spill(folder, used)
