"""The compiled loops that make the zones which steps enter. Any thread may run them: they change only their batch."""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (numba infers the types of compiled functions; mypy takes its integers for Python's)

import numpy as np

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
    LOCATION,
    SIZE,
    SOURCES,
    STEP,
    TARGET,
    TEST,
    TESTS,
    TESTS_END,
)
from checker.engines.zones.zone_tables import (
    ABOUT,
    AGED,
    AGES,
    DATED_TO,
    DATES,
    DEPTH,
    DONE,
    EVENTS,
    FULL,
    GATHERED,
    LONGEST,
    MISS,
    MOST_LATE,
    NEXT,
    RECORD,
    ROW,
    TAKEN,
    TOO_FAR,
    WANTED,
    WHAT,
    CompiledAutomaton,
    Ints,
    State,
    ZoneBatch,
    Zones,
)


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


@inner(cache=True)
def note(b: ZoneBatch, what: int, about: int) -> None:
    """Add a record to a batch."""
    at = RECORD * b.state[GATHERED]
    b.records[at + WHAT], b.records[at + ABOUT] = what, about
    b.records[at + AGES], b.records[at + DATES] = b.state[AGED], b.state[DATED_TO]
    b.state[GATHERED] += 1


@inner(cache=True)
def put(b: ZoneBatch, location: int, ages: Matrix, clocks: int, dated: Matrix, processes: int) -> None:
    """Add an entered zone to a batch: its ages and, with several processes, its dated matrix."""
    note(b, location, 0)
    at, size = b.state[AGED], clocks + processes - 1
    for i in range(clocks):
        for j in range(clocks):
            b.ages[at + i * clocks + j] = ages[i, j]
    b.state[AGED] += clocks * clocks
    if processes > 1:
        at = b.state[DATED_TO]
        for i in range(size):
            for j in range(size):
                b.dated[at + i * size + j] = dated[i, j]
        b.state[DATED_TO] += size * size


@njit(cache=True)
def enter(m: CompiledAutomaton, location: int, first: int, end_: int, b: ZoneBatch) -> None:
    """Add the zone entered in a location by its participants, in `b.e`, and its closure under their delays."""
    at = LOCATION * location
    clocks = m.locations[at + SIZE]
    size = clocks + m.processes - 1
    begin, last = m.locations[at + DEADLINES], m.locations[at + DEADLINES_END]
    lower, upper = b.bounds[0], b.bounds[1]
    for i in range(1, clocks):
        clock = m.clocks[m.locations[at + CLOCKS] + i - 1]
        lower[i], upper[i] = m.lower[clock], m.upper[clock]
    b.late[: m.processes] = -1
    for k in range(first, end_):
        b.late[m.takes[k]] = 0
    count = np.int64(0)
    for k in range(begin, last):
        clock, process, most = deadline_of(m, k)
        if b.late[process] == 0 and b.e[clock, process] > most:
            count += 1
            b.late[process] = count
    if count > MOST_LATE:
        note(b, TOO_FAR, 0)
        return
    for chosen in range(1 << count):
        d = b.e
        if count > 0:
            d = b.d
            for i in range(size):
                for j in range(size):
                    d[i, j] = b.e[i, j]
        if not wait(m, begin, last, first, end_, b.late, chosen, d, size):
            continue
        ages = d
        if m.processes > 1:
            ages = b.f
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
        put(b, location, ages, clocks, d, m.processes)


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
def has_room(m: CompiledAutomaton, b: ZoneBatch, ways: int, largest: int) -> bool:
    """Return whether the successors by so many edges fit in a batch for certain."""
    room = b.state[WANTED] = (2 if m.processes == 1 else 1 << MOST_LATE) * ways
    bounds = room * largest * largest
    return bool(
        RECORD * (b.state[GATHERED] + EVENTS * room + 1) <= len(b.records)
        and b.state[AGED] + bounds <= len(b.ages)
        and (m.processes == 1 or b.state[DATED_TO] + bounds <= len(b.dated))
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


@inner(cache=True)
def take(
    m: CompiledAutomaton, z: Zones, state: State, begin: int, last: int, step: int, b: ZoneBatch
) -> None:
    """Add the successors of some zones by one step, where the distance from the goal is small enough."""
    own, d, e = m.processes - 1, b.d, b.e
    for zone in range(begin, last):
        at = LOCATION * z.places[zone]
        clocks = np.int64(m.locations[at + SIZE])
        for edge in range(EDGE * m.locations[at + EDGES], EDGE * m.locations[at + EDGES_END], EDGE):
            target, sources = m.edges[edge + TARGET], m.edges[edge + SOURCES] - 1
            if m.edges[edge + STEP] != step or state[DEPTH] + m.left[target] > state[LONGEST]:
                continue
            first, end_, taken = np.int64(0), np.int64(1), m.edges[edge + FIRST] >= 0
            if own == 0:
                load(z.bounds, z.begins[zone], clocks, d)
            else:
                if not taken:
                    load(z.bounds, z.begins[zone], clocks, d)
                    taken = meets(m, edge, d, clocks, 0, 0)
                load(z.dated, z.dated_from[zone], clocks + own, d)
                footprint = m.edges[edge + FOOTPRINT]
                first, end_ = np.int64(m.takes_from[footprint]), np.int64(m.takes_from[footprint + 1])
                if not meet_up(m, first, end_, d, clocks + own, b.bounds):
                    continue
            now = np.int64(m.takes[first])
            if not meets(m, edge, d, clocks + own, now, own):
                continue
            if (own == 0 or taken) and (m.edges[edge + FIRST] < 0 or z.ranks[m.rows[target]] < 0):
                note(b, TAKEN, edge)
            after = m.locations[LOCATION * target + SIZE] + own
            for i in range(after):
                one = np.int64(i)
                if i > own:
                    one = np.int64(m.sources[sources + i - own])
                    one = now if one == 0 else one + own
                b.bounds[0, i] = one
            for i in range(after):
                for j in range(after):
                    e[i, j] = 0 if i == j else d[b.bounds[0, i], b.bounds[0, j]]
            enter(m, target, first, end_, b)


@njit(cache=True, nogil=True)
def make(m: CompiledAutomaton, z: Zones, state: State, last: int, largest: int, b: ZoneBatch) -> int:
    """Make the successors of the zones up to `last`, row by row, while the batch has room; return why that ended."""
    while b.state[NEXT] < last:
        begin = b.state[NEXT]
        row, end_ = m.rows[z.places[begin]], begin + 1
        while end_ < last and m.rows[z.places[end_]] == row:
            end_ += 1
        ways = ways_of(m, z, begin, end_)
        if ways < 0:
            return MISS
        if not has_room(m, b, ways, largest):
            return FULL
        step = next_step(m, z, begin, end_, -1)
        while step >= 0:
            take(m, z, state, begin, end_, step, b)
            step = next_step(m, z, begin, end_, step)
        note(b, ROW, end_)
        b.state[NEXT] = end_
    return DONE
