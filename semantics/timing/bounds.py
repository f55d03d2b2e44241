"""The bounds of a step: its clocks, its duration, and the line of the mission's text that gives them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple, TypeVar

from semantics.behaviours.values import show
from semantics.environment import Appears, Drifts, Drops, Leaves, Says, Vanishes
from semantics.state.requests import CTR, FLY, MGR, OBS, SND
from semantics.state.setting import Setting
from semantics.state.signature import Name
from semantics.timing.actor_clocks import ActorClock, Sort, is_taken_up, word_of
from semantics.timing.clocks import TimedStep, TimedView
from semantics.timing.flight_history import travelling
from semantics.timing.intervals import ANY_TIME, Interval
from semantics.timing.timing import ONE_HOST, Every, Sayable, Timing, Window

T = TypeVar("T")


class WrittenBound(NamedTuple):
    """An assumption of the `timing` section as written, and its line; empty if the section has none."""

    words: str = ""
    line: int = 0

    def __str__(self) -> str:
        return f"{self.words} (line {self.line})" if self.line else self.words


class Timed(NamedTuple):
    """The clocks that time a step, in order of preference, and its duration."""

    clocks: tuple[ActorClock, ...]
    interval: Interval


def timed_by(situation: TimedView, step: TimedStep) -> Timed:
    """Return the clocks and the duration of a step."""
    request = None if step.transition.served is None else step.transition.served.request
    if isinstance(request, FLY):
        flight, directed = ActorClock(Sort.FLIGHT, request), ActorClock(Sort.AIM, request)
        least, most = situation.bounds.get(flight, ANY_TIME), situation.bounds.get(directed, ANY_TIME)
        known = tuple(each for each in (flight, directed) if each in situation.first)
        return Timed(known or step.done[:1], Interval(least.lo, most.hi))
    if step.transition.label.agent is None:
        return _timed_clause(situation, step)
    if request is not None:
        ways = [situation.bounds.get(clock, ANY_TIME) for clock in step.done]  # a message may have several
        ends = [each.hi for each in ways if each.hi is not None]
        return Timed(step.done, Interval(min(each.lo for each in ways), min(ends, default=None)))
    sort = Sort.AFTER if step.transition.label.rule == "timeout" else Sort.AGENT
    clock = ActorClock(sort, step.transition.label.agent)
    return Timed(
        (clock if clock in situation.first else step.done[0],), situation.bounds.get(clock, ANY_TIME)
    )


def _timed_clause(situation: TimedView, step: TimedStep) -> Timed:
    clock = step.done[0]
    if clock.sort is Sort.RETURNS:
        return Timed((clock,), situation.bounds.get(clock, ANY_TIME))
    assert isinstance(clock.of, int)
    match situation.timing.clause(clock.of).step:
        case Every(least):
            return Timed((clock,), Interval(least))
        case Window(after, within):
            return Timed((), Interval(after, within))
        case Sayable(after, until):
            return Timed((), Interval(after, until))
        case None:
            return Timed((clock,), ANY_TIME)


def bound_of(situation: TimedView, step: TimedStep) -> WrittenBound:
    """Return the line of the mission's text that bounds a step's duration."""
    return _written(situation.timing, _beginnings(situation, step))


def bound_of_flight(setting: Setting, vehicles: Iterable[Name]) -> WrittenBound:
    """Return the line of the mission's text that bounds a flight of some vehicles."""
    assert setting.timing is not None
    return _written(setting.timing, (each for name in vehicles for each in flight_beginnings(setting, name)))


def _written(timing: Timing, beginnings: Iterable[str]) -> WrittenBound:
    """Return the first line with one of these beginnings, the first ones preferred."""
    found = (
        WrittenBound(*said) for begin in beginnings for said in timing.lines if said[0].startswith(begin)
    )
    return next(found, WrittenBound())


def _beginnings(situation: TimedView, step: TimedStep) -> Iterator[str]:
    """Yield the possible beginnings of a step's bound, the most specific first."""
    label, setting = step.transition.label, situation.c.setting
    request = None if step.transition.served is None else step.transition.served.request
    match request:
        case FLY():
            for vehicle, _ in travelling(situation.c, request):
                yield from flight_beginnings(setting, vehicle)
        case OBS():
            yield "sense "
        case SND():
            for clock in step.done:
                yield (
                    "messages on one host "
                    if clock.channel == ONE_HOST
                    else f"messages over {clock.channel} "
                )
        case MGR():
            yield "migrate "
        case CTR():
            yield f"{word_of(request)} "
            said = situation.timing.command(word_of(request))
            if said is None and is_taken_up(request, label.rule):
                yield "agents "
        case _ if label.agent is not None:
            yield "spawn " if label.rule == "spawn" else "agents "
        case _:
            assert isinstance(step.done[0].of, int)
            yield from clause_beginnings(setting, step.done[0].of)


def flight_beginnings(setting: Setting, vehicle: str) -> tuple[str, str]:
    """Return the possible beginnings of the bound on a vehicle's flights: by the vehicle, or by its kind."""
    return f"{vehicle} flies ", f"{setting.kind(vehicle)} flies "


def clause_beginnings(setting: Setting, number: int) -> Iterator[str]:
    """Yield the possible beginnings of a clause's bound, which also describe its event: `wifi drops `."""
    match setting.environment[number]:
        case Drifts(entity=entity):
            yield f"{entity} drifts "
        case Drops(channel=channel):
            yield f"{channel} drops "
        case Leaves(entity=entity, channel=channel):
            yield f"{entity} leaves {channel} "
        case Appears(entity=entity):
            yield f"{entity} appears "
        case Vanishes(entity=entity):
            yield f"{entity} vanishes "
        case Says(message=message, agent=agent):
            said = f"someone says {show(message)} "
            yield f"{said}to {agent} "
            yield said


def running_in(situation: TimedView) -> Counter[ActorClock]:
    """Return the number of each clock that runs, including the clocks of steps without a bound."""
    done = {clock for step in situation.steps for clock in step.done}
    return Counter(situation.clocks) | Counter(done)


def going_on(
    since: Mapping[ActorClock, tuple[T, ...]],
    source: TimedView,
    done: Iterable[ActorClock],
    after: TimedView,
    now: T,
) -> dict[ActorClock, tuple[T, ...]]:
    """Return the start dates of the clocks after a step; of equal clocks the oldest is first, and is served first."""
    kept = dict(since)
    for clock in done:
        kept[clock] = kept.get(clock, ())[1:] if clock.sort is Sort.REQUEST else ()
    for clock, aimed in after.aims.items():
        if source.aims.get(clock) != aimed:
            kept[clock] = ()
    return {
        clock: (kept.get(clock, ()) + (now,) * count)[:count] for clock, count in running_in(after).items()
    }
