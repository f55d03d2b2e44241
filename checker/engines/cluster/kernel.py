"""The compiled loops of a worker: the owner of each successor, the new rows, and translation of codes."""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (what numba compiles is typed by numba: mypy takes its integers for Python's)

from typing import Any

import numpy as np
from numba import njit

from checker.engines.fast.kernel import (
    BLOCK,
    CUT,
    LIMIT,
    PLACE,
    SIZE,
    TOUCHED,
    WORDS,
    State,
    code_at,
)
from checker.engines.fast.table import Words, bits_for, entry_of, find, hashed, touch

_ONE, _HALF, _TOP = np.uint64(1), np.uint64(32), np.uint64(58)

_DE_BRUIJN = np.uint64(0x03F79D71B4CB0A89)
"""A number whose 64 windows of six bits all differ: times a power of two, its top six bits tell which power."""

_BITS = np.argsort(_DE_BRUIJN << np.arange(64, dtype=np.uint64) >> _TOP).astype(np.uint64)


@njit(cache=True, inline="always")
def key_of(words: Words, at: int, columns: Words, keys: Words, begins: State) -> np.uint64:
    """Return the key of the row that begins there."""
    key = np.uint64(0)
    for column in range(len(begins) - 1):
        if columns[PLACE * column + 2] != 0:
            key ^= keys[begins[column] + code_at(words, at, columns, column)]
    return key


@njit(cache=True)
def owners_of(
    words: Words,
    origins: State,
    rows: Words,
    width: int,
    columns: Words,
    column_at: State,
    keys: Words,
    begins: State,
    workers: int,
    owners: Any,
) -> None:
    """Note the worker that each row belongs to.

    A row differs in a few columns from the one that it was reached from, whose key is worked out once for all that
    were: `column_at` has the column of each bit of a row.
    """
    last, base = np.int64(-1), np.uint64(0)
    for k in range(len(owners)):
        at, to = origins[k] * width, k * width
        if origins[k] != last:
            last, base = origins[k], key_of(words, origins[k] * width, columns, keys, begins)
        key = base
        for j in range(width):
            differing = words[at + j] ^ rows[to + j]
            while differing != 0:
                lowest = differing & (~differing + _ONE)
                column = column_at[64 * j + np.int64(_BITS[(lowest * _DE_BRUIJN) >> _TOP])]
                key ^= keys[begins[column] + code_at(words, at, columns, column)]
                key ^= keys[begins[column] + code_at(rows, to, columns, column)]
                differing &= ~(columns[PLACE * column + 2] << columns[PLACE * column + 1])
        owners[k] = np.int64(((key >> _HALF) * np.uint64(workers)) >> _HALF)


@njit(cache=True)
def settle(
    words: Words,
    origins: Words,
    table: Any,
    rows: Words,
    hashes: Words,
    reached_from: Any,
    owners: Any,
    count: int,
    me: int,
    state: State,
) -> None:
    """Look up the rows that belong to this worker: what is new becomes one of its rows."""
    width, size, limit = state[WORDS], state[SIZE], state[LIMIT]
    bits = np.uint32(bits_for(len(table)))
    for begin in range(0, count, BLOCK):
        end = min(begin + BLOCK, count)
        state[TOUCHED] = touch(words, table, hashes, begin, end, width)
        for k in range(begin, end):
            if owners[k] != me:
                continue
            found = find(words, table, rows, k, hashes[k], width, bits)
            if found >= 0:
                continue
            if size >= limit:
                state[CUT] += 1
                continue
            for j in range(width):
                words[size * width + j] = rows[k * width + j]
            origins[size] = np.uint64(reached_from[k])
            table[-found - 1] = entry_of(hashes[k], size, bits)
            size += 1
    state[SIZE] = size


@njit(cache=True)
def unsent(
    rows: Words, hashes: Words, owners: Any, count: int, me: int, width: int, sent: Words, chosen: Any
) -> int:
    """Note which rows of other workers were not sent to them lately; return how many.

    `sent` holds one row, and before it a 1, for each hash modulo its size: comparing whole rows, it may forget, but
    never errs.
    """
    places = np.uint64(len(sent) // (width + 1))
    found = np.int64(0)
    for k in range(count):
        if owners[k] == me:
            continue
        at = np.int64(hashes[k] % places) * (width + 1)
        same = sent[at] == 1
        for j in range(width):
            same = same and sent[at + 1 + j] == rows[k * width + j]
        if not same:
            sent[at] = 1
            for j in range(width):
                sent[at + 1 + j] = rows[k * width + j]
            chosen[found] = k
            found += 1
    return found


@njit(cache=True)
def translate(
    theirs: Words,
    first: int,
    count: int,
    their_width: int,
    their_columns: Words,
    codes: State,
    begins: State,
    numbers: State,
    columns: Words,
    width: int,
    rows: Words,
    hashes: Words,
) -> None:
    """Put rows of another worker's codes and packing into one's own, and hash them.

    Their column c with code k has the code `codes[begins[c] + k]` in one's own column `numbers[c]`.
    """
    for k in range(count):
        at, to = (first + k) * their_width, k * width
        for j in range(width):
            rows[to + j] = 0
        for column in range(len(numbers)):
            where = PLACE * column
            mask = their_columns[where + 2]
            if mask != 0:
                word = theirs[at + np.int64(their_columns[where])]
                code = codes[begins[column] + np.int64((word >> their_columns[where + 1]) & mask)]
                mine = PLACE * numbers[column]
                rows[to + np.int64(columns[mine])] |= np.uint64(code) << columns[mine + 1]
        hashes[k] = hashed(rows, to, width)
