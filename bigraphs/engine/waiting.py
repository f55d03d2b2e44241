"""States that wait to be expanded, first in, first out; those that wait long are packed.

A state with its occurrences is some kilobytes of lists. Neighbours in the queue differ little, so that a block of
them takes some 40 bytes each, and packing and unpacking a tenth of the time in which they are expanded.
"""

from __future__ import annotations

from collections import deque
from typing import Any, Final

from bigraphs.engine.occurrences import Spot

BLOCK: Final = 512
"""How many states are packed together."""


class Waiting:
    """A queue of the spots of one system: some at its head and its tail as they are, and packed blocks between."""

    def __init__(self, one: Spot) -> None:
        self._one = one
        self._head: deque[Spot] = deque()
        self._blocks: deque[bytes] = deque()
        self._tail: list[Spot] = []

    def __len__(self) -> int:
        return len(self._head) + BLOCK * len(self._blocks) + len(self._tail)

    def append(self, spot: Spot) -> None:
        """Add a spot."""
        spot.carry()
        self._tail.append(spot)
        if len(self._tail) == BLOCK:
            self._blocks.append(_packed([each.parts() for each in self._tail]))
            self._tail = []

    def popleft(self) -> Spot:
        """Take the spot that has waited longest."""
        if not self._head:
            if self._blocks:
                self._head.extend(map(self._one.remade, _unpacked(self._blocks.popleft())))
            else:
                self._head.extend(self._tail)
                self._tail = []
        return self._head.popleft()


def _packed(parts: list[tuple[object, ...]]) -> bytes:
    import pickle  # noqa: PLC0415 - a small system packs nothing
    import zlib  # noqa: PLC0415

    return zlib.compress(pickle.dumps(parts, pickle.HIGHEST_PROTOCOL), 1)


def _unpacked(block: bytes) -> list[tuple[Any, ...]]:
    import pickle  # noqa: PLC0415 - as above
    import zlib  # noqa: PLC0415

    parts: list[tuple[Any, ...]] = pickle.loads(zlib.decompress(block))
    return parts
