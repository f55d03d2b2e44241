"""The compiled loops that keep zones, in order: the test for new ones, and the order within a layer."""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (numba infers the types of compiled functions; mypy takes its integers for Python's)

import numpy as np

from checker.engines.fast.compiled.jit_decorators import inner, njit
from checker.engines.zones.difference_bounds import FREE as MISSING
from checker.engines.zones.timed_automaton import FIRST, GOAL, LEAST, LOCATION, SIZE, TARGET
from checker.engines.zones.zone_tables import (
    ABOUT,
    AGED,
    AGES,
    AT,
    COUNT,
    COVERED,
    DATED,
    DATED_TO,
    DATES,
    DEPTH,
    DONE,
    DROPPED,
    FAR,
    FARTHEST,
    FOUND,
    FULL,
    GATHERED,
    GROUPS,
    LAYER,
    MISSED,
    RANK,
    RANKED,
    RECORD,
    ROW,
    STORED,
    TAKEN,
    TOO_FAR,
    USED,
    WHAT,
    CompiledAutomaton,
    State,
    ZoneBatch,
    Zones,
)


@inner(cache=True)
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
def sum_of(b: ZoneBatch, ages: int, size: int) -> int:
    """Return the sum of the bounds of a zone in a batch."""
    total = np.int64(0)
    for k in range(size * size):
        total += b.ages[ages + k]
    return total


@inner(cache=True)
def keep(
    m: CompiledAutomaton, z: Zones, state: State, location: int, b: ZoneBatch, ages: int, dates: int
) -> None:
    """Keep a zone of a batch, unless the ages of another one include its own."""
    at = LOCATION * location
    size, depth = np.int64(m.locations[at + SIZE]), np.int64(0)
    if state[GROUPS] > 0:
        depth = state[DEPTH]
    total = sum_of(b, ages, size)
    before, zone = np.int64(-1), np.int64(z.heads[location])
    while zone >= 0:
        following = np.int64(z.following[zone])
        begin = z.begins[zone]
        held = z.sums[zone] >= total and z.depths[zone] <= depth
        holds = z.sums[zone] <= total and z.depths[zone] >= depth
        for k in range(size * size):
            if not held and not holds:
                break
            own, bound = b.ages[ages + k], z.bounds[begin + k]
            held = held and own <= bound
            holds = holds and own >= bound
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
    for k in range(size * size):
        z.bounds[begin + k] = b.ages[ages + k]
    z.begins[new], z.sums[new], z.places[new], z.depths[new] = begin, total, location, depth
    z.following[new] = z.heads[location]
    z.heads[location] = new
    state[COUNT] += 1
    state[USED] += size * size
    if m.processes > 1:
        keep_dated(z, state, new, b, dates, size + m.processes - 1)
    goal = m.locations[at + GOAL]
    if goal >= 0 and state[FOUND] < 0 and b.ages[ages + goal * size] >= m.locations[at + LEAST]:
        state[FOUND] = state[DEPTH]


@inner(cache=True)
def keep_dated(z: Zones, state: State, zone: int, b: ZoneBatch, dates: int, size: int) -> None:
    """Keep the dated matrix of a zone."""
    begin = state[DATED]
    for k in range(size * size):
        bound = b.dated[dates + k]
        if bound < MISSING and (bound > FARTHEST or bound < -FARTHEST):
            state[FAR] = 1
        z.dated[begin + k] = bound
    z.dated_from[zone] = begin
    state[DATED] += size * size


@inner(cache=True)
def has_place(z: Zones, state: State, b: ZoneBatch) -> bool:
    """Return whether all zones of a batch that are not stored yet fit among the kept ones."""
    at = RECORD * b.state[STORED]
    state[MISSED] = b.state[GATHERED] - b.state[STORED]
    return bool(
        state[MISSED] == 0
        or (
            state[COUNT] + state[MISSED] <= len(z.begins)
            and state[USED] + b.state[AGED] - b.records[at + AGES] <= len(z.bounds)
            and state[DATED] + b.state[DATED_TO] - b.records[at + DATES] <= len(z.dated)
        )
    )


@njit(cache=True)
def store(m: CompiledAutomaton, z: Zones, state: State, b: ZoneBatch, until: int) -> int:
    """Store a batch in order, up to the row after which there are `until` zones; return why that ended."""
    if not has_place(z, state, b):
        return FULL
    while b.state[STORED] < b.state[GATHERED]:
        at = RECORD * b.state[STORED]
        what, about = np.int64(b.records[at + WHAT]), np.int64(b.records[at + ABOUT])
        b.state[STORED] += 1
        if what >= 0:
            keep(m, z, state, what, b, b.records[at + AGES], b.records[at + DATES])
        elif what == TAKEN:
            if m.edges[about + FIRST] < 0:
                m.edges[about + FIRST] = state[DEPTH] - 1
            discover(m, z, state, m.edges[about + TARGET])
        elif what == TOO_FAR:
            state[FAR] = 1
        elif what == ROW:
            state[AT] = about
            if state[COUNT] >= until:
                break
    return DONE


MOST_LOOKED = 1 << 10
"""The most zones with which `sift` compares a new one: a list that changes meanwhile has no sure end."""


@njit(cache=True, nogil=True)
def sift(m: CompiledAutomaton, z: Zones, state: State, b: ZoneBatch) -> None:
    """Drop the zones of a batch that zones of earlier layers include, in any thread.

    Another thread may keep zones meanwhile, so the list that is followed here may change at any moment. A zone of the
    layer under construction may be incomplete; those of earlier layers stay as they are, and where one of the same
    location includes the new zone, so does a zone in the list.
    """
    for record in range(b.state[STORED], b.state[GATHERED]):
        at = RECORD * record
        location = np.int64(b.records[at + WHAT])
        if location < 0:
            continue
        ages, size = np.int64(b.records[at + AGES]), np.int64(m.locations[LOCATION * location + SIZE])
        total, zone, held = sum_of(b, ages, size), np.int64(z.heads[location]), False
        for _ in range(MOST_LOOKED):
            if zone < 0 or held:
                break
            if zone < state[LAYER] and z.places[zone] == location:
                begin, held = z.begins[zone], z.sums[zone] >= total
                for k in range(size * size):
                    if not held:
                        break
                    held = b.ages[ages + k] <= z.bounds[begin + k]
            zone = np.int64(z.following[zone])
        if held:
            b.records[at + WHAT] = DROPPED


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
