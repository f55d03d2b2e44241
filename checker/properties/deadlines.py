"""Verdicts about time: deadlines, responses, endurance, first moments of propositions, and timelocks."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import cached_property

from checker.engines.contract import Exploration
from checker.engines.timed.answers import Times
from checker.engines.timed.first_runs import TimedRun
from checker.limits import BoundMet
from checker.properties.critical_path import Leg, critical_path
from checker.properties.longest_stays import NEVER
from checker.properties.schedule import EventDates, Milestone, Schedule, flights_of, messages_of
from checker.traces import Trace, dated_trace
from checker.verdicts import Outcome, Verdict, Violation
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import And, Not, holds
from semantics.state.configuration import Configuration
from semantics.state.signature import Name
from semantics.timing.actor_clocks import is_restored
from semantics.timing.clocks import TimedView
from semantics.timing.dates import clock_text, lapse_text
from semantics.timing.timing import Timing

REFUSED = "not decided: this is not known to be sound for missions with a section `timing`"


class Deadlines:
    """Decides the properties of one exploration that are about time."""

    def __init__(self, found: Exploration, times: Times, timing: Timing) -> None:
        self.found = found
        self.times = times
        self.timing = timing

    def decide(self, asked: Property) -> Verdict:
        """Return the verdict on a property; it holds only after a complete exploration."""
        match asked.kind:
            case PropertyKind.WITHIN:
                return self.within(asked)
            case PropertyKind.TIME:
                return self.time(asked)
            case PropertyKind.ENDURANCE:
                return self.endurance(asked)
            case _:
                raise AssertionError(f"{asked.kind} is not about time")

    def judge(self, asked: Property, decided: Callable[[Property], Verdict]) -> Verdict:
        """Return the verdict on any property of a mission with timing; a timelock prevents positive ones."""
        if asked.is_of_runs:
            return Verdict(asked, Outcome.INCOMPLETE, note=REFUSED)
        try:
            return self._judged(asked, decided(asked), self.stop)
        except BoundMet as met:
            return Verdict(asked, Outcome.INCOMPLETE, note=f"not decided: {met.bound} was met")

    def _judged(self, asked: Property, verdict: Verdict, stop: Violation | None) -> Verdict:
        if stop is None:
            return verdict
        if asked.kind is PropertyKind.COMPUTATION:
            shown = (*verdict.violations, stop)
            count, different = verdict.count + 1, verdict.different + 1
            return replace(
                verdict,
                outcome=Outcome.VIOLATED,
                violations=shown,
                count=count,
                different=different,
                witness=None,
            )
        by_a_run = Outcome.HOLDS if asked.kind is PropertyKind.REACHABLE else Outcome.VIOLATED
        if verdict.outcome is by_a_run and not asked.kind.is_of_time:
            return verdict
        return Verdict(asked, Outcome.INCOMPLETE, note=f"not decided: time stops; {stop.message}")

    def notes(self) -> tuple[str, ...]:
        """Return the assumptions of all verdicts: the scheduler and the given bounds; and the missing bounds."""
        scheduler = self.found.configurations[0].setting.scheduler.value
        bounds = (f"{words} (line {line})" if line else words for words, line in self.timing.lines)
        unsaid = sorted(self.times.unbounded())
        searched = f"{self.times.searched}, in ticks of {self.text(1)}"
        said = f"searched over {searched}; times are those under 'scheduler {scheduler}'"
        return (
            said,
            *(f"times rest on: {bound}" for bound in bounds),
            *([f"some of these have no upper time bound: {', '.join(unsaid)}"] if unsaid else []),
        )

    def longest_flights(self) -> tuple[tuple[Name, float], ...]:
        """Return the longest flight of each bigActor in seconds, where it is bounded."""
        most = sorted(self.times.longest_flights().items())
        return tuple((agent, ticks * self.timing.tick / 1000) for agent, ticks in most)

    @property
    def outcome(self) -> Outcome:
        """The outcome for a property without a violation."""
        return Outcome.HOLDS if self.found.complete else Outcome.INCOMPLETE

    # --- deadlines

    def within(self, asked: Property) -> Verdict:
        """Return whether F becomes true in time on every run; of a response, whether G follows each F in time."""
        responds = asked.then is not None
        awaited = asked.formula if asked.then is None else asked.then
        wait = self.times.within(asked.formula if responds else None, awaited, asked.bound)
        if responds:
            examined = sum(self.times.where(And((asked.formula, Not(awaited)))))
        else:
            examined = int(not holds(awaited, self.times.initial))
        if wait.late is not None:
            late = (self._late(asked, wait.late, ever=wait.ever),)
            return Verdict(asked, Outcome.VIOLATED, late, 1, examined, different=1)
        vacuous = responds and not examined and self.found.complete
        note = "" if vacuous else f"after {self.text(wait.most)} at the latest"
        remarks = (f"vacuous: never true: {asked.formula}",) if vacuous else ()
        return Verdict(asked, self.outcome, examined=examined, note=note, remarks=remarks)

    def _late(self, asked: Property, run: TimedRun, *, ever: bool) -> Violation:
        trace, begun = dated_trace(self.times, run), run.end - asked.bound - 1
        since = "" if asked.then is None else f", {self.text(asked.bound + 1)} after {self.clock(begun)}"
        awaited = asked.shown if asked.then is None else str(asked.then)
        message = f"still not true at {self.clock(run.end)}{since}: {awaited}"
        details = (*(["it may stay so for ever"] if ever else []), *self._unsaid(trace.configurations[-1]))
        path = self._path(run, lambda c, _: holds(asked.then or asked.formula, c), begun if asked.then else 0)
        return Violation("late", message, trace, details, path=path)

    def _path(
        self,
        run: TimedRun,
        is_awaited: Callable[[Configuration, Name], bool],
        since: int = 0,
        about: Name = "",
    ) -> tuple[Leg, ...]:
        """Return the critical path of a run, extended to the awaited event."""
        onward = self.times.way_to(run, is_awaited, about)
        return critical_path(self.times.initial, self.times.transitions(run), run, onward, since)

    def _unsaid(self, c: Configuration) -> Iterator[str]:
        """Yield in words the possible steps of a configuration without an upper time bound."""
        for words in dict.fromkeys(map(str, TimedView(c).unbounded())):
            yield f"{words} has no upper time bound"

    # --- first moments

    def time(self, asked: Property) -> Verdict:
        """Return when a proposition is first true: the earliest and the latest date, and whether it may never be."""
        moments, examined = self.times.moments(asked.formula), len(self.times.situations)
        if moments.first is None:
            note = "never" if self.found.complete else "never so far"
            return Verdict(asked, self.outcome, examined=examined, note=note)
        latest = moments.latest
        last = "at any time" if math.isinf(latest) else f"at {self.clock(latest)} at the latest"
        never = " if at all: it may never" if moments.may_wait else ""
        said = [f"at {self.clock(moments.first.end)} at the earliest", last + never]
        note = ", ".join(said if self.found.complete else said[:1])
        witness = dated_trace(self.times, moments.first)
        return Verdict(asked, self.outcome, examined=examined, witness=witness, note=note)

    # --- endurance

    def endurance(self, asked: Property) -> Verdict:
        """Return whether every vehicle is restored within its endurance."""
        runs, count = self.times.exhausted()
        examined = len(self.times.situations)
        if not runs:
            vacuous = () if self.timing.endurances else ("vacuous: no vehicle has a line `lasts`",)
            return Verdict(asked, self.outcome, examined=examined, remarks=vacuous)
        found = sorted(runs.items(), key=lambda each: (len(each[1].steps), each[0]))
        violations = tuple(self._exhausted(vehicle, run) for vehicle, run in found)
        return Verdict(asked, Outcome.VIOLATED, violations, count, examined, different=len(found))

    def _exhausted(self, vehicle: str, run: TimedRun) -> Violation:
        lasts, trace = dict(self.timing.endurances)[vehicle].lasts, dated_trace(self.times, run)
        message = f"{vehicle} lasts {self.text(lasts)}, and is still not restored at {self.clock(run.end)}"
        details = tuple(self._unsaid(trace.configurations[-1]))
        since = run.end - lasts - 1
        path = self._path(run, is_restored, since, vehicle)
        return Violation("exhausted", message, trace, details, subject=vehicle, path=path)

    def schedule(self, asked: Iterable[Property]) -> Schedule:
        """Return the dates of flights, and the first moments of `time` properties."""
        times = [each for each in asked if each.kind is PropertyKind.TIME]
        found = tuple(Milestone(each.name, self._first(each)) for each in times)
        sent = messages_of(self.times)
        return Schedule(self.timing.tick, flights_of(self.times), found, self.found.complete, sent)

    def _first(self, asked: Property) -> EventDates:
        found = self.times.moments(asked.formula)
        if found.first is None:
            return EventDates(math.inf, NEVER, may_never=True)
        return EventDates(found.first.end, found.latest, found.may_wait)

    # --- timelocks

    @cached_property
    def stop(self) -> Violation | None:
        """The first run to a timelock, with the steps that repeat there; None if there is none."""
        stop = self.times.stop()
        if stop is None:
            return None
        trace: Trace = replace(dated_trace(self.times, stop.run), loop=stop.steps)
        done = ", ".join(dict.fromkeys(str(step.label) for step in trace.steps[stop.steps :]))
        message = f"no time can pass any more after {self.clock(stop.run.end)}: {done}, again and again"
        taken = self.times.transitions(stop.run)
        path = critical_path(self.times.initial, taken[: stop.steps], stop.run, taken[stop.steps :][:1])
        return Violation("time stops", message, trace, path=path)

    # --- words

    def clock(self, ticks: float) -> str:
        """Return a moment as text."""
        return clock_text(int(ticks) * self.timing.tick)

    def text(self, ticks: float) -> str:
        """Return a duration as text."""
        if ticks == NEVER:
            return "no time"
        return "any time" if math.isinf(ticks) else lapse_text(int(ticks) * self.timing.tick)
