"""The monitor of the section `timing`: a duration outside its bounds breaks an assumption.

The clocks are those of a check, stored as their starting moments.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Final, NamedTuple

from semantics.environment import Appears, Clause, Drifts, Drops, Leaves, Says, Vanishes
from semantics.state.configuration import Configuration, Transition
from semantics.state.physical_model import Placed
from semantics.state.requests import FLY
from semantics.state.signature import Name
from semantics.timing.actor_clocks import BOUND, FREE, ActorClock, Sort, is_restored
from semantics.timing.bounds import WrittenBound, bound_of, clause_beginnings, going_on, running_in, timed_by
from semantics.timing.clocks import TimedStep, TimedView
from semantics.timing.dates import lapse_text
from semantics.timing.flight_history import travelling
from semantics.timing.timing import Every, Sayable, Window

GRACE: Final = 0.25
"""Seconds that a run itself may need to notice that something is done."""

OWN: Final = frozenset({Sort.REQUEST, Sort.AGENT, Sort.AFTER})
"""Clocks of the run's own activities: they stand still while the run does."""

FULL: Final = frozenset({Sort.EVERY, Sort.RESTORED})
"""Clocks that are past their bound as the mission begins."""


class BrokenDuration(NamedTuple):
    """A broken assumption about time, in words, and its subject."""

    about: Name
    message: str


class Flying(NamedTuple):
    """A flight under way: vehicle, destination, start, and least and most seconds."""

    vehicle: Name
    destination: Name
    since: float
    least: float
    most: float | None


@dataclass(frozen=True, eq=False)
class Timers:
    """The running clocks of the mission's timing.

    Attributes:
        situation: The meaning of time in the configuration.
        since: The starting moments of each clock, the oldest of equal ones first.
        windows: For each clause that has a window and could take its step, whether the window still binds it.
        began: The start of the mission, shifted by the time without listening.
        rested: The seconds for which the run itself stood still since then: it was killed and resumed.
    """

    situation: TimedView
    since: Mapping[ActorClock, tuple[float, ...]]
    windows: Mapping[int, int] = field(default_factory=dict)
    began: float = 0.0
    rested: float = 0.0

    @property
    def seconds(self) -> float:
        """The seconds of a tick."""
        return self.situation.timing.tick / 1000

    def elapsed(self, now: float) -> float:
        """Return the seconds since the mission's start, if a clause is timed from it."""
        return now - self.since[ActorClock(Sort.MISSION)][0]

    def later(self, seconds: float) -> Timers:
        """Return the timers shifted by a time without listening."""
        return self.counted(self.began + seconds, self.rested, math.inf)

    def resting(self, since: float, now: float) -> Timers:
        """Return the timers after a standstill of the run: the world went on, and every `after` wait begins anew."""
        return self.counted(self.began, self.rested + max(now - since, 0.0), now)

    def counted(self, began: float, rested: float, now: float) -> Timers:
        """Return the timers for another start, and another standstill of the run until now."""
        shift, still = began - self.began, rested - self.rested

        def start(clock: ActorClock, at: float) -> float:
            if clock.sort is Sort.AFTER and still:
                return now
            return at + shift + (still if clock.sort in OWN else 0.0)

        since = {clock: tuple(start(clock, at) for at in several) for clock, several in self.since.items()}
        return replace(self, since=since, began=began, rested=rested)


def begun(c: Configuration, now: float) -> Timers:
    """Return the timers at the start of a run."""
    situation = TimedView(c)
    since = {
        clock: (-math.inf if clock.sort in FULL else now,) * count
        for clock, count in running_in(situation).items()
    }
    return _entered(Timers(situation, since, began=now), (), now)


def stepped(timers: Timers, transition: Transition, now: float) -> Timers:
    """Return the timers after a step of the run."""
    source = timers.situation
    after = TimedView(transition.target)
    step = _step_of(source, transition)
    taken = _taken(source, step, after)
    done = (*(step.done if step is not None else ()), *(ActorClock(Sort.EVERY, number) for number in taken))
    since = going_on(timers.since, source, done, after, now)
    for vehicle, endurance in after.timing.endurances:
        restored, aloft = ActorClock(Sort.RESTORED, vehicle), ActorClock(Sort.ALOFT, vehicle)
        left = restored in source.first and restored not in after.first
        if left and now - timers.since[restored][0] >= endurance.after * timers.seconds:
            since[aloft] = (now,)
    return _entered(replace(timers, situation=after, since=since), taken, now)


def _entered(timers: Timers, taken: Iterable[int], now: float) -> Timers:
    """Return the timers with their windows: a window binds a possible step until the step is taken."""
    windows = {**timers.windows, **dict.fromkeys(taken, FREE)}
    for number, transitions in enumerate(timers.situation.by_clauses):
        said = timers.situation.timing.clause(number).step
        if transitions and number not in windows and isinstance(said, Window):
            late = said.within is not None and timers.elapsed(now) > said.within * timers.seconds
            windows[number] = FREE if late else BOUND
    return replace(timers, windows=windows)


def _step_of(situation: TimedView, transition: Transition) -> TimedStep | None:
    return next((each for each in situation.steps if each.transition.label == transition.label), None)


def _taken(source: TimedView, step: TimedStep | None, after: TimedView) -> tuple[int, ...]:
    """Return the clauses whose own step was taken, by any observation."""
    said = (
        step.done[0] if step is not None and step.transition.label.agent is None else ActorClock(Sort.MISSION)
    )
    return tuple(
        number
        for number, clause in enumerate(source.c.setting.environment)
        if said == (Sort.EVERY, number, "") or _has_happened(source.c, after.c, clause)
    )


def _has_happened(before: Configuration, now: Configuration, clause: Clause) -> bool:
    """Return whether a step made a clause's event visible in the world; the return of a channel has another clock."""
    one, other = (each.structure.physical for each in (before, now))
    match clause:
        case Drifts(entity=entity):
            return _has_moved(before, now, entity)
        case Drops(channel=channel):
            return other.is_down(channel) and not one.is_down(channel)
        case Leaves():
            return bool(now.read(clause.left)) and not before.read(clause.left)
        case Appears(entity=entity):
            return entity in other and entity not in one
        case Vanishes(entity=entity):
            return entity in one and entity not in other
        case Says():
            return False


def _has_moved(before: Configuration, now: Configuration, entity: Name) -> bool:
    one, other = (each.structure.physical for each in (before, now))
    if not (isinstance(one.placement(entity), Placed) and isinstance(other.placement(entity), Placed)):
        return False
    return one.abstract_parent(entity) != other.abstract_parent(entity)


# --- violations


def too_soon(timers: Timers, transition: Transition, after: Timers, now: float) -> Iterator[BrokenDuration]:
    """Yield the durations that a step ends, or the repetitions that it makes, too soon."""
    source = timers.situation
    step = _step_of(source, transition)
    request = None if step is None or step.transition.served is None else step.transition.served.request
    if step is not None and isinstance(request, FLY):
        flight = ActorClock(Sort.FLIGHT, request)
        least = timed_by(source, step).interval.lo * timers.seconds
        if flight in timers.since and now - timers.since[flight][0] < least:
            lasted = _text(now - timers.since[flight][0])
            yield from _said(source, step, f"is over after {lasted}, sooner than {_text(least)}")
    for number in _taken(source, step, after.situation):
        yield from _untimely(timers, number, now)


def _untimely(timers: Timers, number: int, now: float) -> Iterator[BrokenDuration]:
    """Yield a violation if a clause has taken its step too soon, or if a message came too late."""
    match timers.situation.timing.clause(number).step:
        case Every(least):
            elapsed = now - timers.since[ActorClock(Sort.EVERY, number)][0]
            if elapsed < least * timers.seconds:
                yield _of_clause(timers, number, f"again after {_text(elapsed)}")
        case Window(after):
            elapsed = timers.elapsed(now)
            if timers.windows.get(number) != FREE and elapsed < after * timers.seconds:
                yield _of_clause(timers, number, f"{_text(elapsed)} after the start")
        case Sayable(after, until):
            elapsed = timers.elapsed(now)
            late = until is not None and elapsed > until * timers.seconds + GRACE
            if late or elapsed < after * timers.seconds:
                yield _of_clause(timers, number, f"{_text(elapsed)} after the start")


def _of_clause(timers: Timers, number: int, when: str) -> BrokenDuration:
    setting = timers.situation.c.setting
    begins = tuple(clause_beginnings(setting, number))
    about = getattr(setting.environment[number], "entity", "")
    return BrokenDuration(about, f"{begins[0]}{when}{_because(_line_of(timers.situation, *begins))}")


def too_late(timers: Timers, now: float) -> Iterator[BrokenDuration]:
    """Yield the steps that take too long, and the vehicles that are aloft for longer than their endurance."""
    situation = timers.situation
    for step, end, most in _ends(timers):
        if now > end + GRACE:
            yield from _said(situation, step, f"takes longer than {_text(most)}")
    for vehicle, end, lasts in _batteries(timers):
        if now > end + GRACE:
            words = _line_of(situation, f"{vehicle} lasts ", f"{situation.c.setting.kind(vehicle)} lasts ")
            yield BrokenDuration(
                vehicle, f"{vehicle} goes unrestored for longer than {_text(lasts)}{_because(words)}"
            )
    for number, end, within in _windows(timers):
        if now > end + GRACE:
            yield _of_clause(timers, number, f"later than {_text(within)} after the start")


def next_end(timers: Timers, now: float) -> float:
    """Return the time of the next check, infinity if no bound ends."""
    ends = (end for found in (_ends(timers), _batteries(timers), _windows(timers)) for _, end, _ in found)
    return min((end + GRACE + 0.001 for end in ends if end + GRACE >= now), default=math.inf)


def _ends(timers: Timers) -> Iterator[tuple[TimedStep, float, float]]:
    """Yield the steps with a deadline: the step, the deadline, and its most seconds."""
    situation = timers.situation
    steps = {clock: step for step in reversed(situation.steps) if step.in_turn for clock in step.done}
    for index, most, unless in situation.deadlines:
        clock = situation.clocks[index]
        if unless is None and clock in steps:
            seconds = most * timers.seconds
            yield steps[clock], timers.since[clock][index - situation.first[clock]] + seconds, seconds


def _batteries(timers: Timers) -> Iterator[tuple[Name, float, float]]:
    situation = timers.situation
    for vehicle, endurance in situation.timing.endurances:
        if vehicle in situation.c.structure.physical and not is_restored(situation.c, vehicle):
            lasts = endurance.lasts * timers.seconds
            yield vehicle, timers.since[ActorClock(Sort.ALOFT, vehicle)][0] + lasts, lasts


def _windows(timers: Timers) -> Iterator[tuple[int, float, float]]:
    """Yield the clauses with a deadline for their first step: number, deadline, and seconds after the start."""
    for number, state in timers.windows.items():
        said, may = timers.situation.timing.clause(number).step, timers.situation.by_clauses[number]
        if state == BOUND and may and isinstance(said, Window) and said.within is not None:
            within = said.within * timers.seconds
            yield number, timers.since[ActorClock(Sort.MISSION)][0] + within, within


def _said(situation: TimedView, step: TimedStep, what: str) -> Iterator[BrokenDuration]:
    request = None if step.transition.served is None else step.transition.served.request
    words = _because(bound_of(situation, step))
    flying = travelling(situation.c, request) if isinstance(request, FLY) else ()
    for vehicle, place in flying:
        yield BrokenDuration(vehicle, f"the flight of {vehicle} to {place} {what}{words}")
    if not flying:
        yield BrokenDuration(step.transition.label.agent or "", f"{step.transition.label} {what}{words}")


def _line_of(situation: TimedView, *begins: str) -> WrittenBound:
    found = (
        WrittenBound(*said)
        for begin in begins
        for said in situation.timing.lines
        if said[0].startswith(begin)
    )
    return next(found, WrittenBound())


def _because(bound: WrittenBound) -> str:
    return f"; the mission says: {bound}" if bound.words else ""


def _text(seconds: float) -> str:
    return lapse_text(round(seconds * 10) * 100)


# --- flights under way


def flying(timers: Timers) -> Iterator[Flying]:
    """Yield the flights under way, with their starts and durations."""
    situation = timers.situation
    for clock, began in timers.since.items():
        if clock.sort is Sort.FLIGHT and isinstance(clock.of, FLY):
            most = situation.bounds.get(ActorClock(Sort.AIM, clock.of))
            hi = None if most is None or most.hi is None else most.hi * timers.seconds
            least = situation.bounds[clock].lo * timers.seconds if clock in situation.bounds else 0.0
            for vehicle, place in travelling(situation.c, clock.of):
                yield Flying(vehicle, place, began[0], least, hi)
