"""Tree compression: a row of any width is stored in two words.

A row is cut into pieces of equal width, and equal pieces are stored once. A row of four pieces is stored as their four
numbers. A row of sixteen pieces has four nodes of four piece numbers each; nodes are interned too, and the row is
stored as its four node numbers. Two rows are equal exactly if their numbers are.

A node holds every fourth piece. Columns that change often are adjacent in a row, so they are spread over all nodes. A
successor differs from its origin in one or two pieces, so only these and their nodes are looked up.

The collapse compression is Holzmann's (1997); trees are from Laarman, van de Pol and Weber (2011), who build them
binary. Nodes of four need two look-ups instead of one for each level of a binary tree.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from threading import local
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.jit_decorators import inner, njit
from checker.engines.fast.compiled.mapped_arrays import Pages, more
from checker.engines.fast.compiled.table import (
    Words,
    alone,
    bits_for,
    entry_of,
    find,
    hashed,
    most_in,
    rebuild,
    slots_for,
)

Numbers = NDArray[np.int64]

FOUR = 4
"""Numbers in a node or a compressed row."""

PAIR = 2
"""Words that hold these four numbers."""

SHALLOW = 8
"""The greatest width in words of a row that has four pieces; wider rows have sixteen."""

COUNT, MOST, BITS, WIDE = range(4)
FIRST = 1 << 10

UNMET, NO_ROOM = -1, -2
"""Codes instead of a number: unknown piece or node that was not added; no room left for a new one."""

MEMORY = 1 << 15
"""The number of entries in the cache of changed pieces, keyed by transition and piece."""

NOWHERE = np.uint64(0xFFFFFFFFFFFFFFFF)
"""The stored word of a row with an unknown piece or node; no visited row has it."""

_HALF, _LOW = np.uint64(32), np.uint64(0xFFFFFFFF)
_NONE = np.zeros(0, np.uint64)


class Interned(NamedTuple):
    """Interned pieces or nodes by number, for the compiled loops.

    Attributes:
        words: Their words.
        index: An open-addressing hash table from words to numbers, like the visited set.
        counts: Their number, the greatest number, the bits of a number in the index, and the words of each.
    """

    words: Words
    index: Any
    counts: Numbers


class FoldedTable(NamedTuple):
    """The interned pieces and nodes, and the row that one thread unfolded last, for the compiled loops.

    While a successor is built, `below` holds the successor's pieces instead of the row's.

    Attributes:
        pieces, nodes: The interned values. A reading thread has its own counts, so it ignores later additions, which
            may be incomplete.
        deep: 1 if nodes stand between pieces and rows, else 0.
        piece_of: The piece of each word of a row.
        begins: The first word of each piece.
        whole: The words of the row.
        below, above: The numbers of its pieces, and of its nodes.
        before, fresh: Scratch space for numbers of pieces, and of nodes.
        sought: Scratch space for the piece or node of a look-up.
        memory, results: A cache of changed pieces: its keys (transition and piece) and the resulting pieces.
        target: Scratch space for the words of a successor.
    """

    pieces: Interned
    nodes: Interned
    deep: int
    piece_of: Numbers
    begins: Numbers
    whole: Words
    below: Numbers
    above: Numbers
    before: Numbers
    fresh: Numbers
    sought: Words
    memory: Words
    results: Numbers
    target: Words


@njit(cache=True, forceinline=True)
def intern(i: Interned, words: Words, adding: bool) -> np.int64:
    """Return the number of a piece or node, adding a new one if `adding`; a code below 0 on failure (see `UNMET`)."""
    width = i.counts[WIDE]
    mixed, bits = hashed(words, 0, width), np.uint32(i.counts[BITS])
    found = find(i.words, i.index, words, 0, mixed, width, bits)
    if found >= i.counts[COUNT] or (found < 0 and not adding):  # another thread is adding it
        found = np.int64(UNMET)
    elif found < 0 and i.counts[COUNT] == i.counts[MOST]:
        found = np.int64(NO_ROOM)
    elif found < 0:
        slot, found = -found - 1, i.counts[COUNT]
        for j in range(width):
            i.words[found * width + j] = words[j]
        i.index[slot] = entry_of(mixed, found, bits)
        i.counts[COUNT] += 1
    return found


@njit(cache=True, forceinline=True)
def number_in(words: Words, at: int, k: int) -> np.int64:
    """Return number `k` of the four in the two words that begin at `at`."""
    word = words[at + (k >> 1)]
    return np.int64(word & _LOW) if k & 1 else np.int64(word >> _HALF)


@njit(cache=True, forceinline=True)
def put_numbers(numbers: Numbers, begin: int, words: Words, at: int) -> None:
    """Pack four numbers, from `begin` on, into two words."""
    for k in range(PAIR):
        high, low = np.uint64(numbers[begin + 2 * k]), np.uint64(numbers[begin + 2 * k + 1])
        words[at + k] = (high << _HALF) | low


@njit(cache=True, forceinline=True)
def unfold_piece(f: FoldedTable, piece: int, number: int) -> None:
    """Write the words of a piece, unless they are there already."""
    if f.below[piece] != number:
        f.below[piece] = number
        width, begin = f.pieces.counts[WIDE], f.begins[piece]
        for k in range(width):
            f.whole[begin + k] = f.pieces.words[number * width + k]


@inner(cache=True)
def unfold(f: FoldedTable, rows: Words, row: int) -> None:
    """Write the words of a row; the words that it shares with the previous row are there already."""
    for k in range(FOUR):
        number = number_in(rows, PAIR * row, k)
        if not f.deep:
            unfold_piece(f, k, number)
        elif f.above[k] != number:
            f.above[k] = number
            for j in range(FOUR):
                unfold_piece(f, FOUR * k + j, number_in(f.nodes.words, PAIR * number, j))


@njit(cache=True, forceinline=True)
def put_piece(f: FoldedTable, piece: int, number: int, touched: int) -> int:
    """Set a piece of the successor; return the set of pieces that it does not share with the row, as bits."""
    if not (touched >> piece) & 1:
        f.before[piece] = f.below[piece]
    f.below[piece] = number
    return touched | (1 << piece)


@njit(cache=True, forceinline=True)
def fold(f: FoldedTable, touched: int, adding: bool, kept: Words, at: int) -> int:
    """Write the compressed successor and restore the row's pieces; return less than 0 if a piece or node is unknown."""
    least = np.int64(0)
    for k in range(FOUR):
        group = (touched >> (FOUR * k)) & 15 if f.deep else np.int64(0)
        f.fresh[k] = f.above[k] if f.deep else f.below[k]
        for piece in range(FOUR * k, FOUR * k + FOUR if group else 0):
            least = min(least, f.below[piece])
        if group and least >= 0:
            put_numbers(f.below, FOUR * k, f.sought, 0)
            f.fresh[k] = intern(f.nodes, f.sought, adding)
        least = min(least, f.fresh[k])
    put_numbers(f.fresh, 0, kept, at)
    if least < 0:
        kept[at] = kept[at + 1] = NOWHERE
    for piece in range(len(f.below)):
        if (touched >> piece) & 1:
            f.below[piece] = f.before[piece]
    return least


@njit(cache=True, forceinline=True)
def leave_open(kept: Words, at: int, row: int, step: int) -> None:
    """Mark a successor as incomplete: store its row and transition instead of its pieces."""
    kept[at], kept[at + 1] = NOWHERE, (np.uint64(step) << _HALF) | np.uint64(row)


@njit(cache=True, forceinline=True)
def step_left_open(kept: Words, at: int) -> int:
    """Return the transition of an incomplete successor; less than 0 for a complete one."""
    if kept[at] != NOWHERE or kept[at + 1] == NOWHERE:
        return np.int64(-1)
    return np.int64(kept[at + 1] >> _HALF)


@inner(cache=True)
def take(f: FoldedTable, words: Words, begin: int, width: int, adding: bool) -> int:
    """Set the pieces of a successor given in plain words; return the pieces that differ from the row's, as bits."""
    touched, wide = np.int64(0), f.pieces.counts[WIDE]
    for first in range(0, width, wide):
        differs = False
        for k in range(wide):
            f.sought[k] = words[begin + first + k] if first + k < width else np.uint64(0)
            differs = differs or f.sought[k] != f.whole[first + k]
        if differs:
            touched = put_piece(f, f.piece_of[first], intern(f.pieces, f.sought, adding), touched)
    return touched


@njit(cache=True, forceinline=True)
def seek_piece(f: FoldedTable, piece: int) -> None:
    """Copy the words of a piece of the successor to `sought`."""
    wide = f.pieces.counts[WIDE]
    begin = f.below[piece] * wide
    for k in range(wide):
        f.sought[k] = f.pieces.words[begin + k]


@njit(cache=True)
def fold_rows(f: FoldedTable, words: Words, width: int, kept: Words, begin: int) -> int:
    """Compress rows from number `begin` on; return the first one without room, or the number of rows."""
    count = len(kept) // PAIR
    for k in range(begin, count):
        if fold(f, take(f, words, k * width, width, True), True, kept, PAIR * k) == NO_ROOM:
            return k
        unfold(f, kept, k)
    return count


@njit(cache=True)
def fold_found(
    f: FoldedTable,
    stored: Words,
    words: Words,
    width: int,
    kept: Words,
    hashes: Words,
    begin: int,
    adding: bool,
) -> int:
    """Compress rows as `fold_rows`, beside the first of the `stored` ones, and hash them.

    Unless `adding`, a row with an unknown piece becomes no row.
    """
    unfold(f, stored, 0)
    for k in range(begin, len(hashes)):
        found = fold(f, take(f, words, k * width, width, adding), adding, kept, PAIR * k)
        if found == NO_ROOM:
            return k
        hashes[k] = hashed(kept, PAIR * k, PAIR)
        if found >= 0:
            unfold(f, kept, k)
    return len(hashes)


@njit(cache=True)
def unfold_rows(f: FoldedTable, kept: Words, width: int, words: Words) -> None:
    """Write the words of compressed rows one after another."""
    for k in range(len(kept) // PAIR):
        unfold(f, kept, k)
        for word in range(width):
            words[k * width + word] = f.whole[word]


@njit(cache=True)
def begin_with_zeros(f: FoldedTable) -> None:
    """Let the row unfolded last be all zeros: all its pieces, and all its nodes, have number 0."""
    f.below[:] = intern(f.pieces, f.whole, True)
    put_numbers(f.below, 0, f.sought, 0)
    f.above[:] = intern(f.nodes, f.sought, True)


@njit(cache=True)
def are_there(words: Words, count: int) -> bool:
    """Return whether all numbers in the words are less than a count."""
    there = True
    for word in words:
        there = there and np.int64(word >> _HALF) < count and np.int64(word & _LOW) < count
    return there


class Pool:
    """A growing set of interned pieces, or of nodes.

    Attributes:
        interned: The set in the form that the loops read. Growing replaces it: don't keep it.
    """

    __slots__ = ("_index", "_words", "interned")

    def __init__(self, width: int, known: Words) -> None:
        count = len(known) // width
        room = max(FIRST, 2 * count)
        self._words = Pages(np.uint64, room * width)
        self._words.room[: len(known)] = known
        counts = np.array([count, 0, 1, width], np.int64)
        self.interned = Interned(self._words.room, np.zeros(1, np.uint32), counts)
        self._rebuild(room)

    def __len__(self) -> int:
        return int(self.interned.counts[COUNT])

    @property
    def width(self) -> int:
        """The number of words of each."""
        return int(self.interned.counts[WIDE])

    @property
    def words(self) -> Words:
        """The words of all."""
        return self.interned.words[: len(self) * self.width]

    @property
    def held(self) -> int:
        """The memory that they take, in bytes."""
        return self._words.held(len(self) * self.width) + self._index.room.nbytes

    def has_room(self, count: int) -> bool:
        """Return whether there is room for `count` more."""
        return bool(len(self) + count <= self.interned.counts[MOST])

    def reserve(self, count: int) -> None:
        """Make room for `count` more.

        Raises:
            OSError: Memory or the file has no room.
        """
        if not self.has_room(count):
            room = more(len(self._words.room) // self.width)
            self.interned = self.interned._replace(words=_NONE)
            self._words.grow(room * self.width)
            self._rebuild(room)

    def _rebuild(self, room: int) -> None:
        self._index = Pages(np.uint32, 1)
        self._index = Pages(np.uint32, slots_for(room))
        rebuild(self._words.room, len(self), self.width, self._index.room, alone)
        slots = len(self._index.room)
        self.interned.counts[MOST] = min(room, most_in(slots))
        self.interned.counts[BITS] = bits_for(slots)
        self.interned = self.interned._replace(words=self._words.room, index=self._index.room)


class FoldingScratch(local):
    """One thread's scratch space for unfolding and folding rows (see `FoldedTable`); no row is unfolded at first."""

    def __init__(self, count: int, width: int) -> None:
        super().__init__()
        self.rooms = (
            np.zeros(count * width, np.uint64),
            np.full(count, UNMET, np.int64),
            np.full(FOUR, UNMET, np.int64),
            np.zeros(count, np.int64),
            np.zeros(FOUR, np.int64),
            np.zeros(max(width, PAIR), np.uint64),
            np.zeros(MEMORY, np.uint64),
            np.zeros(MEMORY, np.int64),
            np.zeros(count * width, np.uint64),
        )


class Folding:
    """The pieces and nodes of all rows of one width.

    Attributes:
        width: The number of words of a row.
    """

    __slots__ = ("_begins", "_deep", "_desk", "_piece_of", "_shown", "nodes", "pieces", "width")

    def __init__(self, width: int, pieces: Words = _NONE, nodes: Words = _NONE) -> None:
        self._deep = width > SHALLOW
        count = FOUR * FOUR if self._deep else FOUR
        self.width = width
        wide = -(-width // count)
        order = np.arange(count).reshape(-1, count // FOUR).T.ravel()  # the piece of the row at each position
        self._begins = wide * order
        self._piece_of = np.repeat(np.argsort(order), wide)
        self.pieces = Pool(wide, pieces)
        self.nodes = Pool(PAIR, nodes)
        self._desk = FoldingScratch(count, self.pieces.width)
        begin_with_zeros(self.folded)
        self.show()

    @property
    def folded(self) -> FoldedTable:
        """The tables and scratch space of the thread that adds. Growing replaces them: don't keep them."""
        return self._at_desk(self.pieces.interned, self.nodes.interned)

    @property
    def shown(self) -> FoldedTable:
        """The tables last published to reading threads. Growing replaces them: don't keep them."""
        return self._at_desk(*self._shown)

    def _at_desk(self, pieces: Interned, nodes: Interned) -> FoldedTable:
        return FoldedTable(pieces, nodes, int(self._deep), self._piece_of, self._begins, *self._desk.rooms)

    def show(self) -> None:
        """Publish the present pieces and nodes to reading threads."""
        self._shown = tuple(
            each._replace(counts=each.counts.copy()) for each in (self.pieces.interned, self.nodes.interned)
        )

    @property
    def held(self) -> int:
        """The memory that they take, in bytes."""
        return self.pieces.held + self.nodes.held

    @property
    def has_room(self) -> bool:
        """Whether there is room for the pieces and nodes of one more row."""
        return self.pieces.has_room(FOUR * FOUR) and self.nodes.has_room(FOUR)

    def reserve(self) -> None:
        """Make room for the pieces and nodes of at least one more row; no thread may look anything up meanwhile.

        Raises:
            OSError: Memory or the file has no room.
        """
        self._shown = ()  # an array keeps its pages from moving
        try:
            self.pieces.reserve(FOUR * FOUR)
            self.nodes.reserve(FOUR)
        finally:
            self.show()

    def are_rows(self, kept: Words) -> bool:
        """Return whether all pieces and nodes of some rows exist, and all of them are distinct."""
        once = all(
            len(np.unique(pool.words.reshape(-1, pool.width), axis=0)) == len(pool)
            for pool in (self.pieces, self.nodes)
        )
        if not self._deep:
            return once and bool(are_there(kept, len(self.pieces)))
        nodes = bool(are_there(self.nodes.words, len(self.pieces)))
        return once and nodes and bool(are_there(kept, len(self.nodes)))
