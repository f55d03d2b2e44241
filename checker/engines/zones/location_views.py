"""One row as the loops see it: its steps and clocks, by one walk through each actor's trees."""

# mypy: disable-error-code="return-value, assignment, arg-type, no-any-return"
# (numba infers the types of compiled functions; mypy takes its integers for Python's)

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.jit_decorators import inner
from checker.engines.fast.compiled.table import Words
from checker.engines.fast.model.decision_leaves import CROWDED, END, FIRST, FLAGS, LEAF, STEP, TURN
from checker.engines.fast.model.learned_model import AT, TREE, LearnedModel, code_at, first_turn, walk

Ints = NDArray[np.int32]
State = NDArray[np.int64]


class LearnedClocks(NamedTuple):
    """The learned clocks of actors, for the loops.

    Attributes:
        agents, clauses: The trees for the clocks of the actors of `LearnedModel`, in the same order.
        vehicles: The trees for the clocks of vehicles with an endurance.
        answers: For each leaf of those trees the ranges of its clocks and of its steps (`ANSWER` numbers).
        running: Clocks with their bounds (`RUNNING`).
        steps: For each step the ranges of the clocks that it ends and of its tests (`TIMES`).
        done, tests: Those clocks; those tests, a disjunction (`TEST`).
        served: For each clock whether it belongs to a request; there may be several of those.
        lasting: The clocks that run everywhere.
        restored: For each vehicle its clocks RESTORED and ALOFT, and the time that restoring takes (`RESTORING`).
        windows: For each window its clause, and its end or `NONE` (`WINDOW`); its clock has the number -1 - window.
    """

    agents: Ints
    clauses: Ints
    vehicles: Ints
    answers: Ints
    running: Ints
    steps: Ints
    done: Ints
    tests: Ints
    served: Ints
    lasting: Ints
    restored: Ints
    windows: Ints


ANSWER, RUNNING, TIMES, RESTORING, WINDOW, CHOICE = 4, 3, 4, 3, 2, 3
CLOCK, LO, HI = range(RUNNING)


class AutomatonGrowth(NamedTuple):
    """The growing automaton, with room, and additional data for each location.

    Attributes:
        rows, windows: The row of each location, and the states of the windows' clocks.
        of_rows: For each row its last location, -1 for none.
        before: For each location the previous one of the same row.
    """

    locations: Ints
    edges: Ints
    tests: Ints
    sources: Ints
    deadlines: Ints
    clocks: Ints
    rows: Ints
    windows: State
    of_rows: Ints
    before: Ints


class LocationView(NamedTuple):
    """The steps and clocks of one row, as `find_steps` finds them.

    Attributes:
        leaves: For each actor its leaf: the agents' first, then the clauses'.
        answers: For each vehicle and then for each actor the leaf with its clocks.
        counts: The numbers of the agents' actors and of all actors, the turn, whether the row is crowded, the stamp of
            the view, and the number of clocks.
        at, many, stamps: For each clock its first index, its multiplicity, and the stamp of the view with this data.
        bound: For each clock the stamp of the view in which an in-turn step ends it.
    """

    leaves: Ints
    answers: Ints
    counts: State
    at: Ints
    many: Ints
    stamps: State
    bound: State


AGENTS, ACTORS, ITS_TURN, IS_CROWDED, STAMP, CLOCKS = range(6)


@inner(cache=True)
def find_steps(
    m: LearnedModel, t: LearnedClocks, words: Words, at: int, row: int, v: LocationView, state: State
) -> bool:
    """Find the steps and clocks of a row whose words begin at `at`; False if a tree lacks an answer."""
    state[AT] = row
    first, last = np.int64(0), np.int64(len(m.agents))
    if m.alpha >= 0:
        group = code_at(words, at, m.columns, m.alpha)
        first, last = np.int64(m.agents_from[group]), np.int64(m.agents_from[group + 1])
    agents, vehicles = last - first, len(t.vehicles)
    actors = agents + len(m.clauses)
    flags = np.int64(0)
    for k in range(actors):
        tree = m.agents[first + k] if k < agents else m.clauses[k - agents]
        reference = walk(words, at, m.root[tree], m.nodes, m.next, state)
        if reference == 0:
            state[TREE] = tree
            return False
        v.leaves[k] = -reference - 1
        flags |= m.leaves[LEAF * (-reference - 1) + FLAGS]
    for k in range(vehicles + actors):
        if k < vehicles:
            tree = t.vehicles[k]
        elif k < vehicles + agents:
            tree = t.agents[first + k - vehicles]
        else:
            tree = t.clauses[k - vehicles - agents]
        reference = walk(words, at, m.root[tree], m.nodes, m.next, state)
        if reference == 0:
            state[TREE] = tree
            return False
        v.answers[k] = -reference - 1
    v.counts[AGENTS], v.counts[ACTORS] = agents, actors
    v.counts[ITS_TURN] = first_turn(m.leaves, m.steps, v.leaves, agents) if m.takes_turns else -1
    v.counts[IS_CROWDED] = flags & CROWDED
    v.counts[STAMP] += 1
    note_clocks(m, t, v)
    return True


@inner(cache=True)
def note_clocks(m: LearnedModel, t: LearnedClocks, v: LocationView) -> None:
    """Record the first index of each clock, and the bound clocks: those that an in-turn step ends."""
    stamp, index = v.counts[STAMP], np.int64(1)
    for clock in t.lasting:
        v.at[clock], v.many[clock], v.stamps[clock] = index, 1, stamp
        index += 1
    vehicles = len(t.vehicles)
    for k in range(vehicles + v.counts[ACTORS]):
        record = ANSWER * v.answers[k]
        for run in range(t.answers[record], t.answers[record + 1]):
            clock = t.running[RUNNING * run + CLOCK]
            if v.stamps[clock] != stamp:
                v.at[clock], v.many[clock], v.stamps[clock] = index, 0, stamp
            v.many[clock] += 1
            index += 1
    v.counts[CLOCKS] = index
    for k in range(v.counts[ACTORS]):
        leaf, record = LEAF * v.leaves[k], ANSWER * v.answers[vehicles + k]
        for one in range(m.leaves[leaf + END] - m.leaves[leaf + FIRST]):
            turn = m.steps[STEP * (m.leaves[leaf + FIRST] + one) + TURN]
            if turn < 0 or turn == v.counts[ITS_TURN]:
                times = TIMES * (t.answers[record + 2] + one)
                for at in range(t.steps[times], t.steps[times + 1]):
                    if t.done[at] >= 0:
                        v.bound[t.done[at]] = stamp
