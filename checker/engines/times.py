"""What an engine knows of time, whichever it is: what verdicts about time are made of."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from typing import Final, NamedTuple, Protocol

from checker.engines.runs import Run
from checker.properties.inspections import InTime
from semantics.environment import Says
from semantics.properties.propositions import Proposition
from semantics.state.configuration import Configuration, Transition
from semantics.state.signature import Name
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

    def where(self, formula: Proposition) -> Sequence[bool]:
        """Return for each configuration whether a proposition is true there."""

    def way_to(self, run: Run, is_end: Callable[[Configuration], bool]) -> tuple[Transition, ...]:
        """Return the fewest steps in turn from the end of a run to some configuration, none if none lead there."""

    def unbounded(self) -> Set[str]:
        """Return the rules by which agents may do something in their turn that nothing says an end of."""

    def longest_flights(self) -> Mapping[Name, int]:
        """Return for how many ticks a flight of each agent takes at most, where that is bounded."""

    def spans(self, steps: Sequence[Set[TakenStep]]) -> list[Span]:
        """Return for each of some sets of steps when one of them is taken."""

    def exhausted(self) -> tuple[dict[str, Run], int]:
        """Return the first run on which each vehicle is aloft for too long, and how many configurations show that."""

    def stop(self) -> Stop | None:
        """Return the first run after which no time can pass any more."""


def shown_in_time(times: Times, place: int, shown: InTime) -> Iterator[tuple[Configuration, Expansion]]:
    """Yield what is shown of a configuration to an inspection."""
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
    """Return what is shown to an inspection."""
    shown: InTime = getattr(inspection, "in_time", InTime.ENABLED)
    return shown


def _taken(situation: Situation, steps: set[int]) -> Expansion:
    taken = {situation.steps[at].transition for at in steps}
    expansion = situation.expansion
    by_agents = tuple(each for each in expansion.by_agents if each in taken)
    by_environment = tuple(each for each in expansion.by_environment if each in taken)
    return Expansion(by_agents, by_environment, (), expansion.faults)


def without_sayings(late: Set[int], c: Configuration) -> Configuration:
    """Return a configuration in which nobody can say any more what some clauses say: it is too late for that."""
    clauses = (c.setting.environment[number] for number in sorted(late))
    counters = {clause.counter: 0 for clause in clauses if isinstance(clause, Says)}
    return c.with_(counters) if counters else c
