"""Dated runs: whether the clocks allow each step at its date."""

from collections.abc import Iterator
from typing import NamedTuple

from semantics.state.configuration import Configuration, Label, Transition
from semantics.timing.actor_clocks import Sort
from semantics.timing.clocks import ClockUpdate, Guard, TimedStep, TimedView
from semantics.timing.dates import clock_text


class UntimelyError(ValueError):
    """A step is not possible at its date; the message gives the reason."""


class Offer(NamedTuple):
    """A possible next step with its earliest and latest date in ticks; `latest` is None if unbounded."""

    transition: Transition
    earliest: int
    latest: int | None


class DatedRun:
    """A run that proceeds step by step, each step with its date.

    Attributes:
        now: The date of the last step, in ticks from the start.
    """

    def __init__(self, initial: Configuration) -> None:
        self.situation = TimedView(initial)
        self.ages = {self.situation.first_ages()}
        self.now = 0

    def offers(self) -> tuple[Offer, ...]:
        """Return the steps that are possible before the next deadline, in the order of the rules."""
        found = []
        for step in self.situation.steps:
            windows = (
                [each for ages in self.ages for each in self._windows(step, ages)] if step.in_turn else []
            )
            if windows:
                ends = [end for _, end in windows if end is not None]
                latest = self.now + max(ends) if len(ends) == len(windows) else None
                earliest = self.now + min(begin for begin, _ in windows)
                found.append(Offer(step.transition, earliest, latest))
        return tuple(found)

    def _windows(self, step: TimedStep, ages: tuple[int, ...]) -> Iterator[tuple[int, int | None]]:
        """Yield the intervals in which a step is possible, in ticks from now."""
        slack = self.situation.slack(ages)
        for guard in step.guards or (None,):
            begin, end = (0, None) if guard is None else self._window(guard, ages[guard.clock])
            end = min((each for each in (end, slack) if each is not None), default=None)
            if end is None or begin <= end:
                yield begin, end

    def _window(self, guard: Guard, age: int) -> tuple[int, int | None]:
        end = None if guard.most is None else guard.most - age
        if self.situation.clocks[guard.clock].sort is Sort.WINDOW and age < guard.least:
            return 0, -1  # a window's clock does not advance with time
        return max(0, guard.least - age), end

    def take(self, label: Label, target: Configuration, date: int) -> None:
        """Take a step.

        Raises:
            UntimelyError: The clocks do not allow the step at that date.
        """
        after = TimedView(target)
        waited = set(self._waiting(date))
        steps = [
            each
            for each in self.situation.steps
            if each.in_turn and each.transition.label == label and each.transition.target == target
        ]
        passages = ((step, ClockUpdate(self.situation, step, after)) for step in steps)
        ages = {
            each
            for step, passage in passages
            for now in waited
            if step.is_due(now)
            for each in passage.ages(now)
        }
        if not ages:
            raise UntimelyError(f"{self._moment(date)} is too early for it")
        self.situation, self.ages, self.now = after, ages, date

    def _waiting(self, date: int) -> Iterator[tuple[int, ...]]:
        """Yield the possible ages at a date."""
        ticks = date - self.now
        if ticks < 0:
            raise UntimelyError(f"it is {self._moment(self.now)} already")
        slacks = {ages: self.situation.slack(ages) for ages in self.ages}
        if all(slack is not None and slack < ticks for slack in slacks.values()):
            latest = self.now + max(filter(None, slacks.values()), default=0)
            raise UntimelyError(f"another step is due by {self._moment(latest)}")
        for ages, slack in slacks.items():
            if slack is None or slack >= ticks:
                yield self.situation.later(ages, ticks)

    def _moment(self, ticks: int) -> str:
        return clock_text(ticks * self.situation.timing.tick)
