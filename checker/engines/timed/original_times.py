"""The answers about time of a search through representatives, in the names of the mission.

An exchange of names maps timed runs to timed runs with the same dates. So the dates of the search are those of the
mission. Its runs pass representatives, and are unfolded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence, Set
from dataclasses import replace

from checker.engines.original_run import original_step
from checker.engines.timed.answers import (
    DateSpan,
    FirstMoments,
    Named,
    TakenStep,
    TimelockRun,
    Times,
    WaitAnswer,
)
from checker.engines.timed.exchanged_clocks import ClockExchange
from checker.engines.timed.first_runs import TimedRun
from checker.limits import look
from checker.reduction.configuration_renaming import Renaming
from semantics.properties.propositions import Proposition
from semantics.state.configuration import Configuration, Transition
from semantics.state.signature import Name
from semantics.timing.clocks import TimedView


class _Unfolding:
    """A run of the mission beside a run of representatives.

    Attributes:
        real, shown: The last situations of both.
        renaming: The renaming from the first to the second.
        steps: The numbers of the real steps.
    """

    def __init__(self, exchange: ClockExchange, initial: Configuration, renaming: Renaming) -> None:
        self.exchange = exchange
        self.real = self.shown = TimedView(initial)
        self.renaming = renaming
        self.steps: list[int] = []

    def take(self, step: int) -> None:
        """Take the step that corresponds to a step of the representative."""
        self.follow(self.shown.steps[step].transition)

    def follow(self, taken: Transition) -> Transition:
        """Take the step that corresponds to a transition of the representative, and return it."""
        allowed = [each.transition for each in self.real.steps]
        real = original_step(taken, self.renaming, allowed)
        self.steps.append(allowed.index(real))
        self.real = TimedView(real.target)
        sorting, shown = self.exchange.symmetry.sorting(taken.target)
        self.renaming, self.shown = sorting.after(self.renaming), TimedView(shown)
        return real

    @property
    def moved(self) -> tuple[frozenset[tuple[object, object]], ...]:
        """The renaming, comparable: the pairs of different things."""
        return tuple(
            frozenset((one, other) for one, other in part.items() if one != other)
            for part in self.renaming.parts
        )


class OriginalTimes:
    """The answers of an engine that searched representatives, in the names of the mission.

    Attributes:
        shown: The answers about representatives.
        exchange: The exchanges of the mission's names.
    """

    def __init__(self, shown: Times, exchange: ClockExchange) -> None:
        self.shown = shown
        self.exchange = exchange
        self.initial = shown.initial
        self.behind: dict[TimedRun, tuple[TimedRun, Renaming]] = {}
        """For each returned run the run of representatives, and the renaming at its beginning."""

    # --- configurations

    @property
    def searched(self) -> str:
        """The size of the searched state space, in words."""
        return self.shown.searched

    @property
    def situations(self) -> Sequence[TimedView]:
        """The timed situation of each representative."""
        return self.shown.situations

    def taken(self, place: int) -> set[int]:
        """Return the steps of a representative that are taken at some time."""
        return self.shown.taken(place)

    def together(self, place: int) -> Iterable[tuple[Transition, ...]]:
        """Return the pairs of pending controls that may be served at the same moment."""
        return self.shown.together(place)

    def unsayable(self, place: int) -> set[int]:
        """Return the clauses whose message has expired at some time in a representative."""
        return self.shown.unsayable(place)

    def where(self, formula: Proposition) -> Sequence[bool]:
        """Return for each representative whether a proposition is true there."""
        return self.shown.where(formula)

    def unbounded(self) -> Set[str]:
        """Return the rules of agents' in-turn steps that have no upper time bound."""
        return self.shown.unbounded()

    def longest_flights(self) -> dict[Name, int]:
        """Return the longest flight of each agent in ticks, where it is bounded."""
        found: dict[Name, int] = {}
        for agent, most in self.shown.longest_flights().items():
            for other in self.exchange.alike(agent):
                found[other] = max(most, found.get(other, 0))
        return found

    # --- runs

    def transitions(self, run: TimedRun) -> tuple[Transition, ...]:
        """Return the transitions of a run."""
        situation, found = TimedView(self.initial), list[Transition]()
        for at in run.steps:
            found.append(situation.steps[at].transition)
            situation = TimedView(found[-1].target)
        return tuple(found)

    def _unfolding(self, shown: TimedRun, first: Renaming | None = None) -> _Unfolding:
        found = _Unfolding(self.exchange, self.initial, Renaming() if first is None else first)
        for step in shown.steps:
            look()
            found.take(step)
        return found

    def _original(self, shown: TimedRun, first: Renaming | None = None) -> TimedRun:
        """Return the run of the mission behind one of representatives, with its dates."""
        run = replace(shown, steps=tuple(self._unfolding(shown, first).steps))
        self.behind[run] = shown, Renaming() if first is None else first
        return run

    def run_before(self, place: int, by: Transition | None) -> TimedRun:
        """Return the first run to a representative's configurations, then through a transition if one is taken."""
        return self._original(self.shown.run_before(place, by))

    def in_original_names(self, place: int, by: Transition | None, text: str) -> str:
        """Return a text about a representative in the names of the run to it that `run_before` returns."""
        run, steps = self.shown.run_before(place, by), self.situations[place].steps
        if by is not None and any(steps[at].transition == by for at in self.taken(place)):
            run = replace(run, steps=run.steps[:-1])
        return self._unfolding(run).renaming.inverse.text(text)

    def way_to(
        self, run: TimedRun, is_end: Callable[[Configuration, Name], bool], about: Name = ""
    ) -> tuple[Transition, ...]:
        """Return the shortest in-turn steps from the end of a run to a configuration, empty if none lead there."""
        shown, first = self.behind[run]
        unfolding = self._unfolding(shown, first)
        onward = self.shown.way_to(shown, is_end, unfolding.renaming.name(about))
        return tuple(map(unfolding.follow, onward))

    # --- durations

    def within(self, asked: Proposition | None, awaited: Proposition, most: int) -> WaitAnswer:
        """Return the longest wait for a proposition from the start, or from wherever another one is true."""
        found = self.shown.within(asked, awaited, most)
        return found if found.late is None else replace(found, late=self._original(found.late))

    def moments(self, formula: Proposition) -> FirstMoments:
        """Return the earliest and latest moments at which a proposition becomes true."""
        found = self.shown.moments(formula)
        return found if found.first is None else replace(found, first=self._original(found.first))

    def spans(self, steps: Sequence[Set[TakenStep]]) -> list[DateSpan]:
        """Return for each set of steps of representatives the span of dates at which one of them is taken."""
        return self.shown.spans(steps)

    def alike(self, event: Named) -> Iterator[Named]:
        """Yield the events that exchanges map an event to, itself first."""

        def image(each: Named, renaming: Renaming) -> Named:
            found: Named = renaming.value(each)
            return found

        return self.exchange.orbit(event, image)

    # --- endurance and timelocks

    def exhausted(self) -> tuple[dict[str, TimedRun], int]:
        """Return the first run that exhausts each vehicle, and the number of representatives with an exhausted one."""
        shown, count = self.shown.exhausted()
        found: dict[str, TimedRun] = {}
        for vehicle, run in sorted(shown.items(), key=lambda each: (len(each[1].steps), each[0])):
            real = self._unfolding(run).renaming.inverse.name(vehicle)
            for other in self.exchange.alike(real):
                if other not in found:  # the initial configuration is preserved by the exchange of both
                    found[other] = self._original(run, self.exchange.between(other, real))
        return found, count

    def stop(self) -> TimelockRun | None:
        """Return the first run to a timelock, None if there is none.

        One round of its steps may exchange names. After some rounds, each name is where it was.
        """
        stop = self.shown.stop()
        if stop is None:
            return None
        run, begin = stop.run, stop.steps
        unfolding = self._unfolding(replace(run, steps=run.steps[:begin]))
        entry, dates = unfolding.moved, run.dates[:begin]
        while True:
            for step in run.steps[begin:]:
                look()
                unfolding.take(step)
            dates += run.dates[begin:]
            if unfolding.moved == entry:
                return TimelockRun(TimedRun(tuple(unfolding.steps), dates, run.end), begin)
