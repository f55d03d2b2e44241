"""What zones tell of time."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from functools import cached_property
from typing import TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from checker.engines.runs import Run
from checker.engines.tick_times import control_pairs
from checker.engines.times import Moments, Span, Stop, TakenStep, Wait
from checker.engines.zones.automaton import (
    EDGE,
    EDGES,
    EDGES_END,
    FIRST,
    LOCATION,
    RULE,
    STEP,
    Constraint,
)
from checker.engines.zones.bounds import MOST
from checker.engines.zones.dates import Dates, Zone, tested, whole
from checker.engines.zones.first_run import run_of
from checker.engines.zones.network import Network
from checker.engines.zones.observers import Meter, Observer, Rule, Watch
from checker.engines.zones.search import Search
from checker.limits import look
from checker.properties.durations import NEVER
from semantics.environment import Says
from semantics.properties.propositions import Proposition, holds
from semantics.state.configuration import Transition
from semantics.timing.actor_clocks import Clock, Sort, is_restored
from semantics.timing.clocks import Situation, TimedStep

Made = TypeVar("Made")


class OfRows(Sequence[Made]):
    """What is made of rows, by their numbers: each anew where it is looked at."""

    def __init__(self, make: Callable[[int], Made], rows: NDArray[np.int64]) -> None:
        self.make = make
        self.rows = rows

    def __len__(self) -> int:
        return len(self.rows)

    @overload
    def __getitem__(self, number: int) -> Made: ...

    @overload
    def __getitem__(self, number: slice) -> Sequence[Made]: ...

    def __getitem__(self, number: int | slice) -> Made | Sequence[Made]:
        if isinstance(number, slice):
            return OfRows(self.make, self.rows[number])
        return self.make(int(self.rows[number]))


class ZoneTimes:
    """Answers from a search through zones.

    Attributes:
        reached: The locations that were reached.
        order: The rows that were reached, in the order of discovery.
    """

    def __init__(self, network: Network, search: Search) -> None:
        self.network = network
        self.search = search
        self.initial = network.initial
        self.reached: NDArray[np.int64] = np.flatnonzero(search.heads.used >= 0)
        self.order: NDArray[np.int64] = search.order

    @property
    def searched(self) -> str:
        """Over what it searched, in words."""
        return f"{self.search.count:,} zones"

    @property
    def situations(self) -> Sequence[Situation]:
        """What time means in each configuration."""
        return OfRows(self.network.situation, self.order)

    @cached_property
    def _by_place(self) -> dict[int, NDArray[np.int64]]:
        return self.search.by_place()

    def _zones(self, place: int) -> Iterator[tuple[int, Zone]]:
        """Yield the zones of a configuration, each with its location."""
        for location in self.network.locations(int(self.order[place])):
            for zone in self._by_place.get(location, ()):
                yield location, self.search.matrix(int(zone))

    # --- of configurations

    def firsts_of(self, place: int) -> dict[int, int]:
        """Return each step that is taken in a configuration, with the number of steps before it at the least."""
        found: dict[int, int] = {}
        for location in self.network.locations(int(self.order[place])):
            for step, depth in self.network.automaton.firsts(location):
                found[step] = min(depth, found.get(step, depth))
        return found

    def taken(self, place: int) -> set[int]:
        """Return the steps of a configuration that are taken at some time."""
        return set(self.firsts_of(place))

    def taken_rules(self) -> NDArray[np.int32]:
        """Return the rule of each step that is taken in a configuration, once."""
        locations = self.network.automaton.locations.used.reshape(-1, LOCATION)
        edges = self.network.automaton.edges.used.reshape(-1, EDGE)
        counts = np.maximum(locations[:, EDGES_END] - locations[:, EDGES], 0)
        begins = np.argsort(np.where(counts > 0, locations[:, EDGES], len(edges)), kind="stable")
        rows = np.repeat(self.network.of_locations.used[begins], counts[begins])
        taken = edges[:, FIRST] >= 0
        steps = np.stack([rows[taken], edges[taken, STEP]])
        _, first = np.unique(steps, axis=1, return_index=True)
        found: NDArray[np.int32] = edges[taken, RULE][first]
        return found

    def together(self, place: int) -> Iterator[tuple[Transition, ...]]:
        """Yield each pair of pending controls that may be served at one moment."""
        for one, other in control_pairs(self.situations[place]):
            if any(self._meet(zone, location, one, other) for location, zone in self._zones(place)):
                yield tuple(step.transition for step in (*one, *other))

    def _meet(self, zone: Zone, location: int, one: Sequence[TimedStep], other: Sequence[TimedStep]) -> bool:
        return any(
            tested(zone, (*first, *second)) is not None
            for first in self._ways(location, one)
            for second in self._ways(location, other)
        )

    def _ways(self, location: int, steps: Sequence[TimedStep]) -> Iterator[tuple[Constraint, ...]]:
        for step in steps:
            yield from self.network.tests(location, step) if step.in_turn else [()]

    def unsayable(self, place: int) -> set[int]:
        """Return the clauses whose message cannot be said any more at some time in a configuration."""
        situation = self.situations[place]
        clauses = situation.c.setting.environment
        if Clock(Sort.MISSION) not in situation.first or not any(isinstance(each, Says) for each in clauses):
            return set()
        mission = Clock(Sort.MISSION)
        latest = max(int(zone[self.network.index(at, mission), 0]) for at, zone in self._zones(place))
        ages = [0] * len(situation.clocks)
        ages[situation.first[mission]] = latest
        return set(situation.unsayable(tuple(ages)))

    # --- runs

    def transitions(self, run: Run) -> tuple[Transition, ...]:
        """Return what is done in a run."""
        situation, found = self.network.situation(0), list[Transition]()
        for at in run.steps:
            found.append(situation.steps[at].transition)
            situation = Situation(found[-1].target)
        return tuple(found)

    def run_before(self, place: int, by: Transition | None) -> Run:
        """Return the first run to a configuration, and then a transition if that is ever taken there."""
        situation = self.situations[place]
        steps = {
            at: depth for at, depth in self.firsts_of(place).items() if situation.steps[at].transition == by
        }
        there = set(self.network.locations(int(self.order[place])))

        def goal(location: int) -> list[Zone]:
            if location not in there:
                return []
            size = len(self.network.automaton.location(location).clocks)
            if not steps:
                return [whole(size)]
            edges = (edge for edge in self.network.automaton.out(location) if edge.step in steps)
            return [zone for edge in edges for zone in [tested(whole(size), edge.tests)] if zone is not None]

        if steps:
            return run_of(self.search, goal, min(steps.values()), there).run().then(min(steps))
        zones = (int(self._by_place[each][0]) for each in there if each in self._by_place)
        return run_of(self.search, goal, self.search.depth(min(zones)), there).run()

    # --- durations

    def true_in(self, formula: Proposition) -> list[bool]:
        """Return for each location whether a proposition is true there."""
        found = np.zeros(self.network.size, np.bool_)
        found[self.order] = [holds(formula, c) for c in OfRows(self.network.configuration, self.order)]
        true: list[bool] = found[self.network.of_locations.used].tolist()
        return true

    def waiting(self, asked: Proposition | None, awaited: Proposition) -> Rule:
        """Return when something is waited for: from the start, or from wherever something else is true."""
        inside = [not true for true in self.true_in(awaited)]
        begins = None if asked is None else self.true_in(asked)

        def rule(before: Watch, location: int) -> Watch | None:
            if not inside[location]:
                return Watch.OFF if begins is not None or location == self.network.first else None
            if before is Watch.ON:
                return Watch.ON
            starts = location == self.network.first if begins is None else begins[location]
            return Watch.START if starts else Watch.OFF

        return rule

    def within(self, asked: Proposition | None, awaited: Proposition, most: int) -> Wait:
        """Return how long something is waited for from the start, or from wherever something else is true."""
        rule = self.waiting(asked, awaited)
        if asked is None and rule(Watch.OFF, self.network.first) is Watch.OFF:
            return Wait(0)
        meter = Meter(most + 1, goal=(Watch.ON, most + 1))
        observer, search = self.explored(Observer(self.network, rule, meter))
        if search.found < 0:
            return Wait(max(_shown(observer, search, Watch.ON), default=0))
        run = self._measured(search).run()
        longest = self._longest(rule, Watch.ON, most)
        return Wait(longest, run, math.isinf(longest))

    def moments(self, formula: Proposition) -> Moments:
        """Return when something is first true."""
        true = self.true_in(formula)
        if true[self.network.first]:
            return Moments(Run(), 0, may_wait=False)

        def rule(before: Watch, location: int) -> Watch:
            if true[location]:
                return Watch.END
            return Watch.ON if before is Watch.ON else Watch.START

        first = self._first(rule)
        latest = NEVER if first is None else self._longest(rule, Watch.END)
        return Moments(first, latest, math.isinf(self._longest(rule, Watch.ON)))

    def _first(self, rule: Rule) -> Run | None:
        """Return the first run of those that come first to an end."""
        observer, search = self.explored(Observer(self.network, rule, Meter(upper=MOST)))
        ends = [
            -int(zone[0, observer.clock(place)])
            for place, zone in search
            if observer.spots[place].watch is Watch.END
        ]
        if not ends:
            return None
        earliest = min(ends)
        meter = Meter(upper=earliest, most=earliest, goal=(Watch.END, 0))
        _, search = self.explored(Observer(self.network, rule, meter))
        return self._measured(search).run()

    def explored(self, observer: Observer) -> tuple[Observer, Search]:
        """Return an observer with a search of its automaton, to the end or to what it looks for."""
        search = Search(observer.automaton, 0, observer.first_ages())
        search.finish(look)
        return observer, search

    def _measured(self, search: Search) -> Dates:
        """Return the first run to what an observer looked for, and found."""

        def goal(place: int) -> list[Zone]:
            location = search.automaton.location(place)
            if location.goal is None:
                return []
            zone = tested(whole(len(location.clocks)), [location.goal])
            return [] if zone is None else [zone]

        return run_of(search, goal, search.found)

    def _longest(self, rule: Rule, where: Watch, least: int = 0) -> float:
        """Return how long a clock may run at most somewhere; infinite where a run that goes round shows that.

        It is counted up to a constant that grows until either is found.
        """
        most = max(least, self.enough)
        while True:
            observer, search = self.explored(
                Observer(self.network, rule, Meter(most + 1, goal=(where, most + 1)))
            )
            if search.found < 0:
                return max(_shown(observer, search, where), default=NEVER)
            if self.goes_round(observer, self._measured(search)):
                return math.inf
            most *= 4

    @property
    def enough(self) -> int:
        """For how many ticks a clock is counted first, where nobody knows how long it may run."""
        return 2 * max(self.network.caps.values(), default=0) + 1

    def goes_round(self, observer: Observer, dates: Dates) -> bool:
        """Tell whether a run comes to the same again, as far as what may follow is concerned, while a clock runs."""
        history = dates.history()
        seen: dict[tuple[int, tuple[int, ...]], int] = {}
        for at, (now, (place, ages)) in enumerate(history[:-1]):
            location, watch = observer.spots[place]
            clock = observer.clock(place)
            if not clock or ages[clock - 1] == 0:
                seen.clear()
            if not clock or watch is Watch.END:
                continue
            measured = ages[: clock - 1]
            capped = self.network.capped(location, measured)
            if seen.setdefault((location, capped), now) < now:
                return True
            stays = history[at + 1][0] - now
            left = [
                self.network.caps[each] - age
                for each, age in zip(self.network.clocks(location), measured, strict=True)
            ]
            if stays > max(left, default=0) and stays > 0:
                return True
        return False

    # --- when steps are taken

    def spans(self, steps: Sequence[Set[TakenStep]]) -> list[Span]:
        """Return for each of some sets of steps when one of them is taken."""
        from checker.engines.zones.spans import Spans  # noqa: PLC0415 - few ask for them

        return Spans(self, steps).found()

    # --- endurance, and whether time goes on

    def exhausted(self) -> tuple[dict[str, Run], int]:
        """Return the first run on which each vehicle is aloft for too long, and how many configurations show that."""
        tests = {location: self.exhaustion(location) for location in self.reached.tolist()}
        first: dict[str, int] = {}
        where: set[int] = set()
        for location, several in tests.items():
            for vehicle, test in several.items():
                for zone in self.search.showing(self._by_place[location], test):
                    first[vehicle] = min(int(zone), first.get(vehicle, int(zone)))
                    where.add(self.network.place(location).number)
        found = {vehicle: self._exhausting(vehicle, zone, tests) for vehicle, zone in sorted(first.items())}
        return found, len(where)

    def exhaustion(self, location: int) -> dict[str, Constraint]:
        """Return what the clocks show in a location where a vehicle is aloft for too long."""
        situation = self.network.situation(self.network.place(location).number)
        return {
            vehicle: Constraint(self.network.index(location, Clock(Sort.ALOFT, vehicle)), endurance.lasts + 1)
            for vehicle, endurance in situation.timing.endurances
            if vehicle in situation.c.structure.physical and not is_restored(situation.c, vehicle)
        }

    def _exhausting(self, vehicle: str, zone: int, tests: Mapping[int, dict[str, Constraint]]) -> Run:
        def goal(location: int) -> list[Zone]:
            size = len(self.network.automaton.location(location).clocks)
            wanted = (
                tested(whole(size), [tests[location][vehicle]])
                if vehicle in tests.get(location, ())
                else None
            )
            return [] if wanted is None else [wanted]

        return run_of(self.search, goal, self.search.depth(zone), tests).run()

    def stop(self) -> Stop | None:
        """Return the first run after which no time can pass any more."""
        from checker.engines.zones.stopping import first_stop  # noqa: PLC0415 - few missions go round in no time

        return first_stop(self.network)


def _shown(observer: Observer, search: Search, where: Watch) -> Iterator[int]:
    """Yield the most that the clock shows in each zone of some locations."""
    for place, zone in search:
        if observer.spots[place].watch is where:
            yield int(zone[observer.clock(place), 0])
