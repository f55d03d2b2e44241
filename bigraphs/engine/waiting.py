"""States that wait to be expanded, first in, first out; those that wait long are packed.

A state with its occurrences is some kilobytes of lists. Neighbours in the queue differ little, so that a block of
them takes some 40 bytes each, and packing and unpacking a tenth of the time in which they are expanded.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

from bigraphs.engine.occurrences import Spot
from bigraphs.engine.world import Codes

BLOCK: Final = 512
"""How many states are packed together."""


@dataclass(frozen=True, slots=True)
class Block:
    """Packed spots.

    Attributes:
        kept: Which of them wait.
        codes: What the codes of the subtrees in them are here, if they were packed elsewhere.
    """

    packed: bytes
    kept: Sequence[int]
    codes: Codes | None = None

    def __len__(self) -> int:
        return len(self.kept)


_Piece: TypeAlias = Block | list[Spot]


class Waiting:
    """A queue of the spots of one system: some at its head and its tail as they are, and packed blocks between."""

    def __init__(self, one: Spot) -> None:
        self._one = one
        self._head: deque[Spot] = deque()
        self._pieces: deque[_Piece] = deque()
        self._tail: list[Spot] = []
        self._length = 0

    def __len__(self) -> int:
        return self._length

    def append(self, spot: Spot) -> None:
        """Add a spot."""
        spot.carry()
        self._tail.append(spot)
        self._length += 1
        if len(self._tail) == BLOCK:
            self._pieces.append(pack(self._tail))
            self._tail = []

    def extend(self, blocks: Iterable[Block]) -> None:
        """Add packed spots."""
        self._end_tail()
        for block in blocks:
            self._pieces.append(block)
            self._length += len(block)

    def popleft(self) -> Spot:
        """Take the spot that has waited longest."""
        if not self._head:
            self._head.extend(self._spots(self._next()))
        self._length -= 1
        return self._head.popleft()

    def drop(self, count: int) -> None:
        """Leave out those that have waited longest; what is packed is not unpacked for it."""
        self._length -= count
        while count > len(self._head):
            count -= len(self._head)
            self._head.clear()
            piece = self._next()
            if len(piece) <= count:
                count -= len(piece)
            else:
                self._head.extend(self._spots(piece))
        for _ in range(count):
            self._head.popleft()

    def blocks(self) -> list[Block]:
        """Return all that wait, packed."""
        pieces = [list(self._head), *self._pieces, self._tail]
        return [piece if isinstance(piece, Block) else pack(piece) for piece in pieces if piece]

    def _next(self) -> _Piece:
        if not self._pieces:
            self._end_tail()
        return self._pieces.popleft()

    def _end_tail(self) -> None:
        """Make the tail a piece, packed if much waits before it."""
        if self._tail:
            self._pieces.append(pack(self._tail) if self._length > 2 * BLOCK else self._tail)
            self._tail = []

    def _spots(self, piece: _Piece) -> Iterable[Spot]:
        return piece if isinstance(piece, list) else unpack(piece, self._one)


def pack(spots: Sequence[Spot]) -> Block:
    """Return a block of spots."""
    import pickle  # noqa: PLC0415 - a small system packs nothing
    import zlib  # noqa: PLC0415

    parts = [spot.parts() for spot in spots]
    return Block(zlib.compress(pickle.dumps(parts, pickle.HIGHEST_PROTOCOL), 1), range(len(spots)))


def unpack(block: Block, one: Spot) -> Iterable[Spot]:
    """Yield the spots of a block that wait, made as this one is."""
    import pickle  # noqa: PLC0415 - as above
    import zlib  # noqa: PLC0415

    parts: list[tuple[Any, ...]] = pickle.loads(zlib.decompress(block.packed))
    for place in block.kept:
        spot = one.remade(parts[place])
        if block.codes is not None:
            spot.state.codes = block.codes.translated(spot.state.codes)
        yield spot
