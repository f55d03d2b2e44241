"""Hash compaction: the visited set holds a tag of each row's hash, and compares only tags.

So rows are never read at random, and may lie in files; but two rows with one tag are taken for the same, and what only
the second leads to is missed. How likely that is follows from how many tags were compared (Stern and Dill 1996).
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (what numba compiles is typed by numba: mypy takes its integers for Python's)

from math import expm1
from typing import Any

import numpy as np

from checker.engines.fast.loops import njit
from checker.engines.fast.table import Words, slot_of

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


@njit(cache=True, inline="always")
def find_tag(table: Any, mixed: np.uint64, bits: int) -> int:
    """Return a slot that has the tag of a hash, as `table.find` returns a row; -slot - 1 where the tag belongs."""
    tag, slots = table.dtype.type(tag_of(mixed, bits)), np.uint64(len(table))
    slot = slot_of(mixed, len(table))
    while table[slot] != 0 and table[slot] != tag:
        slot += _ONE
        if slot == slots:
            slot = np.uint64(0)
    return np.int64(slot) if table[slot] != 0 else -np.int64(slot) - 1


@njit(cache=True, inline="always")
def places_behind(table: Any, mixed: np.uint64, slot: int) -> int:
    """Return how many tags a hash was compared with before a slot."""
    far = slot - np.int64(slot_of(mixed, len(table)))
    return far if far >= 0 else far + len(table)


@njit(cache=True)
def write_tags(hashes: Words, rows: Any, entries: Any, bits: int) -> None:  # noqa: ARG001  # as `table.write_numbers`
    """Write what a table holds of rows: their tags."""
    for k in range(len(hashes)):
        entries[k] = tag_of(hashes[k], bits)
