"""The compiled loop over ample sets: `checker.reduction.ample` on rows and footprints as words.

Row by row, it is chosen first which transitions are followed; only these are made, and those that a choice looks at.
Which actors there are is told by trees of their own; what may disturb what is worked out where it is first asked for.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (what numba compiles is typed by numba: mypy takes its integers for Python's)

from typing import Any, NamedTuple

import numpy as np

from checker.engines.fast.folding import NO_ROOM, Folded, fold, take, unfold
from checker.engines.fast.kernel import (
    ALPHA,
    AT,
    CROWDS,
    EXPANDED,
    FULL,
    KEPT,
    LIMIT,
    NODE,
    SIZE,
    TREE,
    UNSORTED,
    WIDE,
    WORDS,
    Batch,
    Ints,
    Model,
    State,
    add_row,
    code_at,
    conclude,
    copy_columns,
    is_repeated,
    walk,
    write_part,
)
from checker.engines.fast.leaves import (
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
from checker.engines.fast.leaves import PARTS as TREES_OF_PARTS
from checker.engines.fast.loops import njit
from checker.engines.fast.sorting import represent
from checker.engines.fast.table import Words, bits_for, entry_of, find, hashed

WORD = 64
"""Actors of a row in one word of a set."""

MOST_HERE = 8 * WORD
"""A configuration with more actors than these is expanded in full."""

EVERYBODY, UNKNOWN, NOBODY_LEFT, GOING_ON = -1, -2, -3, -4
"""What is said in the place of the transition that leads on: that all are followed, that not all is known, that none
need lead on, or that another set joins."""

MADE, REPRESENTED = 1, 2
"""What is so of a transition: its target is made, and its representative stands in its place."""

TRIED = -1
"""The size of a set that was found not to be ample, or that joined."""

FAIR, AGENTS_OWN = 1, 2
"""Flags of a transition: an agent's, and one that must be taken some time; an agent's."""

MEMBER, NOW, EVER, ASIDE, FOLLOWER = range(5)
RECORD = 5
"""Numbers of an actor in a configuration: which it is, its footprints, and which comes behind it (-1: none)."""

PARTS = 3
"""A footprint has reads, writes and merges, each as words of bits."""

KINDS = 3
"""Parts of an agent (see `checker.reduction.paths.Part`): program, line, requests. Clauses come after all of these."""

NO_AGENT = -1
"""What a path has where it ends at a row that no agent's step led to; less by as much as an agent's number for its."""


class Members(NamedTuple):
    """Who may move, and what that may disturb, as the loop sees it.

    Attributes:
        trees_from, trees: Trees that tell the actors, in groups: one for each value of the cell that names agents.
        begins: For each leaf of these where its actors begin in `actors`, and where they end.
        actors: `RECORD` numbers an actor.
        part: For each actor the part that it belongs to.
        footprints: For each footprint the words of its parts.
        disturbed: For each two footprints whether one disturbs the other: 0 where it was not asked, 1 no, 2 yes.
        step_actor, step_flags: For each transition whose it is, and its flags.
        seen_masks: For each word of a row the bits that properties look at.
        seen_whole: For each word of a row the bits that properties look at as they are.
        seen: Columns that properties look at through a question, each with where its answers begin.
        answers: What that question makes of each code.
        agents: How many agents there may ever be.
        count: For how many footprints `disturbed` has room.
        here, ever, place: Room for one row: its actors, the footprints of what they may ever do, and where each
            actor is among them.
        whose, made, visible: Whose each of its transitions is, what of that was made (see `MADE`), and whether
            properties see it: 0 where that was not asked, 1 no, 2 yes.
        disturbers, sets: Sets of its actors, each in as many words as they need: who may disturb each (where that was
            asked it is one itself), and those that were found.
        sizes: How many transitions each set that was found has.
        inside, owners, whole: Who has joined, who may take a step, and around whom the least set omits nobody's.
        waiting, tried: Room for the actors whose disturbers are asked next; whose sets were found.
        taken, more: Parts that are taken on the way.
    """

    trees_from: Ints
    trees: Ints
    begins: Ints
    actors: Ints
    part: Ints
    footprints: Words
    disturbed: Any
    step_actor: Ints
    step_flags: Ints
    seen_masks: Words
    seen_whole: Words
    seen: Ints
    answers: Any
    agents: int
    count: int
    here: Ints
    ever: Ints
    place: Ints
    whose: Ints
    made: Any
    visible: Any
    disturbers: Words
    sets: Words
    sizes: State
    inside: Words
    owners: Words
    whole: Words
    waiting: Ints
    tried: Ints
    taken: Words
    more: Words


class Trails(NamedTuple):
    """The paths of `checker.reduction.paths`, for each row.

    Attributes:
        leads: Where the path leads on; less than 0 where it ends, with whose step led there (see `NO_AGENT`).
        taken: The parts that are taken on the way there, as words of bits.
    """

    leads: Ints
    taken: Words


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
def meet(m: Model, r: Members, here: Words, state: State) -> int:
    """Note the actors of a row; return how many there are, -1 where something is not known."""
    group = np.int64(0)
    if state[ALPHA] >= 0:
        group = code_at(here, 0, m.columns, state[ALPHA])
    count, actors_here = np.int64(0), r.here
    for k in range(r.trees_from[group], r.trees_from[group + 1]):
        reference = walk(here, 0, m.root[r.trees[k]], m.nodes, m.next, state)
        if reference == 0:
            state[TREE] = r.trees[k]
            return -1
        leaf = -reference - 1
        for actor in range(r.begins[2 * leaf], r.begins[2 * leaf + 1]):
            if count < len(actors_here):
                actors_here[count] = actor
                r.ever[count] = r.actors[RECORD * actor + EVER]
                r.place[r.actors[RECORD * actor + MEMBER]] = count
            count += 1
    return count


@njit(cache=True, inline="always")
def has(sets: Words, begin: int, actor: int) -> bool:
    """Tell whether the set that begins there has an actor."""
    return bool((sets[begin + (actor >> 6)] >> np.uint64(actor & 63)) & np.uint64(1))


@njit(cache=True, inline="always")
def add(sets: Words, begin: int, actor: int) -> None:
    """Add an actor to the set that begins there."""
    sets[begin + (actor >> 6)] |= np.uint64(1) << np.uint64(actor & 63)


@njit(cache=True, inline="always")
def remove(sets: Words, begin: int, actor: int) -> None:
    """Take an actor out of the set that begins there."""
    sets[begin + (actor >> 6)] &= ~(np.uint64(1) << np.uint64(actor & 63))


@njit(cache=True, inline="always")
def note_disturbers(r: Members, actors: int, wide: int, k: int) -> None:
    """Note who may ever disturb what an actor of a row may do now, and that it was asked: it is in its own set."""
    disturbed, ever = r.disturbed, r.ever
    actor = RECORD * r.here[k]
    now, follower = np.int64(r.actors[actor + NOW]), r.actors[actor + FOLLOWER]
    begin = now * r.count
    for word in range(wide):
        first, last = WORD * word, min(WORD * word + WORD, actors)
        found, asked = np.uint64(0), True
        for j in range(first, last):
            known = np.uint64(disturbed[begin + ever[j]])
            asked = asked and known != np.uint64(0)
            found |= (known >> np.uint64(1)) << np.uint64(j - first)
        if not asked:
            for j in range(first, last):
                if disturbed[begin + ever[j]] == 0:
                    known = np.uint64(compare(r.footprints, disturbed, r.count, now, np.int64(ever[j])))
                    found |= (known >> np.uint64(1)) << np.uint64(j - first)
        r.disturbers[k * wide + word] = found
    if follower >= 0:
        j = np.int64(r.place[follower])  # where it was last, in whichever row
        if j < actors and r.actors[RECORD * r.here[j] + MEMBER] == follower:
            aside = np.int64(r.actors[RECORD * r.here[j] + ASIDE])
            known = np.uint64(disturbed[begin + aside])
            if known == np.uint64(0):
                known = np.uint64(compare(r.footprints, disturbed, r.count, now, aside))
            remove(r.disturbers, k * wide, j)
            if known == np.uint64(2):
                add(r.disturbers, k * wide, j)
    add(r.disturbers, k * wide, k)


@njit(cache=True, inline="always")
def persistent(r: Members, actors: int, wide: int, seed: int, at: int) -> bool:
    """Write the least set around an actor such that nothing outside ever disturbs what those inside may do now.

    False where everyone who may take a step is inside, as around somebody inside: it is not written to its end then.
    """
    inside, waiting = r.sets, r.waiting
    for word in range(wide):
        inside[at + word] = np.uint64(0)
    add(inside, at, seed)
    waiting[0] = seed
    left = np.int64(1)
    while left:
        left -= 1
        k = np.int64(waiting[left])
        if not has(r.disturbers, k * wide, k):
            note_disturbers(r, actors, wide, k)
        omitted, whole = np.uint64(0), np.uint64(0)
        for word in range(wide):
            reached = r.disturbers[k * wide + word] | inside[at + word]
            omitted |= r.owners[word] & ~reached
            whole |= r.whole[word] & reached
        if omitted == np.uint64(0) or whole != np.uint64(0):
            add(r.whole, 0, seed)
            return False
        for word in range(wide):
            joining = r.disturbers[k * wide + word] & ~inside[at + word]
            inside[at + word] |= joining
            for bit in range(WORD if joining else 0):
                if (joining >> np.uint64(bit)) & np.uint64(1):
                    waiting[left] = WORD * word + bit
                    left += 1
    return True


@njit(cache=True)
def is_seen(m: Model, r: Members, here: Words, target: Words, to: int, width: int) -> bool:
    """Tell whether properties see a difference between a row and a successor."""
    asked = False
    for j in range(width):
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


@njit(cache=True)
def list_steps(m: Model, here: Words, batch: Batch, state: State) -> int:
    """Note the transitions that a row allows, not made yet; return how many, UNKNOWN where something is not known."""
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


@njit(cache=True)
def make(m: Model, r: Members, f: Folded | None, here: Words, batch: Batch, k: int, state: State) -> bool:
    """Make what a transition of a row leads to, if it was not made yet; False where something is not known."""
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


@njit(cache=True)
def keep(f: Folded | None, batch: Batch, k: int, state: State) -> bool:
    """Fold what a transition leads to, where rows are folded, and hash what is kept; False where there is no room."""
    width, kept = state[WORDS], state[KEPT]
    if f is not None:
        adding = state[SIZE] < state[LIMIT]  # of what can't become a row, nothing is added
        touched = take(f, batch.words, k * width, width, adding)
        if fold(f, touched, adding, batch.kept, k * kept) == NO_ROOM:
            state[NODE] = FULL
            return False
    batch.hashes[k] = hashed(batch.kept, k * kept, kept)
    return True


@njit(cache=True)
def make_representative(
    m: Model, r: Members, x: Any, d: Any, f: Folded | None, here: Words, batch: Batch, k: int, state: State
) -> bool:
    """Make what a transition of a row leads to, and put what represents that in its place, as far as it was not done.

    False where something is not known.
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


@njit(cache=True)
def without_repetitions(
    m: Model, r: Members, f: Folded | None, here: Words, batch: Batch, count: int, state: State
) -> int:
    """Leave out what leads under the same label to the same; return how many are left, UNKNOWN as elsewhere."""
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


@njit(cache=True)
def attribute(r: Members, batch: Batch, count: int, wide: int) -> None:
    """Note whose each transition of a row is, as a number among its actors."""
    for word in range(wide):
        r.owners[word] = r.inside[word] = r.whole[word] = np.uint64(0)
    for k in range(count):
        r.whose[k] = r.place[r.step_actor[batch.steps[k]]]
        add(r.owners, 0, r.whose[k])


@njit(cache=True, inline="always")
def find_set(r: Members, count: int, actors: int, wide: int, seed: int, found: int) -> int:
    """Note the persistent set around an actor after those found; return how many transitions it has.

    A set that was found already, or that omits nothing, counts as tried.
    """
    at = found * wide
    if not persistent(r, actors, wide, seed, at):
        return TRIED
    for other in range(found):
        same = True
        for word in range(wide):
            same = same and r.sets[other * wide + word] == r.sets[at + word]
        if same:
            return TRIED
    size = np.int64(0)
    for j in range(count):
        size += has(r.sets, at, r.whose[j])
    return size


@njit(cache=True)
def is_ample(
    m: Model, r: Members, f: Folded | None, here: Words, batch: Batch, count: int, at: int, state: State
) -> int:
    """Tell whether no property sees a step, and one must be taken some time: 0 or 1, or UNKNOWN."""
    width, fair = state[WORDS], np.int64(0)
    for k in range(count):
        if has(r.sets, at, r.whose[k]):
            if not make(m, r, f, here, batch, k, state):
                return UNKNOWN
            if r.visible[k] == 0:  # of what is made, not of what represents it
                seen = is_seen(m, r, here, batch.words, k * width, width)
                r.visible[k] = 2 if seen else 1
            if r.visible[k] == 2:
                return 0
            fair |= r.step_flags[batch.steps[k]] & FAIR
    return fair


@njit(cache=True, inline="always")
def part_at(r: Members, k: int) -> int:
    """Return the part that an actor of a row belongs to."""
    return np.int64(r.part[r.actors[RECORD * r.here[k] + MEMBER]])


@njit(cache=True)
def ignores(r: Members, sets: Words, at: int, wide: int) -> bool:
    """Tell whether someone in a set may take a step who has not joined, and of whose part none is taken on the way."""
    for word in range(wide):
        left = sets[at + word] & r.owners[word] & ~r.inside[word]
        for bit in range(WORD if left else 0):
            if (left >> np.uint64(bit)) & np.uint64(1) and not has(r.taken, 0, part_at(r, WORD * word + bit)):
                return True
    return False


@njit(cache=True)
def let_join(r: Members, actors: int, wide: int, at: int) -> None:
    """Let a set join: the parts of which all are inside are taken."""
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


@njit(cache=True)
def end_of(trails: Trails, row: int, taken: Words) -> int:
    """Return where the path from a row ends, with what is taken on it; the path is made shorter."""
    wide = len(taken)
    while trails.leads[row] >= 0:
        lead = np.int64(trails.leads[row])
        further = trails.leads[lead] >= 0
        for word in range(wide):
            if further:
                trails.taken[row * wide + word] |= trails.taken[lead * wide + word]
            taken[word] |= trails.taken[row * wide + word]
        if further:
            trails.leads[row] = trails.leads[lead]
        row = np.int64(trails.leads[row])
    return row


@njit(cache=True)
def join(
    m: Model,
    r: Members,
    x: Any,
    d: Any,
    trails: Trails,
    f: Folded | None,
    here: Words,
    words: Words,
    table: Any,
    batch: Batch,
    count: int,
    actors: int,
    at: int,
    state: State,
) -> int:
    """Let a set join that is ample and has someone who is ignored; return which transition leads on, or what is so."""
    kept, row, wide = state[KEPT], state[AT], (actors + WORD - 1) // WORD
    if not ignores(r, r.sets, at, wide):
        return GOING_ON
    ample = is_ample(m, r, f, here, batch, count, at, state)
    if ample <= 0:
        return UNKNOWN if ample == UNKNOWN else GOING_ON
    let_join(r, actors, wide, at)
    bits = np.uint32(bits_for(len(table)))
    for k in range(count):
        if has(r.sets, at, r.whose[k]):
            if x is not None and not make_representative(m, r, x, d, f, here, batch, k, state):
                return UNKNOWN
            number = find(words, table, batch.kept, k, batch.hashes[k], kept, bits)
            if number < 0:
                return k
            r.more[:] = np.uint64(0)
            if end_of(trails, number, r.more) != row:
                return k
            if x is None:  # an exchange gives actors other names on the way
                for word in range(len(r.taken)):
                    r.taken[word] |= r.more[word]
    return GOING_ON if ignores(r, r.owners, 0, wide) else NOBODY_LEFT


@njit(cache=True)
def choose(
    m: Model,
    r: Members,
    x: Any,
    d: Any,
    trails: Trails,
    f: Folded | None,
    here: Words,
    words: Words,
    table: Any,
    batch: Batch,
    count: int,
    state: State,
) -> int:
    """Return which transition leads on of those that are followed, or what is said in its place; note who is inside.

    The sets around who moved last come first, then the others', the smallest first: one with one step at once.
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
    mover, found = NO_AGENT - 1 - np.int64(trails.leads[row]), np.int64(0)
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
        for _ in range(begin, found):
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


@njit(cache=True)
def expand_reduced(
    m: Model,
    r: Members,
    x: Any,
    d: Any,
    trails: Trails,
    words: Words,
    f: Folded | None,
    origins: Any,
    table: Any,
    batch: Batch,
    until: int,
    room: int,
    met: State,
    counts: State,
    state: State,
) -> bool:
    """Expand rows up to a number, or until so many new ones came, by ample sets where there are any.

    Where members are interchangeable (`x` and `d` of `sorting`, else None), what represents a target is visited for it.

    It is counted how often each transition was met, and how often it was followed. False where something is not known
    of the row that comes next: of that, nothing was stored.
    """
    kept, wide = state[KEPT], len(r.taken)
    bits = np.uint32(bits_for(len(table)))
    while state[AT] < until and state[SIZE] + len(batch.steps) <= room:
        row = state[AT]
        here = words[row * kept : (row + 1) * kept]
        if f is not None:
            unfold(f, words, row)
            here = f.whole
        count = list_steps(m, here, batch, state)
        if count > 0:
            count = without_repetitions(m, r, f, here, batch, count, state)
        if count == UNKNOWN:
            return False
        onward = np.int64(EVERYBODY)
        if count:
            onward = choose(m, r, x, d, trails, f, here, words, table, batch, count, state)
        known = onward != UNKNOWN
        for k in range(count if known else 0):
            if onward == EVERYBODY or has(r.inside, 0, r.whose[k]):
                if x is None:  # a call hands over all of `Members`
                    known = known and make(m, r, f, here, batch, k, state)
                else:
                    known = known and make_representative(m, r, x, d, f, here, batch, k, state)
        if not known:
            return False
        for k in range(count):
            step = batch.steps[k]
            met[step] += 1
            if onward != EVERYBODY and not has(r.inside, 0, r.whose[k]):
                continue
            counts[step] += 1
            number = find(words, table, batch.kept, k, batch.hashes[k], kept, bits)
            if number < 0:
                slot, number = -number - 1, np.int64(state[SIZE])
                entry = entry_of(batch.hashes[k], number, bits)
                add_row(words, origins, table, slot, entry, batch.kept, k, row, state)
                if number == state[SIZE]:  # it was left out
                    continue
                agent = np.int64(r.part[r.step_actor[step]]) // KINDS
                trails.leads[number] = NO_AGENT - (agent + 1 if agent < r.agents else 0)
            if k == onward:
                trails.leads[row] = number
                for word in range(wide):
                    trails.taken[row * wide + word] = r.taken[word]
        state[AT] += 1
        state[EXPANDED] = state[AT]
    return True
