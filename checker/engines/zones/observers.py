"""A mission's automaton with one additional clock, which measures how long a proposition is awaited."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum, auto
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.zones.difference_bounds import NONE
from checker.engines.zones.participants import WatchedParticipants
from checker.engines.zones.timed_automaton import Constraint, Edge, Location, TimedAutomaton
from checker.engines.zones.timed_automaton_of import NOWHERE, Network


class ObserverClock(Enum):
    """The state of the additional clock in a location."""

    OFF = auto()
    ON = auto()
    START = auto()
    END = auto()
    """The clock is read, and the location has no edges."""


class ObservedLocation(NamedTuple):
    """A location of the mission's automaton, with the state of the additional clock."""

    location: int
    watch: ObserverClock


Rule = Callable[[ObserverClock, int], ObserverClock | None]
"""The state of the clock in a location, given its state before; None to cut off the location."""


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
        participants: Those of its edges; None for one clock.
    """

    network: Network
    rule: Rule
    meter: Meter
    is_exact: bool = False
    reads: NDArray[np.uint64] | None = None
    automaton: TimedAutomaton = field(default_factory=TimedAutomaton)
    spots: list[ObservedLocation] = field(default_factory=list)
    numbers: dict[ObservedLocation, int] = field(default_factory=dict)
    meter_clock: int = field(init=False)
    participants: WatchedParticipants | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        lower, upper = (
            each.used.tolist() for each in (self.network.automaton.lower, self.network.automaton.upper)
        )
        for least, most in zip(lower, upper, strict=True):
            self.automaton.clock(*(max(least, most),) * 2 if self.is_exact else (least, most))
        self.meter_clock = self.automaton.clock(self.meter.lower, self.meter.upper)
        if self.reads is not None and self.network.participants is not None:
            self.participants = WatchedParticipants(self.network.participants, self.automaton, self.reads)
        watch = self.rule(ObserverClock.OFF, self.network.first)
        assert watch is not None
        self._add(self.network.first, watch)
        for number, spot in enumerate(self.spots):  # grows during the loop
            self.automaton.leave(number, [] if spot.watch is ObserverClock.END else self._edges(spot))
        if self.participants is not None:
            self.participants.join()

    def clock(self, number: int) -> int:
        """Return the index of the additional clock in a location, 0 where it doesn't run."""
        off = self.spots[number].watch is ObserverClock.OFF
        return 0 if off else len(self.automaton.location(number).clocks)

    def first_ages(self) -> tuple[int, ...]:
        """Return the initial clock values."""
        ages = self.network.first_ages
        return ages if self.spots[0].watch is ObserverClock.OFF else (*ages, 0)

    def _add(self, location: int, watch: ObserverClock) -> int:
        spot = ObservedLocation(location, ObserverClock.ON if watch is ObserverClock.START else watch)
        if spot in self.numbers:
            return self.numbers[spot]
        clocks, _, goal = self.network.automaton.location(location)
        deadlines = self.network.automaton.deadlines_of(location)
        process = 0 if self.participants is None else self.participants.process
        if spot.watch is not ObserverClock.OFF:
            clocks = (*clocks, self.meter_clock)
            if self.meter.goal is not None and self.meter.goal[0] is spot.watch:
                goal = Constraint(len(clocks), self.meter.goal[1])
            if spot.watch is ObserverClock.END:
                deadlines = [[*NOWHERE, process]]
            elif self.meter.most >= 0:
                deadlines.append([len(clocks), self.meter.most, process])
        self.spots.append(spot)
        number = self.numbers[spot] = self.automaton.add(Location(clocks, (), goal), deadlines)
        return number

    def _edges(self, spot: ObservedLocation) -> list[Edge]:
        found = []
        clock = len(self.network.automaton.location(spot.location).clocks) + 1
        runs = spot.watch is ObserverClock.ON
        for step, tests, target, sources, footprint in self.network.automaton.out(spot.location):
            watch = self.rule(spot.watch, target)
            if watch is None:
                continue
            if watch is not ObserverClock.OFF:
                sources = (*sources, clock if runs and watch is not ObserverClock.START else 0)  # noqa: PLW2901
            late = (Constraint(clock, 0, self.meter.most),) if runs and self.meter.most >= 0 else ()
            if self.participants is not None:
                footprint = self.participants.footprint(footprint, spot.location, target)  # noqa: PLW2901
            found.append(Edge(step, (*tests, *late), self._add(target, watch), sources, footprint))
        return found
