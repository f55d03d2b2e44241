"""Parcels: rows in transit between workers, with the values that are new to the receiver.

Rows travel in their sender's codes and packing. The receiver keeps a dictionary for each sender, so a value travels
once, and a row is put into other codes by looking up numbers. Values are pickled: between workers of one run only.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.columns import Columns, Packing, Place

WORKERS_AT_MOST = 256


@dataclass(frozen=True, slots=True)
class Entry:
    """Values that a column of the sender took since the last parcel.

    Attributes:
        column: Its number; one that is new follows the last one.
        place: What it is of.
        values: What is new, by code.
    """

    column: int
    place: Place
    values: tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class Parcel:
    """Rows with what they were reached from, in the sender's numbers.

    Attributes:
        news: What the receiver must be told to understand them.
        packing: Where each of the sender's columns stands.
        rows: Packed rows, one after the other.
        origins: For each row the sender's row that it was reached from.
    """

    news: tuple[Entry, ...]
    packing: Packing
    rows: NDArray[np.uint64]
    origins: NDArray[np.uint32]

    def __len__(self) -> int:
        return len(self.origins)

    @property
    def bytes(self) -> int:
        """How many bytes the rows take on their way."""
        return self.rows.nbytes + self.origins.nbytes


@dataclass(slots=True)
class Told:
    """What another worker was told of one's values: how many of each column."""

    sizes: list[int] = field(default_factory=list)

    def news(self, columns: Columns) -> tuple[Entry, ...]:
        """Return what is new, and take it for told."""
        found = tuple(self._entries(columns))
        self.sizes = [len(column.values) for column in columns.all]
        return found

    def _entries(self, columns: Columns) -> Iterator[Entry]:
        for number, column in enumerate(columns.all):
            known = self.sizes[number] if number < len(self.sizes) else 0
            if number >= len(self.sizes) or known < len(column.values):
                yield Entry(number, column.place, tuple(column.values[known:]))


Arrays = tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]


@dataclass(slots=True)
class Dictionary:
    """What is known of another worker's codes.

    Attributes:
        numbers: For each of its columns the number of one's own.
        codes: For each of its columns one's own code of each of its codes.
    """

    numbers: list[int] = field(default_factory=list)
    codes: list[list[int]] = field(default_factory=list)
    _arrays: "Arrays | None" = None

    def add(self, column: int, number: int, codes: list[int]) -> None:
        """Note codes that are new in a column of it, by the number of one's own."""
        if column == len(self.numbers):
            self.numbers.append(number)
            self.codes.append([])
        self.codes[column] += codes
        self._arrays = None

    def arrays(self) -> "Arrays":
        """Return all codes, where those of each column begin, and the numbers of one's own columns."""
        if self._arrays is None:
            begins = np.concatenate(([0], np.cumsum([len(each) for each in self.codes])))
            codes = np.array([code for each in self.codes for code in each], np.int64)
            self._arrays = codes, begins.astype(np.int64), np.array(self.numbers, np.int64)
        return self._arrays
