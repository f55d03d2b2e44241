"""The compiled loop of the search for the first run, which proceeds by groups of zones, depth first."""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (numba infers the types of compiled functions; mypy takes its integers for Python's)

import numpy as np

from checker.engines.fast.compiled.jit_decorators import inner, njit
from checker.engines.zones.keep_zones import store
from checker.engines.zones.make_zones import has_room, next_step, take, ways_of
from checker.engines.zones.zone_tables import (
    AGED,
    AT,
    BEFORE,
    BEGIN,
    BY,
    COUNT,
    DATED_TO,
    DEPTH,
    DONE,
    FULL,
    GATHERED,
    GROUP,
    GROUPS,
    LONGEST,
    MISSED,
    STORED,
    USED,
    WANTED,
    CompiledAutomaton,
    State,
    ZoneBatch,
    Zones,
)


@inner(cache=True)
def is_full(m: CompiledAutomaton, z: Zones, state: State, b: ZoneBatch, ways: int, largest: int) -> bool:
    """Return whether the successors by so many edges may exceed the room."""
    fits = has_room(m, b, ways, largest)
    room = state[MISSED] = b.state[WANTED]
    return bool(
        not fits
        or state[COUNT] + room > len(z.begins)
        or state[USED] + room * largest * largest > len(z.bounds)
        or GROUP * (state[GROUPS] + ways + 1) > len(z.groups)
    )


@inner(cache=True)
def clear(b: ZoneBatch) -> None:
    """Empty a batch."""
    b.state[GATHERED] = b.state[STORED] = b.state[AGED] = b.state[DATED_TO] = 0


@njit(cache=True)
def advance_by_groups(
    m: CompiledAutomaton, z: Zones, state: State, largest: int, until: int, b: ZoneBatch
) -> int:
    """Expand groups depth first, up to one after all steps, or to a number of zones; return why that ended."""
    while state[AT] >= 0 and state[DEPTH] <= state[LONGEST] and state[COUNT] < until:
        group, fresh = state[AT], state[GROUPS]
        begin = z.groups[GROUP * group + BEGIN]
        last = z.groups[GROUP * (group + 1) + BEGIN] if group + 1 < fresh else state[COUNT]
        clear(b)
        ways = ways_of(m, z, begin, last)
        if is_full(m, z, state, b, ways, largest):
            return FULL
        step = next_step(m, z, begin, last, -1)
        while step >= 0:
            first = state[COUNT]
            take(m, z, state, begin, last, step, b)
            store(m, z, state, b, np.int64(1) << 62)
            clear(b)
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
