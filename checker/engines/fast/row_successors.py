"""Compiled loops that list the transitions of one row, and make only the successors that are needed."""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import Any

import numpy as np

from checker.engines.fast.actor_tables import MADE, REPRESENTED, UNKNOWN, Members
from checker.engines.fast.canonicalise import represent
from checker.engines.fast.decision_leaves import (
    ALIKE,
    COPIES,
    COPIES_END,
    CROWDED,
    END,
    FIRST,
    FLAGS,
    LEAF,
    PARTS_END,
    STEP,
)
from checker.engines.fast.decision_leaves import PARTS as TREES_OF_PARTS
from checker.engines.fast.jit_decorators import inner
from checker.engines.fast.kernel import (
    ALPHA,
    CROWDS,
    FULL,
    KEPT,
    LIMIT,
    NODE,
    SIZE,
    TREE,
    UNSORTED,
    WIDE,
    WORDS,
    LearnedModel,
    State,
    SuccessorBatch,
    code_at,
    conclude,
    copy_columns,
    is_repeated,
    walk,
    write_part,
)
from checker.engines.fast.table import Words, hashed
from checker.engines.fast.tree_compression import NO_ROOM, FoldedTable, fold, take


@inner(cache=True)
def list_steps(m: LearnedModel, here: Words, batch: SuccessorBatch, state: State) -> int:
    """Note the enabled transitions of a row without their successors; return their number, or UNKNOWN."""
    first, last = np.int64(0), np.int64(len(m.agents))
    if state[ALPHA] >= 0:
        group = code_at(here, 0, m.columns, state[ALPHA])
        first, last = np.int64(m.agents_from[group]), np.int64(m.agents_from[group + 1])
    count, flags = np.int64(0), np.int64(0)
    for k in range(last - first + len(m.clauses)):
        tree = m.agents[first + k] if first + k < last else m.clauses[first + k - last]
        reference = walk(here, 0, m.root[tree], m.nodes, m.next, state)
        if reference == 0:
            state[TREE] = tree
            return UNKNOWN
        leaf = LEAF * (-reference - 1)
        flags |= m.leaves[leaf + FLAGS]
        for step in range(m.leaves[leaf + FIRST], m.leaves[leaf + END]):
            if count == len(batch.steps):
                state[NODE] = WIDE
                return UNKNOWN
            batch.steps[count] = step
            count += 1
    if flags & CROWDED:
        state[CROWDS] += 1
        return 0
    return count


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
    """Make the successor of a transition unless it is made; return False at something not learned yet."""
    if r.made[k]:
        return True
    width = state[WORDS]
    to, record = k * width, STEP * batch.steps[k]
    if f is None:
        conclude(here, 0, m.masks, batch.steps[k], batch.words, to, width)
    else:
        for word in range(width):
            batch.words[to + word] = here[word]
        write_part(m.columns, m.writes, m.steps, batch.steps[k], batch.words, to)
    begin, end = m.steps[record + COPIES], m.steps[record + COPIES_END]
    copy_columns(here, 0, m.columns, m.copies, begin, end, batch.words, to)
    for part in range(m.steps[record + TREES_OF_PARTS], m.steps[record + PARTS_END]):
        tree = m.part[part]
        reference = walk(here, 0, m.root[tree], m.nodes, m.next, state)
        if reference == 0:
            state[TREE] = tree
            return False
        own = m.leaves[LEAF * (-reference - 1) + FIRST]
        write_part(m.columns, m.writes, m.steps, own, batch.words, to)
    r.made[k] = MADE
    return keep(f, batch, k, state)


@inner(cache=True)
def keep(f: FoldedTable | None, batch: SuccessorBatch, k: int, state: State) -> bool:
    """Compress a successor if rows are compressed, and hash its stored form; return False if there is no room."""
    width, kept = state[WORDS], state[KEPT]
    if f is not None:
        adding = state[SIZE] < state[LIMIT]  # a successor beyond the limit adds no piece
        touched = take(f, batch.words, k * width, width, adding)
        if fold(f, touched, adding, batch.kept, k * kept) == NO_ROOM:
            state[NODE] = FULL
            return False
    batch.hashes[k] = hashed(batch.kept, k * kept, kept)
    return True


@inner(cache=True)
def make_representative(
    m: LearnedModel,
    r: Members,
    x: Any,
    d: Any,
    f: FoldedTable | None,
    here: Words,
    batch: SuccessorBatch,
    k: int,
    state: State,
) -> bool:
    """Make the canonical representative of a transition's successor, unless it is made.

    Return False at something not learned yet.
    """
    if not make(m, r, f, here, batch, k, state):
        return False
    if r.made[k] == REPRESENTED:
        return True
    width = state[WORDS]
    d.whole[:] = 0
    if not represent(x, d, batch.words, k * width, width, m.columns, 1):
        state[NODE] = UNSORTED
        return False
    r.made[k] = REPRESENTED
    return keep(f, batch, k, state)


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
    left = np.int64(0)
    for k in range(count):
        step = batch.steps[k]
        batch.steps[left] = step
        r.made[left] = r.visible[left] = 0
        if not make(m, r, f, here, batch, left, state):
            return UNKNOWN
        if m.steps[STEP * step + ALIKE] < 0 or not is_repeated(
            batch.words, batch.steps, m.steps, 0, left, step, width
        ):
            left += 1
    return left
