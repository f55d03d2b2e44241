"""Keys of rows: numbers that depend only on the configuration, and so are the same for every worker.

Codes are each worker's own; a key is a digest of the canonical writing of a column's place and its value. A
configuration's key is the XOR of those of its columns (Zobrist). Every worker begins a column with the same value, so
that value, of code 0, counts nothing: a column that a worker has not met yet changes no key.
"""

from hashlib import sha256
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.columns import Columns
from semantics.state.canonical import canonical

DIGEST = 16
"""Bytes of a digest; the first half of them is the key."""


def digest_of(value: Any) -> bytes:
    """Return a digest of a value as it is written canonically."""
    return sha256(canonical(value).encode("utf-8", "surrogatepass")).digest()[:DIGEST]


def digest_in(place: bytes, value: bytes) -> bytes:
    """Return the digest of a value in a place, of their digests."""
    return sha256(place + value).digest()[:DIGEST]


class Keys:
    """The digests of all values of all columns, as far as they were asked for.

    Attributes:
        places: For each column the digest of its place.
        keys: The key of each value, column by column.
        begins: For each column where its values begin, and after the last where they end.
    """

    def __init__(self, columns: Columns) -> None:
        self.columns = columns
        self.places: list[bytes] = []
        self._values: dict[int, list[bytes]] = {}
        self._digests: list[list[bytes]] = []
        self.keys = np.zeros(0, np.uint64)
        self.begins = np.zeros(1, np.uint64)

    def refresh(self) -> None:
        """Take in columns and values that are new."""
        columns = self.columns.all
        self.places += [digest_of(column.place) for column in columns[len(self.places) :]]
        self._digests += [[] for _ in columns[len(self._digests) :]]
        sizes = [len(column.values) for column in columns]
        if len(self.begins) == len(sizes) + 1 and np.array_equal(np.diff(self.begins), sizes):
            return
        for column, place, known in zip(columns, self.places, self._digests, strict=True):
            values = self._of_values(column.values)
            known += [digest_in(place, value) for value in values[len(known) :]]
        self.begins = np.concatenate(([0], np.cumsum(sizes))).astype(np.uint64)
        self.keys = np.ascontiguousarray(self.digests()[:, : DIGEST // 2]).view(np.uint64).ravel()
        self.keys[self.begins[:-1]] = 0

    def digests(self) -> NDArray[np.uint8]:
        """Return the digests of all values, column by column, a row each."""
        written = b"".join(each for known in self._digests for each in known)
        return np.frombuffer(written, np.uint8).reshape(-1, DIGEST)

    def codes(self, column: int) -> dict[bytes, int]:
        """Return the code of each digest of a column."""
        return {digest: code for code, digest in enumerate(self._digests[column])}

    def _of_values(self, values: list[Any]) -> list[bytes]:
        """Return the digests of values; those said of one name are the same list in every column."""
        known = self._values.setdefault(id(values), [])
        known += [digest_of(value) for value in values[len(known) :]]
        return known
