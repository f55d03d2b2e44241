"""Paths for the cycle proviso (see `checker.reduction.cycle_proviso`), in arrays for the compiled loops.

Rows are expanded in order, and the next row of a path is stored only for rows that have one, consecutively. A bit for
each row marks these; the number of set bits before it is the index into the stored ones.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.bits import WORD, add, has, ones_in
from checker.engines.fast.jit_decorators import inner, njit
from checker.engines.fast.learned_model import State
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

    def spill(self, folder: Path, rows: int) -> None:
        """Move the paths of `rows` rows to files in a folder; the sets of parts, which are few, stay in memory.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        self.movers.spill(folder, rows)
        self.leads.spill(folder, int(self.count[0]))
        self.led.spill(folder, rows // WORD + 1)
        self.before.spill(folder, rows // (BLOCK * WORD) + 1)

    def kept(self, rows: int) -> tuple[NDArray[Any], ...]:
        """Return the stored form of the paths of `rows` rows: movers, bits, leads and sets."""
        if not rows:
            return self.movers.room[:0], self.led.room[:0], self.leads.room[:0], self.sets.words[:0]
        bits = self.led.room[: -(-rows // WORD)]
        return self.movers.room[:rows], bits, self.leads.room[: self.count[0]], self.sets.words

    def restore(self, kept: tuple[NDArray[Any], ...], rows: int, expanded: int, agents: int) -> None:
        """Load the stored paths of `rows` rows, of which the first are expanded.

        Raises:
            ValueError: No search has these paths.
        """
        movers, led, leads, sets = kept
        sets = sets.reshape(-1, self.wide) if len(sets) % self.wide == 0 else sets
        if len(movers) != rows or len(led) != -(-rows // WORD) or sets.ndim != 2:
            raise ValueError("it has paths of other rows")
        bits = np.unpackbits(led.view(np.uint8), bitorder="little")
        origins, ends = np.flatnonzero(bits), (leads >> _HALF).astype(np.int64)
        if len(origins) != len(leads) or np.any(origins >= expanded) or np.any(movers > agents):
            raise ValueError("it has other paths")
        if (
            np.any(ends >= rows)
            or np.any(leads & _LOW >= len(sets))
            or len(np.unique(sets, axis=0)) != len(sets)
        ):
            raise ValueError("its paths take other steps")
        following = np.arange(rows)
        following[origins] = ends
        for _ in range(rows.bit_length()):  # each round doubles the length
            following = following[following]
        if np.any(bits[following]):
            raise ValueError("a path of it has no end")
        self.reserve(rows)
        self.movers.room[:rows], self.led.room[: len(led)], self.leads.room[: len(leads)] = movers, led, leads
        self.count[0] = len(leads)
        self.sets = Pool(self.wide, sets.ravel())
        blocks = np.zeros(-(-len(bits) // (BLOCK * WORD)) * BLOCK * WORD, np.int64)
        blocks[: len(bits)] = bits
        before = np.concatenate(([0], np.cumsum(blocks.reshape(-1, BLOCK * WORD).sum(1))))[:-1]
        self.before.room[: len(before)] = before
