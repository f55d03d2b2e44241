"""The reachable states in whole ticks: a state is a configuration with the ages of its clocks.

An edge is a step, which takes no time, or `delay`, which adds one to each clock.
"""

from __future__ import annotations

from collections import deque

from checker.engines.timed.exchanged_clocks import ClockExchange, ExchangedUpdate
from checker.engines.timed.first_runs import DELAY, RunEdge
from semantics.state.configuration import Configuration
from semantics.timing.actor_clocks import ActorClock, Sort
from semantics.timing.clocks import ClockUpdate, TimedStep, TimedView

Edges = tuple[RunEdge, ...]


class Timeline:
    """The reachable states in whole ticks.

    Attributes:
        situations: The situation of each configuration, in the order of discovery.
        states: For each state the number of its configuration, and the ages of its clocks.
        edges: The edges of each state; empty before its expansion.
        order: The numbers of the reached configurations, in the order of their first runs (`first_run`).
        taken: The steps that are taken at some time, as pairs of a configuration's number and a step's.
        exchange: The exchanges under which representatives replace configurations; None for none.
    """

    def __init__(self, initial: Configuration, exchange: ClockExchange | None = None) -> None:
        self.initial = initial
        self.exchange = exchange
        self.numbers: dict[Configuration, int] = {}
        self.situations: list[TimedView] = []
        self.passages: dict[tuple[int, int], tuple[int, ClockUpdate | ExchangedUpdate]] = {}
        self.constants: dict[ActorClock, int] = {}
        self.caps: list[tuple[int, ...]] = []
        self.order: list[int] = []
        self.taken: set[tuple[int, int]] = set()
        self.begin()

    def begin(self) -> None:
        """Discard the states and start again; keep the knowledge about configurations."""
        self.grown = False
        self.caps = [self._caps(each) for each in self.situations]
        self.indices: dict[tuple[int, tuple[int, ...]], int] = {}
        self.states: list[tuple[int, tuple[int, ...]]] = []
        self.edges: list[Edges] = []
        number = self.number(self.initial)
        self.waiting: deque[int] = deque()
        self.reach(number, self.situations[number].first_ages())

    def number(self, c: Configuration) -> int:
        """Return the number of a configuration, a new one at the first visit."""
        number = self.numbers.get(c)
        if number is None:
            number = self.numbers[c] = len(self.situations)
            situation = TimedView(c)
            self.situations.append(situation)
            for running, constant in zip(situation.clocks, situation.constants, strict=True):
                clock = self._kin(running)
                before = self.constants.get(clock)
                self.constants[clock] = max(before or 0, constant)
                self.grown = self.grown or (before is not None and constant > before)
            self.caps.append(self._caps(situation))
        return number

    def _caps(self, situation: TimedView) -> tuple[int, ...]:
        return tuple(
            0 if each.sort is Sort.WINDOW else self.constants[self._kin(each)] for each in situation.clocks
        )

    def _kin(self, clock: ActorClock) -> ActorClock:
        return clock if self.exchange is None else self.exchange.kin(clock)

    def reach(self, number: int, ages: tuple[int, ...]) -> int:
        """Return the index of a state, a new one at the first visit."""
        state = (number, ages)
        index = self.indices.get(state)
        if index is None:
            index = self.indices[state] = len(self.states)
            self.states.append(state)
            self.edges.append(())
            self.waiting.append(index)
        return index

    def expand(self, index: int) -> None:
        """Follow every enabled step of a state, and a tick if the deadlines allow it."""
        number, ages = self.states[index]
        situation = self.situations[number]
        found: list[RunEdge] = []
        for at, step in enumerate(situation.steps):
            if step.in_turn and step.is_due(ages):
                target, passage = self.passage(number, at, step)
                found += (RunEdge(at, self.reach(target, each)) for each in passage.ages(ages))
        if situation.slack(ages) != 0:
            found.append(RunEdge(DELAY, self.reach(number, older(ages, self.caps[number]))))
        self.edges[index] = tuple(found)

    def passage(self, number: int, at: int, step: TimedStep) -> tuple[int, ClockUpdate | ExchangedUpdate]:
        """Return the target of a step, and its effect on the clocks."""
        known = self.passages.get((number, at))
        if known is None:
            known = self.passages[number, at] = self._follow(number, step)
        return known

    def _follow(self, number: int, step: TimedStep) -> tuple[int, ClockUpdate | ExchangedUpdate]:
        c = step.transition.target
        if self.exchange is None:
            target = self.number(c)
            return target, ClockUpdate(self.situations[number], step, self.situations[target])
        renaming, shown = self.exchange.symmetry.sorting(c)
        target, reached = self.number(shown), TimedView(c)
        order = self.exchange.order(reached.clocks, renaming, self.situations[target].clocks)
        return target, ExchangedUpdate(ClockUpdate(self.situations[number], step, reached), order)

    # --- queries

    def configuration(self, index: int) -> int:
        """Return the number of a state's configuration."""
        return self.states[index][0]


def older(ages: tuple[int, ...], caps: tuple[int, ...]) -> tuple[int, ...]:
    """Return the ages one tick later; the clocks of windows measure no time and stay."""
    return tuple(age + 1 if age < cap else age for age, cap in zip(ages, caps, strict=True))
