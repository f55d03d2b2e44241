"""Persistent sets in compiled loops: the disturbers of an actor, and the least persistent set around it."""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import Any

import numpy as np

from checker.engines.fast.compiled.bits import WORD, add, has, remove
from checker.engines.fast.compiled.jit_decorators import inner, njit
from checker.engines.fast.compiled.table import Words
from checker.engines.fast.reduce.actor_tables import (
    ASIDE,
    FOLLOWER,
    MEMBER,
    NOW,
    PARTS,
    RECORD,
    TRIED,
    Members,
)


@inner(cache=True)
def compare(footprints: Words, disturbed: Any, count: int, one: int, other: int) -> int:
    """Note whether one footprint disturbs another (see `SlotFootprint`): 1 no, 2 yes."""
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


@njit(cache=True, forceinline=True)
def note_disturbers(r: Members, actors: int, wide: int, k: int) -> None:
    """Note the actors that may ever disturb the current steps of actor `k`; add `k` itself to mark them as computed."""
    disturbed, ever = r.disturbed, r.ever
    actor = RECORD * r.here[k]
    now, follower = np.int64(r.actors[actor + NOW]), r.actors[actor + FOLLOWER]
    begin = now * r.count
    row = np.uint64(begin)  # indices are unsigned in the hot loop
    for word in range(wide):
        first, last = WORD * word, min(WORD * word + WORD, actors)
        found, asked = np.uint64(0), True
        here = np.uint64(first)
        for bit in range(np.uint64(last - first)):
            known = np.uint64(disturbed[row + np.uint64(ever[here + bit])])
            asked = asked and known != np.uint64(0)
            found |= (known >> np.uint64(1)) << bit
        if not asked:
            for j in range(first, last):
                if disturbed[begin + ever[j]] == 0:
                    known = np.uint64(compare(r.footprints, disturbed, r.count, now, np.int64(ever[j])))
                    found |= (known >> np.uint64(1)) << np.uint64(j - first)
        r.disturbers[k * wide + word] = found
    if follower >= 0:
        j = np.int64(r.place[follower])  # its last position, in whichever row
        if j < actors and r.actors[RECORD * r.here[j] + MEMBER] == follower:
            aside = np.int64(r.actors[RECORD * r.here[j] + ASIDE])
            known = np.uint64(disturbed[begin + aside])
            if known == np.uint64(0):
                known = np.uint64(compare(r.footprints, disturbed, r.count, now, aside))
            remove(r.disturbers, k * wide, j)
            if known == np.uint64(2):
                add(r.disturbers, k * wide, j)
    add(r.disturbers, k * wide, k)


@njit(cache=True, forceinline=True)
def persistent(r: Members, actors: int, wide: int, seed: int, at: int) -> bool:
    """Write the least set around an actor whose current steps no actor outside ever disturbs.

    Return False if it contains all enabled actors, or one whose set does; the set is then incomplete.
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


@njit(cache=True, forceinline=True)
def find_set(r: Members, count: int, actors: int, wide: int, seed: int, found: int) -> int:
    """Note the persistent set around an actor, after the sets found before; return its number of transitions.

    A repeated set, or one with all enabled actors, counts as tried.
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
