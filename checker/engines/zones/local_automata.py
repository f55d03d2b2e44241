"""A mission's timed automaton, divided into the automata of its processes in local time.

An event is a step with the local states of its participants before and after it. So a configuration has exactly the
steps whose events its local states allow.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.zones.difference_bounds import NONE
from checker.engines.zones.local_states import LocalStates
from checker.engines.zones.timed_automaton import Constraint, Edge, Location, TimedAutomaton
from semantics.timing.actor_clocks import Sort
from semantics.timing.timing import Sayable, Window

Wrong = Mapping[int, Sequence[Constraint]]
"""The clock constraints that violate a property in each location."""


class LocalAutomaton(NamedTuple):
    """The automaton of a process. The step of an edge is the number of its event.

    Attributes:
        name: The process's name.
        automaton: Its automaton.
        first, ages: Its first location, and the clock values there.
        wrong: The constraints that violate the property.
    """

    name: str
    automaton: TimedAutomaton
    first: int
    ages: tuple[int, ...]
    wrong: Wrong


class LocalAutomata(NamedTuple):
    """The automata of all processes, and the participants of each event."""

    processes: tuple[LocalAutomaton, ...]
    events: tuple[tuple[int, ...], ...]


class _Event(NamedTuple):
    """A step as its participants take part in it: its participants, and what each of them does.

    Attributes:
        takes: Its participants.
        before, after: Their local states.
        tests: For each of them the guard on its clocks.
        sources: For each of them the source of each clock.
    """

    takes: tuple[int, ...]
    before: tuple[int, ...]
    after: tuple[int, ...]
    tests: tuple[tuple[Constraint, ...], ...]
    sources: tuple[tuple[int, ...], ...]


@dataclass
class Division:
    """The division of an automaton among the processes of local time.

    Attributes:
        automaton: The automaton.
        states: The local states in its locations.
        left: The locations whose edges are divided.
    """

    automaton: TimedAutomaton
    states: LocalStates
    left: NDArray[np.int64]

    def divided(self, first: int, ages: Sequence[int], wrong: Wrong) -> LocalAutomata:
        """Return the automata of all processes."""
        events = tuple({event: None for at in self.left.tolist() for event in self._events(at)})
        processes = range(self.automaton.processes)
        edges: list[dict[int, list[Edge]]] = [{} for _ in processes]
        for number, event in enumerate(events):
            for process, before, after, tests, sources in zip(*event, strict=True):
                edges[process].setdefault(before, []).append(Edge(number, tests, after, sources))
        return LocalAutomata(
            tuple(self._process(process, edges[process], first, ages, wrong) for process in processes),
            tuple(event.takes for event in events),
        )

    # --- clocks

    @cached_property
    def _owners(self) -> list[int]:
        """The process of each clock; `NONE` for the mission's clock, of which each process may have its own."""
        home, _ = self.states.homes
        found = [self._owner(number) for number in range(len(self.states.network.clocks_of))]
        return [NONE if each == NONE else int(home[each]) for each in (*found, len(home) - 1)]

    def _owner(self, number: int) -> int:
        """Return the agent, clause or vehicle of a clock."""
        agents, clauses, _ = self.states.participants.sizes
        clock = self.states.network.clocks_of[number]
        match clock.sort:
            case Sort.MISSION:
                return NONE
            case Sort.ALOFT | Sort.RESTORED:
                vehicles = [vehicle for vehicle, _ in self.states.network.timing.endurances]
                return agents + clauses + vehicles.index(str(clock.of))
            case Sort.EVERY | Sort.RETURNS:
                assert isinstance(clock.of, int)
                return agents + clock.of
            case Sort.AGENT | Sort.AFTER:
                return self.states.network.model.groups[0].index(str(clock.of))
            case _:
                agent: str = clock.of.agent  # type: ignore[attr-defined]  # a request
                return self.states.network.model.groups[0].index(agent)

    @cached_property
    def _timekeepers(self) -> frozenset[int]:
        """The processes that have a mission's clock: the clauses that are bound to dates."""
        begin = self.states.participants.sizes[0]
        steps = enumerate(each.step for each in self.states.network.timing.clauses)
        return frozenset(begin + number for number, step in steps if isinstance(step, Window | Sayable))

    def _clocks(self, running: tuple[int, ...], process: int) -> list[int]:
        """Return the indices of a process's clocks among those that run in a location."""
        mine = {process, NONE} if process in self._timekeepers else {process}
        return [index for index, clock in enumerate(running, 1) if self._owners[clock] in mine]

    def clocks_of(self, at: int, process: int) -> list[int]:
        """Return the indices of a process's clocks in a location."""
        return self._clocks(self._running[at], process)

    @cached_property
    def _running(self) -> list[tuple[int, ...]]:
        """The clocks that run in each location."""
        return [self.automaton.location(at).clocks for at in range(len(self.automaton))]

    # --- events and automata

    def _events(self, at: int) -> Iterator[_Event]:
        numbers = self.states.numbers
        for edge in self.automaton.out(at):
            parts = self._known_parts(edge[1:2] + edge[3:], self._running[at], self._running[edge.target])
            before, after = (
                tuple(numbers[each][place] for each in parts.takes) for place in (at, edge.target)
            )
            yield parts._replace(before=before, after=after)

    @cached_property
    def _known_parts(self) -> Callable[..., _Event]:
        return cache(self._parts)

    def _parts(
        self,
        edge: tuple[tuple[Constraint, ...], tuple[int, ...], int],
        running: tuple[int, ...],
        later: tuple[int, ...],
    ) -> _Event:
        """Return the clocks of an event, given an edge's tests, sources and footprint, and the clocks at its ends."""
        tests, sources, footprint = edge
        takes = self.states.participants.of(footprint)
        clocks = {each: self._clocks(running, each) for each in takes}
        guards: dict[int, list[Constraint]] = {each: [] for each in takes}
        for test in tests:
            owner = next(each for each in takes if test.clock in clocks[each])
            guards[owner].append(test._replace(clock=clocks[owner].index(test.clock) + 1))
        begun = [[sources[clock - 1] for clock in self._clocks(later, each)] for each in takes]
        kept = (
            tuple(clocks[each].index(source) + 1 if source else 0 for source in several)
            for each, several in zip(takes, begun, strict=True)
        )
        return _Event(takes, (), (), tuple(map(tuple, guards.values())), tuple(kept))

    def _process(
        self, process: int, edges: Mapping[int, list[Edge]], first: int, ages: Sequence[int], wrong: Wrong
    ) -> LocalAutomaton:
        states, automaton = self.states.numbers[process], TimedAutomaton()
        _, shown = np.unique(np.array(states), return_index=True)
        for at in shown.tolist():
            running = self._running[at]
            indices = self._clocks(running, process)
            mine = [each for each in self.automaton.deadlines_of(at) if each[2] == process]
            deadlines = tuple((indices.index(clock) + 1 if clock else 0, most) for clock, most, _ in mine)
            automaton.add(Location(tuple(running[each - 1] for each in indices), deadlines))
        for state in range(len(automaton)):
            automaton.leave(state, edges.get(state, ()))
        begun = tuple(ages[each - 1] for each in self.clocks_of(first, process))
        violated = {states[at]: self._own(at, process, tests) for at, tests in wrong.items()}
        return LocalAutomaton(self.states.name(process), automaton, states[first], begun, violated)

    def _own(self, at: int, process: int, tests: Iterable[Constraint]) -> list[Constraint]:
        """Return the constraints in a location that are on a process's clocks."""
        indices = self.clocks_of(at, process)
        mine = (each for each in tests if each.clock in indices)
        return [each._replace(clock=indices.index(each.clock) + 1) for each in mine]
