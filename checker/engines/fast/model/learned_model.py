"""The learned model in the form that the compiled loops read, and its evaluation on a row.

Rows are packed words (see `columns.Packing`).
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.jit_decorators import njit
from checker.engines.fast.compiled.table import Words
from checker.engines.fast.model.decision_leaves import CROWDED as HAS_CROWD
from checker.engines.fast.model.decision_leaves import END, FIRST, FLAGS, LEAF, STEP, TURN
from checker.engines.fast.model.decision_trees import BASE, LOW, MASK, RECORD, SHIFT, WIDTH, WORD

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
        alpha: The column of the agents' names, -1 if they are constant.
        takes_turns: Whether requests wait for their turn.
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
    alpha: int
    takes_turns: int


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


STATE = 14
AT, SIZE, LIMIT, WORDS, KEPT, GATHERED, TREE, NODE, CUT, CROWDS, EXPANDED, SIFTED, PUT_OFF, SEEN = range(
    STATE
)
"""The entries of the loops' state.

AT: the next row. SIZE, LIMIT: the number of rows, and its limit. WORDS, KEPT: the words of a row, and of its stored
form. GATHERED: the number of gathered successors. TREE, NODE: the place where a tree ended. CUT: whether the limit left
rows out. CROWDS: the number of crowded rows. EXPANDED: the number of rows with all successors stored.
SIFTED: the number of successors that may be new. PUT_OFF: the number of deferred rows. SEEN: the number of rows that
may be looked up.
"""

WIDE, UNSORTED, FULL = -2, -3, -4
"""Codes in NODE: the batch is too small for one row; a successor's representative is unknown; no room for a piece."""

PLACE, MOVE, LATER = 3, 5, 3
UNKNOWN, CROWDED = -3, -5
"""Codes instead of a result: something is not learned yet; the row is not expanded, since an agent is crowded."""

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
    return reference


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


@njit(cache=True)
def find_unlearned(
    m: LearnedModel, here: Words, asked_from: Ints, asked: Ints, found: Ints, state: State
) -> int:
    """Note the trees of a row's actors, and of the questions asked about them, that lack the row; return their number.

    The trees of questions are in groups as those of agents.
    """
    group = code_at(here, 0, m.columns, m.alpha) if m.alpha >= 0 else np.int64(0)
    count = np.int64(0)
    for trees, begin, end in (
        (m.agents, np.int64(m.agents_from[group]), np.int64(m.agents_from[group + 1])),
        (m.clauses, np.int64(0), np.int64(len(m.clauses))),
        (asked, np.int64(asked_from[group]), np.int64(asked_from[group + 1])),
    ):
        for k in range(begin, end):
            if walk(here, 0, m.root[trees[k]], m.nodes, m.next, state) == 0:
                found[count] = trees[k]
                count += 1
    return count


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
def list_steps(
    m: LearnedModel, source: Words, at: int, batch: SuccessorBatch, begin: int, state: State
) -> int:
    """Note the enabled transitions of a row in the batch, from `begin` on; return their number, UNKNOWN or CROWDED.

    First come those of served requests, then the agents' own steps, then the environment's.
    """
    leaves, taken = batch.leaves, batch.steps
    first, last = np.int64(0), np.int64(len(m.agents))
    if m.alpha >= 0:
        group = code_at(source, at, m.columns, m.alpha)
        first, last = np.int64(m.agents_from[group]), np.int64(m.agents_from[group + 1])
    flags = find_leaves(m, source, at, first, last, leaves, state)
    if flags < 0 or flags & HAS_CROWD:
        return np.int64(UNKNOWN if flags < 0 else CROWDED)
    turn = first_turn(m.leaves, m.steps, leaves, last - first) if m.takes_turns else np.int64(-1)
    end = np.int64(begin)
    for k in range(last - first + len(m.clauses)):
        for step in range(m.leaves[LEAF * leaves[k] + FIRST], m.leaves[LEAF * leaves[k] + END]):
            its_turn = m.steps[STEP * step + TURN]
            if its_turn < 0 or its_turn == turn:
                if end == len(taken):
                    state[NODE] = WIDE
                    return np.int64(UNKNOWN)
                taken[end] = step
                end += 1
    return end - begin
