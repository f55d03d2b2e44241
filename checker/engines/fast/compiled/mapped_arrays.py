"""Arrays in memory pages of their own, which grow without copying; large ones use huge pages where available.

They can move to a file, which the system then writes and reads as it needs memory. The file has no name, so nothing of
it remains, however the process ends.
"""

import mmap
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bigraphs.unnamed_files import reserve, unnamed_file

PIECE = 1 << 20
"""The number of elements copied at once."""

HUGE = 1 << 21
"""The bytes of a huge page, the largest unit of allocation."""

LARGE = 8 * HUGE
"""The least size in bytes for huge pages: a smaller array would leave too much of its last page unused."""


class Pages:
    """A one-dimensional array that grows in place; unwritten elements take no memory.

    Attributes:
        room: The whole array, zero where unwritten. `grow` and `spill` replace it: don't keep it.
    """

    __slots__ = ("__weakref__", "_file", "_kind", "_pages", "room")

    def __init__(self, kind: type[np.generic], count: int) -> None:
        self._kind = np.dtype(kind)
        self._file: int | None = None
        self._map(count)
        self.room: NDArray[Any] = np.frombuffer(self._pages, self._kind)

    @property
    def spilled(self) -> bool:
        """Whether the array is in a file."""
        return self._file is not None

    def held(self, used: int) -> int:
        """Return the bytes taken if only the first `used` elements were written; a file takes its full size."""
        if self.spilled:
            return self.room.nbytes
        page = HUGE if self._is_large else mmap.PAGESIZE
        return min(-(-used * self._kind.itemsize // page) * page, self.room.nbytes)

    def grow(self, count: int) -> None:
        """Make room for `count` elements in all.

        Raises:
            OSError: The file or memory has no room; the array is unchanged.
        """
        if count > len(self.room):
            if self._file is not None:
                reserve(self._file, self._bytes(count))
            self.room = np.zeros(0, self._kind)  # pages can't move while an array refers to them
            try:
                self._resize(count)
            finally:
                self.room = np.frombuffer(self._pages, self._kind)

    def _resize(self, count: int) -> None:
        if self._file is not None:
            # A holder of the old pages has the same file.
            self._pages = mmap.mmap(self._file, self._bytes(count))
            return
        try:
            self._pages.resize(self._bytes(count))
            self._advise()
        except BufferError:  # a traceback or the compiler still holds the array, which keeps the old pages
            held = np.frombuffer(self._pages, np.uint8)
            self._map(count)
            np.frombuffer(self._pages, np.uint8)[: len(held)] = held

    def _map(self, count: int) -> None:
        self._pages = mmap.mmap(-1, self._bytes(count), flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
        self._advise()

    def spill(self, folder: Path, used: int) -> None:
        """Move to an unnamed file in a folder, with the first `used` elements.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        file = unnamed_file(self, folder)
        reserve(file, self.room.nbytes)
        pages = mmap.mmap(file, self.room.nbytes)
        room: NDArray[Any] = np.frombuffer(pages, self._kind)
        for begin in range(0, used, PIECE):
            end = min(begin + PIECE, used)
            room[begin:end] = self.room[begin:end]
        self._file, self._pages, self.room = file, pages, room

    def _bytes(self, count: int) -> int:
        return -(-count * self._kind.itemsize // mmap.PAGESIZE) * mmap.PAGESIZE

    def _advise(self) -> None:
        if hasattr(mmap, "MADV_HUGEPAGE"):
            self._pages.madvise(mmap.MADV_HUGEPAGE if self._is_large else mmap.MADV_NOHUGEPAGE)

    @property
    def _is_large(self) -> bool:
        return len(self._pages) >= LARGE


def more(room: int) -> int:
    """Return the next capacity after `room`: twice as much, or half as much again for large arrays."""
    return room * 2 if room < 1 << 22 else room * 3 // 2
