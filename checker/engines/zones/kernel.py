"""The compiled loops: the successors of zones, and the test for new ones.

Zones are expanded layer by layer: a layer holds the zones that a number of steps reaches and fewer don't. Within a
layer, the zones of one row are expanded together, step by step, and rows in the order of discovery. A zone included in
another one of its location is dropped. A zone that includes others replaces them in later inclusion tests; those of its
own layer are dropped.

The search for the first run to a goal (`checker.engines.timed.first_runs`) proceeds by groups instead. A group is the
set of zones that one sequence of steps reaches, in the order of sequences within a layer; it drops no kept zone.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (numba infers the types of compiled functions; mypy takes its integers for Python's)

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.jit_decorators import inner, njit
from checker.engines.zones.difference_bounds import Matrix, end, extrapolate, let_pass, restrict
from checker.engines.zones.timed_automaton import (
    CLOCKS,
    DEADLINE,
    DEADLINES,
    DEADLINES_END,
    EDGE,
    EDGES,
    EDGES_END,
    FIRST,
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

    `left` holds for each location the least number of steps to the goal, 0 where it is unknown.
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


class Zones(NamedTuple):
    """The reached zones.

    Attributes:
        bounds: The matrices, one after the other.
        begins: The start of each zone's matrix.
        sums: The sum of its bounds; an including zone has at least the same sum.
        places: Its location.
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
    sums: State
    places: Ints
    following: Ints
    heads: Ints
    ranks: Ints
    order: Ints
    groups: Ints


COVERED = -2

GROUP, RANK = 3, 2
BEFORE, BY, BEGIN = range(GROUP)

AT, LAYER, DEPTH, COUNT, USED, FOUND, MISSED, GROUPS, RANKED, LONGEST, STATE = range(11)
"""Indices of a state.

`AT` is the next zone, or group, to expand. `LAYER` is the first zone of the layer under construction, `DEPTH` its
depth. `COUNT`, `USED`, `GROUPS` and `RANKED` count zones, bounds, groups and discovered rows. `FOUND` is the depth of
the goal, -1 before. `MISSED` is the number of zones without room, and `LONGEST` the most steps.
"""

DONE, MISS, FULL = range(3)
"""Why the loops return; at a MISS the edges of the next location are unknown."""


@njit(cache=True, forceinline=True)
def load(z: Zones, zone: int, size: int, d: Matrix) -> None:
    """Copy a zone into a matrix."""
    at = z.begins[zone]
    for i in range(size):
        for j in range(size):
            d[i, j] = z.bounds[at + i * size + j]


@inner(cache=True)
def meets(m: CompiledAutomaton, edge: int, d: Matrix, size: int) -> bool:
    """Intersect a matrix with the guard of an edge; False for an empty result."""
    for k in range(m.edges[edge + TESTS], m.edges[edge + TESTS_END]):
        clock, least, most = m.tests[TEST * k], m.tests[TEST * k + 1], m.tests[TEST * k + 2]
        if least > 0 and not restrict(d, size, 0, clock, -least):
            return False
        if most >= 0 and not restrict(d, size, clock, 0, most):
            return False
    return True


@inner(cache=True)
def before_rank(m: CompiledAutomaton, z: Zones, state: State) -> int:
    """Return the rank of the row that is expanded, 0 at first."""
    return 0 if state[RANKED] == 0 or state[GROUPS] > 0 else np.int64(z.ranks[m.rows[z.places[state[AT]]]])


@inner(cache=True)
def keep(m: CompiledAutomaton, z: Zones, state: State, location: int, d: Matrix, size: int) -> None:
    """Keep a zone, unless another one includes it."""
    at = LOCATION * location
    total = np.int64(0)
    for i in range(size):
        for j in range(size):
            total += d[i, j]
    before, zone = np.int64(-1), np.int64(z.heads[location])
    while zone >= 0:
        following = np.int64(z.following[zone])
        begin, held, holds = z.begins[zone], z.sums[zone] >= total, z.sums[zone] <= total
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
    z.begins[new], z.sums[new], z.places[new] = begin, total, location
    z.following[new] = z.heads[location]
    z.heads[location] = new
    state[COUNT] += 1
    state[USED] += size * size
    row = m.rows[location]
    if z.ranks[row] < 0:
        z.ranks[row] = state[RANKED]
        z.order[RANK * state[RANKED]], z.order[RANK * state[RANKED] + 1] = row, before_rank(m, z, state)
        state[RANKED] += 1
    goal = m.locations[at + GOAL]
    if goal >= 0 and state[FOUND] < 0 and d[goal, 0] >= m.locations[at + LEAST]:
        state[FOUND] = state[DEPTH]


@njit(cache=True)
def enter(
    m: CompiledAutomaton, z: Zones, state: State, location: int, d: Matrix, e: Matrix, bounds: Matrix
) -> None:
    """Keep the zone entered in a location, and its closure under delays."""
    at = LOCATION * location
    size = m.locations[at + SIZE]
    begin, count = m.locations[at + DEADLINES], m.locations[at + DEADLINES_END] - m.locations[at + DEADLINES]
    deadlines, lower, upper = bounds[:2], bounds[2], bounds[3]
    for i in range(1, size):
        clock = m.clocks[m.locations[at + CLOCKS] + i - 1]
        lower[i], upper[i] = m.lower[clock], m.upper[clock]
    within = True
    for k in range(count):
        deadlines[0, k] = m.deadlines[DEADLINE * (begin + k)]
        deadlines[1, k] = m.deadlines[DEADLINE * (begin + k) + 1]
        within = within and d[deadlines[0, k], 0] <= deadlines[1, k]
    if not within:
        for i in range(size):
            for j in range(size):
                e[i, j] = d[i, j]
        extrapolate(e, size, lower, upper)
        keep(m, z, state, location, e, size)
        for k in range(count):
            if deadlines[1, k] < 0 or not restrict(d, size, deadlines[0, k], 0, deadlines[1, k]):
                return
    let_pass(d, size, deadlines[0, :count], deadlines[1, :count])
    extrapolate(d, size, lower, upper)
    end(d, size, deadlines[0, :count], deadlines[1, :count])
    keep(m, z, state, location, d, size)


@inner(cache=True)
def follow(
    m: CompiledAutomaton,
    z: Zones,
    state: State,
    zone: int,
    edge: int,
    d: Matrix,
    e: Matrix,
    f: Matrix,
    bounds: Matrix,
) -> None:
    """Keep the successor of a zone by an edge, if its distance from the goal is small enough."""
    target, sources = m.edges[edge + TARGET], m.edges[edge + SOURCES] - 1
    if state[DEPTH] + m.left[target] > state[LONGEST]:
        return
    size = m.locations[LOCATION * z.places[zone] + SIZE]
    load(z, zone, size, d)
    if not meets(m, edge, d, size):
        return
    if m.edges[edge + FIRST] < 0:
        m.edges[edge + FIRST] = state[DEPTH] - 1
    after = m.locations[LOCATION * target + SIZE]
    e[0, 0] = 0
    for i in range(1, after):
        one = m.sources[sources + i]
        e[i, 0], e[0, i] = d[one, 0], d[0, one]
        for j in range(1, after):
            e[i, j] = 0 if i == j else d[one, m.sources[sources + j]]
    enter(m, z, state, target, e, f, bounds)


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
def is_full(z: Zones, state: State, ways: int, largest: int) -> bool:
    """Return whether the successors by so many edges may exceed the room."""
    room = state[MISSED] = 2 * ways
    return bool(
        state[COUNT] + room > len(z.begins)
        or state[USED] + room * largest * largest > len(z.bounds)
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


@inner(cache=True)
def take(m: CompiledAutomaton, z: Zones, state: State, begin: int, last: int, step: int, s: Scratch) -> None:
    """Take one step from some zones."""
    for zone in range(begin, last):
        at = LOCATION * z.places[zone]
        for edge in range(EDGE * m.locations[at + EDGES], EDGE * m.locations[at + EDGES_END], EDGE):
            if m.edges[edge + STEP] == step:
                follow(m, z, state, zone, edge, s.d, s.e, s.f, s.bounds)


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
        if is_full(z, state, ways, largest):
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
    begin = state[LAYER]
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


@njit(cache=True)
def advance_by_groups(
    m: CompiledAutomaton, z: Zones, state: State, largest: int, last_group: int, s: Scratch
) -> int:
    """Expand groups in order, up to a number of groups; return why that ended."""
    while state[AT] < last_group:
        group = state[AT]
        begin = z.groups[GROUP * group + BEGIN]
        last = z.groups[GROUP * (group + 1) + BEGIN] if group + 1 < state[GROUPS] else state[COUNT]
        ways = ways_of(m, z, begin, last)
        if is_full(z, state, ways, largest):
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
        state[AT] += 1
    return DONE
