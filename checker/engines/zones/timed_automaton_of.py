"""The timed automaton of a mission, unfolded on demand: the steps of configurations, with their clocks.

A location is a row of the fast engine with the states of the windows' clocks, which measure no time. The rules and
their clocks are learned from the few cells that they read; compiled loops then work out the edges of a location. The
constants of a clock are the largest seen so far; the search restarts when one grows.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator
from functools import lru_cache, partial
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.contract import WindowsError
from checker.engines.fast.compiled.arrays import Growing
from checker.engines.fast.compiled.table import most_in
from checker.engines.fast.model.decision_leaves import LEAF
from checker.engines.fast.model.learned_model import LIMIT, NODE
from checker.engines.fast.model.learner import Learner
from checker.engines.fast.search.rule_model import RuleModel
from checker.engines.fast.store.origins import OriginPages
from checker.engines.fast.store.row_store import RowFormat, RowStore
from checker.engines.timed.exchanged_clocks import ClockExchange
from checker.engines.zones import location_successors, location_views
from checker.engines.zones.clock_images import UNNAMED
from checker.engines.zones.difference_bounds import NONE
from checker.engines.zones.learned_images import LearnedImages, tables_of
from checker.engines.zones.location_views import (
    ANSWER,
    CHOICE,
    RUNNING,
    TIMES,
    AutomatonGrowth,
    LearnedClocks,
    LocationView,
)
from checker.engines.zones.participants import Participants
from checker.engines.zones.timed_automaton import (
    CLOCKS,
    DEADLINE,
    DEADLINES,
    EDGE,
    LOCATION,
    TEST,
    Constraint,
    TimedAutomaton,
)
from checker.limits import look
from checker.recording.value_templates import settled
from semantics.environment import Clause
from semantics.state.configuration import Configuration
from semantics.state.signature import Name
from semantics.successors import by_clause, moves, served
from semantics.timing.actor_clocks import (
    ActorClock,
    ActorClocks,
    RunningClock,
    Sort,
    StepClocks,
    lasting,
    of_clause,
    of_moves,
    of_requests,
    of_vehicle,
    timing_of,
)
from semantics.timing.clocks import STRICT, TimedStep, TimedView
from semantics.timing.intervals import Interval
from semantics.timing.timing import Window

NOWHERE = (0, NONE)
"""The deadline of a location in which no time passes."""

MOST_WINDOWS = 39
"""The most windows, whose states are the digits of a number of 64 bits in base 3."""

MARGIN = 1 << 12
"""The number of further locations, and edges, for which room is reserved."""


class MissionLocation(NamedTuple):
    """A location of a mission: the number of its row, and the states of the windows' clocks."""

    number: int
    windows: tuple[int, ...] = ()


class Network:
    """The knowledge about a mission's configurations, and the automaton that they form.

    Attributes:
        store: The configurations, as rows.
        learner, model: The rules, and their tables for the loops.
        automaton: The automaton; the edges of some locations may be unknown.
        clocks_of: The measured subject of each of its clocks.
        caps: The value of each clock beyond which no test distinguishes values.
        outgrown: Whether the constant of a clock has grown.
        first_ages: The clock values of the first location.
        exchange: The exchanges under which representatives replace rows; None for none.
        keys: The clock of each number, with its aim.
        participants: Those of each edge in local time; None with one clock.

    Raises:
        WindowsError: There are too many windows.
    """

    def __init__(
        self,
        initial: Configuration,
        pending: int,
        exchange: ClockExchange | None = None,
        *,
        local: bool = False,
    ) -> None:
        self.initial = initial
        self.exchange = exchange
        self.timing = timing_of(initial)
        self.automaton = TimedAutomaton()
        self.numbers: dict[tuple[ActorClock, Hashable], int] = {}
        self.keys: list[tuple[ActorClock, Hashable]] = []
        self.families: dict[Hashable, list[int]] = {}
        self.clocks_of: list[ActorClock] = []
        self.caps: dict[ActorClock, int] = {}
        self.outgrown = False
        self.windows = [
            number for number, each in enumerate(self.timing.clauses) if isinstance(each.step, Window)
        ]
        if len(self.windows) > MOST_WINDOWS:
            raise WindowsError(
                f"{len(self.windows)} appearances and disappearances with times are more than the engine 'fast' "
                f"counts ({MOST_WINDOWS})"
            )
        self.records: dict[ActorClocks, list[int]] = {}
        self.answers, self.running, self.times = (Growing(np.int32) for _ in range(3))
        self.done, self.tested, self.served = (Growing(np.int32) for _ in range(3))
        self.of_locations, self.of_rows, self.before = (Growing(np.int32) for _ in range(3))
        self.automaton.rows = self.of_locations
        self.said = Growing(np.int64)
        self.noted = 0
        self.counts_of = np.zeros(location_successors.DONE + 1, np.int64)
        self.lasting = {each.clock: self.number(each) for each in lasting(self.timing)}
        self.restored = [self._restoring(vehicle) for vehicle, _ in self.timing.endurances]
        self.questions: dict[tuple[object, Name | int], int] = {}
        self.timed: LearnedClocks
        self.learner = Learner(initial.setting, initial.state, pending)  # type: ignore[arg-type]  # a stored one
        self.store = RowStore(
            form=RowFormat(OriginPages)
        )  # rows are reached in the order of the timed search
        self.learned_images = None if exchange is None else LearnedImages(self, exchange)
        tables = None if exchange is None else tables_of(self.learner, exchange)
        self.model = RuleModel(self.learner, self.store, tables)
        self.participants: Participants | None = None
        self.model.followers.append(self._see)
        self.model.see()
        if local:
            sizes = (len(self.model.groups[0]), len(self.model.clauses), len(self.restored))
            self.participants = Participants(self.learner, self.automaton, sizes)
        self.situation = lru_cache(1 << 12)(lambda number: TimedView(self.configuration(number)))
        self.first_ages: tuple[int, ...] = ()

    @property
    def size(self) -> int:
        """The number of configurations."""
        return self.store.size

    def configuration(self, number: int) -> Configuration:
        """Return a configuration."""
        return self.model.configuration(number)

    def begin(self) -> None:
        """Add the first location."""
        situation = self.situation(0)
        ages = situation.first_ages()
        windows = [age for age, each in zip(ages, situation.clocks, strict=True) if each.sort is Sort.WINDOW]
        code = sum(said * 3**at for at, said in enumerate(windows))
        loop: Callable[..., int] = location_successors.begin

        def work(model: object, timed: LearnedClocks, growth: AutomatonGrowth, view: LocationView) -> int:
            rows, state = self.store.rows, self.store.state
            return loop(model, timed, growth, view, rows.words, rows.folded, code, state, self.counts_of)

        self._run(work)
        self.first_ages = self.measured(situation, ages)

    def settle(self) -> None:
        """Note whether more is shared than the search has supposed; then it is `outgrown`."""
        if self.participants is None:
            return
        if self.participants.is_void:
            self.counts_of[:] = 0
            self.of_rows.used[:] = NONE
            self._measure()
            self.participants.begin()
            self.begin()
            self.outgrown = True
        self.outgrown |= self.participants.divide()

    def leave_again(self, locations: NDArray[np.int64]) -> None:
        """Work out the edges of locations in the order of another network with the same rows.

        Raises:
            ValueError: No network has left them in this order.
        """
        if len(np.unique(locations)) != len(locations) or np.any(locations < 0):
            raise ValueError("it left a location twice")
        done = 0
        while done < len(locations):
            there = locations[done:] < len(self.automaton)
            count = len(there) if there.all() else int(np.argmin(there))
            if not count:
                raise ValueError("it left a location before reaching it")
            self.leave(locations[done : done + count])
            done += count

    # --- learned clocks -------------------------------------------------------------------------------------------

    def _see(self) -> None:
        """Update the loops' view of the learned clocks."""
        vehicles = [self._question(of_vehicle, vehicle) for vehicle, _ in self.timing.endurances]
        agents = [
            self._question(of, a)
            for group in self.model.groups
            for of in (of_requests, of_moves)
            for a in group
        ]
        clauses = [self._question(of_clause, number) for number in range(len(self.model.clauses))]
        self.asked = (agents, clauses, vehicles)
        self._note_answers()
        self._see_clocks()
        if self.participants is not None:
            self.participants.see()

    def _see_clocks(self) -> None:
        """Update the loops' view of the learned clocks."""
        if self.learned_images is not None:
            self.learned_images.see()
        windows = [
            each
            for number in self.windows
            for step in [self.timing.clause(number).step]
            if isinstance(step, Window)
            for each in (number, NONE if step.within is None else step.within)
        ]
        arrays = (self.answers, self.running, self.times, self.done, self.tested, self.served)
        lasting = [number for number in self.lasting.values() if number >= 0]
        always = (lasting, [each for several in self.restored for each in several], windows)
        self.timed = LearnedClocks._make(
            (
                *(np.array(each, np.int32) for each in self.asked),
                *(each.room for each in arrays),
                *(np.array(each, np.int32) for each in always),
            )
        )

    def _question(self, of: Callable[..., ActorClocks], about: Name | int) -> int:
        """Return the tree for the clocks of an actor."""
        if (of, about) not in self.questions:
            self.questions[of, about] = self.learner.question(partial(_asked, of, about))
        return self.questions[of, about]

    def _note_answers(self) -> None:
        """Record the learned clocks of actors."""
        missing = len(self.learner.leaves.leaves) // LEAF - len(self.answers) // ANSWER
        self.answers.extend(missing * ANSWER, NONE)
        new = len(self.learner.answers) - self.noted
        for leaf, answer in reversed(list(islice(reversed(self.learner.answers.items()), new))):
            if not isinstance(answer, ActorClocks):
                continue  # the answer to another question
            if answer not in self.records:
                self.records[answer] = self._record(answer)
            self.answers.room[ANSWER * leaf : ANSWER * (leaf + 1)] = self.records[answer]
        self.noted = len(self.learner.answers)

    def _record(self, answer: ActorClocks) -> list[int]:
        """Record the clocks of an actor; return the ranges of its clocks and its steps."""
        numbers = dict(self.lasting)
        run = len(self.running) // RUNNING
        for each in answer.running:
            number = numbers[each.clock] = self.number(each)
            self.running.append(
                number, each.interval.lo, NONE if each.interval.hi is None else each.interval.hi
            )
        step = len(self.times) // TIMES
        for done, tests in answer.steps:
            ends = len(self.done), len(self.tested) // TEST
            self.done.append(*(numbers[each] for each in done if each in numbers))
            for clock, least, most in tests:
                self.tested.append(numbers[clock], least, NONE if most is None else most)
            self.times.append(ends[0], len(self.done), ends[1], len(self.tested) // TEST)
        return [
            run,
            len(self.running) // RUNNING,
            step,
            len(self.times) // TIMES,
        ]

    def number(self, running: RunningClock) -> int:
        """Return the number of a clock, a new one at its first use; below 0 for a window's clock."""
        clock, interval, aim = running
        if clock.sort is Sort.WINDOW:
            assert isinstance(clock.of, int)
            return -1 - self.windows.index(clock.of)
        kin = self.kin(clock)
        self.caps[kin] = max(self.caps.get(kin, 0), cap(clock, interval))
        family = self.families.setdefault((clock, aim) if self.exchange is None else kin, [])
        number = self.numbers.get((clock, aim))
        if number is None:
            known = self.automaton.constants(family[0]) if family else compared(clock, interval)
            number = self.numbers[clock, aim] = self.automaton.clock(*known)
            self.clocks_of.append(clock)
            self.keys.append((clock, aim))
            self.served.append(clock.sort is Sort.REQUEST)
            family.append(number)
        for each in family:
            self.outgrown |= self.automaton.compare(each, *compared(clock, interval))
        return number

    def kin(self, clock: ActorClock) -> ActorClock:
        """Return the common name of the clocks that exchanges may replace by each other."""
        return clock if self.exchange is None else self.exchange.kin(clock)

    def _restoring(self, vehicle: Name) -> tuple[int, int, int]:
        """Return the clocks RESTORED and ALOFT of a vehicle, and the time that its restoring takes."""
        endurance = dict(self.timing.endurances)[vehicle]
        restored = self.number(RunningClock(ActorClock(Sort.RESTORED, vehicle), Interval(endurance.after)))
        return (
            restored,
            self.number(RunningClock(ActorClock(Sort.ALOFT, vehicle), Interval(endurance.lasts))),
            endurance.after,
        )

    # --- unfolding ------------------------------------------------------------------------------------------------

    def leave(self, locations: NDArray[np.int64]) -> None:
        """Work out the edges of locations, and learn the rules that this requires."""
        self.counts_of[location_successors.DONE] = 0
        choices = np.zeros(CHOICE * (len(self.restored) + len(self.windows) + 1), np.int32)
        images = self.learned_images

        def work(model: object, timed: LearnedClocks, growth: AutomatonGrowth, view: LocationView) -> int:
            store, rows, folded = self.store, self.store.rows, self.store.rows.folded
            other, arrays = self._view(), (rows.words, folded, rows.origins.loops, store.table.room)
            most = min(rows.room, most_in(len(store.table.room)), int(store.state[LIMIT]))
            target = np.zeros(store.packing.words, np.uint64)
            kept = target if folded is None else np.zeros(rows.kept, np.uint64)
            renaming: tuple[object, ...] = (None, None)
            footprints = None
            if self.participants is not None:
                footprints = self.participants.tables(
                    int(self.counts_of[location_successors.LEAVING]), self.margin
                )
            if images is not None:
                kept = np.zeros(max(rows.kept, store.packing.words), np.uint64)
                renaming = (images.images, images.scratch())
            scratch = target, kept, np.zeros(2 * self.margin, np.int32), choices
            loop: Callable[..., int] = location_successors.leave
            known = (model, timed, growth, view, other, footprints, *self.model.symmetry, *renaming)
            return loop(*known, *arrays, most, *scratch, locations, store.state, self.counts_of)

        self._run(work)

    margin = MARGIN

    def _run(self, loop: Callable[..., int]) -> None:
        """Run a loop to its end, with more room and more learned rules where it stops."""
        while True:
            look()  # each location is recorded whole
            if self.store.compress():
                self.model.see()
            self._reserve()
            done = self.counts_of.copy()
            why = loop(self.model.loops, self.timed, self._growth(), self._view())
            self._measure()
            if self.participants is not None:
                self.participants.take(
                    int(done[location_successors.LEAVING]), len(self.automaton.edges) // EDGE
                )
            if why == location_successors.KNOWN:
                return
            if why == location_successors.MISS:
                self._learn_more()
            elif np.array_equal(done, self.counts_of):
                self.margin *= 2

    def _learn_more(self) -> None:
        """Learn the rule, the representative or the image of a clock that a loop lacked."""
        if self.learned_images is not None and self.store.state[NODE] == UNNAMED:
            assert self.model.exchanging is not None
            self.learned_images.learn(self.model.exchanging.desk.place.tolist())
            self._see_clocks()
        else:
            self.model.learn_missing()

    def spill(self, folder: Path) -> None:
        """Move rows, origins and locations to files in a folder; raises OSError as `RowStore.spill`."""
        self.store.spill(folder)
        self.automaton.spill(folder)
        for each in (self.of_rows, self.before, self.said):
            each.spill(folder)

    def _reserve(self) -> None:
        self.store.make_room(self.margin)
        missing = self.size + self.margin - len(self.of_rows)
        if missing > 0:
            self.of_rows.extend(missing, NONE)
        widest = max(int(self.counts_of[location_successors.WIDEST]), 2 + len(self.numbers))
        automaton = self.automaton
        for each, size in (
            (automaton.locations, LOCATION),
            (automaton.edges, EDGE),
            (automaton.tests, 4 * TEST),
            (automaton.sources, min(widest, 64)),
            (automaton.deadlines, 8 * DEADLINE),
            (automaton.clocks, min(widest, 64)),
            (self.of_locations, 1),
            (self.before, 1),
            (self.said, 1),
        ):
            each.reserve(size * self.margin)

    def _growth(self) -> AutomatonGrowth:
        automaton = self.automaton
        arrays = (
            automaton.locations,
            automaton.edges,
            automaton.tests,
            automaton.sources,
            automaton.deadlines,
        )
        known = (automaton.clocks, self.of_locations, self.said, self.of_rows, self.before)
        return AutomatonGrowth(*(each.room for each in (*arrays, *known)))

    def _view(self) -> LocationView:
        clocks = len(self.clocks_of)
        most = self.model.actors
        actors = np.zeros(most, np.int32), np.zeros(most + len(self.restored), np.int32)
        numbers = np.zeros(location_views.CLOCKS + 1, np.int64)
        return LocationView(
            *actors,
            numbers,
            np.zeros(clocks, np.int32),
            np.zeros(clocks, np.int32),
            np.zeros(clocks, np.int64),
            np.zeros(clocks, np.int64),
        )

    def _measure(self) -> None:
        """Read the new sizes of the automaton from the loops."""
        located, leaving, tested, sourced, ended, clocked, widest, _ = self.counts_of.tolist()
        automaton = self.automaton
        automaton.locations.size, automaton.edges.size = LOCATION * located, EDGE * leaving
        automaton.tests.size, automaton.sources.size = TEST * tested, sourced
        automaton.deadlines.size, automaton.clocks.size = DEADLINE * ended, clocked
        automaton.largest = max(automaton.largest, widest)
        self.of_locations.size = self.before.size = self.said.size = located

    # --- locations ------------------------------------------------------------------------------------------------

    first = 0
    """The first location."""

    def place(self, location: int) -> MissionLocation:
        """Return the row and the windows of a location."""
        said = int(self.said.room[location])
        return MissionLocation(
            int(self.of_locations.room[location]), tuple(said // 3**at % 3 for at in range(len(self.windows)))
        )

    def locations(self, number: int) -> Iterator[int]:
        """Yield the locations of a row."""
        at = int(self.of_rows.room[number])
        while at >= 0:
            yield at
            at = int(self.before.room[at])

    def crowded(self, locations: NDArray[np.int64]) -> bool:
        """Return whether in some location an agent has more pending than the limit."""
        records = self.automaton.locations.used.reshape(-1, LOCATION)[locations]
        ends = records[records[:, DEADLINES] < records[:, DEADLINES + 1]][:, DEADLINES]
        return bool(np.any(self.automaton.deadlines.room[DEADLINE * ends + 1] < 0))

    def clocks(self, location: int) -> tuple[ActorClock, ...]:
        """Return the clocks of a location, from its first."""
        return tuple(self.clocks_of[each] for each in self.automaton.location(location).clocks)

    def index(self, location: int, clock: ActorClock) -> int:
        """Return the index of a clock that runs in a location."""
        return self.clocks(location).index(clock) + 1

    def indices(self, clock: ActorClock) -> NDArray[np.int64]:
        """Return the index of a clock without an aim in each location, 0 where it doesn't run."""
        automaton = self.automaton
        records = automaton.locations.used.reshape(-1, LOCATION)
        at = np.flatnonzero(automaton.clocks.used == self.numbers[clock, None])[
            ::-1
        ]  # of equal clocks the first wins
        locations = np.searchsorted(records[:, CLOCKS], at, side="right") - 1
        found = np.zeros(len(records), np.int64)
        found[locations] = at - records[locations, CLOCKS] + 1
        return found

    def measured(self, situation: TimedView, ages: Iterable[int]) -> tuple[int, ...]:
        """Return the values of the clocks that measure time, in the order of locations."""
        return tuple(
            age for age, clock in zip(ages, situation.clocks, strict=True) if clock.sort is not Sort.WINDOW
        )

    def capped(self, location: int, ages: Iterable[int]) -> tuple[int, ...]:
        """Return clock values, capped where no test distinguishes them."""
        return tuple(
            min(age, self.caps[self.kin(clock)])
            for age, clock in zip(ages, self.clocks(location), strict=True)
        )

    def tests(self, location: int, step: TimedStep) -> list[tuple[Constraint, ...]]:
        """Return the guards of a step in a location, a disjunction of conjunctions."""
        number, said = self.place(location)
        if not step.guards:
            return [()]
        found: list[tuple[Constraint, ...]] = []
        for at, least, most in step.guards:
            clock = self.situation(number).clocks[at]
            if clock.sort is Sort.WINDOW:
                assert isinstance(clock.of, int)
                found += [()] if said[self.windows.index(clock.of)] >= least else []
            else:
                index = self.index(location, clock)
                found.append((Constraint(index, least, NONE if most is None else most),))
        return found


def _asked(of: Callable[..., ActorClocks], about: Name | int, c: Configuration) -> ActorClocks:
    """Return the clocks of an actor, with the contents of observations in its requests filled in."""
    if of is of_vehicle:
        return of(c, about)
    clause: Clause | None = c.setting.environment[about] if isinstance(about, int) else None
    steps = (
        by_clause(c, clause)
        if clause is not None
        else (served if of is of_requests else moves)(c, str(about))
    )
    found = of(c, about, list(steps))
    return ActorClocks(
        tuple(each._replace(clock=_settled(each.clock)) for each in found.running),
        tuple(
            StepClocks(
                tuple(map(_settled, done)), tuple(each._replace(clock=_settled(each.clock)) for each in tests)
            )
            for done, tests in found.steps
        ),
    )


def _settled(clock: ActorClock) -> ActorClock:
    return clock._replace(of=settled(clock.of))


def cap(clock: ActorClock, interval: Interval) -> int:
    """Return the cap of a clock: its constant, plus one where a test may find it exceeded."""
    return max(interval.lo, interval.hi or 0) + (clock.sort in STRICT)


def compared(clock: ActorClock, interval: Interval) -> tuple[int, int]:
    """Return the largest constants of a clock's lower and upper bounds."""
    lo, hi = interval.lo or NONE, NONE if interval.hi is None else interval.hi
    match clock.sort:
        case Sort.MISSION:
            return lo + 1, lo + 1
        case Sort.ALOFT:
            return interval.lo + 1, NONE
        case Sort.RESTORED:
            return interval.lo, interval.lo
        case _:
            return lo, hi
