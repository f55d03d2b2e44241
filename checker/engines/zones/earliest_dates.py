"""The earliest dates of a run, by backward propagation of zones from its goal.

The required clock values at a moment are a union of zones, since several edges may belong to one step.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.timed.first_runs import TimedRun
from checker.engines.zones.difference_bounds import FREE, close, restrict
from checker.engines.zones.timed_automaton import Constraint, Edge, TimedAutomaton

Zone = NDArray[np.int32]
Union = dict[int, list[Zone]]
"""For each location a union of zones."""

Ages = tuple[int, ...]
Goal = Callable[[int], list[Zone]]
"""The accepted clock values in a location at the end of a run, as a union of zones."""


class TimedState(NamedTuple):
    """A state of a run: its location and its clock values."""

    location: int
    ages: Ages


def whole(clocks: int) -> Zone:
    """Return the zone of all values of so many clocks."""
    zone = np.full((clocks + 1, clocks + 1), FREE, np.int32)
    zone[0, :] = 0
    np.fill_diagonal(zone, 0)
    return zone


def tested(zone: Zone, tests: Iterable[Constraint]) -> Zone | None:
    """Return a zone intersected with constraints, None if that is empty."""
    found = zone.copy()
    for clock, least, most in tests:
        if least > 0 and not restrict(found, len(found), 0, clock, -least):
            return None
        if most >= 0 and not restrict(found, len(found), clock, 0, most):
            return None
    return found


def before_edge(edge: Edge, clocks: int, zone: Zone) -> Zone | None:
    """Return the predecessors of a zone by an edge whose source has so many clocks, None if there are none."""
    found, sources = whole(clocks), np.array((0, *edge.sources))
    for i, one in enumerate(sources):
        for j, other in enumerate(sources):
            if one == other and zone[i, j] < 0:
                return None
            if one != other:
                found[one, other] = min(found[one, other], zone[i, j])
    return tested(found, edge.tests) if close(found, len(found)) else None


def before_delay(automaton: TimedAutomaton, location: int, zone: Zone) -> Iterator[Zone]:
    """Yield a zone, and its predecessors by a delay within the deadlines."""
    yield zone
    deadlines = automaton.location(location).deadlines
    if any(most < 0 for _, most in deadlines):
        return
    found = tested(zone, (Constraint(clock, 0, most) for clock, most in deadlines))
    if found is not None:
        found[0, 1:] = np.minimum(0, found[1:, 1:].min(axis=0)) if len(found) > 1 else 0
        yield found


def holds(zone: Zone, ages: Ages) -> bool:
    """Return whether clock values are in a zone."""
    shown = np.array((0, *ages))
    return bool(np.all((shown[:, None] - shown[None, :] <= zone) | (zone >= FREE)))


def least_delay(zone: Zone, ages: Ages) -> int | None:
    """Return the least delay after which clock values are in a zone, None if there is none."""
    shown = np.array((0, *ages))
    apart = (shown[:, None] - shown[None, :] <= zone) | (zone >= FREE)
    if not apart[1:, 1:].all():
        return None
    delay = max(0, int((-zone[0, 1:] - shown[1:]).max(initial=0)))
    return delay if holds(zone, tuple(age + delay for age in ages)) else None


class Dates:
    """The earliest dates of a sequence of steps from a moment to a goal."""

    def __init__(
        self, automaton: TimedAutomaton, first: TimedState, steps: Sequence[int], goal: Goal
    ) -> None:
        self.automaton = automaton
        self.first = first
        self.steps = tuple(steps)
        self.layers = list(self._layers())
        self.goals = {location: goal(location) for location in self.layers[-1]}
        self.wanted: list[Union] = []
        """The required clock values when each step is taken; the last entry is for the end of the run."""
        self.entered: list[Union] = []
        """The required clock values when the location of each step is entered."""
        self._solve()
        self._date()

    def _layers(self) -> Iterator[set[int]]:
        layer = {self.first.location}
        yield layer
        for step in self.steps:
            layer = {edge.target for place in layer for edge in self._edges(place, step)}
            yield layer

    def _edges(self, location: int, step: int) -> Iterator[Edge]:
        return (each for each in self.automaton.out(location) if each.step == step)

    def _solve(self) -> None:
        wanted = self.goals
        for done in range(len(self.steps), -1, -1):
            if done < len(self.steps):
                wanted = {place: list(self._before(place, self.steps[done])) for place in self.layers[done]}
            entered = {
                place: spread(
                    [earlier for zone in zones for earlier in before_delay(self.automaton, place, zone)]
                )
                for place, zones in wanted.items()
            }
            self.wanted.append(wanted)
            self.entered.append(entered)
        self.wanted.reverse()
        self.entered.reverse()

    def _before(self, location: int, step: int) -> Iterator[Zone]:
        clocks, found = len(self.automaton.location(location).clocks), list[Zone]()
        for edge in self._edges(location, step):
            for zone in self.entered[-1][edge.target]:
                earlier = before_edge(edge, clocks, zone)
                found += [] if earlier is None else [earlier]
        yield from spread(found)

    def run(self) -> TimedRun:
        """Return the run with its earliest dates."""
        return TimedRun(self.steps, tuple(self._dates[1:-1]), self._dates[-1])

    def history(self) -> list[tuple[int, TimedState]]:
        """Return the date and the moment of each entry into a location; last those of the end."""
        state = min(self.ends)
        found = [(self._dates[-1], state)]
        for now, before in zip(reversed(self._dates[:-1]), reversed(self._before_each), strict=True):
            state = before[state]
            found.append((now, state))
        return found[::-1]

    @property
    def ends(self) -> tuple[TimedState, ...]:
        """The possible last moments of the run with these dates."""
        return tuple(self._before_each[-1])

    def _date(self) -> None:
        now, states = 0, dict.fromkeys([self.first])
        self._dates = [now]
        self._before_each: list[dict[TimedState, TimedState]] = []
        for done in range(len(self.steps) + 1):
            delays = {
                (state, delay): None
                for state in states
                for zone in self.wanted[done].get(state.location, ())
                for delay in [least_delay(zone, state.ages)]
                if delay is not None and self._may_wait(state, delay)
            }
            assert delays, "the steps lead to no goal"
            least = min(delay for _, delay in delays)
            now += least
            before = {_later(state, least): state for state, delay in delays if delay == least}
            if done < len(self.steps):
                before = {after: before[state] for after, state in self._after(done, before).items()}
            states = dict.fromkeys(before)
            self._before_each.append(before)
            self._dates.append(now)

    def _may_wait(self, state: TimedState, delay: int) -> bool:
        bounds = self.automaton.location(state.location).deadlines
        return not delay or all(clock and state.ages[clock - 1] + delay <= most for clock, most in bounds)

    def _after(self, done: int, states: Iterable[TimedState]) -> dict[TimedState, TimedState]:
        """Return the moments after a step, each with the moment before it."""
        found: dict[TimedState, TimedState] = {}
        for state in states:
            for edge in self._edges(state.location, self.steps[done]):
                if passes(edge, state.ages):
                    after = TimedState(edge.target, moved(edge, state.ages))
                    if any(holds(zone, after.ages) for zone in self.entered[done + 1][after.location]):
                        found.setdefault(after, state)
        return found


def passes(edge: Edge, ages: Ages) -> bool:
    """Return whether clock values satisfy the guard of an edge."""
    return all(
        ages[clock - 1] >= least and (most < 0 or ages[clock - 1] <= most)
        for clock, least, most in edge.tests
    )


def moved(edge: Edge, ages: Ages) -> Ages:
    """Return the clock values after an edge."""
    return tuple(0 if source == 0 else ages[source - 1] for source in edge.sources)


def _later(state: TimedState, ticks: int) -> TimedState:
    return TimedState(state.location, tuple(age + ticks for age in state.ages))


def spread(zones: Sequence[Zone]) -> list[Zone]:
    """Return zones without those included in another one."""
    kept: list[Zone] = []
    for zone in zones:
        if not any(np.all(zone <= other) for other in kept):
            kept = [other for other in kept if not np.all(other <= zone)] + [zone]
    return kept


def without(zones: Sequence[Zone], away: Zone) -> list[Zone]:
    """Return the difference of a union of zones and a zone."""
    found: list[Zone] = []
    for zone in zones:
        rest: Zone | None = zone
        for i in range(len(away)):
            for j in range(len(away)):
                if rest is None or i == j or away[i, j] >= FREE or rest[i, j] <= away[i, j]:
                    continue
                outside = rest.copy()
                if restrict(outside, len(outside), j, i, -int(away[i, j]) - 1):
                    found.append(outside)
                rest = rest.copy()
                if not restrict(rest, len(rest), i, j, int(away[i, j])):
                    rest = None
    return found
