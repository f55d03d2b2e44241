"""What an engine knows of time, whichever it is: what verdicts about time are made of."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence, Set
from dataclasses import dataclass
from typing import Final, NamedTuple, Protocol

from checker.engines.runs import Run
from checker.properties.inspections import InTime
from semantics.environment import Says
from semantics.properties.propositions import Proposition
from semantics.state.configuration import Configuration, Transition
from semantics.successors import Expansion
from semantics.timing.clocks import Situation


@dataclass(frozen=True, slots=True)
class Wait:
    """How long something is waited for.

    Attributes:
        most: For so many ticks at the most; 0 where nothing is waited for; infinite where that is not known to end.
        late: The first run on which it is waited for longer than allowed, None if there is none.
        ever: Whether it may be waited for without an end; known only where it may be for too long.
    """

    most: float
    late: Run | None = None
    ever: bool = False


@dataclass(frozen=True, slots=True)
class Moments:
    """When something is first true.

    Attributes:
        first: The first run to there of those that come there first; None if none does.
        latest: The last tick at which it becomes true; infinite where there is none.
        may_wait: Whether it may never be.
    """

    first: Run | None
    latest: float
    may_wait: bool


class TakenStep(NamedTuple):
    """A step of a configuration, both by their numbers."""

    place: int
    step: int


class Span(NamedTuple):
    """When something happens, in ticks from the start: at the earliest, and at the latest.

    The earliest is infinite where it never happens, the latest where nothing bounds it.
    """

    earliest: float
    latest: float


NO_SPAN: Final = Span(math.inf, -math.inf)


@dataclass(frozen=True, slots=True)
class Stop:
    """A run after which no time can pass any more.

    Attributes:
        run: The run, with the steps that are done again and again.
        steps: After how many steps they begin.
    """

    run: Run
    steps: int


class Times(Protocol):
    """What an engine knows of time.

    Attributes:
        initial: What the exploration started from.
        searched: Over what it searched, in words.
        situations: What time means in each configuration, in the order of the exploration.
    """

    initial: Configuration

    @property
    def searched(self) -> str:
        """Over what it searched, in words."""

    @property
    def situations(self) -> Sequence[Situation]:
        """What time means in each configuration, in the order of the exploration."""

    def taken(self, place: int) -> set[int]:
        """Return the steps of a configuration that are taken at some time."""

    def together(self, place: int) -> Iterable[tuple[Transition, ...]]:
        """Return each pair of pending controls with what serves them, if both may be served at one moment.

        What waits for its turn counts as if it had come to its least time.
        """

    def unsayable(self, place: int) -> set[int]:
        """Return the clauses whose message cannot be said any more at some time in a configuration."""

    def run_before(self, place: int, by: Transition | None) -> Run:
        """Return the first run to a configuration, and then a transition if that is ever taken there."""

    def transitions(self, run: Run) -> tuple[Transition, ...]:
        """Return what is done in a run."""

    def within(self, asked: Proposition | None, awaited: Proposition, most: int) -> Wait:
        """Return how long something is waited for from the start, or from wherever something else is true."""

    def moments(self, formula: Proposition) -> Moments:
        """Return when something is first true."""

    def spans(self, steps: Sequence[Set[TakenStep]]) -> list[Span]:
        """Return for each of some sets of steps when one of them is taken."""

    def exhausted(self) -> tuple[dict[str, Run], int]:
        """Return the first run on which each vehicle is aloft for too long, and how many configurations show that."""

    def stop(self) -> Stop | None:
        """Return the first run after which no time can pass any more."""


def inspect_in_time(times: Times, inspect: Sequence[object]) -> None:
    """Show each configuration to inspections as each of them wants to see it."""
    for place, situation in enumerate(times.situations if inspect else ()):
        for inspection in inspect:
            match getattr(inspection, "in_time", InTime.ENABLED):
                case InTime.TAKEN:
                    inspection(place, situation.c, _taken(situation, times.taken(place)))  # type: ignore[operator]
                case InTime.TOGETHER:
                    for pair in times.together(place):
                        inspection(place, situation.c, Expansion(pair, ()))  # type: ignore[operator]
                case _:
                    c = _without_sayings(situation, times.unsayable(place))
                    inspection(place, c, situation.expansion)  # type: ignore[operator]


def _taken(situation: Situation, steps: set[int]) -> Expansion:
    taken = {situation.steps[at].transition for at in steps}
    expansion = situation.expansion
    by_agents = tuple(each for each in expansion.by_agents if each in taken)
    by_environment = tuple(each for each in expansion.by_environment if each in taken)
    return Expansion(by_agents, by_environment, (), expansion.faults)


def _without_sayings(situation: Situation, late: set[int]) -> Configuration:
    """Return a configuration in which nobody can say any more what is too late at some time while it lasts."""
    clauses = (situation.c.setting.environment[number] for number in sorted(late))
    counters = {clause.counter: 0 for clause in clauses if isinstance(clause, Says)}
    return situation.c.with_(counters) if counters else situation.c
