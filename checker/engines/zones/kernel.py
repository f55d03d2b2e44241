"""The compiled loops: what follows from zones, and which of it is new.

A group is what one sequence of steps leads to; groups are numbered in the order of those sequences, the shortest first,
and zones stand in the order of their groups. A zone within another one of its location is not kept; one that holds
others takes their place in what later ones are compared with, and they are followed nevertheless, so that whatever is
reached is reached first by the first sequence that leads there.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (what numba compiles is typed by numba: mypy takes its integers for Python's)

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from checker.engines.zones.automaton import (
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
from checker.engines.zones.bounds import Matrix, end, extrapolate, let_pass, restrict

Ints = NDArray[np.int32]
State = NDArray[np.int64]


class Model(NamedTuple):
    """A timed automaton, as the loops see it; see `Automaton`."""

    locations: Ints
    edges: Ints
    tests: Ints
    sources: Ints
    deadlines: Ints
    clocks: Ints
    lower: Ints
    upper: Ints


class Zones(NamedTuple):
    """What was reached.

    Attributes:
        bounds: The matrices, one after the other.
        begins: Where that of each zone begins.
        sums: The sum of its bounds: what holds it has none smaller.
        places: The location of each.
        following: For each zone the next one that later ones of its location are compared with.
        heads: For each location the first such zone.
        groups: For each group three numbers: the group before, the step, and its first zone; its last is the one before
            the next group's first.
    """

    bounds: Ints
    begins: State
    sums: State
    places: Ints
    following: Ints
    heads: Ints
    groups: Ints


GROUP = 3
BEFORE, BY, BEGIN = range(GROUP)

AT, GROUPS, COUNT, USED, FOUND, MISSED, STATE = range(7)
"""The numbers of a state: the next group to be followed, how many groups, zones and bounds there are, the group that
was found first, and how many zones there is no room for."""

DONE, MISS, FULL = range(3)
"""Why the loops return; at a MISS nobody knows what leads from some location of the next group."""


@njit(cache=True, inline="always")
def load(z: Zones, zone: int, size: int, d: Matrix) -> None:
    """Copy a zone into a matrix."""
    at = z.begins[zone]
    for i in range(size):
        for j in range(size):
            d[i, j] = z.bounds[at + i * size + j]


@njit(cache=True)
def meets(m: Model, edge: int, d: Matrix, size: int) -> bool:
    """Take only the ages at which an edge may be taken; False where there are none."""
    for k in range(m.edges[edge + TESTS], m.edges[edge + TESTS_END]):
        clock, least, most = m.tests[TEST * k], m.tests[TEST * k + 1], m.tests[TEST * k + 2]
        if least > 0 and not restrict(d, size, 0, clock, -least):
            return False
        if most >= 0 and not restrict(d, size, clock, 0, most):
            return False
    return True


@njit(cache=True)
def keep(m: Model, z: Zones, state: State, location: int, d: Matrix, size: int) -> None:
    """Keep a zone, if no other holds it."""
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
    goal = m.locations[at + GOAL]
    if goal >= 0 and state[FOUND] < 0 and d[goal, 0] >= m.locations[at + LEAST]:
        state[FOUND] = state[GROUPS]  # the group that is being made


@njit(cache=True)
def enter(m: Model, z: Zones, state: State, location: int, d: Matrix, e: Matrix, bounds: Matrix) -> None:
    """Keep what is entered in a location, and what it becomes as time passes there."""
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


@njit(cache=True)
def follow(
    m: Model, z: Zones, state: State, zone: int, edge: int, d: Matrix, e: Matrix, f: Matrix, bounds: Matrix
) -> None:
    """Keep what an edge leads to from a zone."""
    size = m.locations[LOCATION * z.places[zone] + SIZE]
    load(z, zone, size, d)
    if not meets(m, edge, d, size):
        return
    if m.edges[edge + FIRST] < 0:
        m.edges[edge + FIRST] = state[AT]
    target, sources = m.edges[edge + TARGET], m.edges[edge + SOURCES] - 1
    after = m.locations[LOCATION * target + SIZE]
    e[0, 0] = 0
    for i in range(1, after):
        one = m.sources[sources + i]
        e[i, 0], e[0, i] = d[one, 0], d[0, one]
        for j in range(1, after):
            e[i, j] = 0 if i == j else d[one, m.sources[sources + j]]
    enter(m, z, state, target, e, f, bounds)


@njit(cache=True)
def advance(m: Model, z: Zones, state: State, largest: int, until: int) -> int:
    """Follow groups up to a number of zones; say why that ended."""
    d, e, f = (
        np.zeros((largest, largest), np.int32),
        np.zeros((largest, largest), np.int32),
        np.zeros((largest, largest), np.int32),
    )
    bounds = np.zeros((4, largest + 1), np.int32)
    while state[AT] < state[GROUPS] and state[COUNT] < until and state[FOUND] < 0:
        group = state[AT]
        begin = z.groups[GROUP * group + BEGIN]
        last = z.groups[GROUP * (group + 1) + BEGIN] if group + 1 < state[GROUPS] else state[COUNT]
        ways = np.int64(0)
        for zone in range(begin, last):
            at = LOCATION * z.places[zone]
            if m.locations[at + EDGES] < 0:
                return MISS
            ways += m.locations[at + EDGES_END] - m.locations[at + EDGES]
        room = 2 * ways
        if (
            state[COUNT] + room > len(z.begins)
            or state[USED] + room * largest * largest > len(z.bounds)
            or GROUP * (state[GROUPS] + ways + 1) > len(z.groups)
        ):
            state[MISSED] = room
            return FULL
        step = np.int64(-1)
        while True:
            following = np.int64(1 << 40)
            for zone in range(begin, last):
                at = LOCATION * z.places[zone]
                for edge in range(EDGE * m.locations[at + EDGES], EDGE * m.locations[at + EDGES_END], EDGE):
                    if step < m.edges[edge + STEP] < following:
                        following = np.int64(m.edges[edge + STEP])
                        break
            if following == 1 << 40:
                break
            step, first = following, state[COUNT]
            for zone in range(begin, last):
                at = LOCATION * z.places[zone]
                for edge in range(EDGE * m.locations[at + EDGES], EDGE * m.locations[at + EDGES_END], EDGE):
                    if m.edges[edge + STEP] == step:
                        follow(m, z, state, zone, edge, d, e, f, bounds)
            if state[COUNT] > first:
                at = GROUP * state[GROUPS]
                z.groups[at + BEFORE], z.groups[at + BY], z.groups[at + BEGIN] = group, step, first
                state[GROUPS] += 1
        state[AT] += 1
    return DONE
