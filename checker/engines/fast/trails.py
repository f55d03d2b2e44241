"""The paths of `checker.reduction.paths`, as the loops of partial-order reduction keep them.

Rows are expanded in order, so where paths lead on is kept only of rows from which one does, one after another: a bit of
each row says whether it is one of these, and how many are before it says which.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (what numba compiles is typed by numba: mypy takes its integers for Python's)

from typing import Any, NamedTuple

import numpy as np

from checker.engines.fast.bits import WORD, add, has, ones_in
from checker.engines.fast.folding import NO_ROOM, Interned, Pool, intern
from checker.engines.fast.kernel import State
from checker.engines.fast.loops import inner, njit
from checker.engines.fast.pages import Pages
from checker.engines.fast.table import Words

BLOCK = 8
"""Words of bits that are counted together."""

SETS = 1 << 8
"""For how many sets more there is room at least where rows begin to be expanded."""

_HALF, _LOW = np.uint64(32), np.uint64(0xFFFFFFFF)


class Trails(NamedTuple):
    """The paths, as the loops see them.

    Attributes:
        movers: For each row that is yet to be expanded whose step led there: the agent's number and 1, 0 for nobody's.
        led: A bit for each row from which a path leads on.
        before: How many of these there are before each block of rows.
        leads: For each of them to which row, and the number of the set of parts that are taken on the way there.
        count: How many of them there are.
        sets: Those sets by number, as words of bits: they are few.
        sought: Room for one that is looked up.
    """

    movers: Any
    led: Words
    before: Any
    leads: Words
    count: State
    sets: Interned
    sought: Words


@njit(cache=True, inline="always")
def begin_row(trails: Trails, row: int) -> None:
    """Note how many paths lead on before a row, where it begins a block; no later row was begun."""
    if row % (BLOCK * WORD) == 0:
        trails.before[row // (BLOCK * WORD)] = trails.count[0]


@njit(cache=True, inline="always")
def lead_on(trails: Trails, row: int, to: int, taken: int) -> None:
    """Let a path lead on from the row that was begun last, with the number of the set that is taken on the way."""
    add(trails.led, 0, row)
    trails.leads[trails.count[0]] = (np.uint64(to) << _HALF) | np.uint64(taken)
    trails.count[0] += 1


@njit(cache=True, inline="always")
def lead_of(trails: Trails, row: int) -> int:
    """Return which of all leads is a row's, -1 where its path ends there."""
    if not has(trails.led, 0, row):
        return np.int64(-1)
    found, last = np.int64(trails.before[row // (BLOCK * WORD)]), row // WORD
    for at in range(last - last % BLOCK, last):
        found += ones_in(trails.led[at])
    return found + ones_in(trails.led[last] & ((np.uint64(1) << np.uint64(row % WORD)) - np.uint64(1)))


@inner(cache=True)
def end_of(trails: Trails, row: int, taken: Words) -> int:
    """Return where the path from a row ends, with what is taken on it; the path is made shorter."""
    wide, sought, sets = len(taken), trails.sought, trails.sets
    at = lead_of(trails, row)
    while at >= 0:
        lead = trails.leads[at]
        row = np.int64(lead >> _HALF)
        beyond = lead_of(trails, row)
        further = trails.leads[beyond] if beyond >= 0 else np.uint64(0)
        begin, end = wide * np.int64(lead & _LOW), wide * np.int64(further & _LOW)
        for word in range(wide):
            sought[word] = sets.words[begin + word] | (
                sets.words[end + word] if beyond >= 0 else np.uint64(0)
            )
            taken[word] |= sought[word]
        if beyond >= 0:
            number = intern(sets, sought, True)
            row = np.int64(further >> _HALF)
            if number != NO_ROOM:
                trails.leads[at] = (further & ~_LOW) | np.uint64(number)
            at = lead_of(trails, row)
        else:
            at = beyond
    return row


class Paths:
    """The paths of one search.

    Args:
        agents: How many agents there may ever be.
        wide: How many words have a bit for each part.
    """

    def __init__(self, agents: int, wide: int) -> None:
        self.wide = wide
        self.movers = Pages(np.min_scalar_type(agents).type, 1)
        self.led, self.leads = Pages(np.uint64, 1), Pages(np.uint64, 1)
        self.before = Pages(np.uint32, 1)
        self.count = np.zeros(1, np.int64)
        self.sets = Pool(wide, np.zeros(0, np.uint64))

    @property
    def trails(self) -> Trails:
        """As the loops see them; growing makes others: don't keep them."""
        rooms = (self.movers.room, self.led.room, self.before.room, self.leads.room)
        return Trails(*rooms, self.count, self.sets.interned, np.zeros(self.wide, np.uint64))

    def reserve(self, rows: int) -> None:
        """Make room for the paths of so many rows, and for more sets of what is taken on them."""
        self.movers.grow(rows)
        self.leads.grow(rows)
        self.led.grow(rows // WORD + 1)
        self.before.grow(rows // (BLOCK * WORD) + 1)
        self.sets.reserve(SETS)

    def held(self, rows: int) -> int:
        """Return how many bytes the paths of so many rows take."""
        bits = self.led.held(rows // WORD + 1) + self.before.held(rows // (BLOCK * WORD) + 1)
        return self.movers.held(rows) + bits + self.leads.held(int(self.count[0])) + self.sets.held
