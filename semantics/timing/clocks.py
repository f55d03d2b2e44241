"""Clocks: the timed steps of a configuration, their bounds, and the clocks that a step restarts.

A clock belongs to a request, an agent, a clause of the environment, a flight, or a vehicle's endurance. It starts when
its owner's step is newly enabled or was just taken, and runs on while other steps are taken.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.signature import Name
from semantics.successors import Expansion, by_clause, expand
from semantics.timing.actor_clocks import (
    BOUND,
    FREE,
    ActorClock,
    ActorClocks,
    Sort,
    is_restored,
    lasting,
    of_clause,
    of_moves,
    of_requests,
    of_vehicle,
)
from semantics.timing.intervals import Interval
from semantics.timing.timing import Sayable, Timing, Window

STRICT = frozenset({Sort.MISSION, Sort.ALOFT, Sort.RESTORED})
"""Clocks that are compared with `>` to a constant; all others only with `>=`."""


class Guard(NamedTuple):
    """A clock of a situation, by its index, must lie within bounds."""

    clock: int
    least: int
    most: int | None = None


class ClockDeadline(NamedTuple):
    """No time passes once a clock reaches a bound, unless another clock marks the clause as free."""

    clock: int
    most: int
    unless: int | None = None


@dataclass(frozen=True, slots=True)
class TimedStep:
    """A transition that is in its turn, or waits for it.

    Attributes:
        transition: The transition.
        done: The clocks that it resets.
        guards: The guards, of which one must hold; empty if it is possible at any time.
        in_turn: Whether it is in its turn.
    """

    transition: Transition
    done: tuple[ActorClock, ...]
    guards: tuple[Guard, ...]
    in_turn: bool = True

    def is_due(self, ages: tuple[int, ...]) -> bool:
        """Whether the clocks allow it."""
        return not self.guards or any(
            ages[clock] >= least and (most is None or ages[clock] <= most)
            for clock, least, most in self.guards
        )


class TimedView:
    """The timed view of one configuration.

    Attributes:
        c: The configuration.
        expansion: Its untimed transitions and faults.
        clocks: The clocks that run; of equal ones the oldest is the first.
        constants: The largest constant that each clock is compared with.
        steps: Its timed steps.
        deadlines: The bounds on the passing of time.
        aims: The targets of each flight.
    """

    def __init__(self, c: Configuration) -> None:
        timing = c.setting.timing
        assert timing is not None
        self.c = c
        self.timing: Timing = timing
        self.expansion: Expansion = expand(c)
        self.by_clauses = tuple(tuple(by_clause(c, clause)) for clause in c.setting.environment)
        actors = tuple(self._actors())
        running = (*lasting(timing), *(each for clocks, _ in actors for each in clocks.running))
        self.bounds: dict[ActorClock, Interval] = {each.clock: each.interval for each in running}
        self.aims: dict[ActorClock, object] = {
            each.clock: each.aim for each in running if each.aim is not None
        }
        self.clocks: tuple[ActorClock, ...] = tuple(each.clock for each in running)
        self.first = {each: index for index, each in reversed(list(enumerate(self.clocks)))}
        self.steps: tuple[TimedStep, ...] = tuple(self._steps(actors))
        self.deadlines: tuple[ClockDeadline, ...] = tuple(dict.fromkeys(self._deadlines()))

    def _actors(self) -> Iterator[tuple[ActorClocks, Sequence[Transition]]]:
        """Yield the clocks of each actor, with its steps."""
        c, agents, enabled = self.c, self.c.alpha.names(), self.expansion.enabled
        for vehicle, _ in self.timing.endurances:
            yield of_vehicle(c, vehicle), ()
        for a in agents:
            served = [each for each in enabled if each.served is not None and each.label.agent == a]
            yield of_requests(c, a, served), served
        for a in agents:
            moves = [each for each in enabled if each.served is None and each.label.agent == a]
            yield of_moves(c, a, moves), moves
        for number, steps in enumerate(self.by_clauses):
            yield of_clause(c, number, steps), steps

    def _steps(self, actors: Iterable[tuple[ActorClocks, Sequence[Transition]]]) -> Iterator[TimedStep]:
        """Yield all steps; those that wait for their turn come last."""
        waiting = {id(each) for each in self.expansion.out_of_turn}
        timed = [each for clocks, steps in actors for each in zip(steps, clocks.steps, strict=True)]
        for in_turn in (True, False):
            for transition, (done, tests) in timed:
                if in_turn is (id(transition) not in waiting):
                    guards = tuple(Guard(self.first[clock], least, most) for clock, least, most in tests)
                    yield TimedStep(transition, done, guards, in_turn)

    def _deadlines(self) -> Iterator[ClockDeadline]:
        bound = {clock for step in self.steps if step.in_turn for clock in step.done}
        for clock, interval in self.bounds.items():
            if interval.hi is not None and clock in bound:
                yield ClockDeadline(self.first[clock], interval.hi)
        mission = self.first.get(ActorClock(Sort.MISSION), 0)
        for number, transitions in enumerate(self.by_clauses):
            step = self.timing.clause(number).step
            if transitions and isinstance(step, Window) and step.within is not None:
                yield ClockDeadline(mission, step.within, self.first[ActorClock(Sort.WINDOW, number)])

    # --- ages

    @cached_property
    def constants(self) -> tuple[int, ...]:
        """The cap of each clock: its largest constant, plus one if it is compared with `>`."""
        bounds = (self.bounds[clock] for clock in self.clocks)
        largest = (max(each.lo, each.hi or 0) for each in bounds)
        return tuple(most + (clock.sort in STRICT) for most, clock in zip(largest, self.clocks, strict=True))

    def slack(self, ages: tuple[int, ...]) -> int | None:
        """Return the number of ticks that may pass; None if unbounded."""
        left = (
            max(most - ages[clock], 0)
            for clock, most, unless in self.deadlines
            if unless is None or ages[unless] < FREE
        )
        return min(left, default=None)

    def later(self, ages: tuple[int, ...], ticks: int) -> tuple[int, ...]:
        """Return the ages after some ticks."""
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
        """Return the ages after a step into this configuration; a window binds a clause once the clause is enabled."""
        for number, transitions in enumerate(self.by_clauses):
            step = self.timing.clause(number).step
            if transitions and isinstance(step, Window):
                window = self.first[ActorClock(Sort.WINDOW, number)]
                if not ages[window]:
                    late = (
                        step.within is not None and ages[self.first[ActorClock(Sort.MISSION)]] > step.within
                    )
                    ages[window] = FREE if late else BOUND
        return tuple(ages)

    def unbounded(self) -> Iterator[Label]:
        """Yield the labels of agents' steps that are in their turn here and have no deadline."""
        ending = {deadline.clock for deadline in self.deadlines}
        for step in self.steps:
            bounded = any(self.first[clock] in ending for clock in step.done if clock in self.first)
            if step.in_turn and step.transition.label.agent is not None and not bounded:
                yield step.transition.label

    def exhausted(self, ages: tuple[int, ...]) -> tuple[Name, ...]:
        """Return the vehicles that have been aloft for longer than their endurance."""
        return tuple(
            vehicle
            for vehicle, endurance in self.timing.endurances
            if ages[self.first[ActorClock(Sort.ALOFT, vehicle)]] > endurance.lasts
            and not is_restored(self.c, vehicle)
            and vehicle in self.c.structure.physical
        )

    def unsayable(self, ages: tuple[int, ...]) -> frozenset[int]:
        """Return the clauses whose message can no longer be said."""
        return frozenset(
            number
            for number, times in enumerate(self.timing.clauses)
            if isinstance(times.step, Sayable)
            and times.step.until is not None
            and ages[self.first[ActorClock(Sort.MISSION)]] > times.step.until
        )


class ClockUpdate:
    """The effect of a step on the clocks.

    Attributes:
        sources: For each clock of the target, the index of the source clock that continues in it; None if it starts.
        freed: The clocks of windows that no longer bind.
        leaving: For each vehicle that leaves a restoring place: its RESTORED clock before, its ALOFT clock after, and
            the time that restoring takes.
    """

    def __init__(self, source: TimedView, step: TimedStep, target: TimedView) -> None:
        going_on: dict[ActorClock, list[int]] = defaultdict(list)
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
                source.first[ActorClock(Sort.RESTORED, vehicle)],
                target.first[ActorClock(Sort.ALOFT, vehicle)],
                endurance.after,
            )
            for vehicle, endurance in target.timing.endurances
            if ActorClock(Sort.RESTORED, vehicle) in source.first
            and ActorClock(Sort.RESTORED, vehicle) not in target.first
        )

    def ages(self, ages: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
        """Yield the ages after the step: several if a vehicle may or may not just have been restored."""
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
