"""The timed automaton of a mission, learned step by step: what configurations allow, and when.

A location is a configuration with what the clocks of windows say, which measure nothing. The rules are run once in each
configuration; what its clocks are compared with is taken for what it was anywhere, as long as it grows nowhere.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import product
from typing import NamedTuple

from checker.engines.reference import crowded
from checker.engines.zones.automaton import Automaton, Constraint, Edge, Location
from checker.engines.zones.bounds import NONE
from semantics.state.configuration import Configuration
from semantics.timing.clocks import BOUND, FREE, Clock, Passage, Situation, Sort, TimedStep
from semantics.timing.timing import Window

NOWHERE = (0, NONE)
"""The deadline of where no time passes at all."""


class Place(NamedTuple):
    """A location of a mission: the number of its configuration, and what the clocks of windows say."""

    number: int
    windows: tuple[int, ...] = ()


class Network:
    """What is known of a mission's configurations, and the automaton that they make.

    Attributes:
        situations: One for each configuration, in the order of discovery.
        places: What each location of the automaton is.
        passages: Where steps lead that were taken, and what they do to the clocks.
        grown: Whether a clock is compared with a larger constant than the automaton knows.
    """

    def __init__(self, initial: Configuration, pending: int) -> None:
        self.initial = initial
        self.pending = pending
        self.automaton = Automaton()
        self.numbers: dict[Configuration, int] = {}
        self.situations: list[Situation] = []
        self.columns: list[tuple[int, ...]] = []
        self.places: list[Place] = []
        self.locations: dict[Place, int] = {}
        self.passages: dict[tuple[int, int], tuple[int, Passage]] = {}
        self.lower: dict[Clock, int] = {}
        self.upper: dict[Clock, int] = {}
        self.caps: dict[Clock, int] = {}
        self.grown = False
        self.is_crowded = False
        number = self.number(initial)
        ages = self.situations[number].first_ages()
        self.first = self.location(Place(number, self._windows(number, ages)))
        self.first_ages = self.measured(number, ages)

    # --- configurations

    def number(self, c: Configuration) -> int:
        """Return the number of a configuration, a new one for one that was not met."""
        number = self.numbers.get(c)
        if number is None:
            number = self.numbers[c] = len(self.situations)
            situation = Situation(c)
            self.situations.append(situation)
            for clock, cap in zip(situation.clocks, situation.constants, strict=True):
                self.caps[clock] = max(self.caps.get(clock, 0), cap)
                lower, upper = compared(situation, clock)
                self._compare(self.lower, clock, lower)
                self._compare(self.upper, clock, upper)
            self.columns.append(
                tuple(at for at, clock in enumerate(situation.clocks) if clock.sort is not Sort.WINDOW)
            )
        return number

    def _compare(self, constants: dict[Clock, int], clock: Clock, constant: int) -> None:
        before = constants.get(clock)
        if before is None or constant > before:
            constants[clock] = constant
            self.grown = self.grown or before is not None

    def measured(self, number: int, ages: Iterable[int]) -> tuple[int, ...]:
        """Return the ages of what measures time, clock by clock of a location."""
        several = tuple(ages)
        return tuple(several[at] for at in self.columns[number])

    def _windows(self, number: int, ages: Iterable[int]) -> tuple[int, ...]:
        clocks = self.situations[number].clocks
        return tuple(age for age, clock in zip(ages, clocks, strict=True) if clock.sort is Sort.WINDOW)

    def clocks(self, location: int) -> tuple[Clock, ...]:
        """Return the clocks of a location, from its first."""
        number = self.places[location].number
        return tuple(self.situations[number].clocks[at] for at in self.columns[number])

    def capped(self, location: int, ages: Iterable[int]) -> tuple[int, ...]:
        """Return ages as far as they are ever told apart."""
        return tuple(
            min(age, self.caps[clock]) for age, clock in zip(ages, self.clocks(location), strict=True)
        )

    # --- locations

    def location(self, place: Place) -> int:
        """Return the number of a location, a new one for one that was not met."""
        found = self.locations.get(place)
        if found is not None:
            return found
        situation = self.situations[place.number]
        full = crowded(situation.c, self.pending)
        self.is_crowded = self.is_crowded or full
        deadlines = (NOWHERE,) if full else self._deadlines(place)
        number = self.automaton.add(Location(*self._constants(place.number), deadlines))
        self.locations[place] = number
        self.places.append(place)
        if not full:
            self.automaton.leave(number, self._unknown(place))
        return number

    def constants(self, location: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Return what the clocks of a location are compared with, from below and from above."""
        return self._constants(self.places[location].number)

    def _constants(self, number: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
        situation = self.situations[number]
        clocks = [situation.clocks[at] for at in self.columns[number]]
        return tuple(self.lower[each] for each in clocks), tuple(self.upper[each] for each in clocks)

    def _deadlines(self, place: Place) -> tuple[tuple[int, int], ...]:
        bounds: dict[int, int] = {}
        for clock, most, unless in self.situations[place.number].deadlines:
            if unless is None or self._shown(place, unless) < FREE:
                at = self._index(place.number, clock)
                bounds[at] = min(most, bounds.get(at, most))
        return tuple(bounds.items())

    def _index(self, number: int, clock: int) -> int:
        return self.columns[number].index(clock) + 1

    def _shown(self, place: Place, window: int) -> int:
        clocks = self.situations[place.number].clocks
        return place.windows[sum(each.sort is Sort.WINDOW for each in clocks[:window])]

    def compare(self) -> None:
        """Let all locations know the constants that have grown."""
        self.grown = False
        for location, place in enumerate(self.places):
            self.automaton.compare(location, *self._constants(place.number))

    # --- edges

    def tests(self, place: Place, step: TimedStep) -> list[tuple[Constraint, ...]]:
        """Return what clocks have to show that a step may be taken: one of several is enough."""
        situation = self.situations[place.number]
        if not step.guards:
            return [()]
        found: list[tuple[Constraint, ...]] = []
        for clock, least, most in step.guards:
            if situation.clocks[clock].sort is Sort.WINDOW:
                found += [()] if self._shown(place, clock) >= least else []
            else:
                at = self._index(place.number, clock)
                found.append((Constraint(at, least, NONE if most is None else most),))
        return found

    def _unknown(self, place: Place) -> Iterator[Edge]:
        for at, step in enumerate(self.situations[place.number].steps):
            if step.in_turn:
                yield from (Edge(at, tests) for tests in self.tests(place, step))

    def learn(self, location: int, at: int) -> None:
        """Run the rules where a step leads that is taken for the first time."""
        place = self.places[location]
        step = self.situations[place.number].steps[at]
        found = tuple(self._known(place, at, step))
        others = (edge for edge in self.automaton.out[location] if edge.step != at)
        self.automaton.leave(location, (*others, *found))

    def passage(self, number: int, at: int, step: TimedStep) -> tuple[int, Passage]:
        """Return where a step leads, and what it does to the clocks."""
        known = self.passages.get((number, at))
        if known is None:
            target = self.number(step.transition.target)
            known = target, Passage(self.situations[number], step, self.situations[target])
            self.passages[number, at] = known
        return known

    def _known(self, place: Place, at: int, step: TimedStep) -> Iterator[Edge]:
        number, passage = self.passage(place.number, at, step)
        leavings = list(product(*(self._leaving(place.number, each) for each in passage.leaving)))
        entries = list(self._entries(place, number, passage))
        for tests, leaving, (windows, entering) in product(self.tests(place, step), leavings, entries):
            fresh = {clock for clock, _ in leaving if clock is not None}
            sources = tuple(
                0 if source is None or after in fresh else self._index(place.number, source)
                for after, source in enumerate(passage.sources)
                if after in self.columns[number]
            )
            more = tuple(test for _, test in leaving)
            yield Edge(at, (*tests, *more, *entering), self.location(Place(number, windows)), sources)

    def _leaving(self, number: int, leaving: tuple[int, int, int]) -> list[tuple[int | None, Constraint]]:
        """Return how a vehicle may leave where it is restored: as it came, or with a clock that starts anew."""
        restored, aloft, after = leaving
        at = self._index(number, restored)
        return [(None, Constraint(at, 0, after)), (aloft, Constraint(at, after))]

    def _entries(
        self, place: Place, number: int, passage: Passage
    ) -> Iterator[tuple[tuple[int, ...], tuple[Constraint, ...]]]:
        """Yield what windows may say after a step, and what the clocks have to show for that."""
        situation = self.situations[number]
        mission = situation.first.get(Clock(Sort.MISSION))
        choices: list[list[tuple[int, tuple[Constraint, ...]]]] = []
        for after, clock in enumerate(situation.clocks):
            if clock.sort is not Sort.WINDOW:
                continue
            source, clause = passage.sources[after], clock.of
            assert isinstance(clause, int)
            said = FREE if after in passage.freed else 0 if source is None else self._shown(place, source)
            window = situation.timing.clause(clause).step
            assert isinstance(window, Window)
            if said or not situation.by_clauses[clause]:
                choices.append([(said, ())])
            elif window.within is None:
                choices.append([(BOUND, ())])
            else:
                assert mission is not None
                came = passage.sources[mission]
                assert came is not None
                at = self._index(place.number, came)
                choices.append(
                    [
                        (BOUND, (Constraint(at, 0, window.within),)),
                        (FREE, (Constraint(at, window.within + 1),)),
                    ]
                )
        for several in product(*choices):
            yield tuple(said for said, _ in several), tuple(test for _, tests in several for test in tests)


def compared(situation: Situation, clock: Clock) -> tuple[int, int]:
    """Return the largest constants that a clock is compared with, from below and from above."""
    interval = situation.bounds[clock]
    lo, hi = interval.lo or NONE, NONE if interval.hi is None else interval.hi
    match clock.sort:
        case Sort.MISSION:
            return lo + 1, lo + 1
        case Sort.ALOFT:
            return interval.lo + 1, NONE
        case Sort.RESTORED:
            return interval.lo, interval.lo
        case Sort.WINDOW:
            return NONE, NONE
        case _:
            return lo, hi
