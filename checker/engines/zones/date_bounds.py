"""The dates of steps, by zones: the least and the greatest value of a clock that is never reset.

The greatest value is counted up to a constant. Beyond it, there is no latest date if some run to the step contains a
cycle (`ZoneTimes.goes_round`); else the constant grows.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence, Set
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from checker.engines.timed.answers import NO_SPAN, DateSpan, TakenStep
from checker.engines.zones.difference_bounds import FREE, MOST
from checker.engines.zones.earliest_dates import Dates, Zone, tested, whole
from checker.engines.zones.first_run import run_of
from checker.engines.zones.observer_walk import ObserverClock
from checker.engines.zones.observers import Meter, Observer
from checker.engines.zones.timed_automaton import Constraint, Edge
from checker.engines.zones.timed_automaton_of import Network
from checker.engines.zones.zone_search import Search

Asked = list[list[tuple[Edge, int]]]
"""For each location the edges of requested steps, each with the number of its set."""


class Searched(Protocol):
    """The results of the mission's search (`ZoneTimes`) that spans need."""

    network: Network
    order: NDArray[np.int64]

    @property
    def enough(self) -> int:
        """Return the first constant of an additional clock."""

    def explored(self, observer: Observer) -> tuple[Observer, Search]:
        """Search the automaton of an observer."""

    def goes_round(self, observer: Observer, dates: Dates) -> bool:
        """Return whether a run contains a cycle."""


class Spans:
    """The dates at which a step of each given set is taken."""

    def __init__(self, times: Searched, steps: Sequence[Set[TakenStep]]) -> None:
        self.times = times
        self.steps = steps
        self.sets: dict[tuple[int, int], list[int]] = {}
        for number, several in enumerate(steps):
            for place, step in several:
                self.sets.setdefault((int(times.order[place]), step), []).append(number)

    def found(self) -> list[DateSpan]:
        """Return the earliest and the latest date of each set."""
        if not self.sets:
            return [NO_SPAN] * len(self.steps)
        return [DateSpan(*each) for each in zip(self._earliest(), self._latest(), strict=True)]

    def _watched(self, meter: Meter) -> tuple[Observer, Search, Asked]:
        """Search with a clock that runs from the start."""
        network = self.times.network
        rule = np.full((2, len(network.automaton)), ObserverClock.ON, np.int8)
        rule[ObserverClock.OFF] = ObserverClock.START
        observer, search = self.times.explored(Observer(network, rule, meter))
        rows = network.of_locations.used[observer.locations].tolist()
        asked = [
            [
                (edge, number)
                for edge in observer.automaton.out(place)
                for number in self.sets.get((row, edge.step), ())
            ]
            for place, row in enumerate(rows)
        ]
        return observer, search, asked

    def _earliest(self) -> list[float]:
        observer, search, asked = self._watched(Meter(upper=MOST))
        found = [math.inf] * len(self.steps)
        for _, place, zone, edge, number in _taken(search, asked):
            clock = observer.clock(place)
            if -zone[0, clock] < found[number]:
                shown = tested(zone, edge.tests)
                found[number] = found[number] if shown is None else min(found[number], -int(shown[0, clock]))
        return found

    def _latest(self) -> list[float]:
        most, found = self.times.enough, [-math.inf] * len(self.steps)
        open_ones = {number for number, each in enumerate(self.steps) if each}
        while open_ones:
            observer, search, asked = self._watched(Meter(most + 1))
            late: dict[int, int] = {}
            for at, place, zone, edge, number in _taken(search, asked):
                clock = observer.clock(place)
                if number not in open_ones or number in late or zone[clock, 0] <= found[number]:
                    continue
                shown = tested(zone, edge.tests)
                if shown is not None and shown[clock, 0] >= FREE:
                    late[number] = at
                elif shown is not None:
                    found[number] = max(found[number], int(shown[clock, 0]))
            open_ones = {
                number
                for number, at in late.items()
                if not self._has_no_end(observer, search, asked, number, at, most)
            }
            found = [
                math.inf if each in late and each not in open_ones else last
                for each, last in enumerate(found)
            ]
            most *= 4
        return found

    def _has_no_end(
        self, observer: Observer, search: Search, asked: Asked, number: int, zone: int, most: int
    ) -> bool:
        """Return whether the first run that takes a step later than so much contains a cycle."""

        def wanted(place: int) -> list[Zone]:
            late = Constraint(observer.clock(place), most + 1)
            size = len(observer.automaton.location(place).clocks)
            shown = [
                tested(whole(size), (*edge.tests, late)) for edge, each in asked[place] if each == number
            ]
            return [each for each in shown if each is not None]

        dates = run_of(search, wanted, search.depth(zone))
        return self.times.goes_round(observer, dates)


def _taken(search: Search, asked: Asked) -> Iterator[tuple[int, int, Zone, Edge, int]]:
    """Yield each zone with each requested edge from its location: zone, location, matrix, edge, and the edge's set."""
    for at in range(search.count):
        place = search.place(at)
        if asked[place]:
            zone = search.matrix(at)
            for edge, number in asked[place]:
                yield at, place, zone, edge, number
