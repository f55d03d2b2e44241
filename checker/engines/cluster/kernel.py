"""The compiled loops of a worker: find new rows, assign rows to workers, and translate codes."""

# mypy: disable-error-code="return-value, no-any-return, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import Any, NamedTuple

import numpy as np

from checker.engines.fast.compiled.jit_decorators import inner, njit
from checker.engines.fast.compiled.prefetch import prefetch
from checker.engines.fast.compiled.table import AHEAD, Words, bits_for, entry_of, fetch, find, hashed
from checker.engines.fast.model.columns import WORD
from checker.engines.fast.model.learned_model import PLACE, SIZE, WORDS, State, SuccessorBatch
from checker.engines.fast.store.kernel import add_row
from checker.engines.fast.store.tree_compression import PAIR, FoldedTable, fold, take, unfold

_ONE, _TWO, _HALF, _TOP = np.uint64(1), np.uint64(2), np.uint64(32), np.uint64(58)
_PLACE, _WORD = np.uint64(PLACE), np.uint64(WORD)

_DE_BRUIJN = np.uint64(0x03F79D71B4CB0A89)
"""A de Bruijn number: its 64 windows of six bits all differ, so the top six bits of its multiple by 2**k identify k."""

_BITS = np.argsort(_DE_BRUIJN << np.arange(64, dtype=np.uint64) >> _TOP).astype(np.uint64)


class Owning(NamedTuple):
    """The data that assigns rows to workers.

    Attributes:
        columns: The word, shift and mask of each column.
        varying: The columns with several values.
        column_at: The column of each bit of a row.
        keys: The key of each value, column by column.
        begins: The first value of each column, and the end of the last.
        workers: The number of workers.
    """

    columns: Words
    varying: Words
    column_at: Words
    keys: Words
    begins: Words
    workers: int


@njit(cache=True, forceinline=True)
def _key_in(words: Words, at: np.uint64, own: Owning, column: np.uint64) -> np.uint64:
    """Return the key of a column's value in the row that begins at `at`."""
    where = _PLACE * column
    code = (words[at + own.columns[where]] >> own.columns[where + _ONE]) & own.columns[where + _TWO]
    return own.keys[own.begins[column] + code]


@inner(cache=True)
def key_of(words: Words, at: np.uint64, own: Owning) -> np.uint64:
    """Return the key of the row that begins at `at`."""
    key = np.uint64(0)
    for column in own.varying:
        key ^= _key_in(words, at, own, column)
    return key


@njit(cache=True, forceinline=True)
def _owner(
    words: Words, at: np.uint64, rows: Words, to: np.uint64, width: int, base: np.uint64, own: Owning
) -> int:
    """Return the worker of a row, computed from the key of a row that differs in few columns."""
    key = base
    for j in range(np.uint64(width)):
        differing = words[at + j] ^ rows[to + j]
        while differing != 0:
            lowest = differing & (~differing + _ONE)
            column = own.column_at[_WORD * j + _BITS[(lowest * _DE_BRUIJN) >> _TOP]]
            key ^= _key_in(words, at, own, column) ^ _key_in(rows, to, own, column)
            differing &= ~(own.columns[_PLACE * column + _TWO] << own.columns[_PLACE * column + _ONE])
    return np.int64(((key >> _HALF) * np.uint64(own.workers)) >> _HALF)


@njit(cache=True)
def owners_of(
    words: Words, f: FoldedTable | None, origins: State, rows: Words, width: int, own: Owning, owners: Any
) -> None:
    """Note the worker of each row; `origins` are the rows from which they were reached, compressed with `f`."""
    wide, last, base = np.uint64(width), np.int64(-1), np.uint64(0)
    for k in range(len(owners)):
        source, at = words, np.uint64(origins[k]) * wide
        if f is not None:
            unfold(f, words, origins[k])
            source, at = f.whole, np.uint64(0)
        if origins[k] != last:
            last, base = origins[k], key_of(source, at, own)
        owners[k] = _owner(source, at, rows, np.uint64(k) * wide, width, base, own)


@njit(cache=True, forceinline=True)
def find_plain(
    words: Words,
    table: Any,
    f: FoldedTable | None,
    batch: SuccessorBatch,
    k: int,
    width: int,
    bits: np.uint32,
) -> int:
    """Return what `find` returns for a plain successor; if rows are compressed with `f`, it is, too."""
    if f is None:
        return find(words, table, batch.kept, k, batch.hashes[k], width, bits)
    unfold(f, words, batch.origins[k])
    if fold(f, take(f, batch.kept, k * width, width, False), False, f.target, 0) < 0:
        return np.int64(-1)
    return find(words, table, f.target, 0, hashed(f.target, 0, PAIR), PAIR, bits)


@njit(cache=True)
def deal(
    words: Words,
    origins: Words,
    table: Any,
    f: FoldedTable | None,
    batch: SuccessorBatch,
    gathered: int,
    own: Owning,
    me: int,
    sent: Words,
    chosen: State,
    owners: Any,
    counts: State,
    state: State,
) -> int:
    """Distribute gathered successors: store the new ones of this worker as rows, and select those of others.

    `chosen` and `owners` get the selected successors, without recently sent ones, and their workers. The worker of a
    successor is computed last: most successors are known rows or were sent before. `sent` is a direct-mapped cache of
    sent rows, indexed by hash, with a flag before each row. It compares whole rows, so it may forget a row but never
    confuses two.

    If rows are compressed with `f`, this worker's new ones are selected, too, instead of stored.

    Returns:
        The number of selected successors.
    """
    rows, hashes, reached_from = batch.kept, batch.hashes, batch.origins
    width, bits = state[WORDS], np.uint32(bits_for(len(table)))
    wide, last_place = np.uint64(width), np.uint64(len(sent) // (width + 1) - 1)
    found, last, base = np.int64(0), np.int64(-1), np.uint64(0)
    for k in range(gathered):
        fetch(words, table, hashes, k, gathered, width, bits)
        if k + AHEAD < gathered:
            prefetch(sent, (hashes[k + AHEAD] & last_place) * (wide + _ONE))
        counts[batch.steps[k]] += 1
        where = find_plain(words, table, f, batch, k, width, bits)
        if where >= 0:
            continue
        to, lately = np.uint64(k) * wide, (hashes[k] & last_place) * (wide + _ONE)
        same = sent[lately] == _ONE
        for j in range(wide):
            same = same and sent[lately + _ONE + j] == rows[to + j]
        if same:
            continue
        source, at = words, np.uint64(reached_from[k]) * wide
        if f is not None:
            source, at = f.whole, np.uint64(0)
        if reached_from[k] != last:
            last, base = reached_from[k], key_of(source, at, own)
        owner = _owner(source, at, rows, to, width, base, own)
        if owner != me:
            sent[lately] = _ONE
            for j in range(wide):
                sent[lately + _ONE + j] = rows[to + j]
        if owner != me or f is not None:
            chosen[found], owners[found] = k, owner
            found += 1
        else:
            entry = entry_of(hashes[k], state[SIZE], bits)
            origin = np.uint64(reached_from[k] * own.workers + me)
            add_row(words, origins, table, -where - 1, entry, rows, k, origin, state)
    return found


class Spelling(NamedTuple):
    """The translation from another worker's codes and packing.

    Attributes:
        columns: The word, shift and mask of each of its columns.
        varying: Its columns with several values.
        codes: The own code for each of its codes, column by column.
        begins: The first code of each of its columns, and the end of the last.
        numbers: The own column for each of its columns.
    """

    columns: Words
    varying: Words
    codes: Words
    begins: Words
    numbers: Words


@njit(cache=True)
def translate(
    theirs: Words,
    first: int,
    count: int,
    their_width: int,
    read: Spelling,
    columns: Words,
    width: int,
    rows: Words,
    hashes: Words,
) -> None:
    """Translate another worker's rows into the own codes and packing, and hash them."""
    wide, their_wide = np.uint64(width), np.uint64(their_width)
    for k in range(np.uint64(count)):
        at, to = (np.uint64(first) + k) * their_wide, k * wide
        for j in range(wide):
            rows[to + j] = 0
        for column in read.varying:
            where = _PLACE * column
            code = (theirs[at + read.columns[where]] >> read.columns[where + _ONE]) & read.columns[
                where + _TWO
            ]
            mine = _PLACE * read.numbers[column]
            rows[to + columns[mine]] |= read.codes[read.begins[column] + code] << columns[mine + _ONE]
        hashes[k] = hashed(rows, np.int64(to), width)
