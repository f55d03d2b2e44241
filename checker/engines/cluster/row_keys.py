"""Keys of rows: hashes that depend only on the configuration, hence equal on all workers.

Each worker has its own codes. The key of a value is a digest of the canonical form of its column's place and of the
value. The key of a configuration is the XOR of its columns' keys (Zobrist hashing). All workers begin a column with the
same value, of code 0 and key 0, so a column unknown to a worker changes no key.
"""

from hashlib import sha256
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.model.columns import Columns
from semantics.state.canonical import canonical

DIGEST = 16
"""The bytes of a digest; its first half is the key."""


def digest_of(value: Any) -> bytes:
    """Return a digest of a value's canonical form."""
    return sha256(canonical(value).encode("utf-8", "surrogatepass")).digest()[:DIGEST]


def digest_in(place: bytes, value: bytes) -> bytes:
    """Return the digest of a place and a value, from their digests."""
    return sha256(place + value).digest()[:DIGEST]


class Keys:
    """The digests of all values of all columns.

    Attributes:
        places: The digest of each column's place.
        keys: The key of each value, column by column.
        begins: The first value of each column, and the end of the last.
    """

    def __init__(self, columns: Columns) -> None:
        self.columns = columns
        self.places: list[bytes] = []
        self._values: dict[int, list[bytes]] = {}
        self._digests: list[list[bytes]] = []
        self.keys = np.zeros(0, np.uint64)
        self.begins = np.zeros(1, np.uint64)

    def refresh(self) -> None:
        """Add new columns and values."""
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
        """Return the digests of all values, column by column, one in each row."""
        written = b"".join(each for known in self._digests for each in known)
        return np.frombuffer(written, np.uint8).reshape(-1, DIGEST)

    def codes(self, column: int) -> dict[bytes, int]:
        """Return the code of each digest of a column."""
        return {digest: code for code, digest in enumerate(self._digests[column])}

    def _of_values(self, values: list[Any]) -> list[bytes]:
        """Return the digests of values; columns of facts about one name share their list of values."""
        known = self._values.setdefault(id(values), [])
        known += [digest_of(value) for value in values[len(known) :]]
        return known
