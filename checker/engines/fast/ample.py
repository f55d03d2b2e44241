"""The compiled loop over ample sets: `checker.reduction.ample` on rows and footprints as words.

Rows are gathered as for the full search. Which successors of a row are followed is chosen when they are stored, row by
row, since whether a step may be put off depends on what was visited before. Which actors there are is told by trees of
their own; what may disturb what is worked out where it is first asked for.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (what numba compiles is typed by numba: mypy takes its integers for Python's)

from typing import Any, NamedTuple

import numpy as np
from numba import njit

from checker.engines.fast.kernel import (
    ALL_KNOWN,
    ALPHA,
    BLOCK,
    CUT,
    EXPANDED,
    LIMIT,
    SIZE,
    TOUCHED,
    TREE,
    WORDS,
    Batch,
    Ints,
    Model,
    State,
    code_at,
    walk,
)
from checker.engines.fast.table import Words, bits_for, entry_of, find, touch

MOST_HERE = 64
"""A configuration with more actors than these is expanded in full."""

EVERYBODY = ~np.uint64(0)
"""The set of all actors."""

TRIED = -1
"""The size of a set that was found not to be ample."""

FAIR, AGENTS_OWN = 1, 2
"""Flags of a transition: an agent's, and one that must be taken some time; an agent's."""

MEMBER, NOW, EVER, ASIDE, FOLLOWER = range(5)
RECORD = 5
"""Numbers of an actor in a configuration: which it is, its footprints, and which comes behind it (-1: none)."""

PARTS = 3
"""A footprint has reads, writes and merges, each as words of bits."""


class Members(NamedTuple):
    """Who may move, and what that may disturb, as the loop sees it.

    Attributes:
        trees_from, trees: Trees that tell the actors, in groups: one for each value of the cell that names agents.
        begins: For each leaf of these where its actors begin in `actors`, and where they end.
        actors: `RECORD` numbers an actor.
        footprints: For each footprint the words of its parts.
        disturbed: For each two footprints whether one disturbs the other: 0 where it was not asked, 1 no, 2 yes.
        step_actor, step_flags: For each transition whose it is, and its flags.
        seen_masks: For each word of a row the bits that properties look at.
        seen: Columns that properties look at through a question, each with where its answers begin.
        answers: What that question makes of each code.
        seen_whole: For each word of a row the bits that properties look at as they are.
        here, disturbers, whose, sets, sizes: Room for one row: its actors, who may disturb each (0 where it was not
            asked), whose each successor is, sets of actors, and how many successors each has.
    """

    trees_from: Ints
    trees: Ints
    begins: Ints
    actors: Ints
    footprints: Words
    disturbed: Any
    step_actor: Ints
    step_flags: Ints
    seen_masks: Words
    seen_whole: Words
    seen: Ints
    answers: Any
    here: Ints
    disturbers: Words
    whose: Ints
    sets: Words
    sizes: State


@njit(cache=True)
def compare(footprints: Words, disturbed: Any, count: int, one: int, other: int) -> int:
    """Note whether one footprint disturbs another (see `checker.reduction.slots.Footprint`): 1 no, 2 yes."""
    words = len(footprints) // (PARTS * count)
    a, b = one * PARTS * words, other * PARTS * words
    found = 1
    for k in range(words):
        reads, writes, merges = footprints[a + k], footprints[a + words + k], footprints[a + 2 * words + k]
        its_reads, its_writes = footprints[b + k], footprints[b + words + k]
        its_merges = footprints[b + 2 * words + k]
        met = writes & (its_reads | its_writes | its_merges)
        met |= its_writes & (reads | merges)
        met |= (merges & its_reads) | (its_merges & reads)
        if met != np.uint64(0):
            found = 2
    disturbed[one * count + other] = found
    return found


@njit(cache=True)
def meet(m: Model, r: Members, words: Words, at: int, here: Ints, state: State) -> int:
    """Note the actors of a row; return how many there are, -1 where something is not known."""
    group = np.int64(0)
    if state[ALPHA] >= 0:
        group = code_at(words, at, m.columns, state[ALPHA])
    count = np.int64(0)
    for k in range(r.trees_from[group], r.trees_from[group + 1]):
        reference = walk(words, at, m.root[r.trees[k]], m.nodes, m.next, state)
        if reference == 0:
            state[TREE] = r.trees[k]
            return -1
        leaf = -reference - 1
        for actor in range(r.begins[2 * leaf], r.begins[2 * leaf + 1]):
            if count < len(here):
                here[count] = actor
            count += 1
    return count


@njit(cache=True, inline="always")
def has(actors: np.uint64, actor: int) -> bool:
    """Tell whether a set of the actors of a row has one."""
    return bool((actors >> np.uint64(actor)) & np.uint64(1))


@njit(cache=True)
def persistent(r: Members, here: Ints, known: Words, actors: int, seed: int) -> np.uint64:
    """Return the least set around an actor such that nothing outside ever disturbs what those inside may do now.

    For each actor it is known who may disturb it, itself included, once that was asked.
    """
    disturbed = r.disturbed
    count = np.int64(np.sqrt(len(disturbed)))
    inside, done = np.uint64(1) << np.uint64(seed), np.uint64(0)
    while inside != done:
        waiting = inside & ~done
        done = inside
        for k in range(actors):
            if not has(waiting, k):
                continue
            if known[k] == np.uint64(0):
                actor = RECORD * here[k]
                now, follower = r.actors[actor + NOW], r.actors[actor + FOLLOWER]
                found = np.uint64(1) << np.uint64(k)
                for j in range(actors):
                    other = RECORD * here[j]
                    behind = follower >= 0 and follower == r.actors[other + MEMBER]
                    may = r.actors[other + (ASIDE if behind else EVER)]
                    known_to = np.int64(disturbed[now * count + may])
                    if known_to == 0:
                        known_to = compare(r.footprints, disturbed, count, now, may)
                    if known_to == 2 and j != k:
                        found |= np.uint64(1) << np.uint64(j)
                known[k] = found
            inside |= known[k]
    return inside


@njit(cache=True)
def is_seen(m: Model, r: Members, words: Words, at: int, target: Words, to: int, width: int) -> bool:
    """Tell whether properties see a difference between a row and a successor."""
    asked = False
    for j in range(width):
        changed = words[at + j] ^ target[to + j]
        if changed & r.seen_whole[j]:
            return True
        asked = asked or (changed & r.seen_masks[j]) != np.uint64(0)
    if asked:
        for k in range(len(r.seen) // 2):
            column, begin = r.seen[2 * k], r.seen[2 * k + 1]
            before = r.answers[begin + code_at(words, at, m.columns, column)]
            if before != r.answers[begin + code_at(target, to, m.columns, column)]:
                return True
    return False


@njit(cache=True)
def attribute(r: Members, batch: Batch, begin: int, count: int) -> None:
    """Note whose each successor of a row is, as a number among its actors."""
    for k in range(count):
        r.whose[k] = 0
        while r.actors[RECORD * r.here[r.whose[k]] + MEMBER] != r.step_actor[batch.steps[begin + k]]:
            r.whose[k] += 1


@njit(cache=True)
def gather_sets(r: Members, batch: Batch, begin: int, count: int, actors: int) -> int:
    """Note the persistent sets around those who can move, and how many successors each has; return how many sets."""
    flags, steps, whose, sets, sizes, disturbers = (
        r.step_flags, batch.steps, r.whose, r.sets, r.sizes, r.disturbers
    )  # fmt: skip
    for k in range(actors):
        disturbers[k] = np.uint64(0)
    found, tried = np.int64(0), np.uint64(0)
    for k in range(count):
        if not flags[steps[begin + k]] & AGENTS_OWN or has(tried, whose[k]):
            continue
        tried |= np.uint64(1) << np.uint64(whose[k])
        inside = persistent(r, r.here, disturbers, actors, whose[k])
        known = False
        for j in range(found):
            known = known or sets[j] == inside
        if not known:
            sets[found], sizes[found] = inside, 0
            for j in range(count):
                sizes[found] += has(inside, whose[j])
            found += 1
    return found


@njit(cache=True)
def is_ample(
    m: Model,
    r: Members,
    words: Words,
    table: Any,
    batch: Batch,
    begin: int,
    count: int,
    inside: np.uint64,
    width: int,
) -> bool:
    """Tell whether no property sees a step, one must be taken some time, and one leads to what is expanded later."""
    bits = np.uint32(bits_for(len(table)))
    row = batch.origins[begin]
    fair, later = False, False
    for k in range(count):
        if has(inside, r.whose[k]):
            if is_seen(m, r, words, row * width, batch.words, (begin + k) * width, width):
                return False
            fair = fair or bool(r.step_flags[batch.steps[begin + k]] & FAIR)
            if not later:
                number = find(words, table, batch.words, begin + k, batch.hashes[begin + k], width, bits)
                later = number < 0 or number > row
    return fair and later


@njit(cache=True)
def choose(
    m: Model, r: Members, words: Words, table: Any, batch: Batch, begin: int, count: int, state: State
) -> tuple[bool, np.uint64]:
    """Return whether all is known, and whose steps are to be followed: everybody's where no set is ample."""
    if count < 2:
        return True, EVERYBODY
    width = state[WORDS]
    actors = meet(m, r, words, batch.origins[begin] * width, r.here, state)
    if actors < 0:
        return False, EVERYBODY
    if actors > MOST_HERE:
        return True, EVERYBODY
    attribute(r, batch, begin, count)
    found = gather_sets(r, batch, begin, count, actors)
    for _ in range(found):
        least = np.int64(-1)
        for j in range(found):
            if 0 <= r.sizes[j] < count and (least < 0 or r.sizes[j] < r.sizes[least]):
                least = j
        if least < 0:
            break
        r.sizes[least] = TRIED
        if is_ample(m, r, words, table, batch, begin, count, r.sets[least], width):
            return True, r.sets[least]
    return True, EVERYBODY


@njit(cache=True, nogil=True)
def store_reduced(
    m: Model,
    r: Members,
    words: Words,
    origins: Any,
    table: Any,
    batch: Batch,
    gathered: int,
    at: int,
    met: State,
    counts: State,
    state: State,
    walked: State,
) -> int:
    """Look up what was gathered of the rows before `at`, as `kernel.store` does, but of ample sets where there are any.

    It is counted how often each transition was met, and how often it was followed. Where the actors of a row are not
    known, the row is returned and nothing from there on is stored; what was not known is noted in `walked`, since
    `gather` notes the same in `state` beside it.
    """
    width, size, limit = state[WORDS], state[SIZE], state[LIMIT]
    walked[WORDS], walked[ALPHA] = width, state[ALPHA]
    bits = np.uint32(bits_for(len(table)))
    begin, touched = np.int64(0), np.int64(0)
    expanded, missed = at, np.int64(ALL_KNOWN)
    while begin < gathered:
        row = batch.origins[begin]
        end = begin + 1
        while end < gathered and batch.origins[end] == row:
            end += 1
        if end > touched:
            until = max(end, min(touched + BLOCK, gathered))
            state[TOUCHED] = touch(words, table, batch.hashes, touched, until, width)
            touched = until
        known, inside = choose(m, r, words, table, batch, begin, end - begin, walked)
        if not known:
            expanded = missed = row
            break
        for k in range(begin, end):
            met[batch.steps[k]] += 1
            if inside != EVERYBODY and not has(inside, r.whose[k - begin]):
                continue
            counts[batch.steps[k]] += 1
            found = find(words, table, batch.words, k, batch.hashes[k], width, bits)
            if found >= 0:
                continue
            if size >= limit:
                state[CUT] += 1
                continue
            for j in range(width):
                words[size * width + j] = batch.words[k * width + j]
            origins[size] = row
            table[-found - 1] = entry_of(batch.hashes[k], size, bits)
            size += 1
        begin = end
    state[SIZE] = size
    state[EXPANDED] = expanded
    return missed
