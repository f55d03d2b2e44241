"""Bit operations on words, for the compiled loops."""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

import numpy as np

from checker.engines.fast.compiled.jit_decorators import njit
from checker.engines.fast.compiled.table import Words

WORD = 64
"""Bits of a word."""

_ONE = np.uint64(1)
_PAIRS, _FOURS, _BYTES, _SUM = (
    np.uint64(each)
    for each in (0x5555555555555555, 0x3333333333333333, 0x0F0F0F0F0F0F0F0F, 0x0101010101010101)
)


@njit(cache=True, forceinline=True)
def ones_in(word: np.uint64) -> int:
    """Return the number of set bits in a word."""
    word -= (word >> _ONE) & _PAIRS
    word = (word & _FOURS) + ((word >> np.uint64(2)) & _FOURS)
    word = (word + (word >> np.uint64(4))) & _BYTES
    return np.int64((word * _SUM) >> np.uint64(56))


@njit(cache=True, forceinline=True)
def lowest(word: np.uint64) -> int:
    """Return the position of the lowest set bit of a word."""
    return ones_in((word & (~word + _ONE)) - _ONE)


@njit(cache=True, forceinline=True)
def has(words: Words, begin: int, bit: int) -> bool:
    """Return whether a bit is set in the bit set that begins at `begin`."""
    return bool((words[begin + (bit >> 6)] >> np.uint64(bit & 63)) & _ONE)


@njit(cache=True, forceinline=True)
def add(words: Words, begin: int, bit: int) -> None:
    """Set a bit in the bit set that begins at `begin`."""
    words[begin + (bit >> 6)] |= _ONE << np.uint64(bit & 63)


@njit(cache=True, forceinline=True)
def remove(words: Words, begin: int, bit: int) -> None:
    """Clear a bit in the bit set that begins at `begin`."""
    words[begin + (bit >> 6)] &= ~(_ONE << np.uint64(bit & 63))
