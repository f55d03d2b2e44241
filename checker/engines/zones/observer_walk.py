"""The walk through the locations of an observer: those of the mission's automaton, with the state of a clock more."""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (numba infers the types of compiled functions; mypy takes its integers for Python's)

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.jit_decorators import njit
from checker.engines.zones.timed_automaton import EDGE, EDGES, EDGES_END, LOCATION, TARGET

Ints = NDArray[np.int32]


class ObserverClock(IntEnum):
    """The state of the additional clock in a location."""

    OFF = 0
    ON = 1
    END = 2
    """The clock is read, and the location has no edges."""
    START = 3


_END, _START = int(ObserverClock.END), int(ObserverClock.START)

Rule = NDArray[np.int8]
"""The state of the clock in each location: where it was off before, and where it was on."""


@njit(cache=True, _nrt=True)
def walk(locations: Ints, edges: Ints, rule: Rule, first: int) -> tuple[Ints, Ints]:
    """Return the observer's locations and edges, breadth-first.

    Of each location: that of the mission, and the state of the clock. Of each edge: that of the mission, its source,
    its target, and whether the clock starts.
    """
    numbers = np.full((3, len(locations) // LOCATION), -1, np.int32)
    spots = np.empty((numbers.size, 2), np.int32)
    found = np.empty((2 * (len(edges) // EDGE), 4), np.int32)
    count, ways, at = 1, 0, 0
    watch = rule[0, first]
    spots[0, 0], spots[0, 1] = first, 1 if watch == _START else watch
    numbers[spots[0, 1], first] = 0
    while at < count:
        location, before = spots[at, 0], spots[at, 1]
        begin, end = locations[LOCATION * location + EDGES], locations[LOCATION * location + EDGES_END]
        if before == _END:
            end = begin
        for edge in range(begin, end):
            target = edges[EDGE * edge + TARGET]
            watch = rule[before, target]
            if watch < 0:
                continue
            after = 1 if watch == _START else watch
            if numbers[after, target] < 0:
                numbers[after, target] = count
                spots[count, 0], spots[count, 1] = target, after
                count += 1
            found[ways, 0], found[ways, 1], found[ways, 2] = edge, at, numbers[after, target]
            found[ways, 3] = watch == _START
            ways += 1
        at += 1
    return spots[:count].copy(), found[:ways].copy()
