"""Parcels: rows in transit between workers, with the values that are new to the receiver.

Rows travel in their sender's codes and packing. The receiver keeps a dictionary for each sender. So each value travels
once, and the translation of a row is a look-up of numbers. Values are pickled: only between workers of one run.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.model.columns import Columns, Packing, Place

WORKERS_AT_MOST = 256


@dataclass(frozen=True, slots=True)
class ColumnUpdate:
    """The values that a sender's column got since the last parcel.

    Attributes:
        column: The column's number; a new one follows the last.
        place: The column's subject.
        values: The new values, in the order of their codes.
    """

    column: int
    place: Place
    values: tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class RowParcel:
    """Rows with their origins, in the sender's numbers.

    Attributes:
        news: The values that are new to the receiver.
        packing: The sender's packing.
        rows: Packed rows, one after the other.
        origins: The sender's row from which each was reached.
    """

    news: tuple[ColumnUpdate, ...]
    packing: Packing
    rows: NDArray[np.uint64]
    origins: NDArray[np.uint32]

    def __len__(self) -> int:
        return len(self.origins)

    @property
    def bytes(self) -> int:
        """The bytes of the rows in transit."""
        return self.rows.nbytes + self.origins.nbytes


@dataclass(slots=True)
class SentValues:
    """The number of values of each column that another worker knows."""

    sizes: list[int] = field(default_factory=list)

    def news(self, columns: Columns) -> tuple[ColumnUpdate, ...]:
        """Return the new values, and note them as sent."""
        found = tuple(self._entries(columns))
        self.sizes = [len(column.values) for column in columns.all]
        return found

    def _entries(self, columns: Columns) -> Iterator[ColumnUpdate]:
        for number, column in enumerate(columns.all):
            known = self.sizes[number] if number < len(self.sizes) else 0
            if number >= len(self.sizes) or known < len(column.values):
                yield ColumnUpdate(number, column.place, tuple(column.values[known:]))


Arrays = tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]


@dataclass(slots=True)
class Dictionary:
    """Another worker's codes.

    Attributes:
        numbers: The own column for each of its columns.
        codes: The own code for each of its codes, column by column.
    """

    numbers: list[int] = field(default_factory=list)
    codes: list[list[int]] = field(default_factory=list)
    _arrays: "Arrays | None" = None

    def add(self, column: int, number: int, codes: list[int]) -> None:
        """Add new codes of one of its columns, with the own column and codes."""
        if column == len(self.numbers):
            self.numbers.append(number)
            self.codes.append([])
        self.codes[column] += codes
        self._arrays = None

    def arrays(self) -> "Arrays":
        """Return all codes, the first of each column, and the own columns."""
        if self._arrays is None:
            begins = np.concatenate(([0], np.cumsum([len(each) for each in self.codes])))
            codes = np.array([code for each in self.codes for code in each], np.int64)
            self._arrays = codes, begins.astype(np.int64), np.array(self.numbers, np.int64)
        return self._arrays
