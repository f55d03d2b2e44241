"""Partial-order reduction in compiled loops: `checker.reduction.ample` on packed rows and footprints.

Each row first chooses its ample set. The loop makes the successors in that set, and those that the visibility check
needs. Separate decision trees list the actors of a row. Disturbance between two footprints is computed at its first
use.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import Any

import numpy as np

from checker.engines.fast.compiled.bits import WORD, add, has
from checker.engines.fast.compiled.jit_decorators import inner, njit
from checker.engines.fast.compiled.table import Words
from checker.engines.fast.model.learned_model import (
    AT,
    CROWDED,
    CROWDS,
    GATHERED,
    KEPT,
    SIFTED,
    WORDS,
    LearnedModel,
    State,
    SuccessorBatch,
    code_at,
    list_steps,
)
from checker.engines.fast.model.learned_model import UNKNOWN as NOT_LEARNED
from checker.engines.fast.reduce.actor_tables import (
    AGENTS_OWN,
    EVERYBODY,
    FAIR,
    GOING_ON,
    KINDS,
    MEMBER,
    MOST_HERE,
    NAMED,
    NOBODY_LEFT,
    RECORD,
    TRIED,
    UNKNOWN,
    Members,
    meet,
)
from checker.engines.fast.reduce.chosen_rows import ENDS, Chosen, leads_away
from checker.engines.fast.reduce.persistent import find_set
from checker.engines.fast.reduce.proviso_paths import AT_ITS_TURN, FORWARD, SINGLE, Trails
from checker.engines.fast.reduce.row_successors import make, make_stored, without_repetitions
from checker.engines.fast.store.kernel import put_off
from checker.engines.fast.store.tree_compression import FoldedTable, unfold


@inner(cache=True)
def is_seen(m: LearnedModel, r: Members, here: Words, target: Words, to: int) -> bool:
    """Return whether a proposition may differ between a row and its successor."""
    asked = False
    for j in r.seen_words:
        changed = here[j] ^ target[to + j]
        if changed & r.seen_whole[j]:
            return True
        asked = asked or (changed & r.seen_masks[j]) != np.uint64(0)
    if asked:
        for k in range(len(r.seen) // 2):
            column, begin = r.seen[2 * k], r.seen[2 * k + 1]
            before = r.answers[begin + code_at(here, 0, m.columns, column)]
            if before != r.answers[begin + code_at(target, to, m.columns, column)]:
                return True
    return False


@inner(cache=True)
def attribute(r: Members, batch: SuccessorBatch, count: int, wide: int) -> None:
    """Note the actor of each transition of a row, by its position among the row's actors."""
    for word in range(wide):
        r.owners[word] = r.inside[word] = r.whole[word] = np.uint64(0)
    for k in range(count):
        r.whose[k] = r.place[r.step_actor[batch.steps[k]]]
        add(r.owners, 0, r.whose[k])


@inner(cache=True)
def is_ample(
    m: LearnedModel,
    r: Members,
    f: FoldedTable | None,
    here: Words,
    batch: SuccessorBatch,
    count: int,
    at: int,
    state: State,
) -> int:
    """Return 1 if the set is ample: its steps are invisible and one of them is fair; 0 if not, or UNKNOWN."""
    width, fair = state[WORDS], np.int64(0)
    for k in range(count):
        if has(r.sets, at, r.whose[k]):
            if r.step_flags[batch.steps[k]] & NAMED:
                return 0
            if len(r.seen_words) and r.visible[k] == 0:
                if not make(m, r, f, here, batch, k, state):
                    return UNKNOWN
                seen = is_seen(m, r, here, batch.words, k * width)  # of the successor, not its representative
                r.visible[k] = 2 if seen else 1
            if r.visible[k] == 2:
                return 0
            fair |= r.step_flags[batch.steps[k]] & FAIR
    return fair


@njit(cache=True, forceinline=True)
def part_at(r: Members, k: int) -> int:
    """Return the part to which an actor of a row belongs."""
    return np.int64(r.part[r.actors[RECORD * r.here[k] + MEMBER]])


@inner(cache=True)
def ignores(r: Members, sets: Words, at: int, wide: int) -> bool:
    """Return whether a set has an enabled actor that was not chosen and whose part no step of the path takes."""
    for word in range(wide):
        left = sets[at + word] & r.owners[word] & ~r.inside[word]
        for bit in range(WORD if left else 0):
            if (left >> np.uint64(bit)) & np.uint64(1) and not has(r.taken, 0, part_at(r, WORD * word + bit)):
                return True
    return False


@inner(cache=True)
def let_join(r: Members, actors: int, wide: int, at: int) -> None:
    """Add a set to the chosen actors; mark a part as taken if the set has all its actors."""
    r.more[:] = np.uint64(0)
    for j in range(actors):
        if has(r.sets, at, j):
            add(r.more, 0, part_at(r, j))
    for j in range(actors):
        if not has(r.sets, at, j):
            part = part_at(r, j)
            r.more[part >> 6] &= ~(np.uint64(1) << np.uint64(part & 63))
    for word in range(len(r.taken)):
        r.taken[word] |= r.more[word]
    for word in range(wide):
        r.inside[word] |= r.sets[at + word]


@inner(cache=True)
def join(
    m: LearnedModel,
    r: Members,
    x: Any,
    d: Any,
    trails: Trails,
    f: FoldedTable | None,
    here: Words,
    words: Words,
    table: Any,
    batch: SuccessorBatch,
    count: int,
    actors: int,
    at: int,
    state: State,
) -> int:
    """Add a set if it is ample and has an ignored actor (cycle proviso).

    If all steps must lead forward, the set is added only if they do, and no other joins it.

    Returns:
        A transition of the set that leads away from this row (see `leads_away`). If there is none: NOBODY_LEFT if no
        enabled actor is ignored any more, else GOING_ON. UNKNOWN if something is not learned yet.
    """
    row, wide = state[AT], (actors + WORD - 1) // WORD
    if not ignores(r, r.sets, at, wide):
        return GOING_ON
    ample = is_ample(m, r, f, here, batch, count, at, state)
    if ample <= 0:
        return UNKNOWN if ample == UNKNOWN else GOING_ON
    forward = trails.asked & FORWARD
    if not forward:
        let_join(r, actors, wide, at)
    for k in range(count):
        if has(r.sets, at, r.whose[k]):
            if not make_stored(m, r, x, d, trails.end == AT_ITS_TURN, f, here, batch, k, state):
                return UNKNOWN
            away = leads_away(x, trails, words, table, batch, k, row, r.taken, state)
            if forward and not away:
                return GOING_ON
            if away and not forward:
                return k
    if forward:
        let_join(r, actors, wide, at)
        return NOBODY_LEFT
    return GOING_ON if ignores(r, r.owners, 0, wide) else NOBODY_LEFT


@inner(cache=True)
def choose(
    m: LearnedModel,
    r: Members,
    x: Any,
    d: Any,
    trails: Trails,
    f: FoldedTable | None,
    here: Words,
    words: Words,
    table: Any,
    batch: SuccessorBatch,
    count: int,
    state: State,
) -> int:
    """Choose the actors to follow, and return a transition on which the path continues (cycle proviso).

    Candidates are the persistent sets around actors of the agent that moved last, then those around the others. Within
    each group, sets with one step are tried at once, the others by increasing size.

    Returns:
        The transition, or a code: EVERYBODY, NOBODY_LEFT or UNKNOWN.
    """
    if count < 2:
        return EVERYBODY
    row = state[AT]
    actors = meet(m, r, here, state)
    if actors < 0:
        return UNKNOWN
    if actors > MOST_HERE:
        return EVERYBODY
    wide = (actors + WORD - 1) // WORD
    attribute(r, batch, count, wide)
    r.disturbers[: actors * wide] = np.uint64(0)
    r.tried[:actors] = 0
    r.taken[:] = np.uint64(0)
    mover, found = np.int64(trails.movers[row]) - 1, np.int64(0)
    for others in range(2):
        begin = found
        for k in range(count):
            seed = np.int64(r.whose[k])
            agent = np.int64(r.part[r.step_actor[batch.steps[k]]]) // KINDS
            if (
                not r.step_flags[batch.steps[k]] & AGENTS_OWN
                or r.tried[seed]
                or (agent != mover) != bool(others)
            ):
                continue
            r.tried[seed] = 1
            size = find_set(r, count, actors, wide, seed, found)
            if size == TRIED:
                continue
            at = found * wide
            r.sizes[found] = size
            found += 1
            if size == 1:
                r.sizes[found - 1] = TRIED
                onward = join(m, r, x, d, trails, f, here, words, table, batch, count, actors, at, state)
                if onward != GOING_ON:
                    return onward
        for _ in range(begin, 0 if trails.asked & SINGLE else found):
            least = np.int64(-1)
            for j in range(begin, found):
                if r.sizes[j] >= 0 and (least < 0 or r.sizes[j] < r.sizes[least]):
                    least = j
            if least < 0:
                break
            r.sizes[least] = TRIED
            onward = join(
                m, r, x, d, trails, f, here, words, table, batch, count, actors, least * wide, state
            )
            if onward != GOING_ON:
                return onward
    return EVERYBODY


@njit(cache=True, forceinline=True)
def note_row(
    r: Members, batch: SuccessorBatch, count: int, onward: int, chosen: Chosen, i: int, state: State
) -> None:
    """Note the transitions of a row and the chosen successors, after those of the rows before it."""
    into, kept = chosen.into, state[KEPT]
    for k in range(count):
        into.steps[state[GATHERED] + k] = batch.steps[k]
        if k == onward:
            chosen.onward[i] = state[SIFTED]
        if onward == EVERYBODY or has(r.inside, 0, r.whose[k]):
            to = state[SIFTED]
            for j in range(kept):
                into.kept[to * kept + j] = batch.kept[k * kept + j]
            into.hashes[to], into.origins[to], chosen.steps[to] = batch.hashes[k], state[AT], batch.steps[k]
            state[SIFTED] = to + 1
    state[GATHERED] += count
    if onward < 0:
        chosen.onward[i] = onward
    else:
        for word in range(len(r.taken)):
            chosen.taken[i * len(r.taken) + word] = r.taken[word]


@njit(cache=True, nogil=True)
def gather_chosen(
    m: LearnedModel,
    r: Members,
    x: Any,
    d: Any,
    trails: Trails,
    words: Words,
    f: FoldedTable | None,
    table: Any,
    batch: SuccessorBatch,
    chosen: Chosen,
    begin: int,
    until: int,
    state: State,
) -> bool:
    """Gather the successors of rows by ample sets, until row `until` or until half of the room is used.

    `batch` has room for all successors of one row. `chosen` has rows from `begin` on. A row that is crowded or not
    fully learned is deferred, if there is room for that.

    Returns:
        False if the next row needs something not learned yet.
    """
    kept, into, known = state[KEPT], chosen.into, True
    while known and state[AT] < until and state[GATHERED] <= len(into.steps) // 2:
        row = state[AT]
        here = words[row * kept : (row + 1) * kept]
        if f is not None:
            unfold(f, words, row)
            here = f.whole
        count, onward = list_steps(m, here, 0, batch, 0, state), np.int64(EVERYBODY)
        if count == CROWDED:
            if len(into.later):
                count = np.int64(NOT_LEARNED)  # counted at its final expansion
            else:
                state[CROWDS] += 1
                count = np.int64(0)
        if count > 0:
            count = without_repetitions(m, r, f, here, batch, count, state)
        if count > 0:
            onward = np.int64(choose(m, r, x, d, trails, f, here, words, table, batch, count, state))
        known = count >= 0 and onward != UNKNOWN
        for k in range(count):
            if known and (onward == EVERYBODY or has(r.inside, 0, r.whose[k])):
                known = make_stored(m, r, x, d, trails.end == AT_ITS_TURN, f, here, batch, k, state)
        if known and state[GATHERED] + count > len(into.steps):
            break
        if known:
            note_row(r, batch, count, onward, chosen, row - begin, state)
        else:
            known = put_off(into.later, row, state[SIFTED], state)
        ends = ENDS * (row - begin)
        chosen.ends[ends], chosen.ends[ends + 1] = state[GATHERED], state[SIFTED]
        state[AT] += known
    return known
