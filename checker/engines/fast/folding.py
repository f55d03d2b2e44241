"""Wide rows folded: of each row two words are kept, however many words it has.

A row is cut into pieces of as many words each, and pieces are interned: what two rows have in common they share. A row
of up to four pieces is kept as their numbers; of one with up to sixteen pieces four numbers are interned again, as a
node, and the row is kept as the numbers of its nodes. Each node has every fourth piece of the row: what varies much
stands side by side, and is so divided among all nodes. Rows are equal exactly if these numbers are. A successor differs
from its origin in a piece or two, so only these are looked up, and the nodes above them. This is the collapse of
Holzmann (1997) in a tree, as Laarman, van de Pol and Weber (2011) fold rows, but four at a time: two look-ups instead
of one for each level of a binary tree.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (what numba compiles is typed by numba: mypy takes its integers for Python's)

from threading import local
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.loops import inner, njit
from checker.engines.fast.pages import Pages, more
from checker.engines.fast.table import (
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
"""Numbers of a node or of a row."""

PAIR = 2
"""Words in which these are kept."""

SHALLOW = 8
"""How many words rows have at most that are cut into four pieces instead of sixteen."""

COUNT, MOST, BITS, WIDE = range(4)
FIRST = 1 << 10

UNMET, NO_ROOM = -1, -2
"""What stands for the number of a piece or node that was never met, where none is added, and where no room is left."""

MEMORY = 1 << 15
"""What a transition made of a piece is remembered for so many of both at the most."""

NOWHERE = np.uint64(0xFFFFFFFFFFFFFFFF)
"""What is kept of a row of which some piece was never met, where none is added: of no row it is kept."""

_HALF, _LOW = np.uint64(32), np.uint64(0xFFFFFFFF)
_NONE = np.zeros(0, np.uint64)


class Interned(NamedTuple):
    """Pieces or nodes by number, as the loops see them.

    Attributes:
        words: Their words.
        index: Finds them, as the visited set finds rows.
        counts: How many there are and may be, how many bits a number takes in the index, and how many words each has.
    """

    words: Words
    index: Any
    counts: Numbers


class Folded(NamedTuple):
    """Pieces and nodes, and the row that one thread unfolded last, as the loops see them.

    While a successor is made of it, the numbers of its own pieces stand in the place of the row's.

    Attributes:
        pieces, nodes: What is interned. A thread that only looks up has counts of its own: what was added since, and
            may not be written to its end, it has never met.
        deep: Whether there are nodes between pieces and rows: a number for a flag.
        piece_of: For each word of a row in which piece it is.
        begins: For each piece with which word it begins.
        whole: The words of the row.
        below, above: The numbers of its pieces, and of its nodes.
        before, fresh: Room for numbers of pieces, and of nodes.
        sought: Room for a piece or node that is looked up.
        memory, results: What some transitions made of some pieces lately.
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


@njit(cache=True, inline="always")
def intern(i: Interned, words: Words, adding: bool) -> np.int64:
    """Return the number of a piece or node; of one that was never met a new one, or less than 0 (see `UNMET`)."""
    width = i.counts[WIDE]
    mixed, bits = hashed(words, 0, width), np.uint32(i.counts[BITS])
    found = find(i.words, i.index, words, 0, mixed, width, bits)
    if found >= i.counts[COUNT] or (found < 0 and not adding):  # another thread adds it just now
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


@njit(cache=True, inline="always")
def number_in(words: Words, at: int, k: int) -> np.int64:
    """Return one of the four numbers in the two words that begin there."""
    word = words[at + (k >> 1)]
    return np.int64(word & _LOW) if k & 1 else np.int64(word >> _HALF)


@njit(cache=True, inline="always")
def put_numbers(numbers: Numbers, begin: int, words: Words, at: int) -> None:
    """Put four numbers, from one on, into two words."""
    for k in range(PAIR):
        high, low = np.uint64(numbers[begin + 2 * k]), np.uint64(numbers[begin + 2 * k + 1])
        words[at + k] = (high << _HALF) | low


@njit(cache=True, inline="always")
def unfold_piece(f: Folded, piece: int, number: int) -> None:
    """Write the words of a piece, if they are not there already."""
    if f.below[piece] != number:
        f.below[piece] = number
        width, begin = f.pieces.counts[WIDE], f.begins[piece]
        for k in range(width):
            f.whole[begin + k] = f.pieces.words[number * width + k]


@inner(cache=True)
def unfold(f: Folded, rows: Words, row: int) -> None:
    """Write the words of a row; what it shares with the row before stands there already."""
    for k in range(FOUR):
        number = number_in(rows, PAIR * row, k)
        if not f.deep:
            unfold_piece(f, k, number)
        elif f.above[k] != number:
            f.above[k] = number
            for j in range(FOUR):
                unfold_piece(f, FOUR * k + j, number_in(f.nodes.words, PAIR * number, j))


@njit(cache=True, inline="always")
def put_piece(f: Folded, piece: int, number: int, touched: int) -> int:
    """Let a piece of the successor be another; return which are its own, as bits."""
    if not (touched >> piece) & 1:
        f.before[piece] = f.below[piece]
    f.below[piece] = number
    return touched | (1 << piece)


@njit(cache=True, inline="always")
def fold(f: Folded, touched: int, adding: bool, kept: Words, at: int) -> int:
    """Write what is kept of the successor; return less than 0 where some piece or node of it is not there."""
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


@njit(cache=True, inline="always")
def leave_open(kept: Words, at: int, row: int, step: int) -> None:
    """Note in the place of a successor of which something was never met how it is made: by which step of which row."""
    kept[at], kept[at + 1] = NOWHERE, (np.uint64(step) << _HALF) | np.uint64(row)


@njit(cache=True, inline="always")
def step_left_open(kept: Words, at: int) -> int:
    """Return the step by which a successor is yet to be made; less than 0 where it is made."""
    if kept[at] != NOWHERE or kept[at + 1] == NOWHERE:
        return np.int64(-1)
    return np.int64(kept[at + 1] >> _HALF)


@inner(cache=True)
def take(f: Folded, words: Words, begin: int, width: int, adding: bool) -> int:
    """Take a successor whose words stand elsewhere; return which of its pieces differ from the row's, as bits."""
    touched, wide = np.int64(0), f.pieces.counts[WIDE]
    for first in range(0, width, wide):
        differs = False
        for k in range(wide):
            f.sought[k] = words[begin + first + k] if first + k < width else np.uint64(0)
            differs = differs or f.sought[k] != f.whole[first + k]
        if differs:
            touched = put_piece(f, f.piece_of[first], intern(f.pieces, f.sought, adding), touched)
    return touched


@njit(cache=True, inline="always")
def seek_piece(f: Folded, piece: int) -> None:
    """Copy the words of a piece of the successor to where what is looked up stands."""
    wide = f.pieces.counts[WIDE]
    begin = f.below[piece] * wide
    for k in range(wide):
        f.sought[k] = f.pieces.words[begin + k]


@njit(cache=True, inline="always")
def seek_piece_of_row(f: Folded, piece: int) -> None:
    """Copy the words of a piece of the row that was unfolded to where what is looked up stands."""
    begin = f.begins[piece]
    for k in range(f.pieces.counts[WIDE]):
        f.sought[k] = f.whole[begin + k]


@njit(cache=True, inline="always")
def put_sought(f: Folded, piece: int, touched: int) -> int:
    """Let a piece of the successor be what was sought, where that is not the row's; return which are its own."""
    differs, begin = False, f.begins[piece]
    for k in range(f.pieces.counts[WIDE]):
        differs = differs or f.sought[k] != f.whole[begin + k]
    return put_piece(f, piece, intern(f.pieces, f.sought, False), touched) if differs else touched


@njit(cache=True)
def fold_rows(f: Folded, words: Words, width: int, kept: Words, begin: int) -> int:
    """Fold rows, from one on, and write what is kept of them; return up to which there was room."""
    count = len(kept) // PAIR
    for k in range(begin, count):
        if fold(f, take(f, words, k * width, width, True), True, kept, PAIR * k) == NO_ROOM:
            return k
        unfold(f, kept, k)
    return count


@njit(cache=True)
def unfold_rows(f: Folded, kept: Words, width: int, words: Words) -> None:
    """Write the words of rows one after another."""
    for k in range(len(kept) // PAIR):
        unfold(f, kept, k)
        for word in range(width):
            words[k * width + word] = f.whole[word]


@njit(cache=True)
def begin_with_zeros(f: Folded) -> None:
    """Let the row that was unfolded last be one of zeros: its pieces have the number 0, and its nodes."""
    f.below[:] = intern(f.pieces, f.whole, True)
    put_numbers(f.below, 0, f.sought, 0)
    f.above[:] = intern(f.nodes, f.sought, True)


@njit(cache=True)
def are_there(words: Words, count: int) -> bool:
    """Tell whether all numbers in words are less than a count."""
    there = True
    for word in words:
        there = there and np.int64(word >> _HALF) < count and np.int64(word & _LOW) < count
    return there


class Pool:
    """Pieces, or nodes, of so many words each: those that are known, and room for more.

    Attributes:
        interned: As the loops see them; growing makes another one: don't keep it.
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
        """How many words each has."""
        return int(self.interned.counts[WIDE])

    @property
    def words(self) -> Words:
        """Their words."""
        return self.interned.words[: len(self) * self.width]

    @property
    def held(self) -> int:
        """How many bytes they take."""
        return self._words.held(len(self) * self.width) + self._index.room.nbytes

    def has_room(self, count: int) -> bool:
        """Tell whether there is room for so many more."""
        return bool(len(self) + count <= self.interned.counts[MOST])

    def reserve(self, count: int) -> None:
        """Make room for so many more.

        Raises:
            OSError: There is none.
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


class Desk(local):
    """The room in which one thread folds and unfolds rows (see `Folded`); each has its own, in which no row is yet."""

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
        )


class Folding:
    """The pieces and nodes of all rows of so many words.

    Attributes:
        width: How many words a row has.
    """

    __slots__ = ("_begins", "_deep", "_desk", "_piece_of", "_shown", "nodes", "pieces", "width")

    def __init__(self, width: int, pieces: Words = _NONE, nodes: Words = _NONE) -> None:
        self._deep = width > SHALLOW
        count = FOUR * FOUR if self._deep else FOUR
        self.width = width
        wide = -(-width // count)
        order = np.arange(count).reshape(-1, count // FOUR).T.ravel()  # which piece of the row each is
        self._begins = wide * order
        self._piece_of = np.repeat(np.argsort(order), wide)
        self.pieces = Pool(wide, pieces)
        self.nodes = Pool(PAIR, nodes)
        self._desk = Desk(count, self.pieces.width)
        begin_with_zeros(self.folded)
        self.show()

    @property
    def folded(self) -> Folded:
        """Both as the loops see them in the thread that adds; making room makes others: don't keep it."""
        return self._at_desk(self.pieces.interned, self.nodes.interned)

    @property
    def shown(self) -> Folded:
        """Both as they were shown last to the threads that only look up; making room makes others: don't keep it."""
        return self._at_desk(*self._shown)

    def _at_desk(self, pieces: Interned, nodes: Interned) -> Folded:
        return Folded(pieces, nodes, int(self._deep), self._piece_of, self._begins, *self._desk.rooms)

    def show(self) -> None:
        """Let all threads look up what is there now."""
        self._shown = tuple(
            each._replace(counts=each.counts.copy()) for each in (self.pieces.interned, self.nodes.interned)
        )

    @property
    def held(self) -> int:
        """How many bytes they take."""
        return self.pieces.held + self.nodes.held

    @property
    def has_room(self) -> bool:
        """Whether there is room for what a row is folded into."""
        return self.pieces.has_room(FOUR * FOUR) and self.nodes.has_room(FOUR)

    def reserve(self) -> None:
        """Make room for one more row, and for more; meanwhile nobody looks up anything.

        Raises:
            OSError: There is none.
        """
        self._shown = ()  # arrays hold their pages where they are
        try:
            self.pieces.reserve(FOUR * FOUR)
            self.nodes.reserve(FOUR)
        finally:
            self.show()

    def are_rows(self, kept: Words) -> bool:
        """Tell whether every piece and node of some rows is there, and each but once."""
        once = all(
            len(np.unique(pool.words.reshape(-1, pool.width), axis=0)) == len(pool)
            for pool in (self.pieces, self.nodes)
        )
        if not self._deep:
            return once and bool(are_there(kept, len(self.pieces)))
        nodes = bool(are_there(self.nodes.words, len(self.pieces)))
        return once and nodes and bool(are_there(kept, len(self.nodes)))
