"""Growing arrays, as the compiled loops see them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray


class Growing:
    """A one-dimensional array with room to spare.

    Attributes:
        room: The array with its room; what lies beyond `size` means nothing.
        size: How much of it is used.
        shared: Whether other threads may read it while it grows: then it grows by being copied.
    """

    __slots__ = ("room", "shared", "size")

    def __init__(self, kind: type[np.generic], room: int = 1024, *, shared: bool = False) -> None:
        self.room: NDArray[Any] = np.zeros(room, kind)
        self.shared = shared
        self.size = 0

    @property
    def used(self) -> NDArray[Any]:
        """What is used of it, as a view."""
        return self.room[: self.size]

    def append(self, *values: int) -> int:
        """Append numbers and return the index of the first."""
        self.reserve(len(values))
        first = self.size
        self.size += len(values)
        self.room[first : self.size] = values
        return first

    def extend(self, count: int, value: int = 0) -> int:
        """Append a number so many times and return the first index."""
        self.reserve(count)
        first = self.size
        self.room[first : first + count] = value
        self.size += count
        return first

    def reserve(self, count: int) -> None:
        """Make room for so many more; a large array grows in place where the system can move its pages."""
        wanted = self.size + count
        if wanted > len(self.room):
            more = len(self.room) // (2 if len(self.room) < 1 << 20 else 8)
            room = max(wanted, len(self.room) + more)
            if self.shared:
                self.room = np.concatenate((self.room, np.zeros(room - len(self.room), self.room.dtype)))
            else:
                self.room.resize(room, refcheck=False)

    def __len__(self) -> int:
        return self.size
