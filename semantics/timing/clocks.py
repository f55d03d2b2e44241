"""Clocks: what is timed in a configuration, the bounds of what may be done there, and what a step starts anew.

A clock belongs to what is done: a request, an agent, a clause of the environment, a flight, a vehicle's endurance. It
starts when that is newly enabled or was itself just done, and goes on while other steps are taken.
"""

import math
import re
from collections import Counter, defaultdict
from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass
from enum import IntEnum, auto
from functools import cached_property
from typing import NamedTuple

from semantics.behaviours.statements import React
from semantics.behaviours.stepping import next_statement
from semantics.environment import Drops, Leaves
from semantics.extension import channels_between
from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.requests import CTR, FLY, MGR, OBS, SND, Request
from semantics.state.signature import Name
from semantics.successors import Expansion, by_clause, expand
from semantics.timing.flight_times import aim, interval_of_flight
from semantics.timing.intervals import ANY_TIME, Interval
from semantics.timing.timing import ONE_HOST, Every, Sayable, Timing, Window


class Sort(IntEnum):
    """What a clock measures."""

    MISSION = auto()
    """The time since the start."""
    EVERY = auto()
    """Since the last step of a clause that steps at most every so often."""
    WINDOW = auto()
    """No time: whether a clause that has a window was enabled in it (1), or is bound by it no more (2)."""
    ALOFT = auto()
    """Since a vehicle left where it is restored."""
    RESTORED = auto()
    """Since a vehicle came to where it is restored."""
    REQUEST = auto()
    AGENT = auto()
    AFTER = auto()
    """Since an agent waits at a `react` with an `after`, and nothing that is there fits."""
    FLIGHT = auto()
    """Since the `command` of a flight."""
    AIM = auto()
    """Since a flight can end, and what it is directed by has not changed."""
    RETURNS = auto()
    """Since what dropped or left may return."""


class Clock(NamedTuple):
    """What a clock belongs to."""

    sort: Sort
    of: Hashable = ""
    channel: Name = ""


BOUND, FREE = 1, 2
"""What the clock of a window says of a clause."""

STRICT = frozenset({Sort.MISSION, Sort.ALOFT, Sort.RESTORED})
"""Clocks of which it is asked whether they are past a constant; of the others only whether they have come to it."""


class Guard(NamedTuple):
    """A clock of a situation, by its index, has to be within bounds."""

    clock: int
    least: int
    most: int | None = None


class Deadline(NamedTuple):
    """No time passes once a clock has come to a bound, unless another says that a clause is free."""

    clock: int
    most: int
    unless: int | None = None


@dataclass(frozen=True, slots=True)
class TimedStep:
    """A transition that is in its turn, or waits for it.

    Attributes:
        transition: What is done.
        done: The clocks of what is done.
        guards: One of them has to be met; nothing where it may be done at any time.
        in_turn: Whether it is in its turn.
    """

    transition: Transition
    done: tuple[Clock, ...]
    guards: tuple[Guard, ...]
    in_turn: bool = True

    def is_due(self, ages: tuple[int, ...]) -> bool:
        """Tell whether the clocks allow it."""
        return not self.guards or any(
            ages[clock] >= least and (most is None or ages[clock] <= most)
            for clock, least, most in self.guards
        )


class Situation:
    """What time means in one configuration.

    Attributes:
        c: The configuration.
        expansion: What it allows apart from time.
        clocks: The clocks that run; of equal ones the oldest is the first.
        constants: The largest constant that each is compared with.
        steps: What may be done.
        deadlines: What ends the passing of time.
        aims: What each flight is directed by.
    """

    def __init__(self, c: Configuration) -> None:
        timing = c.setting.timing
        assert timing is not None
        self.c = c
        self.timing: Timing = timing
        self.expansion: Expansion = expand(c)
        self.by_clauses = tuple(tuple(by_clause(c, clause)) for clause in c.setting.environment)
        self.bounds: dict[Clock, Interval] = {}
        self.aims: dict[Clock, object] = {}
        counts = self._counts()
        self.clocks: tuple[Clock, ...] = tuple(each for each, count in counts.items() for _ in range(count))
        self.first = {each: index for index, each in reversed(list(enumerate(self.clocks)))}
        self.steps: tuple[TimedStep, ...] = tuple(self._steps())
        self.deadlines: tuple[Deadline, ...] = tuple(dict.fromkeys(self._deadlines()))

    # --- which clocks run

    def _counts(self) -> Mapping[Clock, int]:
        """Return how many clocks run of each sort: first those that run from the start, then those of E(c)."""
        counts: dict[Clock, int] = dict.fromkeys(self._lasting(), 1)
        counts |= Counter(self._enabled())
        return counts

    def _lasting(self) -> Iterator[Clock]:
        """Yield the clocks that run whatever is enabled; RESTORED only where it is."""
        steps = [each.step for each in self.timing.clauses]
        if any(isinstance(step, Window | Sayable) for step in steps):
            latest = [
                bound for step in steps if isinstance(step, Window | Sayable) for bound in _bounds_of(step)
            ]
            yield self._timed(Clock(Sort.MISSION), Interval(max(latest)))
        for number, step in enumerate(steps):
            if isinstance(step, Every):
                yield self._timed(Clock(Sort.EVERY, number), Interval(step.least))
            elif isinstance(step, Window):
                yield self._timed(Clock(Sort.WINDOW, number), Interval(FREE))
        for vehicle, endurance in self.timing.endurances:
            yield self._timed(Clock(Sort.ALOFT, vehicle), Interval(endurance.lasts))
            if self.is_restored(vehicle):
                yield self._timed(Clock(Sort.RESTORED, vehicle), Interval(endurance.after))

    def _timed(self, clock: Clock, interval: Interval) -> Clock:
        self.bounds[clock] = interval
        return clock

    def is_restored(self, vehicle: Name) -> bool:
        """Tell whether a vehicle is where it is restored: in transit it is nowhere."""
        physical, places = self.c.structure.physical, dict(self.timing.endurances)[vehicle].places
        if vehicle not in physical or physical.transit(vehicle) is not None:
            return False
        return any(place in places for place in _around(self.c, vehicle))

    def _enabled(self) -> Iterator[Clock]:
        """Yield E(c), as far as it is bounded: agents, requests with their channels, clauses; and the flights."""
        found = (*self._agents(), *self._requests(), *self._flights(), *self._returning())
        for clock, interval in found:
            if clock in self.bounds or interval != ANY_TIME or clock.sort is Sort.FLIGHT:
                yield self._timed(clock, interval)

    def _agents(self) -> Iterator[tuple[Clock, Interval]]:
        moving = {t.label.agent: t.label.rule for t in self.expansion.by_agents if t.served is None}
        for agent, rule in moving.items():
            if rule == "timeout":
                yield Clock(Sort.AFTER, agent), self._after(agent or "")
            else:
                spawns = rule == "spawn"
                yield (
                    Clock(Sort.AGENT, agent),
                    (self.timing.command(rule) or ANY_TIME) if spawns else self.timing.react,
                )

    def _after(self, agent: Name) -> Interval:
        statement = next_statement(self.c, agent)
        assert isinstance(statement, React)
        assert statement.after is not None
        ticks = statement.after.seconds * 1000 / self.timing.tick
        react = self.timing.react
        return Interval(
            math.floor(ticks) + react.lo, None if react.hi is None else math.ceil(ticks) + react.hi
        )

    def _requests(self) -> Iterator[tuple[Clock, Interval]]:
        """Yield the clocks of requests that a rule would serve apart from the scheduler's turn, each as often."""
        enabled = {t.served.request for t in self.expansion.enabled if t.served is not None}
        for pending in (each for a in self.c.alpha.names() for each in self.c.eta.in_line(a)):
            if pending.request in enabled and not isinstance(pending.request, FLY):
                for channel in self._channels(pending.request):
                    yield (
                        Clock(Sort.REQUEST, pending.request, channel),
                        self._service(pending.request, channel),
                    )

    def _channels(self, request: Request) -> tuple[Name, ...]:
        if not isinstance(request, SND):
            return ("",)
        here, there = self.c.alpha.host(request.agent), self.c.alpha.host(request.to)
        return (ONE_HOST,) if here == there else tuple(channels_between(self.c, here, there))

    def _service(self, request: Request, channel: Name) -> Interval:
        timing = self.timing
        match request:
            case OBS():
                return timing.sense
            case SND():
                return timing.message(channel)
            case MGR():
                return timing.command("migrate") or ANY_TIME
            case CTR():
                return timing.command(word_of(request)) or timing.react
            case _:
                return ANY_TIME

    def _flights(self) -> Iterator[tuple[Clock, Interval]]:
        ending = {t.served.request for t in self.expansion.enabled if t.served is not None}
        for fly in dict.fromkeys(each.request for each in self.c.eta.all()):
            if isinstance(fly, FLY):
                interval = interval_of_flight(self.c, fly)
                if interval != ANY_TIME or self.timing.motions:
                    yield Clock(Sort.FLIGHT, fly), Interval(interval.lo)
                if fly in ending and interval.hi is not None:
                    clock = Clock(Sort.AIM, fly)
                    self.aims[clock] = aim(self.c, fly)
                    yield clock, Interval(0, interval.hi)

    def _returning(self) -> Iterator[tuple[Clock, Interval]]:
        for number, times in enumerate(self.timing.clauses):
            if times.returns is not None and any(self._returns(number, t) for t in self.by_clauses[number]):
                yield Clock(Sort.RETURNS, number), Interval(0, times.returns)

    def _returns(self, number: int, transition: Transition) -> bool:
        clause = self.c.setting.environment[number]
        return (
            isinstance(clause, Drops | Leaves)
            and transition.label.about == clause.words[-1]
            and clause.returns
        )

    # --- what they bound

    def _steps(self) -> Iterator[TimedStep]:
        for transition in self.expansion.by_agents:
            yield self._of_agent(transition, in_turn=True)
        for transition in self.expansion.out_of_turn:
            yield self._of_agent(transition, in_turn=False)
        for number, transitions in enumerate(self.by_clauses):
            for transition in transitions:
                yield self.of_clause(number, transition)

    def _of_agent(self, transition: Transition, *, in_turn: bool) -> TimedStep:
        agent = transition.label.agent
        if transition.served is None:
            sort = Sort.AFTER if transition.label.rule == "timeout" else Sort.AGENT
            done = (Clock(Sort.AGENT, agent), Clock(Sort.AFTER, agent))
            return TimedStep(transition, done, self._guards([Clock(sort, agent)]))
        request = transition.served.request
        if isinstance(request, FLY):
            clocks = [Clock(Sort.FLIGHT, request)]
            return TimedStep(transition, (*clocks, Clock(Sort.AIM, request)), self._guards(clocks))
        clocks = [Clock(Sort.REQUEST, request, channel) for channel in self._channels(request)]
        return TimedStep(transition, tuple(clocks), self._guards(clocks), in_turn)

    def _guards(self, clocks: list[Clock]) -> tuple[Guard, ...]:
        """Return the bounds of which one has to be met; none where some clock has none."""
        if any(clock not in self.first or not self.bounds[clock].lo for clock in clocks):
            return ()
        return tuple(Guard(self.first[clock], self.bounds[clock].lo) for clock in clocks)

    def of_clause(self, number: int, transition: Transition) -> TimedStep:
        """Return a step of a clause with its bounds."""
        if self._returns(number, transition):
            return TimedStep(transition, (Clock(Sort.RETURNS, number),), ())
        mission = self.first.get(Clock(Sort.MISSION), 0)
        every, window = Clock(Sort.EVERY, number), Clock(Sort.WINDOW, number)
        match self.timing.clause(number).step:
            case Every(least):
                guards: tuple[Guard, ...] = (Guard(self.first[every], least),)
            case Window(after):
                guards = (Guard(mission, after), Guard(self.first[window], FREE))
            case Sayable(after, until):
                guards = (Guard(mission, after, until),)
            case None:
                guards = ()
        return TimedStep(transition, (every, window), guards)

    def _deadlines(self) -> Iterator[Deadline]:
        bound = {clock for step in self.steps if step.in_turn for clock in step.done}
        for clock, interval in self.bounds.items():
            if interval.hi is not None and clock in bound:
                yield Deadline(self.first[clock], interval.hi)
        mission = self.first.get(Clock(Sort.MISSION), 0)
        for number, transitions in enumerate(self.by_clauses):
            step = self.timing.clause(number).step
            if transitions and isinstance(step, Window) and step.within is not None:
                yield Deadline(mission, step.within, self.first[Clock(Sort.WINDOW, number)])

    # --- what is asked of ages

    @cached_property
    def constants(self) -> tuple[int, ...]:
        """How far each clock has to be counted: the largest constant, and one more where it may be past it."""
        bounds = (self.bounds[clock] for clock in self.clocks)
        largest = (max(each.lo, each.hi or 0) for each in bounds)
        return tuple(most + (clock.sort in STRICT) for most, clock in zip(largest, self.clocks, strict=True))

    def slack(self, ages: tuple[int, ...]) -> int | None:
        """Return how many ticks may pass; None if any number."""
        left = (
            max(most - ages[clock], 0)
            for clock, most, unless in self.deadlines
            if unless is None or ages[unless] < FREE
        )
        return min(left, default=None)

    def later(self, ages: tuple[int, ...], ticks: int) -> tuple[int, ...]:
        """Return the ages some ticks later."""
        return tuple(
            age if clock.sort is Sort.WINDOW else age + ticks
            for age, clock in zip(ages, self.clocks, strict=True)
        )

    def first_ages(self) -> tuple[int, ...]:
        """Return the ages at the start of the mission."""
        full = {Sort.EVERY, Sort.RESTORED}
        ages = [
            most if clock.sort in full else 0 for clock, most in zip(self.clocks, self.constants, strict=True)
        ]
        return self.entered(ages)

    def entered(self, ages: list[int]) -> tuple[int, ...]:
        """Return the ages after a step into this configuration: a window binds what it is first enabled in."""
        for number, transitions in enumerate(self.by_clauses):
            step = self.timing.clause(number).step
            if transitions and isinstance(step, Window):
                window = self.first[Clock(Sort.WINDOW, number)]
                if not ages[window]:
                    late = step.within is not None and ages[self.first[Clock(Sort.MISSION)]] > step.within
                    ages[window] = FREE if late else BOUND
        return tuple(ages)

    def unbounded(self) -> Iterator[Label]:
        """Yield what agents may do here in their turn that nothing says an end of."""
        ending = {deadline.clock for deadline in self.deadlines}
        for step in self.steps:
            bounded = any(self.first[clock] in ending for clock in step.done if clock in self.first)
            if step.in_turn and step.transition.label.agent is not None and not bounded:
                yield step.transition.label

    def exhausted(self, ages: tuple[int, ...]) -> tuple[Name, ...]:
        """Return the vehicles that are aloft for longer than they last."""
        return tuple(
            vehicle
            for vehicle, endurance in self.timing.endurances
            if ages[self.first[Clock(Sort.ALOFT, vehicle)]] > endurance.lasts
            and not self.is_restored(vehicle)
            and vehicle in self.c.structure.physical
        )

    def unsayable(self, ages: tuple[int, ...]) -> frozenset[int]:
        """Return the clauses whose message cannot be said any more."""
        return frozenset(
            number
            for number, times in enumerate(self.timing.clauses)
            if isinstance(times.step, Sayable)
            and times.step.until is not None
            and ages[self.first[Clock(Sort.MISSION)]] > times.step.until
        )


class Passage:
    """What a step does to the clocks.

    Attributes:
        sources: For each clock of the target, the index of the one that goes on in it; None where it starts.
        freed: The clocks of windows that bind no more.
        leaving: Of vehicles that leave where they are restored: RESTORED before, ALOFT after, and how long it takes.
    """

    def __init__(self, source: Situation, step: TimedStep, target: Situation) -> None:
        going_on: dict[Clock, list[int]] = defaultdict(list)
        for index, clock in enumerate(source.clocks):
            going_on[clock].append(index)
        for clock in step.done:
            going_on[clock] = going_on[clock][1:] if clock.sort is Sort.REQUEST else []
        for clock, aimed in target.aims.items():
            if source.aims.get(clock) != aimed:
                going_on[clock] = []
        self.target = target
        windows = (each for each in step.done if each.sort is Sort.WINDOW)
        self.freed = tuple(target.first[each] for each in windows if each in target.first)
        for index in self.freed:
            going_on[target.clocks[index]] = []
        self.sources = tuple(going_on[each].pop(0) if going_on[each] else None for each in target.clocks)
        self.leaving = tuple(
            (
                source.first[Clock(Sort.RESTORED, vehicle)],
                target.first[Clock(Sort.ALOFT, vehicle)],
                endurance.after,
            )
            for vehicle, endurance in target.timing.endurances
            if Clock(Sort.RESTORED, vehicle) in source.first
            and Clock(Sort.RESTORED, vehicle) not in target.first
        )

    def ages(self, ages: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
        """Yield the ages after the step: several where a vehicle may just have been restored, or not."""
        after = [0 if source is None else ages[source] for source in self.sources]
        for index in self.freed:
            after[index] = FREE
        several = [after]
        for restored, aloft, least in self.leaving:
            fresh = [[0 if at == aloft else age for at, age in enumerate(each)] for each in several]
            several = (several if ages[restored] <= least else []) + (
                fresh if ages[restored] >= least else []
            )
        yield from dict.fromkeys(map(self.target.entered, several))


def word_of(request: CTR) -> str:
    """Return the word of a command, or the name of a rule.

    >>> import re
    >>> re.match(r"[A-Za-z_]+", "HAND uav0 TO gcs1").group()
    'HAND'
    """
    found = re.match(r"\w+", request.reaction.text)
    return found.group() if found else ""


def _bounds_of(step: Window | Sayable) -> Iterator[int]:
    yield step.after
    yield from filter(None, [step.within if isinstance(step, Window) else step.until])


def _around(c: Configuration, entity: Name) -> Iterator[Name]:
    """Yield the places around an entity, the innermost first, as P has them."""
    seen: set[Name] = set()
    place = c.structure.physical.abstract_parent(entity)
    while place in c.structure.physical and place not in seen:
        yield place
        seen.add(place)
        place = c.structure.physical.abstract_parent(place)
