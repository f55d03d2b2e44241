"""Lists of numbers in files: the columns of an exploration that exceeded its memory."""

from __future__ import annotations

import mmap
from array import array
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Final, overload

from bigraphs.unnamed_files import reserve, unnamed_file

TAIL: Final = 1 << 16
"""The least number of elements that are written at once."""


class FileColumn(Sequence[int]):
    """A list of numbers in an unnamed file, with its end in memory.

    Only `write` and `beginning` change the file. So an addition never fails, and a forked process adds to its own copy
    alone. A slice of bytes is `bytes`, any other an array.
    """

    __slots__ = ("__weakref__", "_file", "_tail", "_view", "_written", "typecode")

    def __init__(self, given: array[int] | bytearray, folder: Path) -> None:
        """Move numbers to a file in a folder.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        self.typecode: Any = "B" if isinstance(given, bytearray) else given.typecode
        self._file = unnamed_file(self, folder)
        self._view: memoryview[int] = memoryview(b"")
        self._written = 0
        self._tail = array(self.typecode)
        self._put(memoryview(given))

    def append(self, number: int) -> None:
        """Add a number."""
        self._tail.append(number)

    def extend(self, numbers: Iterable[int]) -> None:
        """Add numbers."""
        if isinstance(numbers, bytes):
            self._tail.frombytes(numbers)
        else:
            self._tail.extend(numbers)

    def write(self, least: int | None = None) -> None:
        """Write the end to the file if it is long; raises OSError if the file has no room."""
        if len(self._tail) >= (TAIL if least is None else least):
            self._put(memoryview(self._tail))
            self._tail = array(self.typecode)

    def _put(self, numbers: memoryview[int]) -> None:
        """Write numbers behind the others; raise OSError, and change nothing, if the file has no room."""
        if not numbers:
            return
        size = self._written + len(numbers)
        if size > len(self._view):
            room = max(size, self._written * 3 // 2, TAIL) * self._tail.itemsize
            reserve(self._file, room)
            self._view = memoryview(mmap.mmap(self._file, room)).cast(self.typecode)
        self._view[self._written : size] = numbers
        self._written = size

    def beginning(self, count: int) -> memoryview[int]:
        """Write the end to the file; return the first `count` numbers; raises OSError if the file has no room."""
        self.write(0)
        return self._view[:count]

    def __len__(self) -> int:
        return self._written + len(self._tail)

    @overload
    def __getitem__(self, place: int) -> int: ...
    @overload
    def __getitem__(self, place: slice) -> Any: ...
    def __getitem__(self, place: int | slice) -> Any:
        if isinstance(place, slice):
            start, end, _ = place.indices(len(self))
            return self._slice(start, max(start, end))
        place = range(len(self))[place]
        return self._view[place] if place < self._written else self._tail[place - self._written]

    def _slice(self, start: int, end: int) -> bytes | array[int]:
        written = self._written
        found = self._view[min(start, written) : min(end, written)].tobytes()
        if end > written:
            found += self._tail[max(start - written, 0) : end - written].tobytes()
        return found if self.typecode == "B" else array(self.typecode, found)
