"""Compiled loops over whole tables: after a repacking, or after new transitions."""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import Any

import numpy as np

from checker.engines.fast.compiled.jit_decorators import njit
from checker.engines.fast.compiled.table import Words
from checker.engines.fast.model.decision_leaves import PAIR, STEP, WRITES, WRITES_END
from checker.engines.fast.model.decision_trees import COLUMN, MASK, RECORD, SHIFT, WORD
from checker.engines.fast.model.learned_model import MOVE, PLACE, Ints, State

_ONE = np.uint64(1)


@njit(cache=True, _nrt=True)
def repack(words: Words, size: int, moves: Words, old_width: int, new_width: int) -> None:
    """Repack rows in place, from the last to the first; a row of the new packing is at least as long.

    `moves` come from `columns.shifts`.
    """
    packed = np.zeros(new_width, np.uint64)
    for row in range(size - 1, -1, -1):
        packed[:] = 0
        for k in range(0, len(moves), MOVE):
            bits = words[row * old_width + np.int64(moves[k])] & moves[k + 2]
            packed[np.int64(moves[k + 1])] |= (bits << moves[k + 3]) >> moves[k + 4]
        for k in range(new_width):
            words[row * new_width + k] = packed[k]


@njit(cache=True)
def locate(nodes: Words, columns: Words, first: int) -> None:
    """Write the position of its column into each inner node, from node `first` on."""
    for record in range(RECORD * first, len(nodes), RECORD):
        where = PLACE * np.int64(nodes[record + COLUMN])
        nodes[record + WORD] = columns[where]
        nodes[record + SHIFT] = columns[where + 1]
        nodes[record + MASK] = columns[where + 2]


@njit(cache=True)
def make_masks(masks: Words, steps: Ints, writes: Ints, columns: Words, width: int, first: int) -> None:
    """Compute the bits of each word that a transition keeps and sets, from transition `first` on."""
    for step in range(first, len(masks) // (2 * width)):
        at = 2 * width * step
        for k in range(width):
            masks[at + k] = ~np.uint64(0)
            masks[at + width + k] = np.uint64(0)
        for k in range(steps[STEP * step + WRITES], steps[STEP * step + WRITES_END]):
            where = PLACE * writes[PAIR * k]
            word, shift, mask = np.int64(columns[where]), columns[where + 1], columns[where + 2]
            masks[at + word] &= ~(mask << shift)
            masks[at + width + word] &= ~(mask << shift)
            masks[at + width + word] |= np.uint64(writes[PAIR * k + 1]) << shift


@njit(cache=True)
def note_pieces(
    touches: Words, steps: Ints, writes: Ints, columns: Words, piece_of: State, first: int
) -> None:
    """Compute the set of pieces that each transition writes, as bits, from transition `first` on."""
    for step in range(first, len(touches)):
        touches[step] = 0
        for k in range(steps[STEP * step + WRITES], steps[STEP * step + WRITES_END]):
            touches[step] |= _ONE << np.uint64(piece_of[np.int64(columns[PLACE * writes[PAIR * k]])])


@njit(cache=True)
def mark_used(words: Words, width: int, columns: Words, begins: State, used: Any) -> bool:
    """Mark the values that occur in rows, column by column; return False if a code exceeds its column's values."""
    for row in range(len(words) // width):
        for column in range(len(begins) - 1):
            mask = columns[PLACE * column + 2]
            code = np.int64(0)
            if mask != 0:
                word = words[row * width + np.int64(columns[PLACE * column])]
                code = np.int64((word >> columns[PLACE * column + 1]) & mask)
            if code < 0 or code >= begins[column + 1] - begins[column]:
                return False
            used[begins[column] + code] = True
    return True
