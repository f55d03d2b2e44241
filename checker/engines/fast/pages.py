"""Arrays in memory pages of their own: huge ones where they are large and there are any, grown without copying.

They can go over to a file. Then the system writes them out and reads them again as it needs memory; the file has no
name, so that nothing is left of it however the process ends.
"""

import mmap
import os
import weakref
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

import numpy as np
from numpy.typing import NDArray

PIECE = 1 << 20
"""Numbers that are copied at once."""

HUGE = 1 << 21
"""Bytes of a huge page: large arrays take memory in such pieces at most."""

LARGE = 8 * HUGE
"""Bytes of room from which on an array has huge pages: where smaller ones end, the rest of a page would lie idle."""


class Pages:
    """A one-dimensional array that grows in place; what was never written takes no memory.

    Attributes:
        room: The whole array, zeros where nothing was written. `grow` and `spill` make another: don't keep it.
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
        """Return how many bytes it takes if only so many first numbers were written; a file takes all of its room."""
        if self.spilled:
            return self.room.nbytes
        page = HUGE if self._is_large else mmap.PAGESIZE
        return min(-(-used * self._kind.itemsize // page) * page, self.room.nbytes)

    def grow(self, count: int) -> None:
        """Make room for so many in all.

        Raises:
            OSError: There is no room for them in the file, or in memory; what there was stands.
        """
        if count > len(self.room):
            if self._file is not None:
                reserve(self._file, self._bytes(count))
            self.room = np.zeros(0, self._kind)  # the pages can't move while an array stands on them
            try:
                self._resize(count)
            finally:
                self.room = np.frombuffer(self._pages, self._kind)

    def _resize(self, count: int) -> None:
        if self._file is not None:
            # Whoever has the old pages has the same file.
            self._pages = mmap.mmap(self._file, self._bytes(count))
            return
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

    def spill(self, folder: Path, used: int) -> None:
        """Go over to a file without a name in a folder, with the first so many numbers.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        with TemporaryFile(dir=folder) as opened:
            file = os.dup(opened.fileno())
        weakref.finalize(self, os.close, file)
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


def reserve(file: int, size: int) -> None:
    """Take all the room that a file is to have: writing to a hole that can't be filled would end the process."""
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(file, 0, size)
    else:
        os.ftruncate(file, size)


def more(room: int) -> int:
    """Return how much room comes after so much: the more there is, the less is added."""
    return room * 2 if room < 1 << 22 else room * 3 // 2
