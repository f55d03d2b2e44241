"""The queue of unexpanded states, first in, first out; it packs the states in its middle.

An unpacked state with its occurrences takes some kilobytes of lists. Neighbours in the queue differ little, so a state
in a packed block takes some 40 bytes. Packing and unpacking take a tenth of the expansion time.
"""

from __future__ import annotations

from array import array
from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from bigraphs.engine.decoding import slots_of
from bigraphs.engine.intern_tables import Codes
from bigraphs.engine.occurrences import Spot

if TYPE_CHECKING:
    from bigraphs.file_columns import FileColumn

BLOCK: Final = 512
"""The number of states in a block."""


@dataclass(slots=True)
class Block:
    """Packed spots.

    Attributes:
        packed: The compressed spots, or their part of the file.
        kept: The positions of the spots that still wait.
        codes: The translation of their subtree codes, if another process packed them.
        slots: The slots of their nodes, compressed, once they were needed.
    """

    packed: bytes | slice
    kept: Sequence[int]
    codes: Codes | None = None
    slots: bytes = b""

    def __len__(self) -> int:
        return len(self.kept)


_Piece: TypeAlias = Block | list[Spot]


class Frontier:
    """A queue of the spots of one system: unpacked at its head and tail, packed blocks between."""

    def __init__(self, one: Spot) -> None:
        self._one = one
        self._head: deque[Spot] = deque()
        self._pieces: deque[_Piece] = deque()
        self._tail: list[Spot] = []
        self._length = 0
        self._file: FileColumn | None = None

    def __len__(self) -> int:
        return self._length

    def append(self, spot: Spot) -> None:
        """Add a spot."""
        spot.carry()
        self._tail.append(spot)
        self._length += 1
        if len(self._tail) == BLOCK:
            self._pieces.append(self._kept(pack(self._tail)))
            self._tail = []

    def extend(self, blocks: Iterable[Block]) -> None:
        """Add packed spots."""
        self._end_tail()
        for block in blocks:
            self._pieces.append(self._kept(block))
            self._length += len(block)

    def peek(self) -> Spot:
        """Return the spot that has waited longest."""
        if not self._head:
            self._head.extend(self._spots(self._next()))
        return self._head[0]

    def popleft(self) -> Spot:
        """Remove and return the spot that has waited longest."""
        spot = self.peek()
        self._head.popleft()
        self._length -= 1
        return spot

    def drop(self, count: int) -> None:
        """Remove the spots that have waited longest; it unpacks only a block that is partly removed."""
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
        """Return all waiting spots, packed."""
        pieces = [list(self._head), *self._pieces, self._tail]
        return [piece if isinstance(piece, Block) else pack(piece) for piece in pieces if piece]

    def slots(self, count: int) -> array[int]:
        """Return the slots of the nodes of the first `count` spots, in the order of `slots_of`."""
        found = array("I")
        for piece in (list(self._head), *self._pieces, self._tail):
            if isinstance(piece, Block) and len(piece) <= count:
                found.frombytes(self._slots_in(piece))
            else:
                for spot in islice(self._spots(piece), count):
                    found.extend(slots_of(spot.state))
            count -= min(count, len(piece))
        return found

    def _slots_in(self, block: Block) -> bytes:
        import zlib  # noqa: PLC0415 - a small system packs nothing

        if not block.slots:
            found = array("I", (slot for spot in self._spots(block) for slot in slots_of(spot.state)))
            block.slots = zlib.compress(found.tobytes(), 1)
        return zlib.decompress(block.slots)

    def _next(self) -> _Piece:
        if not self._pieces:
            self._end_tail()
        return self._pieces.popleft()

    def _end_tail(self) -> None:
        """Turn the tail into a piece, packed if the queue is long."""
        if self._tail:
            self._pieces.append(self._kept(pack(self._tail)) if self._length > 2 * BLOCK else self._tail)
            self._tail = []

    def _spots(self, piece: _Piece) -> Iterable[Spot]:
        if isinstance(piece, list):
            return piece
        return unpack(piece, self._bytes(piece.packed), self._one)

    def spill(self, folder: Path) -> FileColumn:
        """Keep packed spots in a file in a folder from now on, and return it; raises OSError if that has no room."""
        from bigraphs.file_columns import FileColumn  # noqa: PLC0415 - few explorations spill

        self._file = FileColumn(bytearray(), folder)
        for piece in self._pieces:
            if isinstance(piece, Block):
                self._kept(piece)
        return self._file

    def _kept(self, block: Block) -> Block:
        """Move a block to the file, if there is one."""
        if self._file is not None:
            start = len(self._file)
            self._file.extend(self._bytes(block.packed))
            block.packed = slice(start, len(self._file))
        return block

    def _bytes(self, packed: bytes | slice) -> bytes:
        if isinstance(packed, bytes):
            return packed
        assert self._file is not None  # a part of it
        found: bytes = self._file[packed]
        return found


def pack(spots: Sequence[Spot]) -> Block:
    """Return a block of spots."""
    import pickle  # noqa: PLC0415 - a small system packs nothing
    import zlib  # noqa: PLC0415

    parts = [spot.parts() for spot in spots]
    return Block(zlib.compress(pickle.dumps(parts, pickle.HIGHEST_PROTOCOL), 1), range(len(spots)))


def unpack(block: Block, packed: bytes, one: Spot) -> Iterable[Spot]:
    """Yield the waiting spots of a block, given its bytes; `one` is any spot of the same system."""
    import pickle  # noqa: PLC0415 - a small system packs nothing
    import zlib  # noqa: PLC0415

    parts: list[tuple[Any, ...]] = pickle.loads(zlib.decompress(packed))
    for place in block.kept:
        spot = one.remade(parts[place])
        if block.codes is not None:
            spot.state.codes = block.codes.translated(spot.state.codes)
        yield spot
