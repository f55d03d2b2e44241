"""The answers about time from whole ticks (digital clocks)."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence, Set
from functools import cached_property, reduce
from itertools import combinations

from checker.engines.timed.answers import (
    NO_SPAN,
    DateSpan,
    FirstMoments,
    Named,
    TakenStep,
    TimelockRun,
    WaitAnswer,
)
from checker.engines.timed.digital_graph import Timeline
from checker.engines.timed.first_runs import DELAY, TimedRun, dated, first_run
from checker.limits import look
from checker.properties.critical_path import way_to
from checker.properties.longest_stays import first_ticks, last_ticks, longest, stopped
from semantics.properties.propositions import Proposition, holds
from semantics.races.monitor import CONTROLS
from semantics.state.configuration import Configuration, Transition
from semantics.state.requests import FLY
from semantics.state.signature import Name
from semantics.timing.actor_clocks import Sort
from semantics.timing.clocks import TimedStep, TimedView

Awaiting = tuple[int, float | None]
"""A state, and the ticks since something is awaited; None if nothing is."""

IN_TIME = -math.inf
"""The elapsed time of a wait that certainly ends in time: its actual length is irrelevant."""


class DigitalAnswers:
    """Answers from a timeline."""

    def __init__(self, timeline: Timeline) -> None:
        self.timeline = timeline
        self.initial = timeline.initial
        self.edges = timeline.edges

    @property
    def searched(self) -> str:
        """The size of the searched state space, in words."""
        return f"{len(self.timeline.states):,} timed configurations"

    @cached_property
    def situations(self) -> tuple[TimedView, ...]:
        """The timed situation of each configuration."""
        return tuple(self.timeline.situations[number] for number in self.timeline.order)

    @cached_property
    def _ages(self) -> dict[int, list[tuple[int, ...]]]:
        found: dict[int, list[tuple[int, ...]]] = {}
        for number, each in self.timeline.states:
            found.setdefault(number, []).append(each)
        return found

    # --- configurations

    def taken(self, place: int) -> set[int]:
        """Return the steps of a configuration that are taken at some time."""
        number = self.timeline.order[place]
        steps = range(len(self.timeline.situations[number].steps))
        return {at for at in steps if (number, at) in self.timeline.taken}

    def together(self, place: int) -> Iterator[tuple[Transition, ...]]:
        """Yield each pair of pending controls that may be served at the same moment."""
        several = self._ages[self.timeline.order[place]]
        for one, other in control_pairs(self.situations[place]):
            if any(_any_due(one, each) and _any_due(other, each) for each in several):
                yield tuple(step.transition for step in (*one, *other))

    def unsayable(self, place: int) -> set[int]:
        """Return the clauses whose message has expired at some time in a configuration."""
        situation, several = self.situations[place], self._ages[self.timeline.order[place]]
        return {number for each in several for number in situation.unsayable(each)}

    # --- runs

    def run_before(self, place: int, by: Transition | None) -> TimedRun:
        """Return the first run to a configuration, then through a transition if that is ever taken there."""
        number, situation = self.timeline.order[place], self.situations[place]
        steps = {at for at in self.taken(place) if situation.steps[at].transition == by}

        def is_there(state: int) -> bool:
            if self.timeline.configuration(state) != number:
                return False
            return not steps or any(step in steps for step, _ in self.edges[state])

        run = self._first(is_there)
        return run.then(min(steps)) if steps else run

    def transitions(self, run: TimedRun) -> tuple[Transition, ...]:
        """Return the transitions of a run."""
        number, found = 0, list[Transition]()
        for at in run.steps:
            found.append(self.timeline.situations[number].steps[at].transition)
            number = self.timeline.passages[number, at][0]
        return tuple(found)

    def in_original_names(self, place: int, by: Transition | None, text: str) -> str:  # noqa: ARG002 - as the protocol
        """Return a text about a configuration as it is: nothing is exchanged."""
        return text

    def alike(self, event: Named) -> tuple[Named, ...]:
        """Return the event: nothing is exchanged."""
        return (event,)

    def _first(self, is_end: object) -> TimedRun:
        run = first_run(0, self.edges.__getitem__, is_end)  # type: ignore[arg-type]
        assert run is not None
        return run

    def where(self, formula: Proposition) -> list[bool]:
        """Return for each configuration whether a proposition is true there."""
        return [holds(formula, each.c) for each in self.situations]

    def way_to(
        self, run: TimedRun, is_end: Callable[[Configuration, Name], bool], about: Name = ""
    ) -> tuple[Transition, ...]:
        """Return the shortest in-turn steps from the end of a run to a configuration, empty if none lead there."""
        timeline, reached = self.timeline, set(self.timeline.order)

        def follow(node: tuple[int, Name]) -> Iterator[tuple[Transition, tuple[int, Name]]]:
            number, name = node
            for step in timeline.situations[number].steps:
                c, later = self._shown(step.transition.target, name)
                target = timeline.numbers.get(c)
                if step.in_turn and target in reached:
                    yield step.transition, (target, later)

        start = reduce(lambda at, step: timeline.passages[at, step][0], run.steps, 0)
        return way_to((start, about), lambda node: is_end(timeline.situations[node[0]].c, node[1]), follow)

    def _shown(self, c: Configuration, name: Name) -> tuple[Configuration, Name]:
        """Return the representative of a configuration, with an entity's name there."""
        if self.timeline.exchange is None:
            return c, name
        renaming, shown = self.timeline.exchange.symmetry.sorting(c)
        return shown, renaming.name(name)

    def unbounded(self) -> set[str]:
        """Return the rules of agents' in-turn steps that have no upper time bound."""
        return {label.rule for each in self.situations for label in each.unbounded()}

    def longest_flights(self) -> dict[Name, int]:
        """Return the longest flight of each agent in ticks, where it is bounded."""
        most: dict[Name, int] = {}
        for situation in self.situations:
            for clock, interval in situation.bounds.items():
                if clock.sort is Sort.AIM and isinstance(clock.of, FLY):
                    most[clock.of.agent] = max(most.get(clock.of.agent, 0), interval.hi or 0)
        return most

    # --- durations

    def true_in(self, formula: Proposition) -> list[bool]:
        """Return for each state whether a proposition is true there."""
        true = dict(zip(self.timeline.order, self.where(formula), strict=True))
        return [true[number] for number, _ in self.timeline.states]

    def within(self, asked: Proposition | None, awaited: Proposition, most: int) -> WaitAnswer:
        """Return the longest wait for a proposition from the start, or from wherever another one is true."""
        inside = [not true for true in self.true_in(awaited)]
        begins = [state == 0 for state in range(len(inside))] if asked is None else self.true_in(asked)
        stays = longest(self.edges, inside, lambda _: True)
        starts = [state for state, begin in enumerate(begins) if begin and inside[state]]
        longest_stay = max((stays[state] for state in starts), default=0)
        if longest_stay <= most:
            return WaitAnswer(longest_stay)

        def waiting(state: int, before: float | None) -> Awaiting:
            if not inside[state]:
                return state, None
            waited = 0 if before is None and begins[state] else before
            ends = waited is not None and stays[state] + waited <= most
            return state, IN_TIME if ends else waited

        def follow(node: Awaiting) -> Iterator[tuple[int, Awaiting]]:
            state, waited = node
            for step, target in self.edges[state]:
                passed = waited if waited is None or step != DELAY else min(waited + 1, most + 1)
                yield step, waiting(target, passed)

        run = first_run(waiting(0, None), follow, lambda node: node[1] == most + 1)
        return WaitAnswer(longest_stay, run, math.isinf(longest_stay))

    def moments(self, formula: Proposition) -> FirstMoments:
        """Return the earliest and latest moments at which a proposition becomes true."""
        true = self.true_in(formula)
        if true[0]:
            return FirstMoments(TimedRun(), 0, may_wait=False)
        inside = [not each for each in true]
        waits = longest(self.edges, inside, lambda _: True)[0]
        latest = longest(self.edges, inside, lambda state: any(true[to] for _, to in self.edges[state]))[0]
        return FirstMoments(self._earliest(true), latest, math.isinf(waits))

    def _earliest(self, true: Sequence[bool]) -> TimedRun | None:
        """Return the first of the earliest runs to a state of the given set, None if it is unreachable."""
        left = self._left(true)
        if 0 not in left:
            return None

        def follow(node: tuple[int, int]) -> Iterator[tuple[int, tuple[int, int]]]:
            state, now = node
            for step, target in self.edges[state]:
                then = now + (step == DELAY)
                if not true[state] and target in left and then + left[target] <= left[0]:
                    yield step, (target, then)

        return first_run((0, 0), follow, lambda node: true[node[0]])

    def _left(self, true: Sequence[bool]) -> dict[int, int]:
        """Return the least ticks from each state to the given set, where it is reachable."""
        sources: dict[int, list[tuple[int, int]]] = {}
        for state, edges in enumerate(self.edges):
            for step, target in edges:
                sources.setdefault(target, []).append((step == DELAY, state))
        left: dict[int, int] = {}
        waiting = deque((0, state) for state, each in enumerate(true) if each)
        while waiting:
            ticks, state = waiting.popleft()
            if state in left:
                continue
            left[state] = ticks
            for takes, source in sources.get(state, ()):
                (waiting.append if takes else waiting.appendleft)((ticks + takes, source))
        return left

    def spans(self, steps: Sequence[Set[TakenStep]]) -> list[DateSpan]:
        """Return for each set of steps the span of dates at which one of them is taken."""
        sets: dict[tuple[int, int], list[int]] = {}
        for number, several in enumerate(steps):
            for place, step in several:
                sets.setdefault((self.timeline.order[place], step), []).append(number)
        found = [NO_SPAN] * len(steps)
        ticks = zip(first_ticks(self.edges), last_ticks(self.edges), strict=True)
        for (at, _), edges, (first, last) in zip(self.timeline.states, self.edges, ticks, strict=True):
            for number in (number for step, _ in edges for number in sets.get((at, step), ())):
                known = found[number]
                found[number] = DateSpan(min(known.earliest, first), max(known.latest, last))
        return found

    # --- endurance and timelocks

    def exhausted(self) -> tuple[dict[str, TimedRun], int]:
        """Return the first run that exhausts each vehicle, and the number of configurations with an exhausted one."""
        states: dict[str, set[int]] = {}
        for state, (number, ages) in enumerate(self.timeline.states):
            for vehicle in self.timeline.situations[number].exhausted(ages):
                states.setdefault(vehicle, set()).add(state)
        runs = {vehicle: self._first(ends.__contains__) for vehicle, ends in states.items()}
        return runs, len({self.timeline.configuration(each) for ends in states.values() for each in ends})

    def stop(self) -> TimelockRun | None:
        """Return the first run to a timelock, None if there is none."""
        look()
        stops = stopped(self.edges, [not edges for edges in self.edges])
        run = first_run(0, self.edges.__getitem__, stops.__getitem__)
        if run is None:
            return None
        _, ends = dated(0, self.edges.__getitem__, run.steps, stops.__getitem__)
        state = min(ends, key=self.timeline.states.__getitem__)
        seen: dict[int, int] = {}
        while state not in seen:
            seen[state] = len(run.steps)
            step, state = self.edges[state][0]
            run = run.then(step)
        return TimelockRun(run, seen[state])


def control_pairs(situation: TimedView) -> Iterable[tuple[list[TimedStep], list[TimedStep]]]:
    """Return the pairs of pending controls, each as the steps that serve it."""
    controls: dict[object, list[TimedStep]] = {}
    for step in situation.steps:
        if step.transition.label.rule in CONTROLS and step.transition.served is not None:
            served = step.transition.served
            controls.setdefault((served.cell, served.position), []).append(step)
    return combinations(controls.values(), 2)


def _any_due(steps: Iterable[TimedStep], ages: tuple[int, ...]) -> bool:
    return any(step.is_due(ages) or not step.in_turn for step in steps)
