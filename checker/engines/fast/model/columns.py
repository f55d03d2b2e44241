"""Columns: the cells of configurations as small integers, packed into words of 64 bits.

Each cell has a column. Each observation within a cell's value has one more column for each mobile name. The values of a
column are interned in the order of their first occurrence, and the column gets as many bits as their codes need. A
column that outgrows its bits requires a new packing.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.recording.access_recording import ColumnQuestion
from checker.recording.value_templates import Family, ObservationHole, holes, join_value, split_value
from semantics.behaviours.observations import NOTHING_SEEN
from semantics.state.cell_values import NAMES, Cell, Row
from semantics.state.signature import Name

WORD = 64


class _Absent:
    def __reduce__(self) -> str:
        return "ABSENT"  # one instance in each process

    def __repr__(self) -> str:
        return "absent"


ABSENT = _Absent()
"""The value of a column where the configuration lacks the cell (an agent not spawned yet)."""

Place = tuple[Cell, int, Name] | tuple[Cell]
"""The subject of a column: the skeleton of a cell, or the fact about a name in one of its holes."""


@dataclass(slots=True)
class ColumnGrowth:
    """The growth of columns.

    Attributes:
        times: The number of new columns and of columns that need one more bit.
        valued: The cells with new values since someone last cleared them.
    """

    times: int = 0
    valued: dict[Cell, None] = field(default_factory=dict)


class Column:
    """The values of a column, by code; all columns of facts about one name share their codes."""

    __slots__ = ("codes", "growth", "place", "values")

    def __init__(self, place: Place, first: Any, growth: ColumnGrowth, alike: "Column | None" = None) -> None:
        self.place = place
        self.growth = growth
        self.values: list[Any] = [first] if alike is None else alike.values
        self.codes: dict[Any, int] = {first: 0} if alike is None else alike.codes

    def value(self, code: int) -> Any:
        """Return the value that a rule reads; None if there is no such cell."""
        value = self.values[code]
        return None if value is ABSENT else value

    def code(self, value: Any) -> int:
        """Return the code of a value, adding it if it is new."""
        known = self.codes.get(value)
        if known is None:
            known = self.codes[value] = len(self.values)
            self.values.append(value)
            self.growth.valued[self.place[0]] = None
            if known & (known - 1) == 0:  # the previous codes need one bit fewer
                self.growth.times += 1
        return known


Writes = list[tuple[int, int]]
"""Columns with their new codes."""


class Columns:
    """All columns of an exploration.

    Attributes:
        mobile: The names for which an observation has columns.
        apart: The names for which the parts of a conclusion are learned separately: the mobile names and agents.
        growth: The growth of all columns.
    """

    def __init__(self, mobile: frozenset[Name], agents: frozenset[Name] = frozenset()) -> None:
        self.mobile = mobile
        self.apart = mobile | agents
        self.names = tuple(sorted(mobile))
        self.all: list[Column] = []
        self.numbers: dict[Place, int] = {}
        self.holes: dict[Cell, int] = {}
        self.growth = ColumnGrowth()
        self.about = {name: Column((NAMES, 0, name), NOTHING_SEEN, self.growth) for name in self.names}

    def __len__(self) -> int:
        return len(self.all)

    def number(self, place: Place) -> int:
        """Return the number of a column; a new column holds *absent*, or nothing seen, in all rows so far."""
        found = self.numbers.get(place)
        if found is None:
            found = self._add(place, ABSENT)
        return found

    def asked(self, ask: ColumnQuestion) -> int:
        """Return the number of the column that a question reads."""
        return self.number((ask.cell,) if ask.hole is None else (ask.cell, *ask.hole))

    def _add(self, place: Place, first: Any) -> int:
        self.numbers[place] = len(self.all)
        alike = self.about[place[2]] if len(place) == 3 else None
        self.all.append(Column(place, first, self.growth, alike))
        self.growth.times += 1
        return self.numbers[place]

    @property
    def sizes(self) -> list[int]:
        """The number of values of each column so far."""
        return [len(column.values) for column in self.all]

    def room(self, varying: Set[Cell]) -> list[int]:
        """Return the number of values for which each column gets bits.

        A varying column gets as many as the widest column of its kind.
        """
        kinds = [(column.place[0][0], len(column.place)) for column in self.all]
        widest: dict[tuple[str, int], int] = {}
        for kind, size in zip(kinds, self.sizes, strict=True):
            widest[kind] = max(size, widest.get(kind, 1))
        return [
            widest[kind] if column.place[0] in varying else 1
            for kind, column in zip(kinds, self.all, strict=True)
        ]

    def start(self, cell: Cell, value: Any) -> None:
        """Create the columns of a cell that every configuration has, with its initial value."""
        skeleton, families = split_value(value, self.mobile)
        self._add((cell,), skeleton)
        self.dig(cell, len(families))

    def dig(self, cell: Cell, count: int) -> bool:
        """Create the columns of a cell's first `count` holes; return whether some were missing."""
        before = self.holes.get(cell, 0)
        for number in range(before, count):
            for name in self.names:
                self.number((cell, number, name))
        self.holes[cell] = max(before, count)
        return before < count

    def of_hole(self, cell: Cell, number: int) -> list[tuple[Name, int]]:
        """Return each mobile name with its column, for one hole of a cell."""
        return [(name, self.numbers[cell, number, name]) for name in self.names]

    def cells(self) -> Iterator[tuple[Cell, int]]:
        """Yield each cell with the column of its skeleton."""
        return ((place[0], number) for place, number in self.numbers.items() if len(place) == 1)

    # --- whole configurations -----------------------------------------------------------------------------------

    def codes(self, row: Row) -> list[int]:
        """Return the code of each column for a row, creating missing columns and codes."""
        found: dict[int, int] = {}
        for cell, value in row.items():
            skeleton, families = split_value(value, self.mobile)
            number = self.number((cell,))
            found[number] = self.all[number].code(skeleton)
            self.dig(cell, len(families))
            for hole, family in enumerate(families):
                for name, column in self.of_hole(cell, hole):
                    found[column] = self.all[column].code(family.get(name, NOTHING_SEEN))
        absent = (number for number, column in enumerate(self.all) if len(column.place) == 1)
        found |= {number: self.all[number].code(ABSENT) for number in absent if number not in found}
        return [found.get(number, 0) for number in range(len(self.all))]

    def row(self, codes: Iterable[int]) -> Row:
        """Return the row of a sequence of codes."""
        given = list(codes)
        cells = ((cell, self.all[number].values[given[number]]) for cell, number in self.cells())
        found = dict(enumerate(given))
        return Row.of({c: self.whole(c, value, found) for c, value in cells if value is not ABSENT})

    def whole(self, cell: Cell, skeleton: Any, codes: Mapping[int, int]) -> Any:
        """Return the value of a cell from its skeleton and the codes of its holes' columns; a missing code is 0."""
        if not self.holes.get(cell):
            return skeleton

        def family_at(hole: ObservationHole) -> Family:
            told = {name: self.all[n].values[codes.get(n, 0)] for name, n in self.of_hole(cell, hole.number)}
            said = {name: fact for name, fact in told.items() if fact != NOTHING_SEEN}
            return dict(sorted({**dict(hole.still), **said}.items()))

        return join_value(skeleton, family_at)

    def holes_of(self, number: int, code: int) -> tuple[ObservationHole, ...]:
        """Return the holes of a skeleton, given its column and code."""
        return tuple(holes(self.all[number].values[code]))


@dataclass(frozen=True, slots=True)
class Packing:
    """The positions of all columns in a row of `words` words.

    Attributes:
        words: The number of words of a row.
        columns: Three numbers for each column: its word, its shift within the word, and the mask of its unshifted code.
    """

    words: int
    columns: NDArray[np.uint64]

    @property
    def word(self) -> NDArray[np.int64]:
        """The word of each column."""
        return self.columns[::3].astype(np.int64)

    @property
    def shift(self) -> NDArray[np.uint64]:
        """The shift of each column within its word."""
        return self.columns[1::3]

    @property
    def mask(self) -> NDArray[np.uint64]:
        """The mask of each column's unshifted code."""
        return self.columns[2::3]

    def code(self, words: Sequence[int], column: int) -> int:
        """Return the code of a column in a row; 0 for a column newer than the packing."""
        word, shift, mask = self.columns[3 * column : 3 * column + 3].tolist() or (0, 0, 0)
        return words[word] >> shift & mask

    def codes(self, words: NDArray[np.uint64]) -> list[int]:
        """Return the code of each column in a row."""
        found: list[int] = ((words[self.word] >> self.shift) & self.mask).tolist()
        return found

    def extends(self, other: "Packing") -> bool:
        """Return whether the columns of another packing are at the same positions in this one."""
        known = self.columns[: len(other.columns)]
        return self.words == other.words and np.array_equal(known, other.columns)

    def packed(self, codes: Sequence[int]) -> NDArray[np.uint64]:
        """Return the row with a code for each column."""
        words = np.zeros(self.words, np.uint64)
        for word, shift, code in zip(self.word, self.shift, codes, strict=True):
            words[word] |= np.uint64(code) << shift
        return words

    def holds(self, sizes: Sequence[int]) -> bool:
        """Return whether every column has enough bits for `sizes` values."""
        return bool(np.all(np.array(sizes, np.uint64) - np.uint64(1) <= self.mask))

    @property
    def is_sound(self) -> bool:
        """Whether the columns lie within the words and no two overlap."""
        if type(self.words) is not int or self.words < 1 or len(self.columns) % 3:
            return False
        taken = [0] * min(self.words, len(self.mask) or 1)
        for word, shift, mask in self.columns.reshape(-1, 3).tolist():
            if word >= len(taken) or shift >= WORD or mask & (mask + 1):
                return False
            bits = mask << shift
            if bits >> WORD or taken[word] & bits:
                return False
            taken[word] |= bits
        return len(taken) == self.words

    def extended(self, sizes: Sequence[int]) -> "Packing":
        """Return the packing with the new columns added; they have one value so far, hence no bits."""
        missing = len(sizes) - len(self.mask)
        if not missing:
            return self
        return Packing(self.words, np.concatenate([self.columns, np.zeros(3 * missing, np.uint64)]))


def packing(sizes: Sequence[int], words: int = 1) -> Packing:
    """Pack columns of the given sizes: the widest first, each into the first word with enough free bits.

    A row has at least `words` words. The spare bits of a word are distributed among its columns, so that they may grow.
    """
    bits = bits_of(sizes)
    rows: list[list[int]] = [[] for _ in range(words)]
    room = [WORD] * words
    full = 0  # the number of leading words that are full
    for number in sorted(np.flatnonzero(bits).tolist(), key=lambda n: -bits[n]):
        at = next((word for word in range(full, len(room)) if room[word] >= bits[number]), len(room))
        if at == len(room):
            rows.append([])
            room.append(WORD)
        rows[at].append(number)
        room[at] -= bits[number]
        while full < len(room) and not room[full]:
            full += 1
    return spread(rows, bits)


def packing_in_order(sizes: Sequence[int], order: Iterable[int], words: int = 1) -> Packing:
    """Pack columns one after another in a given order; otherwise as in `packing`."""
    bits = bits_of(sizes)
    rows: list[list[int]] = [[]]
    room = WORD
    for number in order:
        if bits[number] > room:
            rows.append([])
            room = WORD
        if bits[number]:
            rows[-1].append(number)
            room -= bits[number]
    return spread(rows + [[]] * (words - len(rows)), bits)


def bits_of(sizes: Sequence[int]) -> list[int]:
    """Return the number of bits of a column of each size."""
    return [max(size - 1, 0).bit_length() for size in sizes]


def spread(rows: Sequence[Sequence[int]], bits: Sequence[int]) -> Packing:
    """Return the packing for a list of columns per word, with the spare bits of each word distributed among them."""
    columns = [(0, 0, 0)] * len(bits)
    for word, numbers in enumerate(rows):
        free, shift = WORD - sum(bits[number] for number in numbers), 0
        for place, number in enumerate(numbers):
            spare = (free + len(numbers) - 1 - place) // len(numbers)
            wide = bits[number] + min(spare, 1 if len(numbers) > 1 else free)
            columns[number] = word, shift, (1 << wide) - 1
            shift += wide
    return Packing(len(rows), np.array(columns, np.uint64).ravel())


def shifts(old: Packing, new: Packing) -> NDArray[np.uint64]:
    """Return the moves of bits from one packing to another: five numbers for all columns that move alike.

    The numbers are the old word, the new word, the mask of the bits in the old word, the left shift and the right
    shift.
    """
    moved = np.flatnonzero(old.mask)  # columns newer than the old packing have no bits to move
    far = new.shift[moved].astype(np.int64) - old.shift[moved].astype(np.int64)
    ways = np.stack([old.word[moved], new.word[moved], far], axis=1)
    each, way = np.unique(ways, axis=0, return_inverse=True)
    masks = np.zeros(len(each), np.uint64)
    np.bitwise_or.at(masks, way.ravel(), old.mask[moved] << old.shift[moved])
    found = [each[:, 0], each[:, 1], masks, np.maximum(each[:, 2], 0), np.maximum(-each[:, 2], 0)]
    return np.stack([part.astype(np.uint64) for part in found], axis=1).ravel()
