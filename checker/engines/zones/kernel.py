"""The compiled loops: the successors of zones, and the test for new ones.

Zones are expanded layer by layer: a layer holds the zones that a number of steps reaches and fewer don't. Within a
layer, the zones of one row are expanded together, step by step, and rows in the order of discovery. A zone included in
another one of its location is dropped. A zone that includes others replaces them in later inclusion tests; those of its
own layer are dropped.

The search for the first run to a goal (`checker.engines.timed.first_runs`) proceeds by groups instead, depth first. A
group is the set of zones that one sequence of steps reaches. A zone is dropped if another one that as many steps or
fewer reached includes it; it drops no kept zone.

There is one clock for all processes, or a date for each. A *dated* zone bounds the differences between these dates and
the starts of clocks. Its index i below the number of processes stands for a process, the following ones for clocks. A
step makes the dates of its participants equal; then each of them waits by itself. The *ages* of a zone are its clocks
where all dates are equal: they are compared and kept. With one clock both matrices are the same.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (numba infers the types of compiled functions; mypy takes its integers for Python's)

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.jit_decorators import inner, njit
from checker.engines.zones.difference_bounds import FREE as MISSING
from checker.engines.zones.difference_bounds import Matrix, end, extrapolate, restrict
from checker.engines.zones.timed_automaton import (
    CLOCKS,
    DEADLINE,
    DEADLINES,
    DEADLINES_END,
    EDGE,
    EDGES,
    EDGES_END,
    FIRST,
    FOOTPRINT,
    GOAL,
    LEAST,
    LOCATION,
    SIZE,
    SOURCES,
    STEP,
    TARGET,
    TEST,
    TESTS,
    TESTS_END,
)

Ints = NDArray[np.int32]
State = NDArray[np.int64]


class CompiledAutomaton(NamedTuple):
    """A timed automaton for the loops; see `Automaton`.

    Attributes:
        left: For each location the least number of steps to the goal, 0 where it is unknown.
        takes_from, takes: For each footprint the range of its participants, and those.
        processes: The number of processes with a date; 1 for one clock.
    """

    locations: Ints
    edges: Ints
    tests: Ints
    sources: Ints
    deadlines: Ints
    clocks: Ints
    lower: Ints
    upper: Ints
    rows: Ints
    left: Ints
    takes_from: Ints
    takes: Ints
    processes: int


class Zones(NamedTuple):
    """The reached zones.

    Attributes:
        bounds: The matrices of ages, one after the other.
        begins: The start of each zone's matrix.
        dated, dated_from: With several processes, the dated matrices of the last two layers, and their starts.
        sums: The sum of its bounds; an including zone has at least the same sum.
        places: Its location.
        depths: In a search for a run, the number of steps that reached it; else 0.
        following: The next zone of its location in the list for inclusion tests; `COVERED` for a zone included in
            another one of its layer.
        heads: For each location the first zone of that list.
        ranks: For each row its rank in the order of discovery; -1 before it.
        order: The rows in the order of discovery, each with the rank of its predecessor.
        groups: In a search for a run, three numbers for each group: its predecessor, its step, and its first zone. The
            first zone of the next group ends it.
    """

    bounds: Ints
    begins: State
    dated: Ints
    dated_from: State
    sums: State
    places: Ints
    depths: Ints
    following: Ints
    heads: Ints
    ranks: Ints
    order: Ints
    groups: Ints


COVERED = -2

GROUP, RANK = 3, 2
BEFORE, BY, BEGIN = range(GROUP)

AT, LAYER, DEPTH, COUNT, USED, FOUND, MISSED, GROUPS, RANKED, LONGEST, DATED, FAR, STATE = range(13)
"""Indices of a state.

`AT` is the next zone, or group, to expand; -1 after the last group. `LAYER` is the first zone of the layer under
construction. `DEPTH` is the number of steps to it, or to the successors of the group. `COUNT`, `USED`, `GROUPS` and
`RANKED` count zones, bounds, groups and discovered rows. `FOUND` is the depth of the goal, -1 before. `MISSED` is the
number of zones without room, and `LONGEST` the most steps. `DATED` counts the bounds of dated matrices; `FAR` is 1 once
dates are too far apart to be counted.
"""

FARTHEST = MISSING >> 1
"""The largest finite bound of a dated matrix."""

MOST_LATE = 4
"""The most participants of a step that may be past a deadline after it; with more, dates are given up (`FAR`)."""

DONE, MISS, FULL = range(3)
"""Why the loops return; at a MISS the edges of the next location are unknown."""


@njit(cache=True, forceinline=True)
def load(bounds: Ints, at: int, size: int, d: Matrix) -> None:
    """Copy a zone into a matrix."""
    for i in range(size):
        for j in range(size):
            d[i, j] = bounds[at + i * size + j]


@inner(cache=True)
def meet_up(m: CompiledAutomaton, begin: int, last: int, d: Matrix, size: int, ways: Matrix) -> bool:
    """Make the dates of participants equal; False for an empty result."""
    for i in range(size):
        ways[0, i], ways[1, i] = MISSING, MISSING
        for k in range(begin, last):
            ways[0, i] = min(ways[0, i], d[i, m.takes[k]])
            ways[1, i] = min(ways[1, i], d[m.takes[k], i])
    for k in range(begin, last):
        if ways[0, m.takes[k]] < 0:
            return False
    for i in range(size):
        if ways[0, i] < MISSING:
            for j in range(size):
                if ways[1, j] < MISSING:
                    d[i, j] = min(d[i, j], ways[0, i] + ways[1, j])
        if d[i, i] < 0:
            return False
    return True


@inner(cache=True)
def see_ages(d: Matrix, size: int, processes: int, ages: Matrix) -> bool:
    """Write the ages of a dated matrix, whose processes have clocks from `processes` on; False for none."""
    for p in range(processes):
        for q in range(processes):
            if d[p, q] < 0:
                return False
    own = processes - 1
    ages[0, 0] = 0
    for i in range(processes, size):
        ages[i - own, 0], ages[0, i - own] = MISSING, MISSING
        for p in range(processes):
            ages[i - own, 0] = min(ages[i - own, 0], d[i, p])
            ages[0, i - own] = min(ages[0, i - own], d[p, i])
    for i in range(processes, size):
        for j in range(processes, size):
            ages[i - own, j - own] = d[i, j]
            if processes > 1 and ages[i - own, 0] < MISSING and ages[0, j - own] < MISSING:
                ages[i - own, j - own] = min(d[i, j], ages[i - own, 0] + ages[0, j - own])
        if ages[i - own, i - own] < 0:
            return False
    return True


@inner(cache=True)
def meets(m: CompiledAutomaton, edge: int, d: Matrix, size: int, process: int, own: int) -> bool:
    """Intersect a matrix with the guard of an edge, at the date of a process; False for an empty result."""
    for k in range(m.edges[edge + TESTS], m.edges[edge + TESTS_END]):
        clock, least, most = own + m.tests[TEST * k], m.tests[TEST * k + 1], m.tests[TEST * k + 2]
        if least > 0 and not restrict(d, size, process, clock, -least):
            return False
        if most >= 0 and not restrict(d, size, clock, process, most):
            return False
    return True


@njit(cache=True)
def discover(m: CompiledAutomaton, z: Zones, state: State, location: int) -> None:
    """Note the row of a location as discovered from the row that is expanded, unless it was before."""
    row = m.rows[location]
    if z.ranks[row] < 0:
        before = np.int64(0)
        if state[RANKED] > 0 and state[GROUPS] == 0:
            before = np.int64(z.ranks[m.rows[z.places[state[AT]]]])
        z.ranks[row] = state[RANKED]
        z.order[RANK * state[RANKED]], z.order[RANK * state[RANKED] + 1] = row, before
        state[RANKED] += 1


@inner(cache=True)
def keep(
    m: CompiledAutomaton, z: Zones, state: State, location: int, d: Matrix, size: int, dated: Matrix
) -> None:
    """Keep a zone with these ages and its dated matrix, unless the ages of another one include its own."""
    at = LOCATION * location
    total, depth = np.int64(0), np.int64(0)
    if state[GROUPS] > 0:
        depth = state[DEPTH]
    for i in range(size):
        for j in range(size):
            total += d[i, j]
    before, zone = np.int64(-1), np.int64(z.heads[location])
    while zone >= 0:
        following = np.int64(z.following[zone])
        begin = z.begins[zone]
        held = z.sums[zone] >= total and z.depths[zone] <= depth
        holds = z.sums[zone] <= total and z.depths[zone] >= depth
        for i in range(size):
            if not held and not holds:
                break
            for j in range(size):
                bound = z.bounds[begin + i * size + j]
                held = held and d[i, j] <= bound
                holds = holds and d[i, j] >= bound
        if held:
            return
        if holds:
            if before < 0:
                z.heads[location] = following
            else:
                z.following[before] = following
            if zone >= state[LAYER]:
                z.following[zone] = COVERED
        else:
            before = zone
        zone = following
    new, begin = state[COUNT], state[USED]
    for i in range(size):
        for j in range(size):
            z.bounds[begin + i * size + j] = d[i, j]
    z.begins[new], z.sums[new], z.places[new], z.depths[new] = begin, total, location, depth
    z.following[new] = z.heads[location]
    z.heads[location] = new
    state[COUNT] += 1
    state[USED] += size * size
    if m.processes > 1:
        keep_dated(z, state, new, dated, size + m.processes - 1)
    goal = m.locations[at + GOAL]
    if goal >= 0 and state[FOUND] < 0 and d[goal, 0] >= m.locations[at + LEAST]:
        state[FOUND] = state[DEPTH]


@inner(cache=True)
def keep_dated(z: Zones, state: State, zone: int, dated: Matrix, size: int) -> None:
    """Keep the dated matrix of a zone."""
    begin = state[DATED]
    for i in range(size):
        for j in range(size):
            bound = dated[i, j]
            if bound < MISSING and (bound > FARTHEST or bound < -FARTHEST):
                state[FAR] = 1
            z.dated[begin + i * size + j] = bound
    z.dated_from[zone] = begin
    state[DATED] += size * size


@inner(cache=True)
def deadline_of(m: CompiledAutomaton, deadline: int) -> tuple[int, int, int]:
    """Return the index of a deadline's clock in a dated matrix, that of its process, and its bound."""
    clock, most, process = (
        np.int64(m.deadlines[DEADLINE * deadline]),
        np.int64(m.deadlines[DEADLINE * deadline + 1]),
        np.int64(m.deadlines[DEADLINE * deadline + 2]),
    )
    if m.processes == 1:
        process = np.int64(0)
    return process if clock == 0 else clock + m.processes - 1, process, most


@inner(cache=True)
def waits(late: Ints, chosen: int, process: int) -> bool:
    """Return whether a process waits: a participant that is not late, or that is in time as `chosen` has its bit."""
    return bool(late[process] == 0 or (late[process] > 0 and chosen >> (late[process] - 1) & 1))


@inner(cache=True)
def wait(
    m: CompiledAutomaton, begin: int, last: int, first: int, end_: int, late: Ints, chosen: int, d: Matrix, size: int
) -> bool:  # fmt: skip
    """Let participants wait up to their own deadlines, which they keep; False if that is impossible.

    A participant that may be late (`late` has its number, from 1) stands still unless it is chosen to be in time.
    """
    for k in range(begin, last):
        clock, process, most = deadline_of(m, k)
        if waits(late, chosen, process) and not restrict(d, size, clock, process, most):
            return False
    for k in range(first, end_):
        if waits(late, chosen, m.takes[k]):
            for i in range(size):
                if i != m.takes[k]:
                    d[i, m.takes[k]] = MISSING
    for k in range(begin, last):
        clock, process, most = deadline_of(m, k)
        if waits(late, chosen, process):
            for i in range(size):
                if i != process and d[i, clock] < MISSING:
                    d[i, process] = min(d[i, process], d[i, clock] + most)
    return True


@njit(cache=True)
def enter(
    m: CompiledAutomaton, z: Zones, state: State, location: int, first: int, end_: int, s: "Scratch"
) -> None:
    """Keep the zone entered in a location by its participants, in `s.e`, and its closure under their delays."""
    at = LOCATION * location
    clocks = m.locations[at + SIZE]
    size = clocks + m.processes - 1
    begin, last = m.locations[at + DEADLINES], m.locations[at + DEADLINES_END]
    lower, upper = s.bounds[0], s.bounds[1]
    for i in range(1, clocks):
        clock = m.clocks[m.locations[at + CLOCKS] + i - 1]
        lower[i], upper[i] = m.lower[clock], m.upper[clock]
    s.late[: m.processes] = -1
    for k in range(first, end_):
        s.late[m.takes[k]] = 0
    count = np.int64(0)
    for k in range(begin, last):
        clock, process, most = deadline_of(m, k)
        if s.late[process] == 0 and s.e[clock, process] > most:
            count += 1
            s.late[process] = count
    if count > MOST_LATE:
        state[FAR] = 1
        return
    for chosen in range(1 << count):
        d = s.e
        if count > 0:
            d = s.d
            for i in range(size):
                for j in range(size):
                    d[i, j] = s.e[i, j]
        if not wait(m, begin, last, first, end_, s.late, chosen, d, size):
            continue
        ages = d
        if m.processes > 1:
            ages = s.f
            if not see_ages(d, size, m.processes, ages):
                continue
        within = True
        for k in range(begin, last):
            clock, process, most = deadline_of(m, k)
            within = within and d[clock, process] <= most
        extrapolate(ages, clocks, lower, upper)
        if within:
            deadlines = m.deadlines[DEADLINE * begin : DEADLINE * last]
            end(ages, clocks, deadlines[::DEADLINE], deadlines[1::DEADLINE])
        keep(m, z, state, location, ages, clocks, d)


@inner(cache=True)
def follow(m: CompiledAutomaton, z: Zones, state: State, zone: int, edge: int, s: "Scratch") -> None:
    """Keep the successor of a zone by an edge, if its distance from the goal is small enough."""
    target, sources = m.edges[edge + TARGET], m.edges[edge + SOURCES] - 1
    if state[DEPTH] + m.left[target] > state[LONGEST]:
        return
    clocks, own = m.locations[LOCATION * z.places[zone] + SIZE], m.processes - 1
    d, e, first, end_ = s.d, s.e, np.int64(0), np.int64(1)
    taken = m.edges[edge + FIRST] >= 0
    if own == 0:
        load(z.bounds, z.begins[zone], clocks, d)
    else:
        if not taken:
            load(z.bounds, z.begins[zone], clocks, d)
            taken = meets(m, edge, d, clocks, 0, 0)
        load(z.dated, z.dated_from[zone], clocks + own, d)
        footprint = m.edges[edge + FOOTPRINT]
        first, end_ = np.int64(m.takes_from[footprint]), np.int64(m.takes_from[footprint + 1])
        if not meet_up(m, first, end_, d, clocks + own, s.bounds):
            return
    now = np.int64(m.takes[first])
    if not meets(m, edge, d, clocks + own, now, own):
        return
    if own == 0 or taken:
        if m.edges[edge + FIRST] < 0:
            m.edges[edge + FIRST] = state[DEPTH] - 1
        discover(m, z, state, target)
    after = m.locations[LOCATION * target + SIZE] + own
    for i in range(after):
        one = np.int64(i)
        if i > own:
            one = np.int64(m.sources[sources + i - own])
            one = now if one == 0 else one + own
        s.bounds[0, i] = one
    for i in range(after):
        for j in range(after):
            e[i, j] = 0 if i == j else d[s.bounds[0, i], s.bounds[0, j]]
    enter(m, z, state, target, first, end_, s)


@inner(cache=True)
def ways_of(m: CompiledAutomaton, z: Zones, begin: int, last: int) -> int:
    """Return the number of edges from some zones, -1 if some are unknown."""
    ways = np.int64(0)
    for zone in range(begin, last):
        at = LOCATION * z.places[zone]
        if m.locations[at + EDGES] < 0:
            return -1
        ways += m.locations[at + EDGES_END] - m.locations[at + EDGES]
    return ways


@inner(cache=True)
def is_full(m: CompiledAutomaton, z: Zones, state: State, ways: int, largest: int) -> bool:
    """Return whether the successors by so many edges may exceed the room."""
    room = state[MISSED] = (2 if m.processes == 1 else 1 << MOST_LATE) * ways
    return bool(
        state[COUNT] + room > len(z.begins)
        or state[USED] + room * largest * largest > len(z.bounds)
        or state[DATED] + room * largest * largest > len(z.dated)
        or GROUP * (state[GROUPS] + ways + 1) > len(z.groups)
    )


@inner(cache=True)
def next_step(m: CompiledAutomaton, z: Zones, begin: int, last: int, step: int) -> int:
    """Return the next step after another one in some zones, -1 if there is none."""
    following = np.int64(-1)
    for zone in range(begin, last):
        at = LOCATION * z.places[zone]
        for edge in range(EDGE * m.locations[at + EDGES], EDGE * m.locations[at + EDGES_END], EDGE):
            if step < m.edges[edge + STEP]:
                if following < 0 or m.edges[edge + STEP] < following:
                    following = np.int64(m.edges[edge + STEP])
                break
    return following


class Scratch(NamedTuple):
    """Matrices to work in."""

    d: Matrix
    e: Matrix
    f: Matrix
    bounds: Matrix
    late: Ints


@inner(cache=True)
def take(m: CompiledAutomaton, z: Zones, state: State, begin: int, last: int, step: int, s: Scratch) -> None:
    """Take one step from some zones."""
    for zone in range(begin, last):
        at = LOCATION * z.places[zone]
        for edge in range(EDGE * m.locations[at + EDGES], EDGE * m.locations[at + EDGES_END], EDGE):
            if m.edges[edge + STEP] == step:
                follow(m, z, state, zone, edge, s)


@njit(cache=True)
def advance(m: CompiledAutomaton, z: Zones, state: State, largest: int, until: int, s: Scratch) -> int:
    """Expand the zones of a layer, row by row, up to a number of zones; return why that ended."""
    while state[AT] < state[LAYER] and state[COUNT] < until:
        begin = state[AT]
        row, last = m.rows[z.places[begin]], begin + 1
        while last < state[LAYER] and m.rows[z.places[last]] == row:
            last += 1
        ways = ways_of(m, z, begin, last)
        if ways < 0:
            return MISS
        if is_full(m, z, state, ways, largest):
            return FULL
        step = next_step(m, z, begin, last, -1)
        while step >= 0:
            take(m, z, state, begin, last, step, s)
            step = next_step(m, z, begin, last, step)
        state[AT] = last
    return DONE


@njit(cache=True, _nrt=True)
def arrange(m: CompiledAutomaton, z: Zones, state: State, kept: State) -> None:
    """Reorder the zones of the layer under construction and keep only the given ones; the others are covered."""
    begin, used = state[LAYER], state[USED]
    if state[COUNT] > begin:  # the first zone of an empty layer has no place
        used = z.begins[begin]
    renamed = np.full(state[COUNT] - begin, -1, np.int64)
    for k in range(len(kept)):
        renamed[kept[k] - begin] = begin + k
    bounds, begins = z.bounds[used : state[USED]].copy(), z.begins[begin : state[COUNT]].copy()
    sums, places = z.sums[begin : state[COUNT]].copy(), z.places[begin : state[COUNT]].copy()
    following = z.following[begin : state[COUNT]].copy()
    are_heads = np.zeros(len(kept), np.bool_)
    for k in range(len(kept)):
        are_heads[k] = z.heads[places[kept[k] - begin]] == kept[k]
    for k in range(len(kept)):
        old, new = kept[k] - begin, begin + k
        if are_heads[k]:
            z.heads[places[old]] = new
        z.sums[new], z.places[new], z.begins[new] = sums[old], places[old], used
        z.following[new] = following[old] if following[old] < begin else renamed[following[old] - begin]
        size = np.int64(m.locations[LOCATION * places[old] + SIZE])
        for i in range(size * size):
            z.bounds[used + i] = bounds[begins[old] - begins[0] + i]
        used += size * size
    state[USED], state[COUNT] = used, begin + len(kept)
    if m.processes > 1:
        arrange_dated(m, z, state, kept, renamed)


@njit(cache=True, _nrt=True)
def arrange_dated(m: CompiledAutomaton, z: Zones, state: State, kept: State, renamed: State) -> None:
    """Keep the dated matrices of these zones of the layer under construction alone; those before it are expanded."""
    begin, used = state[LAYER], np.int64(0)
    dated, dated_from = z.dated[: state[DATED]].copy(), z.dated_from[begin : begin + len(renamed)].copy()
    for k in range(len(kept)):
        size = np.int64(m.locations[LOCATION * z.places[begin + k] + SIZE]) + m.processes - 1
        at = dated_from[kept[k] - begin]
        for i in range(size * size):
            z.dated[used + i] = dated[at + i]
        z.dated_from[begin + k] = used
        used += size * size
    state[DATED] = used


@njit(cache=True)
def advance_by_groups(
    m: CompiledAutomaton, z: Zones, state: State, largest: int, until: int, s: Scratch
) -> int:
    """Expand groups depth first, up to one after all steps, or to a number of zones; return why that ended."""
    while state[AT] >= 0 and state[DEPTH] <= state[LONGEST] and state[COUNT] < until:
        group, fresh = state[AT], state[GROUPS]
        begin = z.groups[GROUP * group + BEGIN]
        last = z.groups[GROUP * (group + 1) + BEGIN] if group + 1 < fresh else state[COUNT]
        ways = ways_of(m, z, begin, last)
        if is_full(m, z, state, ways, largest):
            return FULL
        step = next_step(m, z, begin, last, -1)
        while step >= 0:
            first = state[COUNT]
            take(m, z, state, begin, last, step, s)
            if state[COUNT] > first:
                at = GROUP * state[GROUPS]
                z.groups[at + BEFORE], z.groups[at + BY], z.groups[at + BEGIN] = group, step, first
                state[GROUPS] += 1
            step = next_step(m, z, begin, last, step)
        if state[GROUPS] > fresh:
            state[AT] = fresh
            state[DEPTH] += 1
        else:
            turn_back(z, state)
    return DONE


@njit(cache=True)
def turn_back(z: Zones, state: State) -> None:
    """Go on after a group without further successors: with the next one by the same group, or by an earlier one."""
    group = state[AT]
    while group >= 0:
        before = np.int64(z.groups[GROUP * group + BEFORE])
        group += 1
        if group < state[GROUPS] and z.groups[GROUP * group + BEFORE] == before:
            break
        group = before
        state[DEPTH] -= 1
    state[AT] = group
