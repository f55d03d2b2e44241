"""Rows whose successors partial-order reduction has chosen, on their way into the store, in compiled loops.

Any thread chooses an ample set for a row ahead of its turn. The cycle proviso depends on the rows stored before, so the
storing thread decides it, row by row. It seldom rejects a set; such a row is expanded again at its turn.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import Any, NamedTuple

import numpy as np

from checker.engines.fast.compiled.jit_decorators import inner, njit
from checker.engines.fast.compiled.table import Words, bits_for, entry_of, find, hashed
from checker.engines.fast.model.learned_model import (
    EXPANDED,
    KEPT,
    LIMIT,
    SIZE,
    Ints,
    LearnedModel,
    State,
    SuccessorBatch,
)
from checker.engines.fast.reduce.actor_tables import EVERYBODY, GOING_ON, NOBODY_LEFT
from checker.engines.fast.reduce.proviso_paths import (
    AT_ITS_TURN,
    FORWARD,
    NOWHERE,
    Trails,
    begin_row,
    end_of,
    end_row,
    has_room,
    lead_on,
    store_transition,
)
from checker.engines.fast.store.kernel import add_row, complete, room_for
from checker.engines.fast.store.tree_compression import (
    NO_ROOM,
    FoldedTable,
    intern,
    leave_open,
    step_left_open,
    unfold,
)

ENDS = 2
"""The numbers of a row in `Chosen.ends`."""

DONE, NO_MORE_ROOM, REJECTED = range(3)
"""Why `store_chosen` ended: all rows are stored; something has no room; the chosen set of the next row is not ample."""


class Chosen(NamedTuple):
    """Rows with their chosen successors.

    Attributes:
        into: The chosen successors; its `steps` are all transitions of the rows.
        steps: The transition of each chosen successor.
        ends: For each row, the numbers of transitions and of chosen successors up to its last.
        onward: For each row, the successor on which its path continues, or a code (see `ample_kernel.choose`).
        taken: For each row with such a successor, the set of parts taken on the way.
    """

    into: SuccessorBatch
    steps: Ints
    ends: State
    onward: State
    taken: Words


@inner(cache=True)
def leads_away(
    x: Any,
    trails: Trails,
    words: Words,
    table: Any,
    batch: SuccessorBatch,
    k: int,
    row: int,
    taken: Words,
    state: State,
) -> bool:
    """Return whether the path from a successor does not return to its row, or that its step leads forward, if asked.

    Parts on a path that returns are added to `taken`. In a divided search, and ahead of a row's turn, the answer is
    only assumed.
    """
    if trails.end == AT_ITS_TURN:
        return True
    number = find(words, table, batch.kept, k, batch.hashes[k], state[KEPT], np.uint32(bits_for(len(table))))
    if trails.asked & FORWARD:
        return not 0 <= number < (trails.end or row + 1)
    if number < 0 or trails.end:
        return True
    trails.further[:] = np.uint64(0)
    if end_of(trails, number, trails.further) != row:
        return True
    if x is None:  # an exchange renames actors along the path
        for word in range(len(taken)):
            taken[word] |= trails.further[word]
    return False


@inner(cache=True)
def complete_row(
    m: LearnedModel,
    x: Any,
    d: Any,
    f: FoldedTable,
    words: Words,
    into: SuccessorBatch,
    begin: int,
    end: int,
    row: int,
    state: State,
) -> bool:
    """Complete the successors of a row that were left open; return False without room for their pieces."""
    kept = state[KEPT]
    adding, whole = state[SIZE] < state[LIMIT], False
    for k in range(begin, end):
        step = step_left_open(into.kept, kept * k)
        if step >= 0:
            if not whole:
                unfold(f, words, row)
                whole = True
            if complete(m, x, d, f, step, adding, into.kept, kept * k, state) == NO_ROOM:
                leave_open(into.kept, kept * k, row, step)
                return False
            into.hashes[k] = hashed(into.kept, kept * k, kept)
    return True


@inner(cache=True)
def decide(
    x: Any,
    trails: Trails,
    words: Words,
    table: Any,
    batch: SuccessorBatch,
    begin: int,
    end: int,
    row: int,
    taken: Words,
    state: State,
) -> int:
    """Decide the cycle proviso for the chosen set of a row.

    Returns:
        The successor on which the path continues; NOBODY_LEFT if all lead forward, as asked; GOING_ON if the set alone
        is not ample.
    """
    forward = trails.asked & FORWARD
    for k in range(begin, end):
        away = leads_away(x, trails, words, table, batch, k, row, taken, state)
        if away and not forward:
            return k
        if forward and not away:
            return GOING_ON
    return NOBODY_LEFT if forward else GOING_ON


@njit(cache=True, nogil=True)
def store_chosen(
    m: LearnedModel,
    x: Any,
    d: Any,
    trails: Trails,
    words: Words,
    f: FoldedTable | None,
    origins: Any,
    table: Any,
    chosen: Chosen,
    movers: State,
    begin: int,
    until: int,
    is_decided: bool,
    met: State,
    counts: State,
    state: State,
) -> int:
    """Store the chosen successors of rows, from the first one not expanded to row `until`.

    `chosen` has rows from `begin` on, `movers` the agent of each transition (see `Trails.movers`). `met` counts all
    transitions, `counts` the chosen ones.

    Returns:
        DONE; NO_MORE_ROOM, or REJECTED if the set of the next row is not ample: nothing of that row is then stored.
    """
    into, kept, wide = chosen.into, state[KEPT], len(trails.sought)
    bits, room = np.uint32(bits_for(len(table))), room_for(words, origins, table, kept)
    while state[EXPANDED] < until:
        row = state[EXPANDED]
        at = ENDS * (row - begin)
        step, first = (chosen.ends[at - ENDS], chosen.ends[at - 1]) if at else (np.int64(0), np.int64(0))
        last, onward = chosen.ends[at + 1], chosen.onward[row - begin]
        if min(state[SIZE] + last - first, state[LIMIT]) > room or not has_room(trails, last - first):
            return NO_MORE_ROOM
        if f is not None and not complete_row(m, x, d, f, words, into, first, last, row, state):
            return NO_MORE_ROOM
        begin_row(trails, row)
        taken = chosen.taken[wide * (row - begin) : wide * (row - begin + 1)]
        if onward != EVERYBODY and not is_decided:
            onward = np.int64(decide(x, trails, words, table, into, first, last, row, taken, state))
            if onward == GOING_ON:
                return REJECTED
        path = np.int64(intern(trails.sets, taken, True)) if onward >= 0 else np.int64(0)
        if path == NO_ROOM:
            return NO_MORE_ROOM
        for k in range(step, chosen.ends[at]):
            met[into.steps[k]] += 1
        for k in range(first, last):
            step = np.int64(chosen.steps[k])
            counts[step] += 1
            number = find(words, table, into.kept, k, into.hashes[k], kept, bits)
            if number < 0:
                slot, number = -number - 1, np.int64(state[SIZE])
                entry = entry_of(into.hashes[k], number, bits)
                add_row(words, origins, table, slot, entry, into.kept, k, row, state)
                if number == state[SIZE]:  # the limit left it out
                    number = np.int64(NOWHERE)
                else:
                    trails.movers[number] = movers[step]
            store_transition(trails, step, number)
            if k == onward and number != NOWHERE:
                lead_on(trails, row, number, path)
        end_row(trails, row)
        state[EXPANDED] = row + 1
    return DONE
