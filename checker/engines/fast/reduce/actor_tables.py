"""The actors of a row and their footprints, for the loops of partial-order reduction."""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import Any, NamedTuple

import numpy as np

from checker.engines.fast.compiled.bits import WORD
from checker.engines.fast.compiled.jit_decorators import inner
from checker.engines.fast.compiled.table import Words
from checker.engines.fast.model.learned_model import TREE, Ints, LearnedModel, State, code_at, walk

MOST_HERE = 8 * WORD
"""The greatest number of actors for which a row is reduced; with more, it is expanded fully."""

EVERYBODY, UNKNOWN, NOBODY_LEFT, GOING_ON = -1, -2, -3, -4
"""Codes instead of the transition on which a path continues: all transitions are followed; something is unknown; no
ignored actor remains; another set is needed."""

MADE, STORED = 1, 2
"""The states of a successor: its words are made, and so is its stored form."""

TRIED = -1
"""The size of a set that is not ample, or that was added."""

FAIR, AGENTS_OWN, NAMED = 1, 2, 4
"""The flags of a transition: an agent's that must eventually be taken; an agent's; one that a formula names."""

MEMBER, NOW, EVER, ASIDE, FOLLOWER = range(5)
RECORD = 5
"""The numbers of an actor: its index, three footprints, and the program whose requests queue behind it (-1: none)."""

PARTS = 3
"""The bit sets of a footprint: reads, writes and merges."""

KINDS = 3
"""The parts of an agent: program, line, requests (`checker.reduction.cycle_proviso.Part`). Clauses follow agents."""


class Members(NamedTuple):
    """The tables of actors and disturbances, with scratch space for one row, in the form that the loops read.

    Attributes:
        trees_from, trees: Trees that list the actors, in groups: one for each value of the cell that names agents.
        begins: For each leaf of these trees, the bounds of its actors in `actors`.
        actors: `RECORD` numbers an actor.
        part: The part of each actor.
        footprints: The words of each footprint.
        disturbed: For each pair of footprints, whether one disturbs the other: 0 not computed, 1 no, 2 yes.
        step_actor, step_flags: The actor and the flags of each transition.
        seen_words: The words of a row that properties read.
        seen_masks: For each word of a row, the bits that properties read.
        seen_whole: For each word of a row, the bits that properties read directly, without a question.
        seen: Columns that properties read through a question, each with the first of its answers in `answers`.
        answers: The answer of that question for each code.
        agents: The greatest number of agents.
        count: The number of footprints for which `disturbed` has room.
        here, ever, place: Scratch space: the actors of a row, the footprints of all they may ever do, and the position
            of each actor among them.
        whose, made, visible: For each transition of the row, its actor, the state of its successor (see `MADE`), and
            its visibility: 0 not computed, 1 no, 2 yes.
        disturbers, sets: Sets of the row's actors as bits: the disturbers of each actor, and the persistent sets found.
            An actor among its own disturbers marks them as computed.
        sizes: The number of transitions of each set.
        inside, owners, whole: The chosen actors, the enabled actors, and those whose persistent set contains all
            enabled ones.
        waiting, tried: Scratch space: a stack of actors in the closure, and the actors that have their set.
        taken, more: The parts taken along the path.
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
    seen_words: State
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
def meet(m: LearnedModel, r: Members, here: Words, state: State) -> int:
    """Note the actors of a row; return their number, or -1 if something is not learned yet."""
    group = np.int64(0)
    if m.alpha >= 0:
        group = code_at(here, 0, m.columns, m.alpha)
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
