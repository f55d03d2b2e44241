"""The critical path of a run with dates: the consecutive steps whose durations add up to its last date."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final, TypeVar

from checker.engines.timed.first_runs import TimedRun
from semantics.state.configuration import Configuration, Label, Transition
from semantics.timing.actor_clocks import ActorClock
from semantics.timing.bounds import WrittenBound, bound_of, going_on, running_in, timed_by
from semantics.timing.clocks import TimedStep, TimedView
from semantics.timing.dates import clock_text, lapse_text
from semantics.timing.intervals import Interval

Node = TypeVar("Node", bound=Hashable)
Step = TypeVar("Step")

BEGINNING: Final = -1
"""The number for the start of the mission, in the place of a step's number."""


@dataclass(frozen=True, slots=True)
class Leg:
    """One stretch of a critical path: the wait for a step, from the moment it became possible.

    Attributes:
        begin: The first tick of the wait.
        end: The tick of the step, or of the end of the path.
        label: The step.
        interval: Its duration, in ticks.
        bound: The origin of that duration in the mission.
        tick: Milliseconds of a tick.
        going_on: Whether the path ends before the step is taken.
    """

    begin: int
    end: int
    label: Label
    interval: Interval
    bound: WrittenBound
    tick: int
    going_on: bool = False

    def __str__(self) -> str:
        lasted = lapse_text((self.end - self.begin) * self.tick)
        so_far = " so far" if self.going_on else ""
        return f"{lasted}{so_far} from {clock_text(self.begin * self.tick)} on: {self.label}, {self.why}"

    @property
    def why(self) -> str:
        """The allowed duration, and its origin."""
        if not self.bound.words:
            return "without an upper time bound"
        line = f", line {self.bound.line}" if self.bound.line else ""
        return f"{interval_text(self.interval, self.tick)} ({self.bound.words}{line})"


def interval_text(interval: Interval, tick: int) -> str:
    """Return an interval as text.

    >>> interval_text(Interval(0, 5), 1000), interval_text(Interval(60), 1000), interval_text(Interval(2, 2), 1000)
    ('at most 5 s', 'at least 1 min', '2 s')
    >>> interval_text(Interval(90, 120), 1000), interval_text(Interval(), 1000)
    ('90 s to 2 min', 'any time')
    """
    lo, hi = interval.lo, interval.hi
    if hi is None:
        return f"at least {lapse_text(lo * tick)}" if lo else "any time"
    if lo == hi:
        return lapse_text(lo * tick) if lo else "no time"
    most = lapse_text(hi * tick)
    return f"{lapse_text(lo * tick)} to {most}" if lo else f"at most {most}"


def critical_path(
    initial: Configuration,
    done: Sequence[Transition],
    run: TimedRun,
    onward: Sequence[Transition] = (),
    since: int = 0,
) -> tuple[Leg, ...]:
    """Return the critical path of a run, in order, from one tick on.

    Each leg ends with the step that the next one waits for. A leg begins with the step that enabled its own, or gave it
    its turn.

    Args:
        initial: The initial configuration.
        done: The steps of the run.
        run: The run, with their dates.
        onward: Possible further steps, to the event awaited at its end.
        since: The first tick of the path.
    """
    dates = (*run.dates[: len(done)], *(run.end for _ in onward))
    taken = tuple(_taken(initial, (*done, *onward), dates))
    legs: list[Leg] = []
    number = len(taken) - 1
    while number != BEGINNING and taken[number].date > since:
        leg, before = taken[number].leg(taken)
        begin = max(leg.begin, since)
        if begin < leg.end:
            legs.append(replace(leg, begin=begin, going_on=number >= len(done)))
        number = before
    return tuple(reversed(legs))


def way_to(
    start: Node, is_end: Callable[[Node], bool], follow: Callable[[Node], Iterable[tuple[Step, Node]]]
) -> tuple[Step, ...]:
    """Return the fewest steps from a node to an end, empty if none lead there."""
    ways: dict[Node, tuple[Step, ...]] = {start: ()}
    waiting = deque([start])
    while waiting:
        at = waiting.popleft()
        if is_end(at):
            return ways[at]
        for step, target in follow(at):
            if target not in ways:
                ways[target] = (*ways[at], step)
                waiting.append(target)
    return ()


@dataclass(frozen=True, slots=True)
class _Taken:
    """A step of a run.

    Attributes:
        situation: The situation before it.
        step: The step.
        date: Its date, in ticks.
        since: The steps that may have begun the wait for it, the likeliest first.
    """

    situation: TimedView
    step: TimedStep
    date: int
    since: tuple[int, ...]

    def leg(self, taken: Sequence[_Taken]) -> tuple[Leg, int]:
        """Return the wait for the step as a leg, and the number of the step that began it."""
        interval = timed_by(self.situation, self.step).interval
        begins = {each: 0 if each == BEGINNING else taken[each].date for each in self.since}
        fit = (each for each in self.since if interval.hi is None or self.date - begins[each] <= interval.hi)
        number = next(fit, max(self.since))
        bound = bound_of(self.situation, self.step)
        label, tick = self.step.transition.label, self.situation.timing.tick
        return Leg(begins[number], self.date, label, interval, bound, tick), number


def _taken(initial: Configuration, done: Sequence[Transition], dates: Sequence[int]) -> Iterator[_Taken]:
    """Yield the steps of a run, each with the possible starts of its wait."""
    situation = TimedView(initial)
    running = {each: (BEGINNING,) * count for each, count in running_in(situation).items()}
    in_turn = dict.fromkeys(_in_turn(situation), BEGINNING)
    for number, (transition, date) in enumerate(zip(done, dates, strict=True)):
        step = next(each for each in situation.steps if each.transition == transition)
        clocks = timed_by(situation, step).clocks
        begins = (running[each][0] for each in clocks)
        turns = [in_turn[each] for each in clocks if each in in_turn]
        yield _Taken(situation, step, date, (*dict.fromkeys([*begins, *turns]),) or (BEGINNING,))
        after = TimedView(transition.target)
        running = going_on(running, situation, step.done, after, number)
        turned = {each: at for each, at in in_turn.items() if each not in step.done}
        in_turn = {each: turned.get(each, number) for each in _in_turn(after)}
        situation = after


def _in_turn(situation: TimedView) -> set[ActorClock]:
    return {clock for step in situation.steps if step.in_turn for clock in step.done}
