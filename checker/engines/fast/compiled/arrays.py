"""Growing arrays for the compiled loops."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.mapped_arrays import Pages


class Growing:
    """A one-dimensional array with spare capacity.

    Attributes:
        room: The array with its spare capacity; elements from `size` on are meaningless.
        size: The number of elements in use.
        shared: Whether other threads read it while it grows. Then growing copies it.
    """

    __slots__ = ("_pages", "room", "shared", "size")

    def __init__(self, kind: type[np.generic], room: int = 1024, *, shared: bool = False) -> None:
        self.room: NDArray[Any] = np.zeros(room, kind)
        self.shared = shared
        self.size = 0
        self._pages: Pages | None = None

    @property
    def used(self) -> NDArray[Any]:
        """The elements in use, as a view."""
        return self.room[: self.size]

    def append(self, *values: int) -> int:
        """Append numbers and return the index of the first."""
        self.reserve(len(values))
        first = self.size
        self.size += len(values)
        self.room[first : self.size] = values
        return first

    def extend(self, count: int, value: int = 0) -> int:
        """Append a value `count` times and return the index of the first."""
        self.reserve(count)
        first = self.size
        self.room[first : first + count] = value
        self.size += count
        return first

    def reserve(self, count: int) -> None:
        """Reserve capacity for `count` more; a large array grows in place where the system can move its pages."""
        wanted = self.size + count
        if wanted > len(self.room):
            more = len(self.room) // (2 if len(self.room) < 1 << 20 else 8)
            room = max(wanted, len(self.room) + more)
            if self._pages is not None:
                self._pages.grow(room)
                self.room = self._pages.room
            elif self.shared:
                self.room = np.concatenate((self.room, np.zeros(room - len(self.room), self.room.dtype)))
            else:
                self.room.resize(room, refcheck=False)

    def spill(self, folder: Path) -> None:
        """Move to a file in a folder, with the spare capacity, in which loops may have written.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        pages = Pages(self.room.dtype.type, len(self.room))
        pages.room[: len(self.room)] = self.room
        pages.spill(folder, len(self.room))
        self._pages, self.room = pages, pages.room

    def __len__(self) -> int:
        return self.size
