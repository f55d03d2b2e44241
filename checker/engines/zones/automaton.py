"""Timed automata as arrays, as the compiled loops see them: locations with their clocks, edges with their guards.

Clocks are numbered from 1 in each location; an edge says of each clock of its target which of its source goes on in it,
0 for none. A clock that no location has is not remembered.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from checker.engines.fast.arrays import Growing
from checker.engines.zones.bounds import MOST, NONE

UNKNOWN = -1
"""Stands for the target of an edge as long as nobody has taken it."""


class Constraint(NamedTuple):
    """A clock shows at least so much, and at most so much if that is not `NONE`."""

    clock: int
    least: int
    most: int = NONE


class Edge(NamedTuple):
    """What leads from one location to another.

    Attributes:
        step: The number of its step in its location; edges of one step may be taken at different ages.
        tests: What all of the clocks have to show.
        target: The location that it leads to.
        sources: For each clock of the target the one that goes on in it, 0 where it starts.
    """

    step: int
    tests: tuple[Constraint, ...] = ()
    target: int = UNKNOWN
    sources: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Location:
    """Where a timed automaton may be.

    Attributes:
        lower, upper: For each clock the largest constant that it is compared with from below and from above.
        deadlines: No time passes once a clock has come to a bound; a bound below 0 lets no time pass at all.
        goal: What is looked for here; None where nothing is.
    """

    lower: tuple[int, ...] = ()
    upper: tuple[int, ...] = ()
    deadlines: tuple[tuple[int, int], ...] = ()
    goal: Constraint | None = None


class TooLargeError(Exception):
    """A constant is larger than clocks are compared with."""


LOCATION, EDGE, TEST, DEADLINE = 8, 6, 3, 2
"""How many numbers each of them has."""

SIZE, DEADLINES, DEADLINES_END, EDGES, EDGES_END, CONSTANTS, GOAL, LEAST = range(LOCATION)
STEP, TARGET, TESTS, TESTS_END, SOURCES, FIRST = range(EDGE)


def _numbers() -> Growing:
    return Growing(np.int32)


@dataclass(slots=True)
class Automaton:
    """A timed automaton.

    Attributes:
        locations: Of each `LOCATION` numbers: one more than it has clocks, where its parts are, its goal.
        edges: Of each `EDGE` numbers; the last is the group that it was first taken in.
        largest: One more than the most clocks that a location has.
    """

    locations: Growing = field(default_factory=_numbers)
    edges: Growing = field(default_factory=_numbers)
    tests: Growing = field(default_factory=_numbers)
    sources: Growing = field(default_factory=_numbers)
    deadlines: Growing = field(default_factory=_numbers)
    lower: Growing = field(default_factory=_numbers)
    upper: Growing = field(default_factory=_numbers)
    all: list[Location] = field(default_factory=list)
    out: list[tuple[Edge, ...]] = field(default_factory=list)
    largest: int = 1

    def add(self, location: Location) -> int:
        """Return the number of a new location."""
        _look(location)
        begin = len(self.deadlines) // DEADLINE
        for each in location.deadlines:
            self.deadlines.append(*each)
        end = len(self.deadlines) // DEADLINE
        constants = self.lower.append(NONE, *location.lower)
        self.upper.append(NONE, *location.upper)
        goal, least = (NONE, 0) if location.goal is None else location.goal[:2]
        size = 1 + len(location.lower)
        self.largest = max(self.largest, size)
        self.all.append(location)
        self.out.append(())
        return self.locations.append(size, begin, end, 0, 0, constants, goal, least) // LOCATION

    def leave(self, location: int, edges: Iterable[Edge]) -> None:
        """Say what leads from a location, whatever was said before, in the order of the steps."""
        several = tuple(sorted(edges, key=lambda edge: edge.step))
        begin = len(self.edges) // EDGE
        for step, tests, target, sources in several:
            first = len(self.tests) // TEST
            for test in tests:
                self.tests.append(*test)
            at = self.sources.append(*sources)
            self.edges.append(step, target, first, len(self.tests) // TEST, at, NONE)
        self.out[location] = several
        self.locations.room[LOCATION * location + EDGES] = begin
        self.locations.room[LOCATION * location + EDGES_END] = begin + len(several)

    def compare(self, location: int, lower: Sequence[int], upper: Sequence[int]) -> None:
        """Say anew what the clocks of a location are compared with."""
        begin = int(self.locations.room[LOCATION * location + CONSTANTS]) + 1
        self.lower.room[begin : begin + len(lower)] = lower
        self.upper.room[begin : begin + len(upper)] = upper

    def firsts(self, location: int) -> list[tuple[int, int]]:
        """Return each step of a location that was taken, with the group that it was first taken in."""
        begin, end = self.locations.room[LOCATION * location + EDGES : LOCATION * location + EDGES_END + 1]
        edges = self.edges.room[EDGE * begin : EDGE * end].reshape(-1, EDGE)
        return [(int(each[STEP]), int(each[FIRST])) for each in edges if each[FIRST] >= 0]

    def forget(self) -> None:
        """Forget which edges were taken."""
        self.edges.used[FIRST::EDGE] = NONE


def _look(location: Location) -> None:
    constants = (*location.lower, *location.upper, *(most for _, most in location.deadlines))
    if max(constants, default=0) > MOST:
        raise TooLargeError(f"{max(constants):,} ticks are more than the engine 'fast' counts ({MOST:,})")
