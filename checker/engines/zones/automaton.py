"""Timed automata as arrays, as the compiled loops see them: locations with their clocks, edges with their guards.

A clock has a number in the automaton, by which it is known what it is compared with, and stands at an index in each
location, from 1. An edge says of each clock of its target which of its source goes on in it, 0 for none. A clock that
no location has is not remembered.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.arrays import Growing
from checker.engines.zones.bounds import MOST, NONE

UNKNOWN = -1
"""Stands for where the edges of a location begin as long as nobody knows them."""


class Constraint(NamedTuple):
    """A clock, by its index, shows at least so much, and at most so much if that is not `NONE`."""

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
    tests: tuple[Constraint, ...]
    target: int
    sources: tuple[int, ...]


class Location(NamedTuple):
    """Where a timed automaton may be.

    Attributes:
        clocks: The numbers of the clocks that run; of equal ones the oldest is the first.
        deadlines: No time passes once a clock has come to a bound; a bound below 0 lets no time pass at all.
        goal: What is looked for here; None where nothing is.
    """

    clocks: tuple[int, ...] = ()
    deadlines: tuple[tuple[int, int], ...] = ()
    goal: Constraint | None = None


class TooLargeError(Exception):
    """A constant is larger than clocks are compared with."""


LOCATION, EDGE, TEST, DEADLINE = 8, 7, 3, 2
"""How many numbers each of them has."""

SIZE, CLOCKS, DEADLINES, DEADLINES_END, EDGES, EDGES_END, GOAL, LEAST = range(LOCATION)
STEP, TARGET, TESTS, TESTS_END, SOURCES, LEARNED, FIRST = range(EDGE)


def _numbers() -> Growing:
    return Growing(np.int32)


@dataclass(slots=True)
class Automaton:
    """A timed automaton.

    Attributes:
        locations: Of each `LOCATION` numbers: one more than it has clocks, where its parts are, its goal.
        edges: Of each `EDGE` numbers; the last are the number by which its step was learned, and after how many steps
            it was first taken.
        lower, upper: For each clock the largest constant that it is compared with from below and from above.
        rows: The row of each location: those of one row are followed side by side.
        largest: One more than the most clocks that a location has.
    """

    locations: Growing = field(default_factory=_numbers)
    edges: Growing = field(default_factory=_numbers)
    tests: Growing = field(default_factory=_numbers)
    sources: Growing = field(default_factory=_numbers)
    deadlines: Growing = field(default_factory=_numbers)
    clocks: Growing = field(default_factory=_numbers)
    lower: Growing = field(default_factory=_numbers)
    upper: Growing = field(default_factory=_numbers)
    rows: Growing = field(default_factory=_numbers)
    largest: int = 1

    def __len__(self) -> int:
        return len(self.locations) // LOCATION

    def clock(self, lower: int, upper: int) -> int:
        """Return the number of a new clock, which is compared with these constants."""
        _look(lower, upper)
        self.lower.append(lower)
        return self.upper.append(upper)

    def compare(self, clock: int, lower: int, upper: int) -> bool:
        """Let a clock be compared with these constants, too; tell whether that is with more than before."""
        _look(lower, upper)
        before = int(self.lower.room[clock]), int(self.upper.room[clock])
        after = max(before[0], lower), max(before[1], upper)
        self.lower.room[clock], self.upper.room[clock] = after
        return after != before

    def add(self, location: Location) -> int:
        """Return the number of a new location, whose edges nobody knows."""
        begin = len(self.deadlines) // DEADLINE
        for each in location.deadlines:
            _look(each[1])
            self.deadlines.append(*each)
        end = len(self.deadlines) // DEADLINE
        clocks = self.clocks.append(*location.clocks)
        goal, least = (NONE, 0) if location.goal is None else location.goal[:2]
        size = 1 + len(location.clocks)
        self.largest = max(self.largest, size)
        self.rows.append(len(self))
        return self.locations.append(size, clocks, begin, end, UNKNOWN, UNKNOWN, goal, least) // LOCATION

    def leave(self, location: int, edges: Iterable[Edge]) -> None:
        """Say what leads from a location, in the order of the steps."""
        begin = len(self.edges) // EDGE
        for step, tests, target, sources in edges:
            first = len(self.tests) // TEST
            for test in tests:
                self.tests.append(*test)
            at = self.sources.append(*sources)
            self.edges.append(step, target, first, len(self.tests) // TEST, at, NONE, NONE)
        self._record(location)[EDGES : EDGES_END + 1] = begin, len(self.edges) // EDGE

    def location(self, number: int) -> Location:
        """Return a location."""
        size, clocks, begin, end, _, _, goal, least = self._record(number).tolist()
        deadlines = self.deadlines.room[DEADLINE * begin : DEADLINE * end].reshape(-1, DEADLINE).tolist()
        numbers = self.clocks.room[clocks : clocks + size - 1].tolist()
        sought = None if goal < 0 else Constraint(goal, least)
        return Location(tuple(numbers), tuple((clock, most) for clock, most in deadlines), sought)

    def out(self, location: int) -> list[Edge]:
        """Return what leads from a location; nothing where nobody knows."""
        return [self._edge(each) for each in self._edges(location).tolist()]

    def _edge(self, record: list[int]) -> Edge:
        step, target, begin, end, at = record[: SOURCES + 1]
        tests = self.tests.room[TEST * begin : TEST * end].reshape(-1, TEST).tolist()
        sources = self.sources.room[at : at + self._record(target)[SIZE] - 1].tolist()
        return Edge(step, tuple(Constraint(*each) for each in tests), target, tuple(sources))

    def _record(self, location: int) -> NDArray[np.int32]:
        return self.locations.room[LOCATION * location : LOCATION * (location + 1)]

    def _edges(self, location: int) -> NDArray[np.int32]:
        begin, end = self._record(location)[EDGES : EDGES_END + 1]
        return self.edges.room[EDGE * max(begin, 0) : EDGE * max(end, 0)].reshape(-1, EDGE)

    def arrows(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return where the edges that were taken begin and end."""
        locations, edges = self.locations.used.reshape(-1, LOCATION), self.edges.used.reshape(-1, EDGE)
        begins = locations[:, EDGES]
        counts = np.where(begins < 0, 0, locations[:, EDGES_END] - begins)
        order = np.argsort(np.where(counts > 0, begins, len(edges)), kind="stable")
        sources = np.repeat(order, counts[order])
        taken = edges[:, FIRST] >= 0
        return sources[taken], edges[taken, TARGET].astype(np.int64)

    def firsts(self, location: int) -> list[tuple[int, int]]:
        """Return each step of a location that was taken, with the number of steps before it at the least."""
        return [(int(each[STEP]), int(each[FIRST])) for each in self._edges(location) if each[FIRST] >= 0]

    def forget(self) -> None:
        """Forget which edges were taken."""
        self.edges.used[FIRST::EDGE] = NONE


def _look(*constants: int) -> None:
    if max(constants) > MOST:
        raise TooLargeError(f"{max(constants):,} ticks are more than the engine 'fast' counts ({MOST:,})")
