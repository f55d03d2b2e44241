"""The interface of answers about time, the same for every engine; verdicts about time are made of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from typing import Final, NamedTuple, Protocol, TypeVar

from checker.engines.timed.first_runs import TimedRun
from checker.properties.inspections import InTime
from semantics.environment import Says
from semantics.properties.propositions import Proposition
from semantics.state.configuration import Configuration, Transition
from semantics.state.requests import FLY
from semantics.state.signature import Name
from semantics.successors import Expansion
from semantics.timing.clocks import TimedView


@dataclass(frozen=True, slots=True)
class WaitAnswer:
    """The wait for a proposition.

    Attributes:
        most: The longest wait in ticks; 0 without a wait; infinite where it has no known end.
        late: The first run that waits longer than allowed, None if there is none.
        ever: Whether the wait may be endless; known only where it may be too long.
    """

    most: float
    late: TimedRun | None = None
    ever: bool = False


@dataclass(frozen=True, slots=True)
class FirstMoments:
    """The moments at which a proposition is first true.

    Attributes:
        first: The first of the earliest runs to such a moment; None if it is never true.
        latest: The last tick at which it becomes true; infinite where there is none.
        may_wait: Whether it may never become true.
    """

    first: TimedRun | None
    latest: float
    may_wait: bool


class TakenStep(NamedTuple):
    """A step of a configuration, both by number."""

    place: int
    step: int


class DateSpan(NamedTuple):
    """The earliest and the latest date of an event, in ticks from the start.

    The earliest is infinite if the event never happens, the latest if nothing bounds it.
    """

    earliest: float
    latest: float


NO_SPAN: Final = DateSpan(math.inf, -math.inf)


@dataclass(frozen=True, slots=True)
class TimelockRun:
    """A run to a timelock: no time can pass after it.

    Attributes:
        run: The run, ending with the zero-time steps that repeat.
        steps: The number of steps before the repetition.
    """

    run: TimedRun
    steps: int


Named = TypeVar("Named", bound=Hashable)
"""An event as a report tells it: a flight, or the two agents of a message."""


@dataclass(frozen=True, slots=True)
class VehicleFlight:
    """The flight of one vehicle.

    Attributes:
        request: Its request.
        travelling: The vehicles that travel by this request.
        vehicle: The vehicle.
        agent: The requesting agent.
        origin: The place in which L has the vehicle at the start.
        destination: The place in which the flight ends.
    """

    request: FLY
    travelling: tuple[Name, ...]
    vehicle: Name
    agent: Name
    origin: Name
    destination: Name


class Times(Protocol):
    """The answers of an engine about time.

    Attributes:
        initial: The initial configuration of the exploration.
        searched: The size of the searched state space, in words.
        situations: The timed situation of each configuration, in the order of the exploration.
    """

    initial: Configuration

    @property
    def searched(self) -> str:
        """The size of the searched state space, in words."""

    @property
    def situations(self) -> Sequence[TimedView]:
        """The timed situation of each configuration, in the order of the exploration."""

    def taken(self, place: int) -> set[int]:
        """Return the steps of a configuration that are taken at some time."""

    def together(self, place: int) -> Iterable[tuple[Transition, ...]]:
        """Return the pairs of pending controls that may be served at the same moment, as the steps that serve them.

        A control that waits for its turn counts as past its least time.
        """

    def unsayable(self, place: int) -> set[int]:
        """Return the clauses whose message has expired at some time in a configuration."""

    def run_before(self, place: int, by: Transition | None) -> TimedRun:
        """Return the first run to a configuration, then through a transition if that is ever taken there."""

    def transitions(self, run: TimedRun) -> tuple[Transition, ...]:
        """Return the transitions of a run."""

    def within(self, asked: Proposition | None, awaited: Proposition, most: int) -> WaitAnswer:
        """Return the longest wait for a proposition from the start, or from wherever another one is true."""

    def moments(self, formula: Proposition) -> FirstMoments:
        """Return the earliest and latest moments at which a proposition becomes true."""

    def where(self, formula: Proposition) -> Sequence[bool]:
        """Return for each configuration whether a proposition is true there."""

    def way_to(
        self, run: TimedRun, is_end: Callable[[Configuration, Name], bool], about: Name = ""
    ) -> tuple[Transition, ...]:
        """Return the shortest in-turn steps from the end of a run to a configuration, empty if none lead there.

        `is_end` gets a configuration, and the name there of the entity that is called `about` at the end of the run:
        representatives have other names. An empty name stands for none.
        """

    def in_original_names(self, place: int, by: Transition | None, text: str) -> str:
        """Return a text about a configuration in the names of the run to it that `run_before` returns."""

    def alike(self, event: Named) -> Iterable[Named]:
        """Return the events that have the same dates as one, itself included: exchanges of names map it to them.

        What is reported of an event by its names is to be reported of each of these.
        """

    def unbounded(self) -> Set[str]:
        """Return the rules of agents' in-turn steps that have no upper time bound."""

    def longest_flights(self) -> Mapping[Name, int]:
        """Return the longest flight of each agent in ticks, where it is bounded."""

    def spans(self, steps: Sequence[Set[TakenStep]]) -> list[DateSpan]:
        """Return for each set of steps the span of dates at which one of them is taken."""

    def exhausted(self) -> tuple[dict[str, TimedRun], int]:
        """Return the first run that exhausts each vehicle, and the number of configurations with an exhausted one."""

    def stop(self) -> TimelockRun | None:
        """Return the first run to a timelock, None if there is none."""


def shown_in_time(times: Times, place: int, shown: InTime) -> Iterator[tuple[Configuration, Expansion]]:
    """Yield the views of a configuration for an inspection."""
    situation = times.situations[place]
    match shown:
        case InTime.TAKEN:
            yield situation.c, _taken(situation, times.taken(place))
        case InTime.TOGETHER:
            for pair in times.together(place):
                yield situation.c, Expansion(pair, ())
        case InTime.ENABLED:
            yield without_sayings(times.unsayable(place), situation.c), situation.expansion


def shown_to(inspection: object) -> InTime:
    """Return the kind of view that an inspection requires."""
    shown: InTime = getattr(inspection, "in_time", InTime.ENABLED)
    return shown


def _taken(situation: TimedView, steps: set[int]) -> Expansion:
    taken = {situation.steps[at].transition for at in steps}
    expansion = situation.expansion
    by_agents = tuple(each for each in expansion.by_agents if each in taken)
    by_environment = tuple(each for each in expansion.by_environment if each in taken)
    return Expansion(by_agents, by_environment, (), expansion.faults)


def without_sayings(late: Set[int], c: Configuration) -> Configuration:
    """Return a configuration in which the messages of expired clauses are used up."""
    clauses = (c.setting.environment[number] for number in sorted(late))
    counters = {clause.counter: 0 for clause in clauses if isinstance(clause, Says)}
    return c.with_(counters) if counters else c
