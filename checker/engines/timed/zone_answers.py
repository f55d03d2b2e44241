"""The answers about time from zones."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence, Set
from functools import cached_property, partial, reduce

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.survey.proposition_table import Profiles
from checker.engines.fast.survey.row_inspection import truths
from checker.engines.made_on_access import MadeOnAccess
from checker.engines.timed.answers import (
    DateSpan,
    FirstMoments,
    Named,
    TakenStep,
    TimelockRun,
    WaitAnswer,
)
from checker.engines.timed.digital_answers import control_pairs
from checker.engines.timed.first_runs import TimedRun
from checker.engines.zones.difference_bounds import MOST, NONE
from checker.engines.zones.earliest_dates import Dates, Zone, tested, whole
from checker.engines.zones.first_run import run_of
from checker.engines.zones.observer_walk import ObserverClock, Rule
from checker.engines.zones.observers import CUT_OFF, Meter, Observer
from checker.engines.zones.questions import NO_TURN, first_turn, is_aloft, longest_flight, unbounded
from checker.engines.zones.timed_automaton import (
    EDGE,
    EDGES,
    EDGES_END,
    FIRST,
    LEARNED,
    LOCATION,
    SIZE,
    STEP,
    Constraint,
)
from checker.engines.zones.timed_automaton_of import Network
from checker.engines.zones.timed_survey import TimedSurvey
from checker.engines.zones.zone_search import Search
from checker.limits import look
from checker.properties.critical_path import way_to
from checker.properties.inspections import InTime
from checker.properties.longest_stays import NEVER
from physical.wordings import counted
from semantics.properties.property import Property
from semantics.properties.propositions import Proposition
from semantics.state.configuration import Configuration, Transition
from semantics.state.setting import Scheduler
from semantics.state.signature import Name
from semantics.timing.actor_clocks import ActorClock, Sort, Test
from semantics.timing.clocks import TimedStep, TimedView
from semantics.timing.timing import Sayable


class ZoneTimes:
    """Answers from a search through zones.

    Attributes:
        reached: The reached locations.
        order: The reached rows, in the order of discovery.
    """

    def __init__(self, network: Network, search: Search) -> None:
        self.network = network
        self.search = search
        self.initial = network.initial
        self.reached: NDArray[np.int64] = np.flatnonzero(search.heads.used >= 0)
        self.order: NDArray[np.int64] = search.order
        self._reads_of: dict[tuple[Proposition, ...], NDArray[np.uint64]] = {}

    @property
    def searched(self) -> str:
        """The size of the searched state space, in words."""
        return counted(self.search.count, "zone") + (" of local time" if self.search.is_local else "")

    @property
    def situations(self) -> Sequence[TimedView]:
        """The timed situation of each configuration."""
        return MadeOnAccess(self.network.situation, self.order)

    def survey(self, shown: InTime = InTime.ENABLED) -> TimedSurvey:
        """Return a survey of the configurations."""
        return TimedSurvey(self.network, self, self.order, shown)

    # --- zones

    @cached_property
    def _locations(self) -> NDArray[np.int32]:
        """The location of each zone."""
        found: NDArray[np.int32] = self.search.places.room[: self.search.count]
        return found

    @cached_property
    def places(self) -> NDArray[np.int64]:
        """The place of each zone's configuration."""
        rows = self.network.of_locations.room[self._locations]
        found: NDArray[np.int64] = self.search.ranks.room[rows].astype(np.int64)
        return found

    def latest(self, zones: NDArray[np.int64], clock: ActorClock) -> NDArray[np.int32]:
        """Return the greatest value of a clock in some zones; `NONE` where it doesn't run."""
        indices = self.network.indices(clock)[self._locations[zones]]
        sizes = self.network.automaton.locations.used[SIZE::LOCATION][self._locations[zones]]
        shown = self.search.bounds.room[self.search.begins.room[zones] + sizes * indices]
        return np.where(indices > 0, shown, NONE).astype(np.int32)

    def is_due(self, zones: NDArray[np.int64], turn: float, tests: tuple[Test, ...]) -> NDArray[np.bool_]:
        """Return in which zones a step with a turn and tests may be taken, regardless of its turn.

        A step that waits for its turn counts as past its least time. Zones are closed under delays, so two steps that
        are due in one zone are both due at one of its moments.
        """
        waits = turn > self._first_turns[self.places[zones]] if turn < NO_TURN else np.False_
        due = [self.latest(zones, clock) >= least for clock, least, _ in tests]
        found: NDArray[np.bool_] = waits | np.any(due, axis=0) if due else np.ones(len(zones), np.bool_)
        return found

    @cached_property
    def _first_turns(self) -> NDArray[np.float64]:
        """For each configuration the first turn that steps wait for."""
        survey = self.survey()
        found = np.full(len(self.order), NO_TURN)
        for a in survey.agents() if self.initial.setting.scheduler is Scheduler.FCFS else ():
            numbers, turns = survey.answered(partial(first_turn, a))
            found = np.minimum(found, np.array(turns, np.float64)[numbers])
        return found

    @cached_property
    def _by_place(self) -> dict[int, NDArray[np.int64]]:
        return self.search.by_place()

    def _zones(self, place: int) -> Iterator[tuple[int, Zone]]:
        """Yield the zones of a configuration, each with its location."""
        for location in self.network.locations(int(self.order[place])):
            for zone in self._by_place.get(location, ()):
                yield location, self.search.matrix(int(zone))

    # --- configurations

    def firsts_of(self, place: int) -> dict[int, int]:
        """Return each step that is taken in a configuration, with the least number of steps before it."""
        found: dict[int, int] = {}
        for location in self.network.locations(int(self.order[place])):
            for step, depth in self.network.automaton.firsts(location):
                found[step] = min(depth, found.get(step, depth))
        return found

    def taken(self, place: int) -> set[int]:
        """Return the steps of a configuration that are taken at some time."""
        return set(self.firsts_of(place))

    @cached_property
    def _taken(self) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
        """The learned step and the configuration's place of each taken step, once."""
        locations = self.network.automaton.locations.used.reshape(-1, LOCATION)
        edges = self.network.automaton.edges.used.reshape(-1, EDGE)
        counts = np.maximum(locations[:, EDGES_END] - locations[:, EDGES], 0)
        begins = np.argsort(np.where(counts > 0, locations[:, EDGES], len(edges)), kind="stable")
        rows = np.repeat(self.network.of_locations.used[begins], counts[begins])
        taken = edges[:, FIRST] >= 0
        steps = np.stack([rows[taken], edges[taken, STEP]])
        _, first = np.unique(steps, axis=1, return_index=True)
        return edges[taken, LEARNED][first], self.search.ranks.room[rows[taken][first]].astype(np.int64)

    def taken_rules(self) -> NDArray[np.int32]:
        """Return the rule of each step that is taken in a configuration, once."""
        found: NDArray[np.int32] = self.network.learner.leaves.rule.room[self._taken[0]]
        return found

    def taken_steps(self) -> Iterator[tuple[int, NDArray[np.int64]]]:
        """Yield each learned step that is taken at some time, with the places of its configurations."""
        steps, places = self._taken
        order = np.argsort(steps, kind="stable")
        met, begins = np.unique(steps[order], return_index=True)
        yield from zip(
            met.tolist(), np.split(places[order], begins[1:]), strict=False
        )  # without steps there is one empty part

    def where(self, formula: Proposition) -> list[bool]:
        """Return for each configuration whether a proposition is true there."""
        true: list[bool] = truths(self.survey(), formula, len(self.order)).tolist()
        return true

    def unbounded(self) -> set[str]:
        """Return the rules of agents' in-turn steps that have no upper time bound."""
        survey, found = self.survey(), set[str]()
        for a in survey.agents():
            answers, several = survey.answered(partial(unbounded, a))
            for number, steps in enumerate(several):
                turns = self._first_turns[answers == number]
                found |= {rule for rule, turn in steps if turn == NO_TURN or np.any(turns >= turn)}
        return found

    def longest_flights(self) -> dict[Name, int]:
        """Return the longest flight of each agent in ticks, where it is bounded."""
        survey = self.survey()
        answers = {a: survey.answers(partial(longest_flight, a)) for a in survey.agents()}
        bounded = {
            a: [each.value for each in found if each.value is not None] for a, found in answers.items()
        }
        return {a: max(most) for a, most in bounded.items() if most}

    def together(self, place: int) -> Iterator[tuple[Transition, ...]]:
        """Yield each pair of pending controls that may be served at the same moment."""
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
        """Return the clauses whose message has expired at some time in a configuration."""
        return next(set(late) for late, places in self.late_sayings if place in places)

    @cached_property
    def late_sayings(self) -> list[tuple[frozenset[int], NDArray[np.int64]]]:
        """The sets of clauses whose messages have expired at some time, each with the places of its configurations."""
        ends = {
            number: times.step.until
            for number, times in enumerate(self.network.timing.clauses)
            if isinstance(times.step, Sayable) and times.step.until is not None
        }
        every = np.arange(len(self.order))
        if not ends:
            return [(frozenset(), every)]
        latest = np.zeros(len(self.order), np.int64)
        zones = np.arange(len(self.places))
        np.maximum.at(latest, self.places, self.latest(zones, ActorClock(Sort.MISSION)))
        late = np.stack([latest > until for until in ends.values()])
        kinds, which = np.unique(late, axis=1, return_inverse=True)
        return [
            (
                frozenset(n for n, is_late in zip(ends, kind, strict=True) if is_late),
                every[which.ravel() == at],
            )
            for at, kind in enumerate(kinds.T)
        ]

    # --- runs

    def way_to(
        self, run: TimedRun, is_end: Callable[[Configuration, Name], bool], about: Name = ""
    ) -> tuple[Transition, ...]:
        """Return the shortest in-turn steps from the end of a run to a configuration, empty if none lead there."""

        def follow(node: tuple[int, Name]) -> Iterator[tuple[tuple[int, int], tuple[int, Name]]]:
            row, name = node
            targets = self._targets(row).items()
            return (
                ((row, step), (target, self._name_after(row, step, name)))
                for step, target in targets
                if self.search.ranks.room[target] >= 0
            )

        row = reduce(lambda at, step: self._targets(at)[step], run.steps, 0)
        way = way_to((row, about), lambda node: is_end(self.network.configuration(node[0]), node[1]), follow)
        return tuple(self.network.situation(at).steps[step].transition for at, step in way)

    def _name_after(self, row: int, step: int, name: Name) -> Name:
        """Return the name that an entity of a row has after a step."""
        exchange = self.network.exchange
        if exchange is None or not name:
            return name
        target = self.network.situation(row).steps[step].transition.target
        return exchange.symmetry.sorting(target)[0].name(name)

    def in_original_names(self, place: int, by: Transition | None, text: str) -> str:  # noqa: ARG002 - as the protocol
        """Return a text about a configuration as it is: nothing is exchanged."""
        return text

    def alike(self, event: Named) -> tuple[Named, ...]:
        """Return the event: nothing is exchanged."""
        return (event,)

    def _targets(self, row: int) -> dict[int, int]:
        """Return the target row of each in-turn step, from the reached locations of a row."""
        rows = self.network.of_locations.room
        edges = (e for location in self.network.locations(row) for e in self.network.automaton.out(location))
        return {each.step: int(rows[each.target]) for each in sorted(edges, key=lambda each: each.step)}

    def transitions(self, run: TimedRun) -> tuple[Transition, ...]:
        """Return the transitions of a run."""
        situation, found = self.network.situation(0), list[Transition]()
        for at in run.steps:
            found.append(situation.steps[at].transition)
            situation = TimedView(found[-1].target)
        return tuple(found)

    def run_before(self, place: int, by: Transition | None) -> TimedRun:
        """Return the first run to a configuration, then through a transition if that is ever taken there."""
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
            return run_of(self.search, goal, min(steps.values())).run().then(min(steps))
        zones = (int(self._by_place[each][0]) for each in there if each in self._by_place)
        return run_of(self.search, goal, self.search.depth(min(zones))).run()

    # --- durations

    def true_in(self, formula: Proposition) -> NDArray[np.bool_]:
        """Return for each location whether a proposition is true there."""
        found = np.zeros(self.network.size, np.bool_)
        found[self.order] = self.where(formula)
        true: NDArray[np.bool_] = found[self.network.of_locations.used]
        return true

    def waiting(self, asked: Proposition | None, awaited: Proposition) -> Rule:
        """Return the observer's rule for a wait from the start, or from wherever another proposition is true."""
        over, first = self.true_in(awaited), self.network.first
        begins = np.arange(len(over)) == first if asked is None else self.true_in(asked)
        rule = np.full((2, len(over)), ObserverClock.ON, np.int8)
        rule[ObserverClock.OFF] = np.where(begins, ObserverClock.START, ObserverClock.OFF)
        rule[:, over] = ObserverClock.OFF
        if asked is None:
            rule[:, over & ~begins] = CUT_OFF
        return rule

    def observer(self, asked: Property) -> Observer:
        """Return the observer of a deadline, whose goal is that it is missed."""
        awaited = asked.formula if asked.then is None else asked.then
        begins = None if asked.then is None else asked.formula
        meter = Meter(asked.bound + 1, goal=(ObserverClock.ON, asked.bound + 1))
        asks = (awaited,) if begins is None else (begins, awaited)
        return self._observer(self.waiting(begins, awaited), meter, asks)

    def within(self, asked: Proposition | None, awaited: Proposition, most: int) -> WaitAnswer:
        """Return the longest wait for a proposition from the start, or from wherever another one is true."""
        rule = self.waiting(asked, awaited)
        if asked is None and rule[ObserverClock.OFF, self.network.first] == ObserverClock.OFF:
            return WaitAnswer(0)
        meter = Meter(most + 1, goal=(ObserverClock.ON, most + 1))
        asks = (awaited,) if asked is None else (asked, awaited)
        observer, search = self.explored(self._observer(rule, meter, asks))
        if search.found < 0:
            return WaitAnswer(int(_shown(observer, search, ObserverClock.ON)[1].max(initial=0)))
        run = self._measured(search).run()
        longest = self._longest(rule, ObserverClock.ON, asks, most)
        return WaitAnswer(longest, run, math.isinf(longest))

    def moments(self, formula: Proposition) -> FirstMoments:
        """Return the earliest and latest moments at which a proposition becomes true."""
        true = self.true_in(formula)
        if true[self.network.first]:
            return FirstMoments(TimedRun(), 0, may_wait=False)
        rule = np.full((2, len(true)), ObserverClock.ON, np.int8)
        rule[ObserverClock.OFF] = ObserverClock.START
        rule[:, true] = ObserverClock.END
        first = self._first(rule, (formula,))
        latest = NEVER if first is None else self._longest(rule, ObserverClock.END, (formula,))
        return FirstMoments(first, latest, math.isinf(self._longest(rule, ObserverClock.ON, (formula,))))

    def _observer(self, rule: Rule, meter: Meter, asks: tuple[Proposition, ...]) -> Observer:
        """Return an observer of propositions."""
        return Observer(self.network, rule, meter, reads=self._reads(asks) if self.search.is_local else None)

    def _reads(self, asks: tuple[Proposition, ...]) -> NDArray[np.uint64] | None:
        """Return for each location the columns that decide some propositions; None if a column is too new."""
        participants = self.network.participants
        assert participants is not None
        if asks not in self._reads_of:
            survey = self.survey()
            trees = [tree for formula in asks for tree in Profiles(survey, formula).trees.values()]
            leaves = [self.network.model.classify(tree, self.order) for tree in trees]
            participants.see()
            if participants.is_void:
                return None
            sets = participants.reads.used.reshape(-1, participants.words)
            found = np.zeros((self.network.size, participants.words), np.uint64)
            for each in leaves:
                found[self.order] |= sets[each]
            self._reads_of[asks] = found[self.network.of_locations.used]
        return self._reads_of[asks]

    def _first(self, rule: Rule, asks: tuple[Proposition, ...]) -> TimedRun | None:
        """Return the first of the earliest runs to an end of the observer."""
        observer, search = self.explored(self._observer(rule, Meter(upper=MOST), asks))
        ends, _ = _shown(observer, search, ObserverClock.END)
        if not len(ends):
            return None
        earliest = int(ends.min())
        meter = Meter(upper=earliest, most=earliest, goal=(ObserverClock.END, 0))
        _, search = self.explored(self._observer(rule, meter, asks))
        return self._measured(search).run()

    def explored(self, observer: Observer) -> tuple[Observer, Search]:
        """Return an observer with a search of its automaton, to the end or to its goal."""
        start = observer.automaton, 0, observer.first_ages()
        threads = self.search.threads
        search = Search(*start, is_local=observer.participants is not None, threads=threads)
        search.finish(look)
        if search.is_far:
            search = Search(*start, threads=threads)
            search.finish(look)
        return observer, search

    def _measured(self, search: Search) -> Dates:
        """Return the first run to the goal that a search has found."""

        def goal(place: int) -> list[Zone]:
            location = search.automaton.location(place)
            if location.goal is None:
                return []
            zone = tested(whole(len(location.clocks)), [location.goal])
            return [] if zone is None else [zone]

        return run_of(search, goal, search.found)

    def _longest(
        self, rule: Rule, where: ObserverClock, asks: tuple[Proposition, ...], least: int = 0
    ) -> float:
        """Return the greatest value of the observer's clock in one of its states.

        The clock is counted up to a constant, which grows until the value is certain. It is infinite if some run to
        larger values contains a cycle.
        """
        most = max(least, self.enough)
        while True:
            meter = Meter(most + 1, goal=(where, most + 1))
            observer, search = self.explored(self._observer(rule, meter, asks))
            if search.found < 0:
                return float(_shown(observer, search, where)[1].max(initial=NEVER))
            if self.goes_round(observer, self._measured(search)):
                return math.inf
            most *= 4

    @property
    def enough(self) -> int:
        """The first constant of an additional clock whose greatest value is unknown."""
        return 2 * max(self.network.caps.values(), default=0) + 1

    def goes_round(self, observer: Observer, dates: Dates) -> bool:
        """Return whether a run repeats a state, up to indistinguishable values, while the observer's clock runs."""
        history = dates.history()
        seen: dict[tuple[int, tuple[int, ...]], int] = {}
        for at, (now, (place, ages)) in enumerate(history[:-1]):
            location, watch = observer.spot(place)
            clock = observer.clock(place)
            if not clock or ages[clock - 1] == 0:
                seen.clear()
            if not clock or watch is ObserverClock.END:
                continue
            measured = ages[: clock - 1]
            capped = self.network.capped(location, measured)
            if seen.setdefault((location, capped), now) < now:
                return True
            stays = history[at + 1][0] - now
            left = [
                self.network.caps[self.network.kin(each)] - age
                for each, age in zip(self.network.clocks(location), measured, strict=True)
            ]
            if stays > max(left, default=0) and stays > 0:
                return True
        return False

    # --- dates of steps

    def spans(self, steps: Sequence[Set[TakenStep]]) -> list[DateSpan]:
        """Return for each set of steps the span of dates at which one of them is taken."""
        from checker.engines.zones.date_bounds import Spans  # noqa: PLC0415 - few ask for them

        return Spans(self, steps).found()

    # --- endurance and timelocks

    def exhausted(self) -> tuple[dict[str, TimedRun], int]:
        """Return the first run that exhausts each vehicle, and the number of configurations with an exhausted one."""
        zones, first, where = np.arange(len(self.places)), dict[Name, int](), np.zeros(0, np.int64)
        for vehicle, endurance in self.network.timing.endurances:
            late = self.latest(zones, ActorClock(Sort.ALOFT, vehicle)) > endurance.lasts
            showing = zones[self._aloft[vehicle][self.places] & late]
            if len(showing):
                first[vehicle] = int(showing[0])
                where = np.union1d(where, self.places[showing])
        return {vehicle: self._exhausting(vehicle, zone) for vehicle, zone in sorted(first.items())}, len(
            where
        )

    @cached_property
    def _aloft(self) -> dict[Name, NDArray[np.bool_]]:
        """For each vehicle with an endurance, whether it exists and is not where it is restored."""
        vehicles = [vehicle for vehicle, _ in self.network.timing.endurances]
        return {vehicle: self.survey().where(partial(is_aloft, vehicle)) for vehicle in vehicles}

    def exhaustion(self, location: int) -> dict[Name, Constraint]:
        """Return the clock constraint in a location for each vehicle that has exceeded its endurance."""
        place = int(self.search.ranks.room[self.network.place(location).number])
        return {
            vehicle: Constraint(
                self.network.index(location, ActorClock(Sort.ALOFT, vehicle)), endurance.lasts + 1
            )
            for vehicle, endurance in self.network.timing.endurances
            if place >= 0 and self._aloft[vehicle][place]
        }

    def _exhausting(self, vehicle: Name, zone: int) -> TimedRun:
        def goal(location: int) -> list[Zone]:
            size = len(self.network.automaton.location(location).clocks)
            tests = [test for name, test in self.exhaustion(location).items() if name == vehicle]
            wanted = tested(whole(size), tests) if tests else None
            return [] if wanted is None else [wanted]

        return run_of(self.search, goal, self.search.depth(zone)).run()

    def stop(self) -> TimelockRun | None:
        """Return the first run to a timelock, None if there is none."""
        from checker.engines.zones.timelock import first_stop  # noqa: PLC0415 - few missions go round in no time

        return first_stop(self.network)


def _shown(
    observer: Observer, search: Search, where: ObserverClock
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the least and the greatest value of the observer's clock, the last, in the zones of one of its states."""
    places = search.places.room[: search.count]
    zones = np.flatnonzero(observer.watches[places] == where)
    sizes = search.automaton.locations.used[SIZE::LOCATION][places[zones]].astype(np.int64)
    begins, bounds = search.begins.room[zones], search.bounds.room
    least, most = -bounds[begins + sizes - 1], bounds[begins + sizes * (sizes - 1)]
    return least.astype(np.float64), most.astype(np.float64)
