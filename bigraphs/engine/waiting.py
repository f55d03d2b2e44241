"""States that wait to be expanded, first in, first out; those that wait long are packed.

A state with its occurrences is some kilobytes of lists. Neighbours in the queue differ little, so that a block of
them takes some 40 bytes each, and packing and unpacking a tenth of the time in which they are expanded.
"""

from __future__ import annotations

import pickle
import zlib
from collections import deque
from typing import Final

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
            parts = [each.parts() for each in self._tail]
            self._blocks.append(zlib.compress(pickle.dumps(parts, pickle.HIGHEST_PROTOCOL), 1))
            self._tail = []

    def popleft(self) -> Spot:
        """Take the spot that has waited longest."""
        if not self._head:
            if self._blocks:
                parts = pickle.loads(zlib.decompress(self._blocks.popleft()))
                self._head.extend(map(self._one.remade, parts))
            else:
                self._head.extend(self._tail)
                self._tail = []
        return self._head.popleft()
