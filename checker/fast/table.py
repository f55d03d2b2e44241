"""The visited set: an open hash table of row numbers, each beside as many bits of its hash as 32 bits leave room for.

Equality is decided on whole rows. A hash belongs into the slot that lies as far in the table as the hash among all
hashes; where that is taken, into the next one that is free.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (what numba compiles is typed by numba: mypy takes its integers for Python's)

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Words = NDArray[np.uint64]

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


@njit(cache=True)
def rebuild(words: Words, size: int, width: int, table: Any) -> None:
    """Fill an empty table with the rows, all of them different."""
    bits = np.uint32(bits_for(len(table)))
    hashes, rows = np.zeros(ENTERED, np.uint64), np.zeros(ENTERED, np.int64)
    entries = np.zeros(ENTERED, np.uint32)
    for begin in range(0, size, ENTERED):
        count = min(ENTERED, size - begin)
        in_parts(words, begin, count, width, hashes, rows)
        for k in range(count):
            entries[k] = entry_of(hashes[k], rows[k], bits)
        enter(table, hashes, entries, count)


@njit(cache=True)
def in_parts(words: Words, begin: int, count: int, width: int, hashes: Words, rows: Any) -> None:
    """Note the hashes and numbers of rows, ordered by the parts of a table into which they belong."""
    mixed, ends = np.empty(count, np.uint64), np.zeros(PARTS + 1, np.int64)
    for k in range(count):
        mixed[k] = hashed(words, (begin + k) * width, width)
        ends[np.int64(mixed[k] >> _PART) + 1] += 1
    for part in range(PARTS):
        ends[part + 1] += ends[part]
    for k in range(count):
        part = np.int64(mixed[k] >> _PART)
        hashes[ends[part]], rows[ends[part]] = mixed[k], begin + k
        ends[part] += 1


@njit(cache=True)
def enter(table: Any, hashes: Words, entries: Any, count: int) -> None:
    """Enter what no slot holds yet; slots are touched some ahead."""
    slots = np.uint64(len(table))
    touched = np.uint64(0)
    for begin in range(0, count, AHEAD):
        end = min(begin + AHEAD, count)
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
