"""Compiled loops that make the successor of a row: by its transition's writes, as its representative, compressed.

A successor is first made in plain words. With symmetry (`Exchanges`), its representative replaces it. With tree
compression (`FoldedTable`), its stored form is the compressed row. Each variant is compiled at its first use.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import Any

import numpy as np

from checker.engines.fast.compiled.jit_decorators import inner, njit
from checker.engines.fast.compiled.table import Words
from checker.engines.fast.model.decision_leaves import (
    ALIKE,
    COPIES,
    COPIES_END,
    PAIR,
    PARTS,
    PARTS_END,
    STEP,
    WRITES,
    WRITES_END,
)
from checker.engines.fast.model.learned_model import (
    FULL,
    NODE,
    PLACE,
    UNKNOWN,
    UNSORTED,
    Ints,
    LearnedModel,
    State,
    code_at,
    part_step,
)
from checker.engines.fast.store.canonicalise import represent
from checker.engines.fast.store.tree_compression import (
    MEMORY,
    NO_ROOM,
    FoldedTable,
    fold,
    intern,
    put_piece,
    seek_piece,
    take,
)

_ONE, _PIECE, _STEP, _MEMORY = map(np.uint64, (1, 32, 36, 65 - MEMORY.bit_length()))
_MULTIPLIER = np.uint64(0x9E3779B97F4A7C15)


@njit(cache=True, forceinline=True)
def conclude(words: Words, at: int, masks: Words, step: int, target: Words, to: int, width: int) -> None:
    """Write a row with a transition's writes to the target."""
    wide, source, goal = np.uint64(width), np.uint64(at), np.uint64(to)
    keep = wide * np.uint64(2 * step)
    put = keep + wide
    for j in range(wide):
        target[goal + j] = (words[source + j] & masks[keep + j]) | masks[put + j]


@njit(cache=True, forceinline=True)
def copy_columns(
    words: Words, at: int, columns: Words, copies: Ints, begin: int, end: int, target: Words, to: int
) -> None:
    """Apply a transition's copies from column to column."""
    for k in range(begin, end):
        code = np.uint64(code_at(words, at, columns, copies[PAIR * k + 1]))
        where = PLACE * copies[PAIR * k]
        word, shift, mask = to + np.int64(columns[where]), columns[where + 1], columns[where + 2]
        target[word] = (target[word] & ~(mask << shift)) | (code << shift)


@njit(cache=True, forceinline=True)
def write_part(columns: Words, writes: Ints, steps: Ints, step: int, target: Words, to: int) -> None:
    """Apply the writes of a part of a transition column by column: they are few compared with a row."""
    record = STEP * step
    for k in range(steps[record + WRITES], steps[record + WRITES_END]):
        where = PLACE * writes[PAIR * k]
        word, shift, mask = to + np.int64(columns[where]), columns[where + 1], columns[where + 2]
        target[word] = (target[word] & ~(mask << shift)) | (np.uint64(writes[PAIR * k + 1]) << shift)


@njit(cache=True, forceinline=True)
def write_piece(columns: Words, writes: Ints, steps: Ints, step: int, f: FoldedTable, piece: int) -> None:
    """Apply the writes of a transition, or of a part, to a piece in `sought`."""
    record = STEP * step
    for k in range(steps[record + WRITES], steps[record + WRITES_END]):
        where = PLACE * writes[PAIR * k]
        word, shift, mask = np.int64(columns[where]), columns[where + 1], columns[where + 2]
        if f.piece_of[word] == piece:
            word -= f.begins[piece]
            f.sought[word] = (f.sought[word] & ~(mask << shift)) | (np.uint64(writes[PAIR * k + 1]) << shift)


@inner(cache=True)
def change_piece(
    columns: Words, writes: Ints, steps: Ints, step: int, f: FoldedTable, piece: int, adding: bool
) -> int:
    """Return the number of a piece of the successor after the writes of a transition or part."""
    seek_piece(f, piece)
    write_piece(columns, writes, steps, step, f, piece)
    return np.int64(intern(f.pieces, f.sought, adding))


@njit(cache=True, forceinline=True)
def change_pieces(
    columns: Words,
    writes: Ints,
    steps: Ints,
    touches: Words,
    step: int,
    f: FoldedTable,
    touched: int,
    adding: bool,
) -> int:
    """Apply the writes of a transition or part to the successor, piece by piece; return the successor's own pieces.

    A cache keeps recent results by transition and piece.
    """
    left, piece = touches[step], np.int64(0)
    while left:
        if left & _ONE and f.below[piece] >= 0:
            key = (np.uint64(step) << _STEP) | (np.uint64(piece) << _PIECE) | np.uint64(f.below[piece] + 1)
            slot = (key * _MULTIPLIER) >> _MEMORY
            result = f.results[slot]
            if f.memory[slot] != key:
                result = change_piece(columns, writes, steps, step, f, piece, adding)
                if result >= 0:
                    f.memory[slot], f.results[slot] = key, result
            touched = put_piece(f, piece, result, touched)
        left >>= _ONE
        piece += 1
    return touched


@inner(cache=True)
def copy_pieces(
    columns: Words, copies: Ints, begin: int, end: int, f: FoldedTable, touched: int, adding: bool
) -> int:
    """Apply a transition's copies to the successor; return the successor's own pieces."""
    for k in range(begin, end):
        code = np.uint64(code_at(f.whole, 0, columns, copies[PAIR * k + 1]))
        where = PLACE * copies[PAIR * k]
        word, shift, mask = np.int64(columns[where]), columns[where + 1], columns[where + 2]
        piece = f.piece_of[word]
        if f.below[piece] >= 0:
            seek_piece(f, piece)
            word -= f.begins[piece]
            f.sought[word] = (f.sought[word] & ~(mask << shift)) | (code << shift)
            touched = put_piece(f, piece, intern(f.pieces, f.sought, adding), touched)
    return touched


@inner(cache=True)
def is_repeated(target: Words, taken: Ints, steps: Ints, began: int, end: int, step: int, width: int) -> bool:
    """Return whether a row has an earlier transition with the same label and successor."""
    for other in range(began, end):
        if steps[STEP * taken[other] + ALIKE] == steps[STEP * step + ALIKE]:
            same = True
            for k in range(width):
                same = same and target[other * width + k] == target[end * width + k]
            if same:
                return True
    return False


@njit(cache=True, forceinline=True)
def make_plain(
    m: LearnedModel,
    f: FoldedTable | None,
    source: Words,
    at: int,
    step: int,
    target: Words,
    to: int,
    width: int,
    state: State,
) -> int:
    """Write the words of a row's successor by a transition; return less than 0 if something is not learned yet."""
    record, own = STEP * step, np.int64(0)
    if f is None:
        conclude(source, at, m.masks, step, target, to, width)
    else:  # there are no masks
        for word in range(width):
            target[to + word] = source[at + word]
        write_part(m.columns, m.writes, m.steps, step, target, to)
    begin, stop = m.steps[record + COPIES], m.steps[record + COPIES_END]
    if begin < stop:
        copy_columns(source, at, m.columns, m.copies, begin, stop, target, to)
    for part in range(m.steps[record + PARTS], m.steps[record + PARTS_END]):
        own = part_step(m, source, at, part, state)
        if own < 0:
            break
        write_part(m.columns, m.writes, m.steps, own, target, to)
    return own


@njit(cache=True, forceinline=True)
def make_folded(
    m: LearnedModel, f: FoldedTable, step: int, adding: bool, kept: Words, to: int, state: State
) -> int:
    """Write the compressed successor of the unfolded row; return less than 0 if a part or piece is unknown."""
    record, own = STEP * step, np.int64(0)
    touched = change_pieces(m.columns, m.writes, m.steps, m.masks, step, f, np.int64(0), adding)
    begin, stop = m.steps[record + COPIES], m.steps[record + COPIES_END]
    if begin < stop:
        touched = copy_pieces(m.columns, m.copies, begin, stop, f, touched, adding)
    for part in range(m.steps[record + PARTS], m.steps[record + PARTS_END]):
        own = part_step(m, f.whole, 0, part, state)
        if own < 0:
            break
        touched = change_pieces(m.columns, m.writes, m.steps, m.masks, own, f, touched, adding)
    least = fold(f, touched, adding, kept, to)
    return least if own >= 0 else own


@inner(cache=True)
def put_stored(
    m: LearnedModel,
    x: Any,
    d: Any,
    f: FoldedTable | None,
    words: Words,
    at: int,
    width: int,
    adding: bool,
    kept: Words,
    to: int,
    state: State,
) -> int:
    """Write the stored form of a row: its representative with symmetry, compressed with tree compression.

    `x` and `d` are the symmetry tables and scratch space of `canonicalise`, or None. `f` has the tables of tree
    compression, with the row's origin unfolded, or is None. Unknown pieces and nodes are added if `adding`.

    Returns:
        At least 0, or a code: UNKNOWN for a representative that is not learned yet, UNMET for an unknown piece or node
        that was not added, NO_ROOM if there is no room for it.
    """
    source, begin, there = words, np.int64(at), np.int64(0)
    if x is not None:
        source, begin = d.image, np.int64(0)
        for word in range(width):
            source[word] = words[at + word]
        if not represent(x, d, source, 0, width, m.columns):
            state[NODE] = UNSORTED
            return np.int64(UNKNOWN)
    if f is not None:
        there = fold(f, take(f, source, begin, width, adding), adding, kept, to)
        if there == NO_ROOM:
            state[NODE] = FULL
    elif x is not None:
        for word in range(width):
            kept[to + word] = source[word]
    return there
