"""The row from which each row was first reached.

Breadth-first search reaches rows in the order of their origins. So one bit for each row and one for each origin encode
all origins: the bit with the index row + origin is set for each row (Elias, *Efficient storage and retrieval by content
and address of static files*, 1974). If rows come in another order, as between workers, each stores its origin as a
number.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numba import types
from numba.extending import overload
from numpy.typing import NDArray

from checker.engines.fast.compiled.bits import WORD, lowest, ones_in
from checker.engines.fast.compiled.jit_decorators import njit
from checker.engines.fast.compiled.mapped_arrays import Pages
from checker.engines.fast.compiled.table import Words

BLOCK = 64
"""The number of words that share one stored count of set bits."""

_ONE = np.uint64(1)


class Bits(NamedTuple):
    """Origins that never decrease, for the compiled loops."""

    words: Words


def note_origin(origins: Any, number: Any, origin: Any) -> None:
    """Note the origin of a new row, in `Bits` or in an array of numbers. Only for compiled loops."""
    raise NotImplementedError


def most_origins(origins: Any) -> int:
    """Return the number of rows for which origins have room. Only for compiled loops."""
    raise NotImplementedError


@overload(note_origin, inline="always")
def _note_origin(origins: Any, number: Any, origin: Any) -> Callable[..., None]:  # noqa: ARG001 - numba asks by name
    def in_bits(origins: Any, number: Any, origin: Any) -> None:
        at = np.uint64(number) + np.uint64(origin)
        origins.words[at >> np.uint64(6)] |= _ONE << (at & np.uint64(63))

    def in_numbers(origins: Any, number: Any, origin: Any) -> None:
        origins[number] = origin

    return in_bits if isinstance(origins, types.BaseNamedTuple) else in_numbers


@overload(most_origins, inline="always")
def _most_origins(origins: Any) -> Callable[..., int]:
    def in_bits(origins: Any) -> int:
        return len(origins.words) * (WORD // 2)

    def in_numbers(origins: Any) -> int:
        return len(origins)

    return in_bits if isinstance(origins, types.BaseNamedTuple) else in_numbers


@njit(cache=True)
def count_ones(words: Words, before: NDArray[np.int64]) -> int:
    """Note the number of set bits before each block of words; return their total."""
    found = np.int64(0)
    for at in range(len(words)):
        if at % BLOCK == 0:
            before[at // BLOCK] = found
        found += ones_in(words[at])
    return found


@njit(cache=True)
def place_of(words: Words, before: NDArray[np.int64], number: int) -> int:
    """Return the position of the set bit before which exactly `number` bits are set; it must exist."""
    block = np.searchsorted(before, number, side="right") - 1
    left, at = number - before[block], block * BLOCK
    while left >= ones_in(words[at]):
        left -= ones_in(words[at])
        at += 1
    word = words[at]
    for _ in range(left):
        word &= word - _ONE
    return at * WORD + lowest(word)


@njit(cache=True)
def write_origins(words: Words, origins: NDArray[np.int64]) -> None:
    """Write the origins of all rows, one for each set bit."""
    number = np.int64(0)
    for at in range(len(words)):
        word = words[at]
        while word:
            origins[number] = at * WORD + lowest(word) - number
            word &= word - _ONE
            number += 1


def origins_in(bits: Words) -> NDArray[np.int64]:
    """Return the origins of all rows that have a bit."""
    told = np.zeros(count_ones(bits, np.zeros(len(bits), np.int64)), np.int64)
    write_origins(bits, told)
    return told


class OriginPages(Pages):
    """Origins as numbers, in any order."""

    __slots__ = ()

    NUMBER: type[np.generic] = np.uint32

    def __init__(self, count: int) -> None:
        super().__init__(self.NUMBER, count)

    @property
    def rows(self) -> int:
        """The number of rows that have room."""
        return len(self.room)

    @property
    def loops(self) -> Any:
        """The form that the loops write. Growing and spilling replace it: don't keep it."""
        return self.room

    @property
    def bytes_each(self) -> float:
        """The bytes for one row."""
        return self.room.itemsize

    def origin(self, number: int, size: int) -> int:  # noqa: ARG002 - part of the interface
        """Return the origin of one of `size` rows."""
        return int(self.room[number])

    def kept(self, size: int) -> NDArray[Any]:
        """Return the stored form of the origins of `size` rows."""
        return self.room[:size]

    def restore(self, kept: NDArray[Any], size: int) -> None:
        """Load the stored origins of `size` rows, for which there is room.

        Raises:
            ValueError: No search of that size has them.
        """
        self.room[:size] = kept


class Elsewhere(OriginPages):
    """Origins of rows that may have been reached from another worker's row."""

    __slots__ = ()

    NUMBER = np.uint64


class Rising(OriginPages):
    """Origins that never decrease, as bits; the first row is its own origin. Counts are of rows, not of words."""

    __slots__ = ("_before", "_counted")

    NUMBER = np.uint64

    def __init__(self, rows: int) -> None:
        super().__init__(_words_for(rows))
        self.room[0] = 1
        self._before, self._counted = np.zeros(0, np.int64), 0

    @property
    def rows(self) -> int:
        """The number of rows that have room."""
        return len(self.room) * (WORD // 2)

    @property
    def bytes_each(self) -> float:
        """The bytes for one row, including the bit of an origin."""
        return 2 / 8

    @property
    def loops(self) -> Bits:
        """The form that the loops write. Growing and spilling replace it: don't keep it."""
        return Bits(self.room)

    def held(self, used: int) -> int:
        """Return the bytes for the first `used` rows."""
        return super().held(_words_for(used))

    def grow(self, count: int) -> None:
        """Make room for `count` rows in all; raises OSError as `Pages.grow`."""
        super().grow(_words_for(count))

    def spill(self, folder: Path, used: int) -> None:
        """Move to a file, with the first `used` rows; raises OSError as `Pages.spill`."""
        super().spill(folder, _words_for(used))

    def origin(self, number: int, size: int) -> int:
        """Return the origin of one of `size` rows."""
        if self._counted != size:
            words = self.kept(size)
            self._before, self._counted = np.zeros(-(-len(words) // BLOCK), np.int64), size
            count_ones(words, self._before)
        return int(place_of(self.room, self._before, number)) - number

    def kept(self, size: int) -> Words:
        """Return the stored form of the origins of `size` rows: a bit for each row and each origin."""
        return self.room[: _words_for(size)]

    def restore(self, kept: Words, size: int) -> None:
        """Load the stored origins of `size` rows, for which there is room.

        Raises:
            ValueError: No search of that size has them.
        """
        told = origins_in(
            kept[: _words_for(size)]
        )  # a longer file may have more bits, each of which would yield a number
        known = len(kept) == _words_for(size) and len(told) == size
        if not known or told[0] or np.any(told[1:] >= np.arange(1, size)):
            raise ValueError("some row was reached from a later one")
        self.room[: len(kept)] = kept


def _words_for(rows: int) -> int:
    """Return the number of words with a bit for each of `rows` rows and of their origins."""
    return 2 * rows // WORD + 1
