"""A mission's automaton with one additional clock, which measures how long a proposition is awaited."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.arrays import Growing
from checker.engines.zones.difference_bounds import NONE
from checker.engines.zones.observer_walk import ObserverClock, Rule, walk
from checker.engines.zones.participants import WatchedParticipants
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
    LEARNED,
    LEAST,
    LOCATION,
    SIZE,
    SOURCES,
    TARGET,
    TEST,
    TESTS,
    TESTS_END,
    TimedAutomaton,
)
from checker.engines.zones.timed_automaton_of import NOWHERE, Network

Ints = NDArray[np.int32]


CUT_OFF: Final = -1
"""The state that a rule gives to a location that is left out."""


class ObservedLocation(NamedTuple):
    """A location of the mission's automaton, with the state of the additional clock."""

    location: int
    watch: ObserverClock


@dataclass(frozen=True, slots=True)
class Meter:
    """The constants of the additional clock.

    Attributes:
        lower, upper: The largest constants of its lower and of its upper bounds.
        most: The last value at which a step is taken.
        goal: The goal of a search: a state of the clock, and its least value.
    """

    lower: int = NONE
    upper: int = NONE
    most: int = NONE
    goal: tuple[ObserverClock, int] | None = None


@dataclass(slots=True)
class Observer:
    """A mission's automaton with an additional clock.

    Attributes:
        network: The mission's automaton.
        rule: Determines when the clock runs.
        meter: The constants of the clock.
        is_exact: Whether each clock's larger constant serves for both kinds of bounds; extrapolation then adds only
            bisimilar values.
        reads: In local time the columns that decide the rule in each of the mission's locations; None for one clock.
        locations, watches: The mission's location of each of its own, and the state of the clock there.
        participants: Those of its edges; None for one clock.
    """

    network: Network
    rule: Rule
    meter: Meter
    is_exact: bool = False
    reads: NDArray[np.uint64] | None = None
    automaton: TimedAutomaton = field(default_factory=TimedAutomaton)
    locations: Ints = field(init=False)
    watches: Ints = field(init=False)
    meter_clock: int = field(init=False)
    participants: WatchedParticipants | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        base = self.network.automaton
        for least, most in zip(base.lower.used.tolist(), base.upper.used.tolist(), strict=True):
            self.automaton.clock(*(max(least, most),) * 2 if self.is_exact else (least, most))
        self.meter_clock = self.automaton.clock(self.meter.lower, self.meter.upper)
        if self.reads is not None and self.network.participants is not None:
            self.participants = WatchedParticipants(self.network.participants, self.automaton, self.reads)
        spots, edges = walk(base.locations.used, base.edges.used, self.rule, self.network.first)
        self.locations, self.watches = spots.T
        self._add_locations(np.bincount(edges[:, 1], minlength=len(spots)))
        self._add_edges(*edges.T)
        if self.participants is not None:
            self.participants.join()

    def spot(self, number: int) -> ObservedLocation:
        """Return the mission's location of a location, and the state of the clock there."""
        return ObservedLocation(int(self.locations[number]), ObserverClock(int(self.watches[number])))

    def clock(self, number: int) -> int:
        """Return the index of the additional clock in a location, 0 where it doesn't run."""
        off = self.watches[number] == ObserverClock.OFF
        return 0 if off else int(self.automaton.locations.used[LOCATION * number + SIZE]) - 1

    def first_ages(self) -> tuple[int, ...]:
        """Return the initial clock values."""
        ages = self.network.first_ages
        return ages if self.watches[0] == ObserverClock.OFF else (*ages, 0)

    def _add_locations(self, ways: NDArray[np.int64]) -> None:
        """Add the locations, with so many edges each."""
        base, found = self.network.automaton, self.automaton
        records = base.locations.used.reshape(-1, LOCATION)[self.locations]
        runs, ends = self.watches != ObserverClock.OFF, self.watches == ObserverClock.END
        own = records[:, SIZE].copy()
        more = np.full((len(records), 1), self.meter_clock, np.int32)
        begins = records[:, CLOCKS].copy()
        records[:, CLOCKS], _ = _extend(
            found.clocks, base.clocks.used[:, None], (begins, begins + own - 1), runs, more
        )
        late = runs & (self.meter.most >= 0) | ends
        process = 0 if self.participants is None else self.participants.process
        more = np.stack([own, np.full_like(own, self.meter.most), np.full_like(own, process)], axis=1)
        more[ends] = *NOWHERE, process
        begins, last = (
            records[:, DEADLINES].copy(),
            np.where(ends, records[:, DEADLINES], records[:, DEADLINES_END]),
        )
        records[:, DEADLINES], records[:, DEADLINES_END] = _extend(
            found.deadlines, base.deadlines.used.reshape(-1, DEADLINE), (begins, last), late, more
        )
        records[:, SIZE] += runs
        records[:, EDGES_END] = np.cumsum(ways)
        records[:, EDGES] = records[:, EDGES_END] - ways
        if self.meter.goal is not None:
            sought = runs & (self.watches == self.meter.goal[0])
            records[sought, GOAL], records[sought, LEAST] = own[sought], self.meter.goal[1]
        _put(found.locations, records)
        _put(found.rows, np.arange(len(records)))
        found.largest = int(records[:, SIZE].max())

    def _add_edges(self, edges: Ints, sources: Ints, targets: Ints, starts: Ints) -> None:
        """Add the edges: those of the mission, from one location to another; `starts` is 1 where the clock starts."""
        base, found = self.network.automaton, self.automaton
        records = base.edges.used.reshape(-1, EDGE)[edges]
        size = base.locations.used[SIZE::LOCATION]
        own, kept = size[self.locations[sources]], size[self.locations[targets]] - 1
        ran, runs = (self.watches[each] != ObserverClock.OFF for each in (sources, targets))
        more = np.stack([own, np.zeros_like(own), np.full_like(own, self.meter.most)], axis=1)
        records[:, TESTS], records[:, TESTS_END] = _extend(
            found.tests,
            base.tests.used.reshape(-1, TEST),
            (records[:, TESTS].copy(), records[:, TESTS_END].copy()),
            ran & (self.meter.most >= 0),
            more,
        )
        begins = records[:, SOURCES].copy()
        goes_on = np.where(ran & (starts == 0), own, 0)[:, None]
        records[:, SOURCES], _ = _extend(
            found.sources, base.sources.used[:, None], (begins, begins + kept), runs, goes_on
        )
        if self.participants is not None:
            records[:, FOOTPRINT] = self.participants.footprints(
                records[:, FOOTPRINT], self.locations[sources], self.locations[targets]
            )
        records[:, TARGET] = targets
        records[:, LEARNED] = records[:, FIRST] = NONE
        _put(found.edges, records)


def _extend(
    to: Growing, records: Ints, ranges: tuple[Ints, Ints], chosen: NDArray[np.bool_], more: Ints
) -> tuple[Ints, Ints]:
    """Add ranges of records, the chosen ones with one more record at the end; return the ranges where they are."""
    begins, ends = (each.astype(np.int64) for each in ranges)
    sizes = ends - begins
    lasts = np.cumsum(sizes + chosen)
    firsts = lasts - sizes - chosen
    found = np.empty((int(lasts[-1]) if len(lasts) else 0, records.shape[1]), np.int32)
    found[_counted(firsts, sizes)] = records[_counted(begins, sizes)]
    found[lasts[chosen] - 1] = more[chosen]
    _put(to, found)
    return firsts.astype(np.int32), lasts.astype(np.int32)


def _counted(begins: NDArray[np.int64], sizes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the numbers in ranges that begin there and are so long."""
    ends = np.cumsum(sizes)
    found: NDArray[np.int64] = np.arange(int(sizes.sum())) + np.repeat(begins - ends + sizes, sizes)
    return found


def _put(to: Growing, numbers: NDArray[np.int32] | NDArray[np.int64]) -> None:
    """Add numbers to an array."""
    first = to.extend(numbers.size)
    to.room[first : to.size] = numbers.ravel()
