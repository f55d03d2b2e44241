"""The visited set: an open hash table of row numbers, each with as many bits of its hash as fit 32 bits.

Equality is decided on whole rows. A hash belongs into the slot that lies as far in the table as the hash among all
hashes; where that is taken, into the next one that is free.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (what numba compiles is typed by numba: mypy takes its integers for Python's)

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.loops import njit

Words = NDArray[np.uint64]
Write = Callable[[Words, Any, Any, int], None]

PARTS = 16
"""Parts of a table; rows that belong into one are entered one after another, so that they meet in a few pages."""

ENTERED = 1 << 14
"""Rows that are put into the order of those parts at once."""

AHEAD = 256
"""Rows whose slots are touched before the first of them is entered."""

_MULTIPLIER = np.uint64(0x9E3779B97F4A7C15)
_HALF, _ONE = np.uint64(32), np.uint64(1)
_PART = np.uint64(60)


@njit(cache=True, inline="always")
def hashed(words: Words, at: int, count: int) -> np.uint64:
    """Return the hash of a row."""
    mixed, begin = np.uint64(count), np.uint64(at)
    for k in range(np.uint64(count)):
        mixed = (mixed ^ words[begin + k]) * _MULTIPLIER
        mixed ^= mixed >> _HALF
    return mixed * _MULTIPLIER


@njit(cache=True, inline="always")
def slot_of(mixed: np.uint64, slots: int) -> np.uint64:
    """Return where a hash belongs in a table of so many slots."""
    return ((mixed >> _HALF) * np.uint64(slots)) >> _HALF


@njit(cache=True)
def bits_for(slots: int) -> int:
    """Return how many bits a row's number takes in a table of so many slots; the others hold bits of its hash."""
    bits = 1
    while (1 << bits) <= slots:
        bits += 1
    return bits


@njit(cache=True)
def most_in(slots: int) -> int:
    """Return how many rows a table of so many slots may hold."""
    return slots * 2 // 3


def slots_for(rows: int) -> int:
    """Return how many slots a table has at first that is to hold so many rows, and half as many more later.

    So it takes 6 to 9 bytes a row, less than if it were doubled; fuller ones take less still, but looking up longer.
    """
    return rows * 9 // 4


def slots_within(left: float, rows: int, row: int, entry: int) -> float:
    """Return how many slots a table has that is full just when memory is, as rows come.

    So that memory is not spent on slots whose rows would find none.

    Args:
        left: Bytes for the table and for rows that come.
        rows: How many there are.
        row: Bytes of one, with its origin.
        entry: Bytes of a slot.

    >>> slots_within(1_000 * 6 + 500 * 20, 500, 20, 4)
    1500.0
    """
    return 3 * (left + rows * row) / (3 * entry + 2 * row)


@njit(cache=True, inline="always")
def entry_of(mixed: np.uint64, row: int, bits: np.uint32) -> np.uint32:
    """Return what a table holds of a row: bits of its hash, and its number; 0 stands for none."""
    return ((np.uint32(mixed) >> bits) << bits) | np.uint32(row + 1)


@njit(cache=True, inline="always")
def find(
    words: Words, table: Any, target: Words, k: int, mixed: np.uint64, width: int, bits: np.uint32
) -> int:
    """Return the number of the row that a successor is; -slot - 1 where it is new, with where it belongs."""
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


@njit(cache=True)
def touch(words: Words, table: Any, hashes: Words, begin: int, end: int, width: int) -> int:
    """Read what successors will be compared with, so that the memory fetches it side by side."""
    wide = np.uint64(width)
    bits = np.uint32(bits_for(len(table)))
    numbers = np.uint32((np.int64(1) << np.int64(bits)) - 1)
    touched = np.uint64(0)
    for k in range(np.uint64(begin), np.uint64(end)):
        touched += np.uint64(table[slot_of(hashes[k], len(table))])
    for k in range(np.uint64(begin), np.uint64(end)):
        entry = table[slot_of(hashes[k], len(table))]
        if entry != 0 and entry >> bits == np.uint32(hashes[k]) >> bits:
            touched += words[(np.uint64(entry & numbers) - _ONE) * wide]
    return np.int64(touched & _ONE)


# --- entering all rows anew -------------------------------------------------------------------------------------------


def rebuild(words: Words, size: int, width: int, table: Any, write: Write, bits: int) -> None:
    """Fill an empty table with the rows, all of them different.

    Args:
        words: The rows.
        size: How many there are.
        width: Words of each.
        table: The table.
        write: Writes entries for the hashes and numbers of rows: `write_numbers`, or `compacting.write_tags`.
        bits: What it is given besides.
    """
    hashes, rows = np.zeros(ENTERED, np.uint64), np.zeros(ENTERED, np.int64)
    entries = np.zeros(ENTERED, table.dtype)
    for begin in range(0, size, ENTERED):
        some = slice(0, min(ENTERED, size - begin))
        order(words, begin, width, hashes[some], rows[some])
        write(hashes[some], rows[some], entries[some], bits)
        enter(table, hashes[some], entries[some])


@njit(cache=True, _nrt=True)
def order(words: Words, begin: int, width: int, hashes: Words, rows: Any) -> None:
    """Note the hashes and numbers of as many rows, ordered by the parts of a table into which they belong."""
    mixed, ends = np.empty(len(hashes), np.uint64), np.zeros(PARTS + 1, np.int64)
    for k in range(len(hashes)):
        mixed[k] = hashed(words, (begin + k) * width, width)
        ends[np.int64(mixed[k] >> _PART) + 1] += 1
    for part in range(PARTS):
        ends[part + 1] += ends[part]
    for k in range(len(hashes)):
        part = np.int64(mixed[k] >> _PART)
        hashes[ends[part]], rows[ends[part]] = mixed[k], begin + k
        ends[part] += 1


@njit(cache=True)
def write_numbers(hashes: Words, rows: Any, entries: Any, bits: int) -> None:
    """Write what a table holds of rows whose numbers take so many bits."""
    for k in range(len(hashes)):
        entries[k] = entry_of(hashes[k], rows[k], np.uint32(bits))


@njit(cache=True)
def enter(table: Any, hashes: Words, entries: Any) -> None:
    """Enter what no slot holds yet; slots are touched some ahead."""
    slots = np.uint64(len(table))
    touched = np.uint64(0)
    for begin in range(0, len(hashes), AHEAD):
        end = min(begin + AHEAD, len(hashes))
        for k in range(begin, end):
            touched += np.uint64(table[slot_of(hashes[k], len(table))])
        for k in range(begin, end):
            slot = slot_of(hashes[k], len(table))
            while table[slot] != 0:
                slot += _ONE
                if slot == slots:
                    slot = np.uint64(0)
            table[slot] = entries[k]
    hashes[0] = touched  # so that the compiler reads what is touched
