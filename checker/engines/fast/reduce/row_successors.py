"""Compiled loops that make only some successors of a row, for partial-order reduction."""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import Any

from checker.engines.fast.compiled.jit_decorators import inner
from checker.engines.fast.compiled.table import Words, hashed
from checker.engines.fast.model.decision_leaves import ALIKE, STEP
from checker.engines.fast.model.learned_model import (
    AT,
    FULL,
    KEPT,
    LIMIT,
    NODE,
    SIZE,
    WORDS,
    LearnedModel,
    State,
    SuccessorBatch,
)
from checker.engines.fast.reduce.actor_tables import MADE, STORED, UNKNOWN, Members
from checker.engines.fast.store.make_successors import is_repeated, make_folded, make_plain, put_stored
from checker.engines.fast.store.tree_compression import NO_ROOM, UNMET, FoldedTable, leave_open


@inner(cache=True)
def make(
    m: LearnedModel,
    r: Members,
    f: FoldedTable | None,
    here: Words,
    batch: SuccessorBatch,
    k: int,
    state: State,
) -> bool:
    """Make the words of a transition's successor unless they are made; return False at something not learned yet."""
    width = state[WORDS]
    if not r.made[k]:
        if make_plain(m, f, here, 0, batch.steps[k], batch.words, k * width, width, state) < 0:
            return False
        r.made[k] = MADE
    return True


@inner(cache=True)
def make_stored(
    m: LearnedModel,
    r: Members,
    x: Any,
    d: Any,
    leaving_open: bool,
    f: FoldedTable | None,
    here: Words,
    batch: SuccessorBatch,
    k: int,
    state: State,
) -> bool:
    """Make and hash the stored form of a transition's successor unless it is made (see `put_stored`).

    Return False at something not learned yet, or without room. A compressed successor with an unknown piece or node is
    added, or left open for the storing thread.
    """
    is_plain = f is None or x is not None  # otherwise it is compressed at once, without its words
    if is_plain and not make(m, r, f, here, batch, k, state):
        return False
    if r.made[k] != STORED:
        width, kept, within = state[WORDS], state[KEPT], state[SIZE] < state[LIMIT]
        adding = within and not leaving_open
        if is_plain:
            there = put_stored(m, x, d, f, batch.words, k * width, width, adding, batch.kept, k * kept, state)
        else:
            there = make_folded(m, f, batch.steps[k], adding, batch.kept, k * kept, state)
            if there == NO_ROOM:
                state[NODE] = FULL
        if there < 0 and there != UNMET:  # beyond the limit, no piece is added
            return False
        if there == UNMET and within:
            leave_open(batch.kept, k * kept, state[AT], batch.steps[k])
        batch.hashes[k] = hashed(batch.kept, k * kept, kept)
        r.made[k] = STORED
    return True


@inner(cache=True)
def without_repetitions(
    m: LearnedModel,
    r: Members,
    f: FoldedTable | None,
    here: Words,
    batch: SuccessorBatch,
    count: int,
    state: State,
) -> int:
    """Drop transitions with the same label and successor as an earlier one; return the number left, or UNKNOWN."""
    width, alike = state[WORDS], False
    for k in range(count):
        r.made[k] = r.visible[k] = 0
        alike = alike or m.steps[STEP * batch.steps[k] + ALIKE] >= 0
    if not alike:
        return count
    left = 0
    for k in range(count):
        step = batch.steps[k]
        batch.steps[left] = step
        r.made[left] = 0
        is_compared = m.steps[STEP * step + ALIKE] >= 0
        if is_compared and not make(m, r, f, here, batch, left, state):
            return UNKNOWN
        if not is_compared or not is_repeated(batch.words, batch.steps, m.steps, 0, left, step, width):
            left += 1
    return left
