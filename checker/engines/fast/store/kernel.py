"""The compiled loops: evaluate the decision trees on the frontier, and maintain the exact visited set.

Rows are packed words (see `columns.Packing`); a hash table finds them (see `table`). Successors are first gathered in a
batch, then looked up in order, while the memory for later ones is prefetched.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import Any

import numpy as np

from checker.engines.fast.compiled.jit_decorators import inner, njit
from checker.engines.fast.compiled.table import Words, bits_for, entry_of, fetch, find, hashed, most_in
from checker.engines.fast.model.decision_leaves import ALIKE, STEP
from checker.engines.fast.model.learned_model import (
    AT,
    CROWDED,
    CROWDS,
    CUT,
    FULL,
    GATHERED,
    KEPT,
    LATER,
    LIMIT,
    NODE,
    PUT_OFF,
    SEEN,
    SIFTED,
    SIZE,
    TREE,
    UNKNOWN,
    WORDS,
    Ints,
    LearnedModel,
    State,
    SuccessorBatch,
    list_steps,
    walk,
)
from checker.engines.fast.store.make_successors import is_repeated, make_folded, make_plain, put_stored
from checker.engines.fast.store.origins import most_origins, note_origin
from checker.engines.fast.store.tree_compression import (
    NO_ROOM,
    NOWHERE,
    UNMET,
    FoldedTable,
    leave_open,
    step_left_open,
    unfold,
)

_QUARTER = np.uint64(40)


@njit(cache=True, forceinline=True)
def make_successor(
    m: LearnedModel,
    x: Any,
    d: Any,
    f: FoldedTable | None,
    source: Words,
    at: int,
    row: int,
    step: int,
    batch: SuccessorBatch,
    end: int,
    state: State,
) -> int:
    """Write the stored form of a row's successor to the batch; return less than 0 if something is not learned yet.

    A compressed successor with an unknown piece or node is left open, for `store` to complete. One that must be
    compared with others can't be: its pieces are added, unless its row can be deferred. Beyond the limit of rows, a
    successor with an unknown piece is no row.
    """
    made, width, kept = batch.kept, state[WORDS], state[KEPT]
    is_compared = m.steps[STEP * step + ALIKE] >= 0
    adding = x is None and is_compared and not len(batch.later)
    if x is not None:
        there = make_plain(m, f, source, at, step, batch.words, end * width, width, state)
        if there >= 0:
            there = put_stored(m, x, d, f, batch.words, end * width, width, adding, made, kept * end, state)
    elif f is None:
        there = make_plain(m, f, source, at, step, made, end * width, width, state)
    else:
        there = make_folded(m, f, step, adding, made, kept * end, state)
        if there == NO_ROOM:
            state[NODE] = FULL
    if there == UNMET and (x is not None or not is_compared):
        if state[SIZE] < state[LIMIT]:
            leave_open(made, kept * end, row, step)
        there = np.int64(0)
    return there


@njit(cache=True, forceinline=True)
def is_found_again(
    m: LearnedModel, x: Any, batch: SuccessorBatch, began: int, end: int, step: int, state: State
) -> bool:
    """Return whether the row has an earlier transition with the same label and successor."""
    if m.steps[STEP * step + ALIKE] < 0:
        return False
    if x is None:
        return is_repeated(batch.kept, batch.steps, m.steps, began, end, step, state[KEPT])
    return is_repeated(batch.words, batch.steps, m.steps, began, end, step, state[WORDS])


@njit(cache=True, forceinline=True)
def put_off(later: State, row: int, found: int, state: State) -> bool:
    """Defer a row, if there is room; `found` successors were found before it."""
    at = LATER * state[PUT_OFF]
    if at >= len(later):
        return False
    later[at], later[at + 1], later[at + 2] = row, state[GATHERED], found
    state[PUT_OFF] += 1
    return True


@njit(cache=True, nogil=True)
def gather(
    m: LearnedModel,
    x: Any,
    d: Any,
    words: Words,
    f: FoldedTable | None,
    batch: SuccessorBatch,
    state: State,
    until: int,
) -> bool:
    """Gather the successors of rows until row `until` or until half of the batch is full; False at something unknown.

    The successors of a row are distinct: first those of served requests, then the agents' own steps, then the
    environment's. A row that is crowded or not fully learned is deferred if `later` has room.

    With symmetry (`x` and scratch space `d`), representatives replace successors. With tree compression (`f`),
    successors are compressed at once. Each variant is compiled separately. Pieces are numbered in the order of
    successors, whichever thread gathers them.
    """
    hashes, taken, kept, known = batch.hashes, batch.steps, state[KEPT], True
    while known and state[AT] < until and state[GATHERED] <= len(hashes) // 2:
        row = state[AT]
        source, at = words, row * state[WORDS]
        if f is not None:
            unfold(f, words, row)
            source, at = f.whole, np.int64(0)
        began, end = state[GATHERED], state[GATHERED]
        count = list_steps(m, source, at, batch, began, state)
        if count == CROWDED:
            if len(batch.later):
                count = np.int64(UNKNOWN)  # counted at its final expansion
            else:
                state[CROWDS] += 1
        known = count != UNKNOWN
        for k in range(began, began + count if known else began):
            step = np.int64(taken[k])
            known = make_successor(m, x, d, f, source, at, row, step, batch, end, state) >= 0
            if not known:
                break
            taken[end] = step
            if not is_found_again(m, x, batch, began, end, step, state):
                hashes[end] = hashed(batch.kept, kept * end, kept)
                batch.origins[end] = row
                end += 1
        if known:
            state[GATHERED] = end
        else:
            known = put_off(batch.later, row, state[GATHERED], state)
        state[AT] += known
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


@inner(cache=True)
def complete(
    m: LearnedModel,
    x: Any,
    d: Any,
    f: FoldedTable,
    step: int,
    adding: bool,
    kept: Words,
    to: int,
    state: State,
) -> int:
    """Write the stored form of a successor of the unfolded row; everything but pieces and nodes is learned."""
    if x is None and adding:
        return make_folded(m, f, step, adding, kept, to, state)
    width = state[WORDS]
    make_plain(m, f, f.whole, 0, step, f.target, 0, width, state)
    return put_stored(m, x, d, f, f.target, 0, width, adding, kept, to, state)


@njit(cache=True, nogil=True)
def store(
    words: Words,
    origins: Any,
    table: Any,
    m: LearnedModel | None,
    x: Any,
    d: Any,
    f: FoldedTable | None,
    batch: SuccessorBatch,
    begin: int,
    end: int,
    state: State,
) -> int:
    """Look up a range of gathered successors; store the new ones as rows, with their origins.

    Other threads may look up older rows meanwhile. With tree compression (`f`, with the model `m`, and symmetry's `x`
    and `d`), incomplete successors are made first; that variant is compiled separately.

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
                if complete(m, x, d, f, step, state[SIZE] < limit, target, width * k, state) == NO_ROOM:
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
    x: Any,
    d: Any,
    f: FoldedTable | None,
    batch: SuccessorBatch,
    targets: Any,
    state: State,
) -> None:
    """Note the row number of each successor in the batch; with tree compression (`f`, as for `store`), add no piece."""
    target, hashes = batch.kept, batch.hashes
    width = state[KEPT]
    bits = np.uint32(bits_for(len(table)))
    if f is not None:
        for k in range(len(targets)):
            if target[width * k] == NOWHERE:
                unfold(f, words, batch.origins[k])
                complete(m, x, d, f, batch.steps[k], False, target, width * k, state)
                hashes[k] = hashed(target, width * k, width)
    for k in range(len(targets)):
        fetch(words, table, hashes, k, len(targets), width, bits)
        targets[k] = find(words, table, target, k, hashes[k], width, bits)
