"""From which row each row was first reached.

Breadth-first search reaches rows in the order of these, so a bit for each row and one for each origin say it all: the
bit number + origin of each row is set (Elias, Efficient storage and retrieval by content and address of static files,
1974). Where rows come from elsewhere, as between workers, each has a number of its own.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (what numba compiles is typed by numba: mypy takes its integers for Python's)

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numba import types
from numba.extending import overload
from numpy.typing import NDArray

from checker.engines.fast.bits import WORD, lowest, ones_in
from checker.engines.fast.loops import njit
from checker.engines.fast.pages import Pages
from checker.engines.fast.table import Words

BLOCK = 64
"""Words of bits whose ones are counted once."""

_ONE = np.uint64(1)


class Bits(NamedTuple):
    """Origins that never decrease, as the loops see them."""

    words: Words


def note_origin(origins: Any, number: Any, origin: Any) -> None:
    """Note from which row a new row was reached, in `Bits` or in an array of numbers: in loops only."""
    raise NotImplementedError


def most_origins(origins: Any) -> int:
    """Return of how many rows it can be noted: in loops only."""
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
    """Note how many bits are set before each block of words, and return how many are set in all."""
    found = np.int64(0)
    for at in range(len(words)):
        if at % BLOCK == 0:
            before[at // BLOCK] = found
        found += ones_in(words[at])
    return found


@njit(cache=True)
def place_of(words: Words, before: NDArray[np.int64], number: int) -> int:
    """Return where the bit is set before which so many are set, which there must be."""
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
    """Write the origins of all rows, of which there is one for each bit that is set."""
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
    """Origins that are numbers, in any order."""

    __slots__ = ()

    NUMBER: type[np.generic] = np.uint32

    def __init__(self, count: int) -> None:
        super().__init__(self.NUMBER, count)

    @property
    def rows(self) -> int:
        """Of how many rows they can be noted."""
        return len(self.room)

    @property
    def loops(self) -> Any:
        """What the loops note them in; growing and spilling make another: don't keep it."""
        return self.room

    @property
    def bytes_each(self) -> float:
        """How many bytes that of one row takes."""
        return self.room.itemsize

    def origin(self, number: int, size: int) -> int:  # noqa: ARG002 - as others need it
        """Return the origin of one of so many rows, of all that there are."""
        return int(self.room[number])

    def kept(self, size: int) -> NDArray[Any]:
        """Return those of so many rows, of all that there are, as they are kept."""
        return self.room[:size]

    def restore(self, kept: NDArray[Any], size: int) -> None:
        """Take those of so many rows as they were kept elsewhere; there is room for them.

        Raises:
            ValueError: They are not those of a search that has so many rows.
        """
        self.room[:size] = kept


class Elsewhere(OriginPages):
    """Those of rows that may have been reached from another worker's."""

    __slots__ = ()

    NUMBER = np.uint64


class Rising(OriginPages):
    """Origins that never decrease, of rows of which the first is its own; counts are those of rows, not of words."""

    __slots__ = ("_before", "_counted")

    NUMBER = np.uint64

    def __init__(self, rows: int) -> None:
        super().__init__(_words_for(rows))
        self.room[0] = 1
        self._before, self._counted = np.zeros(0, np.int64), 0

    @property
    def rows(self) -> int:
        """Of how many rows they can be noted."""
        return len(self.room) * (WORD // 2)

    @property
    def bytes_each(self) -> float:
        """How many bytes that of one row takes, with what it adds to an expanded one."""
        return 2 / 8

    @property
    def loops(self) -> Bits:
        """What the loops note them in; growing and spilling make another: don't keep it."""
        return Bits(self.room)

    def held(self, used: int) -> int:
        """Return how many bytes those of so many first rows take."""
        return super().held(_words_for(used))

    def grow(self, count: int) -> None:
        """Make room for those of so many rows in all; OSError as for all pages."""
        super().grow(_words_for(count))

    def spill(self, folder: Path, used: int) -> None:
        """Go over to a file with those of so many first rows; OSError as for all pages."""
        super().spill(folder, _words_for(used))

    def origin(self, number: int, size: int) -> int:
        """Return the origin of one of so many rows, of all that there are."""
        if self._counted != size:
            words = self.kept(size)
            self._before, self._counted = np.zeros(-(-len(words) // BLOCK), np.int64), size
            count_ones(words, self._before)
        return int(place_of(self.room, self._before, number)) - number

    def kept(self, size: int) -> Words:
        """Return those of so many rows, of all that there are, as they are kept: a bit for each and its origin."""
        return self.room[: _words_for(size)]

    def restore(self, kept: Words, size: int) -> None:
        """Take those of so many rows as they were kept elsewhere; there is room for them.

        Raises:
            ValueError: They are not those of a search that has so many rows.
        """
        told = origins_in(
            kept[: _words_for(size)]
        )  # a file may have more, each bit of which would take a number
        known = len(kept) == _words_for(size) and len(told) == size
        if not known or told[0] or np.any(told[1:] >= np.arange(1, size)):
            raise ValueError("some row was reached from a later one")
        self.room[: len(kept)] = kept


def _words_for(rows: int) -> int:
    """Return how many words have a bit for each of so many rows and for each origin of one."""
    return 2 * rows // WORD + 1
