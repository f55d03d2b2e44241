"""Paths for the cycle proviso (see `checker.reduction.cycle_proviso`), and followed transitions, in arrays for loops.

Rows are expanded in order, and the next row of a path is stored only for rows that have one, consecutively. A bit for
each row marks these; the number of set bits before it is the index into the stored ones.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.bits import WORD, add, has, ones_in
from checker.engines.fast.compiled.jit_decorators import inner, njit
from checker.engines.fast.compiled.mapped_arrays import Pages
from checker.engines.fast.compiled.table import Words
from checker.engines.fast.model.learned_model import State
from checker.engines.fast.store.tree_compression import NO_ROOM, Interned, Pool, intern

BLOCK = 8
"""Words of bits that share one stored count."""

SETS = 1 << 8
"""Free room for sets that exists at least when the expansion of rows begins."""

FORWARD, SINGLE, EDGES = 1, 2, 4
"""What is asked of a search, as bits: ample sets lead forward, have a single step (see `checker.reduction.ample`), and
followed transitions are stored.
"""

LED, FOLLOWED = range(2)
"""The numbers of stored leads and of stored transitions, in `Trails.count`."""

AT_ITS_TURN = -1
"""`Trails.end` where the cycle proviso is decided when a row is stored."""

NOWHERE = 0xFFFFFFFF
"""The target of a stored transition that the limit left out."""

_HALF, _LOW = np.uint64(32), np.uint64(0xFFFFFFFF)


class Trails(NamedTuple):
    """The paths in the form that the loops read.

    Attributes:
        movers: For each row not yet expanded, the number of the agent whose step led there, plus 1; 0 for a clause.
        led: A bit for each row from which a path continues.
        before: The number of set bits before each block.
        leads: For each of these rows, the next row and the number of the set of parts taken on the way.
        count: The numbers of stored leads and transitions.
        sets: The sets of parts by number, as words of bits: there are few.
        sought, further: Scratch space for sets of parts.
        asked: What is asked of the search, as bits.
        end: The first row of the next layer, in a search that is divided among workers; AT_ITS_TURN; 0 in any other.
        followed: The followed transitions, row by row: target and step.
        ends: For each expanded row, the number of transitions up to its last one.
    """

    movers: Any
    led: Words
    before: Any
    leads: Words
    count: State
    sets: Interned
    sought: Words
    further: Words
    asked: int
    end: int
    followed: Words
    ends: Any


@njit(cache=True, forceinline=True)
def has_room(trails: Trails, transitions: int) -> bool:
    """Return whether so many transitions can be stored, if they are."""
    return not trails.asked & EDGES or trails.count[FOLLOWED] + transitions <= len(trails.followed)


@njit(cache=True, forceinline=True)
def store_transition(trails: Trails, step: int, to: int) -> None:
    """Store a followed transition of the last begun row."""
    if trails.asked & EDGES:
        trails.followed[trails.count[FOLLOWED]] = (np.uint64(to) << _HALF) | np.uint64(step)
        trails.count[FOLLOWED] += 1


@njit(cache=True, forceinline=True)
def end_row(trails: Trails, row: int) -> None:
    """End the transitions of a row."""
    if trails.asked & EDGES:
        trails.ends[row] = trails.count[FOLLOWED]


@njit(cache=True, forceinline=True)
def begin_row(trails: Trails, row: int) -> None:
    """Note the number of leads before a row that begins a block; rows must begin in order."""
    if row % (BLOCK * WORD) == 0:
        trails.before[row // (BLOCK * WORD)] = trails.count[LED]


@njit(cache=True, forceinline=True)
def lead_on(trails: Trails, row: int, to: int, taken: int) -> None:
    """Let the path of the last begun row continue at row `to`, taking set number `taken`."""
    add(trails.led, 0, row)
    trails.leads[trails.count[LED]] = (np.uint64(to) << _HALF) | np.uint64(taken)
    trails.count[LED] += 1


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
        asked: What is asked of the search, as bits.

    Attributes:
        most: The greatest number of transitions of a row.
    """

    def __init__(self, agents: int, wide: int, asked: int = 0) -> None:
        self.wide = wide
        self.asked = asked
        self.most = 0
        self.movers = Pages(np.min_scalar_type(agents).type, 1)
        self.led, self.leads = Pages(np.uint64, 1), Pages(np.uint64, 1)
        self.before = Pages(np.uint32, 1)
        self.count = np.zeros(2, np.int64)
        self.sets = Pool(wide, np.zeros(0, np.uint64))
        self.followed, self.ends = Pages(np.uint64, 1), Pages(np.uint64, 1)

    def trails(self, end: int = 0) -> Trails:
        """Return the paths in the form that the loops read, with `Trails.end`. They are void after growing."""
        rooms = (self.movers.room, self.led.room, self.before.room, self.leads.room)
        sought, further = np.zeros(self.wide, np.uint64), np.zeros(self.wide, np.uint64)
        stored = (self.followed.room, self.ends.room)
        return Trails(*rooms, self.count, self.sets.interned, sought, further, self.asked, end, *stored)

    def lacks_room(self, rows: int) -> bool:
        """Return whether `reserve` is due."""
        stored = self.asked & EDGES and len(self.followed.room) < int(self.count[FOLLOWED]) + 2 * self.most
        return bool(stored) or rows > len(self.leads.room) or not self.sets.has_room(SETS)

    def reserve(self, rows: int) -> None:
        """Make room for the paths of `rows` rows, for more sets of parts, and for more transitions.

        No other thread may read paths meanwhile.
        """
        self.movers.grow(rows)
        self.leads.grow(rows)
        self.led.grow(rows // WORD + 1)
        self.before.grow(rows // (BLOCK * WORD) + 1)
        self.sets.reserve(SETS)
        if self.asked & EDGES:
            self.followed.grow(2 * int(self.count[FOLLOWED]) + 4 * self.most)
            self.ends.grow(rows)

    def held(self, rows: int) -> int:
        """Return the bytes that the paths of `rows` rows take."""
        bits = self.led.held(rows // WORD + 1) + self.before.held(rows // (BLOCK * WORD) + 1)
        stored = self.followed.held(int(self.count[FOLLOWED])) + self.ends.held(rows)
        return self.movers.held(rows) + bits + self.leads.held(int(self.count[LED])) + self.sets.held + stored

    @property
    def has_transitions(self) -> bool:
        """Whether the followed transitions are stored."""
        return bool(self.asked & EDGES)

    def transitions(self, rows: int) -> tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int64]]:
        """Return the followed transitions of the first rows: origins, steps, and targets (< 0: none)."""
        ends = self.ends.room[:rows].astype(np.int64)
        stored = self.followed.room[: int(ends[-1]) if rows else 0]
        targets = (stored >> _HALF).astype(np.int64)
        targets[targets == NOWHERE] = -1
        return np.repeat(np.arange(rows), np.diff(ends, prepend=0)), (stored & _LOW).astype(np.int32), targets

    def spill(self, folder: Path, rows: int) -> None:
        """Move the paths of `rows` rows to files in a folder; the sets of parts, which are few, stay in memory.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        self.movers.spill(folder, rows)
        self.leads.spill(folder, int(self.count[LED]))
        self.led.spill(folder, rows // WORD + 1)
        self.before.spill(folder, rows // (BLOCK * WORD) + 1)
        self.followed.spill(folder, int(self.count[FOLLOWED]))
        self.ends.spill(folder, rows if self.has_transitions else 0)

    def kept(self, rows: int, expanded: int) -> tuple[NDArray[Any], ...]:
        """Return the stored form of the paths of `rows` rows: movers, bits, leads, sets, transitions and their ends."""
        ends = self.ends.room[: expanded if self.has_transitions else 0]
        return (
            self.movers.room[:rows],
            self.led.room[: -(-rows // WORD)],
            self.leads.room[: self.count[LED]],
            self.sets.words,
            self.followed.room[: self.count[FOLLOWED]],
            ends,
        )

    def restore(self, kept: tuple[NDArray[Any], ...], rows: int, expanded: int, agents: int) -> None:
        """Load the stored paths of `rows` rows, of which the first are expanded.

        Raises:
            ValueError: No search has these paths.
        """
        movers, led, leads, sets, followed, ends = kept
        sets = sets.reshape(-1, self.wide) if len(sets) % self.wide == 0 else sets
        if len(movers) != rows or len(led) != -(-rows // WORD) or sets.ndim != 2:
            raise ValueError("it has paths of other rows")
        bits = np.unpackbits(led.view(np.uint8), bitorder="little")
        origins, to = np.flatnonzero(bits), (leads >> _HALF).astype(np.int64)
        if len(origins) != len(leads) or np.any(origins >= expanded) or np.any(movers > agents):
            raise ValueError("it has other paths")
        known = len(np.unique(sets, axis=0)) == len(sets) and not np.any(leads & _LOW >= len(sets))
        if not known or np.any(to >= rows):
            raise ValueError("its paths take other steps")
        following = np.arange(rows)
        following[origins] = to
        for _ in range(rows.bit_length()):  # each round doubles the length
            following = following[following]
        if np.any(bits[following]):
            raise ValueError("a path of it has no end")
        self._look_at_transitions(followed, ends, rows, expanded)
        self.count[:] = len(leads), len(followed)
        self.reserve(rows)
        self.sets = Pool(self.wide, sets.ravel())
        pairs = ((self.movers, movers), (self.led, led), (self.leads, leads), (self.followed, followed))
        for pages, known_before in (*pairs, (self.ends, ends), (self.before, _ones_before(bits))):
            pages.room[: len(known_before)] = known_before

    def _look_at_transitions(
        self, followed: NDArray[Any], ends: NDArray[Any], rows: int, expanded: int
    ) -> None:
        """Raise ValueError unless the stored transitions are those of so many rows."""
        targets = followed >> _HALF
        wanted = expanded if self.has_transitions else 0
        last = int(ends[-1]) if len(ends) else 0
        rises = bool(np.all(ends[:-1] <= ends[1:]))
        if len(ends) != wanted or last != len(followed) or not rises:
            raise ValueError("it has transitions of other rows")
        if np.any((targets >= rows) & (targets != NOWHERE)):
            raise ValueError("it has transitions to rows that it does not have")

    def steps(self) -> NDArray[np.int64]:
        """Return the steps of the stored transitions."""
        return (self.followed.room[: self.count[FOLLOWED]] & _LOW).astype(np.int64)


def _ones_before(bits: NDArray[np.uint8]) -> NDArray[np.int64]:
    """Return the number of set bits before each block."""
    blocks = np.zeros(-(-len(bits) // (BLOCK * WORD)) * BLOCK * WORD, np.int64)
    blocks[: len(bits)] = bits
    return np.concatenate(([0], np.cumsum(blocks.reshape(-1, BLOCK * WORD).sum(1))))[:-1]
