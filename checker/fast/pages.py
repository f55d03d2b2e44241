"""Large arrays in pages of their own: huge ones where the system has them, grown without being copied."""

import mmap
from typing import Any

import numpy as np
from numpy.typing import NDArray


class Pages:
    """A one-dimensional array that grows in place; what was never written takes no memory.

    Attributes:
        room: The whole array, zeros where nothing was written. `grow` makes another: don't keep it.
    """

    __slots__ = ("_kind", "_pages", "room")

    def __init__(self, kind: type[np.generic], count: int) -> None:
        self._kind = np.dtype(kind)
        self._map(count)
        self.room: NDArray[Any] = np.frombuffer(self._pages, self._kind)

    def grow(self, count: int) -> None:
        """Make room for so many in all."""
        if count > len(self.room):
            self.room = np.zeros(0, self._kind)  # the pages can't move while an array stands on them
            self._resize(count)
            self.room = np.frombuffer(self._pages, self._kind)

    def _resize(self, count: int) -> None:
        try:
            self._pages.resize(self._bytes(count))
            self._advise()
        except BufferError:  # a traceback or the compiler still holds the array: leave it the old pages
            held = np.frombuffer(self._pages, np.uint8)
            self._map(count)
            np.frombuffer(self._pages, np.uint8)[: len(held)] = held

    def _map(self, count: int) -> None:
        self._pages = mmap.mmap(-1, self._bytes(count), flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
        self._advise()

    def _bytes(self, count: int) -> int:
        return -(-count * self._kind.itemsize // mmap.PAGESIZE) * mmap.PAGESIZE

    def _advise(self) -> None:
        if hasattr(mmap, "MADV_HUGEPAGE"):
            self._pages.madvise(mmap.MADV_HUGEPAGE)
