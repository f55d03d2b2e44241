"""Paths for the cycle proviso (see `checker.reduction.cycle_proviso`), in arrays for the compiled loops.

Rows are expanded in order, and the next row of a path is stored only for rows that have one, consecutively. A bit for
each row marks these; the number of set bits before it is the index into the stored ones.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import Any, NamedTuple

import numpy as np

from checker.engines.fast.bits import WORD, add, has, ones_in
from checker.engines.fast.jit_decorators import inner, njit
from checker.engines.fast.kernel import State
from checker.engines.fast.mapped_arrays import Pages
from checker.engines.fast.table import Words
from checker.engines.fast.tree_compression import NO_ROOM, Interned, Pool, intern

BLOCK = 8
"""Words of bits that share one stored count."""

SETS = 1 << 8
"""Free room for sets that exists at least when the expansion of rows begins."""

_HALF, _LOW = np.uint64(32), np.uint64(0xFFFFFFFF)


class Trails(NamedTuple):
    """The paths in the form that the loops read.

    Attributes:
        movers: For each row not yet expanded, the number of the agent whose step led there, plus 1; 0 for a clause.
        led: A bit for each row from which a path continues.
        before: The number of set bits before each block.
        leads: For each of these rows, the next row and the number of the set of parts taken on the way.
        count: The number of these rows.
        sets: The sets of parts by number, as words of bits: there are few.
        sought: Scratch space for a set to look up.
    """

    movers: Any
    led: Words
    before: Any
    leads: Words
    count: State
    sets: Interned
    sought: Words


@njit(cache=True, forceinline=True)
def begin_row(trails: Trails, row: int) -> None:
    """Note the number of leads before a row that begins a block; rows must begin in order."""
    if row % (BLOCK * WORD) == 0:
        trails.before[row // (BLOCK * WORD)] = trails.count[0]


@njit(cache=True, forceinline=True)
def lead_on(trails: Trails, row: int, to: int, taken: int) -> None:
    """Let the path of the last begun row continue at row `to`, taking set number `taken`."""
    add(trails.led, 0, row)
    trails.leads[trails.count[0]] = (np.uint64(to) << _HALF) | np.uint64(taken)
    trails.count[0] += 1


@njit(cache=True, forceinline=True)
def lead_of(trails: Trails, row: int) -> int:
    """Return the index of a row's lead, -1 if its path ends there."""
    if not has(trails.led, 0, row):
        return np.int64(-1)
    found, last = np.int64(trails.before[row // (BLOCK * WORD)]), row // WORD
    for at in range(last - last % BLOCK, last):
        found += ones_in(trails.led[at])
    return found + ones_in(trails.led[last] & ((np.uint64(1) << np.uint64(row % WORD)) - np.uint64(1)))


@inner(cache=True)
def end_of(trails: Trails, row: int, taken: Words) -> int:
    """Return the end of the path from a row, and add the parts taken on it; shorten the path on the way."""
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


class SearchPaths:
    """The paths of one search.

    Args:
        agents: The greatest number of agents.
        wide: The number of words of a set of parts.
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
        """The paths in the form that the loops read. Growing replaces them: don't keep them."""
        rooms = (self.movers.room, self.led.room, self.before.room, self.leads.room)
        return Trails(*rooms, self.count, self.sets.interned, np.zeros(self.wide, np.uint64))

    def reserve(self, rows: int) -> None:
        """Make room for the paths of `rows` rows, and for more sets of parts."""
        self.movers.grow(rows)
        self.leads.grow(rows)
        self.led.grow(rows // WORD + 1)
        self.before.grow(rows // (BLOCK * WORD) + 1)
        self.sets.reserve(SETS)

    def held(self, rows: int) -> int:
        """Return the bytes that the paths of `rows` rows take."""
        bits = self.led.held(rows // WORD + 1) + self.before.held(rows // (BLOCK * WORD) + 1)
        return self.movers.held(rows) + bits + self.leads.held(int(self.count[0])) + self.sets.held
