"""Timed automata as arrays for the compiled loops: locations with their clocks, edges with their guards.

A clock has a number in the automaton, which identifies its constants, and an index from 1 in each location. An edge
maps each clock of its target to the clock of its source that continues in it, or to 0. The other clocks of the source
are dropped.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.contract import TickError
from checker.engines.fast.compiled.arrays import Growing
from checker.engines.zones.difference_bounds import MOST, NONE

UNKNOWN = -1
"""The start of a location's edges before they are worked out."""


class Constraint(NamedTuple):
    """A closed interval for a clock, given by its index; without an upper bound where `most` is `NONE`."""

    clock: int
    least: int
    most: int = NONE


class Edge(NamedTuple):
    """An edge between two locations.

    Attributes:
        step: The number of its step in its location; several edges of one step have different guards.
        tests: Its guard, a conjunction.
        target: The target location.
        sources: For each clock of the target the clock that continues in it, 0 for a reset one.
        footprint: The number of its footprint in local time.
    """

    step: int
    tests: tuple[Constraint, ...]
    target: int
    sources: tuple[int, ...]
    footprint: int = NONE


class Location(NamedTuple):
    """A location of a timed automaton.

    Attributes:
        clocks: The numbers of the running clocks; of equal ones the oldest is the first.
        deadlines: Pairs of a clock and its upper bound. Time stops passing at a bound; a bound below 0 makes the
            location urgent. Unlike an invariant, a deadline doesn't prevent entry.
        goal: The constraint that a search looks for here; None for none.
    """

    clocks: tuple[int, ...] = ()
    deadlines: tuple[tuple[int, int], ...] = ()
    goal: Constraint | None = None


LOCATION, EDGE, TEST, DEADLINE = 8, 8, 3, 3
"""The length of each kind of record."""

SIZE, CLOCKS, DEADLINES, DEADLINES_END, EDGES, EDGES_END, GOAL, LEAST = range(LOCATION)
STEP, TARGET, TESTS, TESTS_END, SOURCES, LEARNED, FIRST, FOOTPRINT = range(EDGE)


def _numbers() -> Growing:
    return Growing(np.int32)


@dataclass(slots=True)
class TimedAutomaton:
    """A timed automaton.

    Attributes:
        locations: Records of `LOCATION` numbers: one more than the count of its clocks, the ranges of its parts, its
            goal.
        edges: Records of `EDGE` numbers; the last three are the number of the learned step, the number of steps before
            the edge was first taken, and the number of its footprint.
        deadlines: Records of `DEADLINE` numbers: the clock, its bound, and the process that waits no longer.
        lower, upper: For each clock the largest constant of its lower and of its upper bounds.
        rows: The row of each location; the locations of one row are expanded together.
        takes_from, takes: For each footprint the range of its participants, and those.
        processes: The number of processes in local time.
        largest: One more than the most clocks of any location.
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
    takes_from: Growing = field(default_factory=_numbers)
    takes: Growing = field(default_factory=_numbers)
    processes: int = 1
    largest: int = 1

    def __len__(self) -> int:
        return len(self.locations) // LOCATION

    def clock(self, lower: int, upper: int) -> int:
        """Return the number of a new clock with these largest constants."""
        _look(lower, upper)
        self.lower.append(lower)
        return self.upper.append(upper)

    def constants(self, clock: int) -> tuple[int, int]:
        """Return a clock's largest constants, of its lower and of its upper bounds."""
        return int(self.lower.room[clock]), int(self.upper.room[clock])

    def compare(self, clock: int, lower: int, upper: int) -> bool:
        """Raise a clock's constants to at least these; return whether one of them grew."""
        _look(lower, upper)
        before = self.constants(clock)
        after = max(before[0], lower), max(before[1], upper)
        self.lower.room[clock], self.upper.room[clock] = after
        return after != before

    def add(self, location: Location, deadlines: Iterable[Sequence[int]] | None = None) -> int:
        """Return the number of a new location, its edges still unknown; with `deadlines`, those of processes."""
        begin = len(self.deadlines) // DEADLINE
        for clock, most, process in (
            ((*each, 0) for each in location.deadlines) if deadlines is None else deadlines
        ):
            _look(most)
            self.deadlines.append(clock, most, process)
        end = len(self.deadlines) // DEADLINE
        clocks = self.clocks.append(*location.clocks)
        goal, least = (NONE, 0) if location.goal is None else location.goal[:2]
        size = 1 + len(location.clocks)
        self.largest = max(self.largest, size)
        self.rows.append(len(self))
        return self.locations.append(size, clocks, begin, end, UNKNOWN, UNKNOWN, goal, least) // LOCATION

    def leave(self, location: int, edges: Iterable[Edge]) -> None:
        """Set the edges of a location, in the order of their steps."""
        begin = len(self.edges) // EDGE
        for step, tests, target, sources, footprint in edges:
            first = len(self.tests) // TEST
            for test in tests:
                self.tests.append(*test)
            at = self.sources.append(*sources)
            self.edges.append(step, target, first, len(self.tests) // TEST, at, NONE, NONE, footprint)
        self._record(location)[EDGES : EDGES_END + 1] = begin, len(self.edges) // EDGE

    def location(self, number: int) -> Location:
        """Return a location."""
        size, clocks, _, _, _, _, goal, least = self._record(number).tolist()
        deadlines: dict[int, int] = {}
        for clock, most, _ in self.deadlines_of(number):
            deadlines[clock] = min(most, deadlines.get(clock, most))
        numbers = self.clocks.room[clocks : clocks + size - 1].tolist()
        sought = None if goal < 0 else Constraint(goal, least)
        return Location(tuple(numbers), tuple(deadlines.items()), sought)

    def deadlines_of(self, location: int) -> list[list[int]]:
        """Return the deadlines of a location: the clock, its bound, and the process of each."""
        begin, end = self._record(location)[DEADLINES : DEADLINES_END + 1].tolist()
        found: list[list[int]] = (
            self.deadlines.room[DEADLINE * begin : DEADLINE * end].reshape(-1, DEADLINE).tolist()
        )
        return found

    def out(self, location: int) -> list[Edge]:
        """Return the edges of a location; none before they are worked out."""
        return [self._edge(each) for each in self._edges(location).tolist()]

    def _edge(self, record: list[int]) -> Edge:
        step, target, begin, end, at, _, _, footprint = record
        tests = self.tests.room[TEST * begin : TEST * end].reshape(-1, TEST).tolist()
        sources = self.sources.room[at : at + self._record(target)[SIZE] - 1].tolist()
        return Edge(step, tuple(Constraint(*each) for each in tests), target, tuple(sources), footprint)

    def _record(self, location: int) -> NDArray[np.int32]:
        return self.locations.room[LOCATION * location : LOCATION * (location + 1)]

    def _edges(self, location: int) -> NDArray[np.int32]:
        begin, end = self._record(location)[EDGES : EDGES_END + 1]
        return self.edges.room[EDGE * max(begin, 0) : EDGE * max(end, 0)].reshape(-1, EDGE)

    def arrows(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the sources and the targets of the edges."""
        locations, edges = self.locations.used.reshape(-1, LOCATION), self.edges.used.reshape(-1, EDGE)
        begins = locations[:, EDGES]
        counts = np.where(begins < 0, 0, locations[:, EDGES_END] - begins)
        order = np.argsort(np.where(counts > 0, begins, len(edges)), kind="stable")
        return np.repeat(order, counts[order]), edges[:, TARGET].astype(np.int64)

    def left(self) -> NDArray[np.int64]:
        """Return the locations whose edges are known, in the order in which they were worked out."""
        begins = self.locations.used[EDGES::LOCATION]
        known = np.flatnonzero(begins != UNKNOWN)
        return known[np.argsort(begins[known], kind="stable")]

    def spill(self, folder: Path) -> None:
        """Move the arrays that grow with the locations to files in a folder.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        for each in (
            self.locations,
            self.edges,
            self.tests,
            self.sources,
            self.deadlines,
            self.clocks,
            self.rows,
        ):
            each.spill(folder)

    def firsts(self, location: int) -> list[tuple[int, int]]:
        """Return each taken step of a location, with the least number of steps before it."""
        return [(int(each[STEP]), int(each[FIRST])) for each in self._edges(location) if each[FIRST] >= 0]

    def forget(self) -> None:
        """Mark all edges as not taken."""
        self.edges.used[FIRST::EDGE] = NONE


def _look(*constants: int) -> None:
    if max(constants) > MOST:
        raise TickError(f"{max(constants):,} ticks are more than the engine 'fast' counts ({MOST:,})")
