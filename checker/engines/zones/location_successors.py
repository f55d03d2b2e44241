"""The compiled loops that unfold a mission: the automaton's locations and edges, from rows and learned trees.

A location is a row with the states of
the windows' clocks, as digits of a number in base 3.
"""

# mypy: disable-error-code="return-value, assignment, arg-type, no-any-return"
# (numba infers the types of compiled functions; mypy takes its integers for Python's)

from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.jit_decorators import inner, njit
from checker.engines.fast.compiled.table import Words, bits_for, entry_of, find, hashed
from checker.engines.fast.model.decision_leaves import ALIKE, END, FIRST, LEAF, STEP, TURN
from checker.engines.fast.model.learned_model import AT, KEPT, NODE, SIZE, UNKNOWN, WORDS, LearnedModel
from checker.engines.fast.store.kernel import add_row
from checker.engines.fast.store.make_successors import make_plain, put_stored
from checker.engines.fast.store.tree_compression import FoldedTable, unfold
from checker.engines.zones import timed_automaton as automata
from checker.engines.zones.clock_images import UNNAMED, note_names
from checker.engines.zones.difference_bounds import NONE
from checker.engines.zones.location_views import (
    ACTORS,
    AGENTS,
    ANSWER,
    CHOICE,
    CLOCK,
    CLOCKS,
    HI,
    IS_CROWDED,
    ITS_TURN,
    RESTORING,
    RUNNING,
    STAMP,
    TIMES,
    WINDOW,
    AutomatonGrowth,
    LearnedClocks,
    LocationView,
    find_steps,
)
from checker.engines.zones.step_footprints import look_round, note_footprint, put_footprints
from checker.engines.zones.timed_automaton import DEADLINE, EDGE, LOCATION, TEST
from semantics.timing.actor_clocks import BOUND
from semantics.timing.actor_clocks import FREE as UNBOUND

Ints = NDArray[np.int32]
State = NDArray[np.int64]


LOCATED, LEAVING, TESTED, SOURCED, DEADLINED, CLOCKED, WIDEST, DONE = range(8)
"""The positions in the loops' state.

They hold the numbers of locations, edges, tests, sources, deadlines and clocks; the most clocks of a location, plus 1;
and the number of given locations that are done.
"""

KNOWN, MISS, FULL = range(3)
"""Why the loops return: all is done, a tree lacks an answer, or there is no room."""


@inner(cache=True)
def steps_of_clause(m: LearnedModel, v: LocationView, clause: int) -> int:
    """Return the number of steps of a clause."""
    leaf = LEAF * v.leaves[v.counts[AGENTS] + clause]
    return m.leaves[leaf + END] - m.leaves[leaf + FIRST]


@inner(cache=True)
def digit(windows: int, window: int) -> int:
    """Return the state of a window's clock."""
    return windows // 3**window % 3


@inner(cache=True)
def add_location(
    m: LearnedModel,
    t: LearnedClocks,
    g: AutomatonGrowth,
    v: LocationView,
    row: int,
    windows: int,
    s: State,
) -> int:
    """Return the location of a row that was looked at, a new one at the first visit; -1 if there is no room."""
    found = np.int64(g.of_rows[row])
    while found >= 0 and g.windows[found] != windows:
        found = np.int64(g.before[found])
    if found >= 0:
        return found
    number, size = s[LOCATED], v.counts[CLOCKS]
    if (
        number >= len(g.rows)
        or LOCATION * (number + 1) > len(g.locations)
        or s[CLOCKED] + size > len(g.clocks)
        or DEADLINE * (s[DEADLINED] + size + len(t.windows) + 1) > len(g.deadlines)
    ):
        return -1
    at, begin, stamp = s[CLOCKED], s[DEADLINED], v.counts[STAMP]
    end = add_deadlines(m, t, g, v, windows, begin)
    index, vehicles, agents = np.int64(0), len(t.vehicles), v.counts[AGENTS]
    for clock in t.lasting:
        g.clocks[at + index] = clock
        index += 1
    for k in range(vehicles + v.counts[ACTORS]):
        record, process = ANSWER * v.answers[k], k - vehicles - agents + (agents >> 1)
        if k < vehicles + agents:
            process = (k - vehicles) % max(agents >> 1, 1)
        for run in range(t.answers[record], t.answers[record + 1]):
            clock, most = t.running[RUNNING * run + CLOCK], t.running[RUNNING * run + HI]
            g.clocks[at + index] = clock
            index += 1
            if not v.counts[IS_CROWDED] and most >= 0 and v.bound[clock] == stamp and v.at[clock] == index:
                end = put_deadline(g, end, index, most, process)
    record = LOCATION * number
    g.locations[record + automata.SIZE], g.locations[record + automata.CLOCKS] = size, at
    g.locations[record + automata.DEADLINES], g.locations[record + automata.DEADLINES_END] = begin, end
    for each in (automata.EDGES, automata.EDGES_END, automata.GOAL, automata.LEAST):
        g.locations[record + each] = NONE
    g.rows[number], g.windows[number] = row, windows
    g.before[number], g.of_rows[row] = g.of_rows[row], number
    s[LOCATED], s[CLOCKED], s[DEADLINED] = number + 1, at + size - 1, end
    s[WIDEST] = max(s[WIDEST], size)
    return number


@inner(cache=True)
def add_deadlines(
    m: LearnedModel, t: LearnedClocks, g: AutomatonGrowth, v: LocationView, windows: int, begin: int
) -> int:
    """Add the deadline of a crowded location, or else those of the windows; return the end of the deadlines."""
    if v.counts[IS_CROWDED]:
        return put_deadline(g, begin, 0, NONE, 0)
    end = np.int64(begin)
    for window in range(len(t.windows) // WINDOW):
        clause, within = np.int64(t.windows[WINDOW * window]), np.int64(t.windows[WINDOW * window + 1])
        if within >= 0 and steps_of_clause(m, v, clause) > 0 and digit(windows, window) < UNBOUND:
            end = put_deadline(
                g, end, 1, within, (v.counts[AGENTS] >> 1) + clause
            )  # the mission's clock is the first
    return end


@inner(cache=True)
def put_deadline(g: AutomatonGrowth, deadline: int, clock: int, most: int, process: int) -> int:
    """Add a deadline; return the end of the deadlines."""
    at = DEADLINE * deadline
    g.deadlines[at], g.deadlines[at + 1], g.deadlines[at + 2] = clock, most, process
    return deadline + 1


@inner(cache=True)
def target_row(
    m: LearnedModel,
    x: Any,
    d: Any,
    f: FoldedTable | None,
    words: Words,
    source: Words,
    at: int,
    row: int,
    step: int,
    target: Words,
    kept: Words,
    origins: Any,
    table: Any,
    most: int,
    state: State,
) -> int:
    """Return the row that a step leads to, new at the first visit; -1 if something is not learned yet, -2 without room.

    Its words are then in `target`. With symmetry (`x` and scratch space `d`), its representative is in `d.image`.
    """
    width, stored = state[WORDS], state[KEPT]
    if make_plain(m, f, source, at, step, target, 0, width, state) < 0:
        state[AT] = row
        return -1
    there = put_stored(m, x, d, f, target, 0, width, True, kept, 0, state)
    if there < 0:
        state[AT] = row
        return -1 if there == UNKNOWN else -2
    digest = hashed(kept, 0, stored)
    bits = np.uint32(bits_for(len(table)))
    found = find(words, table, kept, 0, digest, stored, bits)
    if found >= 0:
        return found
    new = state[SIZE]
    if new >= most:
        return -2
    add_row(words, origins, table, -found - 1, entry_of(digest, new, bits), kept, 0, row, state)
    return new


@inner(cache=True)
def source_of(t: LearnedClocks, a: LocationView, done: int, end: int, clock: int, earlier: int) -> int:
    """Return the index of the source clock that continues in the target's, after so many equal ones; 0 for a reset."""
    if a.stamps[clock] != a.counts[STAMP]:
        return 0
    at = np.int64(earlier)
    for k in range(done, end):
        if t.done[k] == clock:
            if not t.served[clock]:
                return 0
            at += 1
    return a.at[clock] + at if at < a.many[clock] else 0


@inner(cache=True)
def choices_of_vehicles(t: LearnedClocks, n: Any, a: LocationView, b: LocationView, choices: Ints) -> int:
    """Note a choice for each vehicle that leaves its restoring place; return their number."""
    count = np.int64(0)
    for vehicle in range(len(t.restored) // RESTORING):
        restored, aloft = t.restored[RESTORING * vehicle], t.restored[RESTORING * vehicle + 1]
        later = np.int64(restored)
        if n is not None:
            later = np.int64(n.restored[vehicle])
        if a.stamps[restored] == a.counts[STAMP] and b.stamps[later] != b.counts[STAMP]:
            at = CHOICE * count
            choices[at], choices[at + 1], choices[at + 2] = (
                a.at[restored],
                t.restored[RESTORING * vehicle + 2],
                aloft,
            )
            count += 1
    return count


@inner(cache=True)
def add_edges(  # each argument is another part of the state
    m: LearnedModel, t: LearnedClocks, n: Any, g: AutomatonGrowth, a: LocationView, b: LocationView,
    here: int, row: int, times: int, number: int, step: int,
    choices: Ints, s: State,
) -> int:  # fmt: skip
    """Add the edges of a step to a row that was looked at, one for each combination of tests and choices.

    One choice for each vehicle that leaves its restoring place: whether its endurance was restored in full. One choice
    for each window that becomes bound: whether it is already over. With symmetry, `n` has the names that the target had
    before its representative replaced it.
    """
    done, end = t.steps[times], t.steps[times + 1]
    count, said = np.int64(choices_of_vehicles(t, n, a, b, choices)), np.int64(0)
    for window in range(len(t.windows) // WINDOW):
        value, within = digit(g.windows[here], window), t.windows[WINDOW * window + 1]
        for k in range(done, end):
            if t.done[k] == -1 - window:
                value = UNBOUND
        after = np.int64(window)
        if n is not None:
            after = np.int64(n.windows[window])
        if value == 0 and steps_of_clause(m, b, t.windows[WINDOW * after]) > 0:
            value = BOUND
            if within >= 0:
                at = CHOICE * count
                choices[at], choices[at + 1], choices[at + 2] = 1, within, -1 - after
                count += 1
        said += value * 3**after
    begin, last = t.steps[times + 2], t.steps[times + 3]
    for test in range(begin, max(last, begin + 1)):
        clock, least, most = np.int64(NONE), np.int64(0), np.int64(NONE)
        if begin < last:
            clock, least, most = (
                np.int64(t.tests[TEST * test]),
                np.int64(t.tests[TEST * test + 1]),
                np.int64(t.tests[TEST * test + 2]),
            )
            if clock < 0 and digit(g.windows[here], -1 - clock) < least:
                continue
        for chosen in range(1 << count):
            windows, fresh = said, s[TESTED]
            if TEST * (s[TESTED] + count + 1) > len(g.tests) or EDGE * (s[LEAVING] + 1) > len(g.edges):
                return FULL
            if clock >= 0:
                put(g.tests, s, a.at[clock], least, most)
            for k in range(count):
                at, bound, what = choices[CHOICE * k], choices[CHOICE * k + 1], choices[CHOICE * k + 2]
                if not is_second(chosen, count, k):
                    put(g.tests, s, at, 0, bound)
                elif what >= 0:
                    put(g.tests, s, at, bound, NONE)
                else:
                    put(g.tests, s, at, bound + 1, NONE)
                    windows += 3 ** (-1 - what)
            target = add_location(m, t, g, b, row, windows, s)
            if target < 0 or s[SOURCED] + b.counts[CLOCKS] > len(g.sources):
                return FULL
            at = EDGE * s[LEAVING]
            g.edges[at + automata.STEP], g.edges[at + automata.TARGET] = number, target
            g.edges[at + automata.TESTS], g.edges[at + automata.TESTS_END] = fresh, s[TESTED]
            g.edges[at + automata.SOURCES], g.edges[at + automata.LEARNED] = s[SOURCED], step
            g.edges[at + automata.FIRST] = g.edges[at + automata.FOOTPRINT] = NONE
            add_sources(t, n, g, a, b, done, end, target, choices, count, chosen, s)
            s[LEAVING] += 1
    return KNOWN


@inner(cache=True)
def is_second(chosen: int, count: int, choice: int) -> bool:
    """Return whether the second alternative of a choice was chosen; the last choice varies fastest."""
    return bool(chosen >> (count - 1 - choice) & 1)


@inner(cache=True)
def put(tests: Ints, s: State, clock: int, least: int, most: int) -> None:
    """Add a test."""
    at = TEST * s[TESTED]
    tests[at], tests[at + 1], tests[at + 2] = clock, least, most
    s[TESTED] += 1


@inner(cache=True)
def add_sources(
    t: LearnedClocks, n: Any, g: AutomatonGrowth, a: LocationView, b: LocationView, done: int, end: int,
    target: int, choices: Ints, count: int, chosen: int,
    s: State,
) -> None:  # fmt: skip
    """Add for each clock of the target the source clock that continues in it."""
    clocks = g.locations[LOCATION * target + automata.CLOCKS]
    for index in range(1, b.counts[CLOCKS]):
        clock = np.int64(g.clocks[clocks + index - 1])
        earlier = index - b.at[clock]
        if n is not None:
            clock = np.int64(n.clocks[clock])
        source = source_of(t, a, done, end, clock, earlier)
        for k in range(count):
            if choices[CHOICE * k + 2] == clock and is_second(chosen, count, k):
                source = 0
        g.sources[s[SOURCED]] = source
        s[SOURCED] += 1


@njit(cache=True)
def begin(
    m: LearnedModel,
    t: LearnedClocks,
    g: AutomatonGrowth,
    v: LocationView,
    words: Words,
    f: FoldedTable | None,
    windows: int,
    state: State,
    s: State,
) -> int:
    """Add the location of the first row; return why that ended."""
    source = words
    if f is not None:
        unfold(f, words, 0)
        source = f.whole
    if not find_steps(m, t, source, 0, 0, v, state):
        return MISS
    return KNOWN if add_location(m, t, g, v, 0, windows, s) >= 0 else FULL


@njit(cache=True)
def leave(
    m: LearnedModel, t: LearnedClocks, g: AutomatonGrowth, a: LocationView, b: LocationView,
    p: Any, x: Any, d: Any, i: Any, n: Any, words: Words, f: FoldedTable | None, origins: Any, table: Any, most: int,
    target: Words, kept: Words, taken: Ints, choices: Ints, locations: State, state: State, s: State,
) -> int:  # fmt: skip
    """Add the edges of the given locations, from the next undone one; return why that ended.

    With `p` (`LearnedFootprints`) their footprints are noted, which no exchange has renamed.
    With symmetry, representatives replace targets: `x` and `d` are the tables and scratch space of `canonicalise`, `i`
    and `n` those of `clock_images`.
    """
    while s[DONE] < len(locations):
        here = locations[s[DONE]]
        row, began = np.int64(g.rows[here]), (s[LEAVING], s[TESTED], s[SOURCED])
        source, at = words, row * state[WORDS]
        if f is not None:
            unfold(f, words, row)
            source, at = f.whole, np.int64(0)
        if not find_steps(m, t, source, at, row, a, state):
            return MISS
        why = KNOWN
        if not a.counts[IS_CROWDED]:
            why = leave_by_steps(
                m, t, g, a, b, p, x, d, i, n, words, source, at, f, origins, table, most, target, kept, taken, choices,
                here, row, state, s,
            )  # fmt: skip
        if why != KNOWN:
            s[LEAVING], s[TESTED], s[SOURCED] = began
            return why
        record = LOCATION * here
        g.locations[record + automata.EDGES], g.locations[record + automata.EDGES_END] = began[0], s[LEAVING]
        s[DONE] += 1
    return KNOWN


@inner(cache=True)
def is_target(
    m: LearnedModel,
    f: FoldedTable | None,
    source: Words,
    at: int,
    step: int,
    target: Words,
    scratch: Words,
    state: State,
) -> bool:
    """Return whether a step leads to the row in `target`, before its representative replaces it."""
    width = state[WORDS]
    make_plain(m, f, source, at, step, scratch, 0, width, state)
    same = True
    for word in range(width):
        same = same and scratch[word] == target[word]
    return same


@inner(cache=True)
def leave_by_steps(
    m: LearnedModel, t: LearnedClocks, g: AutomatonGrowth, a: LocationView, b: LocationView,
    p: Any, x: Any, d: Any, i: Any, n: Any,
    words: Words, source: Words, at: int, f: FoldedTable | None, origins: Any, table: Any, most: int,
    target: Words, kept: Words, taken: Ints, choices: Ints, here: int, row: int, state: State, s: State,
) -> int:  # fmt: skip
    """Add the edges of each in-turn step of a location; equal steps of an agent count once."""
    number = np.int64(0)
    if p is not None:
        look_round(t, p, a)
    for k in range(a.counts[ACTORS]):
        leaf, record = LEAF * a.leaves[k], ANSWER * a.answers[len(t.vehicles) + k]
        first, own = np.int64(m.leaves[leaf + FIRST]), number
        for step in range(first, m.leaves[leaf + END]):
            turn, alike = m.steps[STEP * step + TURN], m.steps[STEP * step + ALIKE]
            if turn >= 0 and turn != a.counts[ITS_TURN]:
                continue
            to = target_row(
                m, x, d, f, words, source, at, row, step, target, kept, origins, table, most, state
            )
            if to < 0:
                return MISS if to == -1 else FULL
            if to >= len(g.of_rows) or 2 * number + 2 > len(taken):
                return FULL
            again = False
            for other in range(own, number if k < a.counts[AGENTS] and alike >= 0 else own):
                earlier = taken[2 * other + 1]
                if taken[2 * other] == to and m.steps[STEP * earlier + ALIKE] == alike:
                    same = True
                    if x is not None:  # targets that are exchanged are different ones
                        same = is_target(m, f, source, at, earlier, target, kept, state)
                    again = again or same
            if again:
                continue
            taken[2 * number], taken[2 * number + 1] = to, step
            reached = target
            if x is not None:
                reached = d.image
            if not find_steps(m, t, reached, 0, to, b, state):
                return MISS
            if x is not None and not note_names(t, i, n, d.place, b):
                state[NODE] = UNNAMED
                return MISS
            times, edges = TIMES * (t.answers[record + 2] + step - first), s[LEAVING]
            if add_edges(m, t, n, g, a, b, here, to, times, number, step, choices, s) == FULL:
                return FULL
            if p is not None:
                note_footprint(m, t, p, a, b, k, step, source, at, state)
                if not put_footprints(p, edges, s[LEAVING]):
                    return FULL
            number += 1
    return KNOWN
