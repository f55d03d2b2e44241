"""The compiled loops: evaluate the decision trees on the frontier, and maintain the exact visited set.

Rows are packed words (see `columns.Packing`); a hash table finds them (see `table`). Successors are first gathered in a
batch, then looked up in order, while the memory for later ones is prefetched.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.decision_leaves import (
    ALIKE,
    COPIES,
    COPIES_END,
    CROWDED,
    END,
    FIRST,
    FLAGS,
    LEAF,
    PAIR,
    PARTS,
    PARTS_END,
    STEP,
    TURN,
    WRITES,
    WRITES_END,
)
from checker.engines.fast.decision_trees import BASE, COLUMN, LOW, MASK, RECORD, SHIFT, WIDTH, WORD
from checker.engines.fast.jit_decorators import inner, njit
from checker.engines.fast.origins import most_origins, note_origin
from checker.engines.fast.table import Words, bits_for, entry_of, fetch, find, hashed, most_in
from checker.engines.fast.tree_compression import (
    MEMORY,
    NO_ROOM,
    NOWHERE,
    UNMET,
    FoldedTable,
    fold,
    intern,
    leave_open,
    put_piece,
    put_sought,
    seek_piece,
    seek_piece_of_row,
    step_left_open,
    unfold,
)

Ints = NDArray[np.int32]
State = NDArray[np.int64]


class LearnedModel(NamedTuple):
    """The learned trees and leaves in the form that the loops read.

    Attributes:
        root, nodes, next: See `Trees`.
        leaves, steps, copies, writes, part: See `Leaves`.
        masks: For each transition and word, the bits that it keeps, then those that it sets. With tree compression, for
            each transition the set of pieces that it writes.
        columns: The word, shift and mask of each column.
        agents_from, agents, clauses: Trees. Those of agents are in groups, one for each value of the cell that names
            the agents.
    """

    root: Ints
    nodes: Words
    next: Ints
    leaves: Ints
    steps: Ints
    copies: Ints
    writes: Ints
    part: Ints
    masks: Words
    columns: Words
    agents_from: Ints
    agents: Ints
    clauses: Ints


class SuccessorBatch(NamedTuple):
    """Gathered successors that are not looked up yet.

    Attributes:
        words: Their words.
        kept: Their stored form: the words, or the compressed rows.
        hashes: The hashes of the stored form.
        origins, steps: The row and the transition that led to each.
        leaves: Scratch space for the leaves of one row.
        later: Deferred rows: the number of each, and the numbers of transitions and successors before it.
        lately: A small cache: the last successor for some bits of a hash.
    """

    words: Words
    kept: Words
    hashes: Words
    origins: State
    steps: Ints
    leaves: Ints
    later: State
    lately: Ints


STATE = 17
AT, SIZE, LIMIT, WORDS, KEPT, TURNS, ALPHA, GATHERED, TREE, NODE, CODE, CUT, CROWDS, EXPANDED = range(14)
SIFTED, PUT_OFF, SEEN = range(14, STATE)
"""The entries of the loops' state.

AT: the next row. SIZE, LIMIT: the number of rows, and its limit. WORDS, KEPT: the words of a row, and of its stored
form. TURNS: whether requests wait for their turn. ALPHA: the column of the agents, -1 if constant. GATHERED: the number
of gathered successors. TREE, NODE, CODE: the place where a tree ended. CUT: whether the limit left rows out. CROWDS:
the number of crowded rows. EXPANDED: the number of rows with all successors stored. SIFTED: the number of successors
that may be new. PUT_OFF: the number of deferred rows. SEEN: the number of rows that may be looked up.
"""

WIDE, UNSORTED, FULL = -2, -3, -4
"""Codes in NODE: the batch is too small for one row; a successor's representative is unknown; no room for a piece."""

PLACE, MOVE, LATER = 3, 5, 3
UNKNOWN = -3
"""The code for something not learned yet."""

_QUARTER = np.uint64(40)

_ONE, _PIECE, _STEP, _MEMORY = map(np.uint64, (1, 32, 36, 65 - MEMORY.bit_length()))
_MULTIPLIER = np.uint64(0x9E3779B97F4A7C15)

# Indices are unsigned in the inner loops: numba tests a signed index for a negative value.
_RECORD, _LOW, _WIDTH, _BASE, _WORD, _SHIFT, _MASK = map(
    np.uint64, (RECORD, LOW, WIDTH, BASE, WORD, SHIFT, MASK)
)


@njit(cache=True, forceinline=True)
def code_at(words: Words, at: int, columns: Words, column: int) -> int:
    """Return the code of a column in the row that begins at `at`."""
    where = PLACE * column
    return np.int64((words[at + np.int64(columns[where])] >> columns[where + 1]) & columns[where + 2])


@njit(cache=True, forceinline=True)
def walk(words: Words, at: int, start: int, nodes: Words, leads: Ints, state: State) -> int:
    """Return the reference to the leaf of a row in a tree, from some node on; 0 if the tree ends before."""
    begin = np.uint64(at)
    reference = np.int64(start)
    record, code = np.uint64(0), np.uint64(0)
    while reference > 0:
        record = _RECORD * np.uint64(reference - 1)
        code = (words[begin + nodes[record + _WORD]] >> nodes[record + _SHIFT]) & nodes[record + _MASK]
        inside = code - nodes[record + _LOW]
        reference = np.int64(0)
        if inside < nodes[record + _WIDTH]:
            reference = np.int64(leads[nodes[record + _BASE] + inside])
    if reference == 0:
        state[NODE] = -1 if start == 0 else np.int64(record // _RECORD)
        state[CODE] = np.int64(code)
    return reference


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


@njit(cache=True)
def first_turn(all_leaves: Ints, steps: Ints, leaves: Ints, actors: int) -> int:
    """Return the first enabled turn in the queue; -1 if there is none."""
    found = np.int64(-1)
    for k in range(actors):
        leaf = LEAF * leaves[k]
        for step in range(all_leaves[leaf + FIRST], all_leaves[leaf + END]):
            turn = np.int64(steps[STEP * step + TURN])
            if turn >= 0 and (found < 0 or turn < found):
                found = turn
    return found


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
def find_leaves(
    m: LearnedModel, source: Words, at: int, first: int, last: int, leaves: Ints, state: State
) -> int:
    """Note the leaf of each actor of a row, agents first; return the union of their flags, or UNKNOWN."""
    flags = np.int64(0)
    for k in range(last - first + len(m.clauses)):
        tree = m.agents[first + k] if first + k < last else m.clauses[first + k - last]
        reference = walk(source, at, m.root[tree], m.nodes, m.next, state)
        if reference == 0:
            state[TREE] = tree
            flags = np.int64(UNKNOWN)
            break
        leaves[k] = -reference - 1
        flags |= m.leaves[LEAF * (-reference - 1) + FLAGS]
    return flags


@njit(cache=True, forceinline=True)
def part_step(m: LearnedModel, source: Words, at: int, part: int, state: State) -> int:
    """Return the transition that holds the writes of a part; less than 0 if it is not learned yet."""
    tree = m.part[part]
    reference = walk(source, at, m.root[tree], m.nodes, m.next, state)
    if reference == 0:
        state[TREE] = tree
        return np.int64(UNKNOWN)
    return np.int64(m.leaves[LEAF * (-reference - 1) + FIRST])


@njit(cache=True, forceinline=True)
def make_plain(
    m: LearnedModel, source: Words, at: int, step: int, target: Words, to: int, width: int, state: State
) -> int:
    """Write the successor of a row by a transition; return less than 0 if something is not learned yet."""
    record, own = STEP * step, np.int64(0)
    conclude(source, at, m.masks, step, target, to, width)
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
def make_whole(m: LearnedModel, f: FoldedTable, step: int, kept: Words, to: int, state: State) -> int:
    """Write the compressed successor like `make_folded`, but look up only its final pieces.

    `make_folded` also looks up intermediate pieces, before parts write to them. Such a piece may occur in no row and
    vanish at a repacking, although the final pieces exist. Returns less than 0 as `make_folded` does.
    """
    record, touched = STEP * step, np.int64(0)
    for piece in range(len(f.below)):
        seek_piece_of_row(f, piece)
        write_piece(m.columns, m.writes, m.steps, step, f, piece)
        for k in range(m.steps[record + COPIES], m.steps[record + COPIES_END]):
            where = PLACE * m.copies[PAIR * k]
            word, shift, mask = np.int64(m.columns[where]), m.columns[where + 1], m.columns[where + 2]
            if f.piece_of[word] == piece:
                code = np.uint64(code_at(f.whole, 0, m.columns, m.copies[PAIR * k + 1]))
                word -= f.begins[piece]
                f.sought[word] = (f.sought[word] & ~(mask << shift)) | (code << shift)
        for part in range(m.steps[record + PARTS], m.steps[record + PARTS_END]):
            own = part_step(m, f.whole, 0, part, state)
            if own < 0:
                return own  # at the first piece, before any is set
            write_piece(m.columns, m.writes, m.steps, own, f, piece)
        touched = put_sought(f, piece, touched)
    return fold(f, touched, False, kept, to)


@njit(cache=True, nogil=True)
def gather(
    m: LearnedModel, words: Words, f: FoldedTable | None, batch: SuccessorBatch, state: State, until: int
) -> bool:
    """Gather the successors of rows until row `until` or until half of the batch is full; False at something unknown.

    The successors of a row are distinct: first those of served requests, then the agents' own steps, then the
    environment's. A row that is crowded or not fully learned is deferred if `later` has room.

    With tree compression (`f`, compiled separately), successors are compressed at once. A successor with an unknown
    piece or node is completed by `store`. So pieces are numbered in the order of successors, whichever thread gathers
    them. A successor that must be compared with others can't wait; its row is deferred where possible.
    """
    made, hashes, origins, taken, leaves, later = (
        batch.kept, batch.hashes, batch.origins, batch.steps, batch.leaves, batch.later,
    )  # fmt: skip
    width, kept, known = state[WORDS], state[KEPT], True
    is_full = state[SIZE] >= state[LIMIT]  # then a successor with an unknown piece is no row
    while known and state[AT] < until and state[GATHERED] <= len(hashes) // 2:
        row = state[AT]
        source, at = words, row * width
        if f is not None:
            unfold(f, words, row)
            source, at = f.whole, np.int64(0)
        first, last = np.int64(0), np.int64(len(m.agents))
        if state[ALPHA] >= 0:
            group = code_at(source, at, m.columns, state[ALPHA])
            first, last = np.int64(m.agents_from[group]), np.int64(m.agents_from[group + 1])
        flags = find_leaves(m, source, at, first, last, leaves, state)
        began, end = state[GATHERED], state[GATHERED]
        known = flags >= 0
        if known and flags & CROWDED:
            if len(later):
                known = False  # counted at its final expansion
            else:
                state[CROWDS] += 1
        elif known:
            turn = first_turn(m.leaves, m.steps, leaves, last - first) if state[TURNS] else np.int64(-1)
            for k in range(last - first + len(m.clauses)):
                for step in range(m.leaves[LEAF * leaves[k] + FIRST], m.leaves[LEAF * leaves[k] + END]):
                    record = STEP * step
                    if m.steps[record + TURN] >= 0 and m.steps[record + TURN] != turn:
                        continue
                    if end == len(hashes):
                        state[NODE] = WIDE
                        known = False
                        break
                    is_compared = m.steps[record + ALIKE] >= 0
                    if f is None:
                        there = make_plain(m, source, at, step, made, end * width, width, state)
                    else:
                        there = make_folded(
                            m, f, step, is_compared and not len(later), made, kept * end, state
                        )
                        if there == UNMET and not is_compared:
                            if not is_full:
                                leave_open(made, kept * end, row, step)
                            there = np.int64(0)
                        elif there == NO_ROOM:
                            state[NODE] = FULL
                    known = there >= 0
                    if not known:
                        break
                    if is_compared and is_repeated(made, taken, m.steps, began, end, step, kept):
                        continue
                    hashes[end] = hashed(made, kept * end, kept)
                    origins[end], taken[end] = row, step
                    end += 1
                if not known:
                    break
        if known:
            state[GATHERED] = end
            state[AT] += 1
        elif LATER * state[PUT_OFF] < len(later):
            at = LATER * state[PUT_OFF]
            later[at], later[at + 1], later[at + 2] = row, state[GATHERED], state[GATHERED]
            state[PUT_OFF] += 1
            state[AT] += 1
            known = True
    return known


@njit(cache=True, forceinline=True)
def room_for(words: Words, origins: Any, table: Any, width: int) -> int:
    """Return the number of rows for which all arrays have room."""
    return min(len(words) // width, most_origins(origins), most_in(len(table)))


@njit(cache=True, forceinline=True)
def add_row(
    words: Words,
    origins: Any,
    table: Any,
    slot: int,
    entry: Any,
    target: Words,
    k: int,
    origin: Any,
    state: State,
) -> None:
    """Store a successor as a new row, for which there must be room; beyond the limit, note that it was left out."""
    size, width = state[SIZE], state[KEPT]
    if size >= state[LIMIT]:
        state[CUT] = 1
    else:
        for j in range(width):
            words[size * width + j] = target[k * width + j]
        note_origin(origins, size, origin)
        table[slot] = entry
        state[SIZE] = size + 1


@njit(cache=True, nogil=True)
def store(
    words: Words,
    origins: Any,
    table: Any,
    m: LearnedModel | None,
    f: FoldedTable | None,
    batch: SuccessorBatch,
    begin: int,
    end: int,
    state: State,
) -> int:
    """Look up a range of gathered successors; store the new ones as rows, with their origins.

    Other threads may look up older rows meanwhile. With tree compression (`f`, and the model `m`),
    incomplete successors are made first; that variant is compiled separately.

    Returns:
        The first successor for which there is no room, else `end`.
    """
    target, hashes, reached_from = batch.kept, batch.hashes, batch.origins
    width, limit = state[KEPT], state[LIMIT]
    bits = np.uint32(bits_for(len(table)))
    room = room_for(words, origins, table, width)
    for k in range(begin, end):
        if f is not None:
            step = step_left_open(target, width * k)
            if step >= 0:
                unfold(f, words, reached_from[k])
                if make_folded(m, f, step, state[SIZE] < limit, target, width * k, state) == NO_ROOM:
                    leave_open(target, width * k, reached_from[k], step)
                    end = k
                    break
                hashes[k] = hashed(target, width * k, width)
        fetch(words, table, hashes, k, end, width, bits)
        found = find(words, table, target, k, hashes[k], width, bits)
        if found >= 0:
            continue
        if room <= state[SIZE] < limit:
            end = k
            break
        entry = entry_of(hashes[k], state[SIZE], bits)
        add_row(words, origins, table, -found - 1, entry, target, k, reached_from[k], state)
    return end


@njit(cache=True, nogil=True)
def count(steps: Ints, begin: int, end: int, counts: State) -> None:
    """Count followed transitions."""
    for k in range(begin, end):
        counts[steps[k]] += 1


@njit(cache=True, forceinline=True)
def keep(batch: SuccessorBatch, k: int, left: int, width: int) -> None:
    """Move a successor behind those that remain."""
    for j in range(width):
        batch.kept[left * width + j] = batch.kept[k * width + j]
    batch.hashes[left], batch.origins[left] = batch.hashes[k], batch.origins[k]


@njit(cache=True, forceinline=True)
def note_later(later: State, put_off: int, k: int, left: int) -> int:
    """Update the number of successors before each deferred row up to a successor; return the number of rows updated."""
    while LATER * put_off < len(later) and later[LATER * put_off + 2] <= k:
        later[LATER * put_off + 2] = left
        put_off += 1
    return put_off


@njit(cache=True, nogil=True)
def drop_repeated(batch: SuccessorBatch, state: State) -> None:
    """Drop successors that a small cache of recent ones holds: most duplicates within a batch."""
    target, hashes, lately = batch.kept, batch.hashes, batch.lately
    later = batch.later[: LATER * state[PUT_OFF]]
    width, gathered = state[KEPT], state[GATHERED]
    last_place = np.uint64(len(lately) - 1)
    lately[:] = 0
    left, noted = np.int64(0), np.int64(0)
    for k in range(gathered):
        noted = note_later(later, noted, k, left)
        place = (hashes[k] >> _QUARTER) & last_place
        before = np.int64(lately[place]) - 1
        same = before >= 0
        if same:
            for j in range(width):
                same = same and target[before * width + j] == target[k * width + j]
        if not same:
            keep(batch, k, left, width)
            left += 1
            lately[place] = left
    note_later(later, noted, gathered, left)
    state[SIFTED] = left


@njit(cache=True, nogil=True)
def sift(words: Words, table: Any, batch: SuccessorBatch, state: State) -> None:
    """Drop successors that are rows below number `SEEN`.

    Other threads may store rows from that number on. Such a row never counts as found: its words may not be visible
    here yet.
    """
    target, hashes, later = batch.kept, batch.hashes, batch.later[: LATER * state[PUT_OFF]]
    width, seen, several = state[KEPT], state[SEEN], state[SIFTED]
    bits = np.uint32(bits_for(len(table)))
    left, noted = np.int64(0), np.int64(0)
    for k in range(several):
        noted = note_later(later, noted, k, left)
        fetch(words, table, hashes, k, several, width, bits)
        found = find(words, table, target, k, hashes[k], width, bits)
        if found < 0 or found >= seen:
            keep(batch, k, left, width)
            left += 1
    note_later(later, noted, several, left)
    state[SIFTED] = left


@njit(cache=True)
def classify(
    m: LearnedModel, words: Words, f: FoldedTable | None, rows: State, tree: int, found: Ints, state: State
) -> int:
    """Note the leaf of each row in a tree; return the number of rows classified before the first unknown one."""
    root, nodes, leads = m.root, m.nodes, m.next
    done = np.int64(0)
    for k in range(len(rows)):
        source, at = words, rows[k] * state[WORDS]
        if f is not None:
            unfold(f, words, rows[k])
            source, at = f.whole, np.int64(0)
        reference = walk(source, at, root[tree], nodes, leads, state)
        if reference == 0:
            state[TREE] = tree
            break
        found[k] = -reference - 1
        done += 1
    return done


@njit(cache=True)
def look_up(
    words: Words,
    table: Any,
    m: LearnedModel | None,
    f: FoldedTable | None,
    batch: SuccessorBatch,
    targets: Any,
    state: State,
) -> None:
    """Note the row number of each successor in the batch; with tree compression (`f`, and the model), add no piece."""
    target, hashes = batch.kept, batch.hashes
    width = state[KEPT]
    bits = np.uint32(bits_for(len(table)))
    if f is not None:
        for k in range(len(targets)):
            if target[width * k] == NOWHERE:
                unfold(f, words, batch.origins[k])
                make_whole(m, f, batch.steps[k], target, width * k, state)
                hashes[k] = hashed(target, width * k, width)
    for k in range(len(targets)):
        fetch(words, table, hashes, k, len(targets), width, bits)
        targets[k] = find(words, table, target, k, hashes[k], width, bits)


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
