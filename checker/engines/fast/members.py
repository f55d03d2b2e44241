"""Who may move in a row, and what that may disturb, as the loops of partial-order reduction see it."""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (what numba compiles is typed by numba: mypy takes its integers for Python's)

from typing import Any, NamedTuple

import numpy as np

from checker.engines.fast.bits import WORD
from checker.engines.fast.kernel import ALPHA, TREE, Ints, Model, State, code_at, walk
from checker.engines.fast.loops import inner
from checker.engines.fast.table import Words

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


@inner(cache=True)
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
