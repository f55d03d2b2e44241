"""The visited set: an open-addressing hash table of row numbers, each with as many hash bits as fit into 32 bits.

Two rows are compared in full. The home slot of a hash is proportional to the hash, so the table is ordered by it.
Collisions take the next free slot (linear probing).
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.jit_decorators import njit
from checker.engines.fast.compiled.prefetch import prefetch

Words = NDArray[np.uint64]
Share = Callable[[Callable[[range], Any], int], list[Any]]

PARTS = 16
"""The number of parts of a table that different threads may fill."""

ENTERED = 1 << 14
"""The number of rows in one step of filling a table."""

AHEAD = 32
"""The prefetch distance of rows; slots are prefetched twice as far ahead."""

_MULTIPLIER = np.uint64(0x9E3779B97F4A7C15)
_HALF, _ONE = np.uint64(32), np.uint64(1)
_PART, _SIXTY_FOUR = np.uint64(60), np.uint64(64)


@njit(cache=True, forceinline=True)
def hashed(words: Words, at: int, count: int) -> np.uint64:
    """Return the hash of a row."""
    mixed, begin = np.uint64(count), np.uint64(at)
    for k in range(np.uint64(count)):
        mixed = (mixed ^ words[begin + k]) * _MULTIPLIER
        mixed ^= mixed >> _HALF
    return mixed * _MULTIPLIER


@njit(cache=True, forceinline=True)
def slot_of(mixed: np.uint64, slots: int) -> np.uint64:
    """Return the home slot of a hash in a table of `slots` slots."""
    return ((mixed >> _HALF) * np.uint64(slots)) >> _HALF


@njit(cache=True)
def bits_for(slots: int) -> int:
    """Return the number of bits for a row number in a table of `slots` slots; the others hold bits of the hash."""
    bits = 1
    while (1 << bits) <= slots:
        bits += 1
    return bits


@njit(cache=True)
def most_in(slots: int) -> int:
    """Return the greatest number of rows in a table of `slots` slots."""
    return slots * 2 // 3


def slots_for(rows: int) -> int:
    """Return the initial size of a table for `rows` rows, with room for half as many more.

    It takes 6 to 9 bytes a row, less than with doubling. A fuller table takes less memory, but longer look-ups.
    """
    return rows * 9 // 4


def slots_within(left: float, rows: int, row: float, entry: int) -> float:
    """Return the size of a table that fills up just when memory does.

    A larger table would take memory from the rows that fill its slots.

    Args:
        left: Bytes for the table and for new rows.
        rows: The number of present rows.
        row: Bytes of a row with its origin.
        entry: Bytes of a slot.

    >>> slots_within(1_000 * 6 + 500 * 20, 500, 20, 4)
    1500.0
    """
    return 3 * (left + rows * row) / (3 * entry + 2 * row)


@njit(cache=True, forceinline=True)
def entry_of(mixed: np.uint64, row: int, bits: np.uint32) -> np.uint32:
    """Return the table entry of a row: bits of its hash, and its number plus 1; 0 marks a free slot."""
    return ((np.uint32(mixed) >> bits) << bits) | np.uint32(row + 1)


@njit(cache=True, forceinline=True)
def find(
    words: Words, table: Any, target: Words, k: int, mixed: np.uint64, width: int, bits: np.uint32
) -> int:
    """Return the number of a row equal to the target; -slot - 1 with its free slot if there is none."""
    slots, wide = np.uint64(len(table)), np.uint64(width)
    numbers = np.uint32((np.int64(1) << np.int64(bits)) - 1)
    tag = np.uint32(mixed) >> bits
    slot, goal = slot_of(mixed, len(table)), np.uint64(k) * wide
    found = np.int64(-1)
    while True:
        entry = table[slot]
        if entry == 0:
            found = -np.int64(slot) - 1
            break
        if entry >> bits == tag:
            row = np.uint64(entry & numbers) - _ONE
            same = True
            for j in range(wide):
                same = same and words[row * wide + j] == target[goal + j]
            if same:
                found = np.int64(row)
                break
        slot += _ONE
        if slot == slots:
            slot = np.uint64(0)
    return found


@njit(cache=True, forceinline=True)
def fetch(words: Words, table: Any, hashes: Words, k: int, end: int, width: int, bits: np.uint32) -> None:
    """Prefetch the slots and rows with which later successors will be compared."""
    far, near = k + 2 * AHEAD, k + AHEAD
    if far < end:
        prefetch(table, slot_of(hashes[far], len(table)))
    if near < end:
        entry = table[slot_of(hashes[near], len(table))]
        if entry != 0 and entry >> bits == np.uint32(hashes[near]) >> bits:
            numbers = np.uint32((np.int64(1) << np.int64(bits)) - 1)
            prefetch(words, (np.uint64(entry & numbers) - _ONE) * np.uint64(width))


# --- rebuilding -------------------------------------------------------------------------------------------------------


def alone(work: Callable[[range], Any], parts: int) -> list[Any]:
    """Do some work on all parts in this thread."""
    return [work(range(parts))]


def rebuild(words: Words, size: int, width: int, table: Any, share: Share) -> None:
    """Fill an empty table with rows, all of them different.

    Each part of the table is filled by one thread, in the order of the rows. The few rows without room in their part
    come last. So the contents do not depend on the number of threads.

    Args:
        words: The rows.
        size: The number of rows.
        width: The words of a row.
        table: The table.
        share: Runs some work on ranges of parts, in several threads, and returns the results.
    """
    bits = bits_for(len(table))

    def fill(parts: range) -> list[tuple[Words, Any]]:
        hashes, rows = np.zeros(ENTERED, np.uint64), np.zeros(ENTERED, np.int64)
        entries = np.zeros(ENTERED, table.dtype)
        left = [(hashes[:0], entries[:0])]
        for begin in range(0, size, ENTERED):
            end = min(begin + ENTERED, size)
            count = choose(words, begin, end, width, parts.start, parts.stop, hashes, rows)
            write_entries(hashes[:count], rows[:count], entries[:count], bits)
            over = enter(table, hashes[:count], entries[:count], PARTS)
            left.append((hashes[:over].copy(), entries[:over].copy()))
        return left

    found = [each for several in share(fill, PARTS) for each in several]
    hashes, entries = (np.concatenate(each) for each in zip(*found, strict=True))
    order = np.argsort(hashes >> _PART, kind="stable")
    enter(table, hashes[order], entries[order], 1)


@njit(cache=True, nogil=True)
def choose(
    words: Words, begin: int, end: int, width: int, first: int, last: int, hashes: Words, rows: Any
) -> int:
    """Note the hashes and numbers of the rows that belong to some parts; return their number."""
    low, wide = np.uint64(first) << _PART, (np.uint64(last - first) << _PART) - _ONE
    count = np.int64(0)
    for row in range(begin, end):
        mixed = hashed(words, row * width, width)
        hashes[count], rows[count] = mixed, row
        count += mixed - low <= wide
    return count


@njit(cache=True)
def write_entries(hashes: Words, rows: Any, entries: Any, bits: int) -> None:
    """Write the table entries of rows, with `bits` bits for each number."""
    for k in range(len(hashes)):
        entries[k] = entry_of(hashes[k], rows[k], np.uint32(bits))


@njit(cache=True, nogil=True)
def enter(table: Any, hashes: Words, entries: Any, parts: int) -> int:
    """Insert entries into free slots of their part of the table; move those without room to the front.

    Return the number of entries without room. With a single part the search wraps around, so there is always room.
    """
    slots, left = np.uint64(len(table)), np.int64(0)
    for k in range(len(hashes)):
        if k + AHEAD < len(hashes):
            prefetch(table, slot_of(hashes[k + AHEAD], len(table)))
        slot, end = slot_of(hashes[k], len(table)), slots
        if parts > 1:
            end = (((hashes[k] >> _PART) + _ONE) * slots) >> (_SIXTY_FOUR - _PART)
        while slot < end and table[slot] != 0:
            slot += _ONE
            if slot == end and parts == 1:
                slot = np.uint64(0)
        if slot < end:
            table[slot] = entries[k]
        else:
            hashes[left], entries[left] = hashes[k], entries[k]
            left += 1
    return left
