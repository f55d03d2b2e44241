"""Hash compaction: the visited set holds a tag of each row's hash, and compares only tags.

So rows are never read at random, and may lie in files; but two rows with one tag are taken for the same, and what only
the second leads to is missed. How likely that is follows from how many tags were compared (Stern and Dill 1996).
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (what numba compiles is typed by numba: mypy takes its integers for Python's)

from math import expm1
from typing import Any

import numpy as np

from checker.engines.fast.kernel import (
    CUT,
    KEPT,
    LIMIT,
    PROBED,
    SIZE,
    Batch,
    State,
    room_for,
)
from checker.engines.fast.loops import njit
from checker.engines.fast.prefetch import prefetch
from checker.engines.fast.table import AHEAD, Words, slot_of

_ONE, _WORD, _FOLD, _MULTIPLIER = map(np.uint64, (1, 64, 29, 0xBF58476D1CE4E5B9))


def omission(probed: int, size: int, bits: int) -> float:
    """Return a bound of the probability that a row was taken for another, if hashes are as good as random.

    A row is missed if a tag that it is compared with is its own by chance, or its whole hash of 64 bits another's.

    Args:
        probed: How many tags were compared with those of rows that were new.
        size: How many rows there are.
        bits: Of a tag.

    >>> f"{omission(25_000_000, 10_000_000, 32):.4f}"
    '0.0058'
    """
    return -expm1(-(probed / 2**bits + size**2 / 2**65))


@njit(cache=True, inline="always")
def tag_of(mixed: np.uint64, bits: int) -> np.uint64:
    """Return the tag of a hash, which does not depend on its place in the table; 0 stands for none."""
    tag = ((mixed ^ (mixed >> _FOLD)) * _MULTIPLIER) >> (_WORD - np.uint64(bits))
    return max(tag, _ONE)


@njit(cache=True, nogil=True)
def store_tags(
    words: Words,
    origins: Any,
    table: Any,
    batch: Batch,
    begin: int,
    end: int,
    state: State,
    bits: int,
) -> int:
    """Look up some of what was gathered, as `kernel.store` does, by tags alone."""
    width, size, limit = state[KEPT], state[SIZE], state[LIMIT]
    slots = np.uint64(len(table))
    room = room_for(words, origins, table, width)
    for k in range(begin, end):
        if k + AHEAD < end:
            prefetch(table, slot_of(batch.hashes[k + AHEAD], len(table)))
        tag = table.dtype.type(tag_of(batch.hashes[k], bits))
        slot = slot_of(batch.hashes[k], len(table))
        probed = np.int64(0)
        while table[slot] != 0 and table[slot] != tag:
            probed += 1
            slot += _ONE
            if slot == slots:
                slot = np.uint64(0)
        if table[slot] != 0:
            continue
        if size >= limit:
            state[CUT] = 1
            continue
        if size >= room:
            end = k
            break
        for j in range(width):
            words[size * width + j] = batch.kept[k * width + j]
        origins[size] = batch.origins[k]
        table[slot] = tag
        size += 1
        state[PROBED] += probed
    state[SIZE] = size
    return end


@njit(cache=True)
def write_tags(hashes: Words, rows: Any, entries: Any, bits: int) -> None:  # noqa: ARG001  # as `table.write_numbers`
    """Write what a table holds of rows: their tags."""
    for k in range(len(hashes)):
        entries[k] = tag_of(hashes[k], bits)
