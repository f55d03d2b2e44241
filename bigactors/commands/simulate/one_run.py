"""One run of a mission, step by step: the possible next steps, with their dates where the mission has times."""

from __future__ import annotations

import random
from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass, field
from itertools import repeat
from typing import TYPE_CHECKING, NamedTuple

from checker import Step, Trace
from physical.wordings import counted
from semantics.state.configuration import Configuration, Transition
from semantics.state.printing import print_changes, print_configuration
from semantics.successors import Expansion, expand

if TYPE_CHECKING:
    from semantics.timing.dated_runs import DatedRun  # geometry is slow to load

MINUTE = 60_000


class Choice(NamedTuple):
    """A possible next step. With times, its earliest and latest date in ticks; `latest` is None without a bound."""

    transition: Transition
    earliest: int | None = None
    latest: int | None = None


@dataclass
class OneRun:
    """A run that grows and shrinks.

    Attributes:
        initial: Its first configuration.
        taken: The steps so far.
        dates: The date of each step in ticks; empty for a mission without times.
        shown: The texts that `display` showed in each step.
        in_turn: Whether all its steps are in the turn of `fcfs`: see `Trace`.
    """

    initial: Configuration
    taken: list[Step] = field(default_factory=list)
    dates: list[int] = field(default_factory=list)
    shown: list[tuple[str, ...]] = field(default_factory=list)
    in_turn: bool = True
    _dated: list[DatedRun] = field(default_factory=list)

    def __post_init__(self) -> None:
        if self.initial.setting.timing is not None:
            from semantics.timing.dated_runs import DatedRun  # geometry is slow to load

            self._dated.append(DatedRun(self.initial))

    @classmethod
    def following(cls, trace: Trace) -> OneRun:
        """Return a run that begins with the steps of a trace; without times if the trace has no dates."""
        run = cls(trace.initial, in_turn=trace.in_turn)
        if run.is_timed and not trace.dates:
            run._dated.clear()
        for step, date in zip(trace.steps, trace.dates or repeat(None), strict=False):
            run._add(step, date)
            run.shown.append(())
        return run

    @property
    def is_timed(self) -> bool:
        """Whether its steps have dates."""
        return bool(self._dated)

    @property
    def at(self) -> Configuration:
        """The current configuration."""
        return self.taken[-1].target if self.taken else self.initial

    @property
    def trace(self) -> Trace:
        """The run so far."""
        return Trace(self.initial, tuple(self.taken), dates=tuple(self.dates), in_turn=self.in_turn)

    def expansion(self) -> Expansion:
        """Return the possible transitions at any date."""
        return expand(self.at)

    def choices(self, at: int | None = None) -> tuple[Choice, ...]:
        """Return the possible next steps, at the end or at an earlier configuration."""
        at = len(self.taken) if at is None else at
        if self._dated:
            return tuple(Choice(*offer) for offer in self._dated[at].offers())
        return tuple(map(Choice, expand(self.trace.configurations[at]).transitions))

    def take(self, choice: Choice, date: int | None = None) -> None:
        """Take a step; with times, at `date` or at the earliest date.

        Raises:
            UntimelyError: The clocks do not allow the step at that date.
        """
        transition = choice.transition
        alike = [each.target for each in self.expansion().transitions if each.label == transition.label]
        step = Step(transition.label, alike.index(transition.target), transition.target)
        self._add(step, choice.earliest if date is None else date)
        self.shown.append(transition.shown)

    def _add(self, step: Step, date: int | None) -> None:
        if self._dated:
            assert date is not None
            run = copy(self._dated[-1])
            run.take(step.label, step.target, date)
            self._dated.append(run)
            self.dates.append(date)
        self.taken.append(step)

    def take_by_chance(self, chance: random.Random) -> bool:
        """Take one of the steps at random, at a random one of its dates; return whether there was a step."""
        choices = self.choices()
        if not choices:
            return False
        choice = chance.choice(choices)
        if choice.earliest is None:
            self.take(choice)
            return True
        from semantics.timing.dated_runs import UntimelyError  # geometry is slow to load

        try:
            self.take(choice, chance.randint(choice.earliest, self._last(choice)))
        except UntimelyError:  # the allowed dates may have gaps
            self.take(choice)
        return True

    def _last(self, choice: Choice) -> int:
        """Return the latest date for a random choice: a minute after the earliest where there is no bound."""
        assert choice.earliest is not None
        assert self.initial.setting.timing is not None
        a_minute_on = choice.earliest + max(1, MINUTE // self.initial.setting.timing.tick)
        return a_minute_on if choice.latest is None else choice.latest

    def undo(self) -> None:
        """Take the last step back."""
        for each in (self.taken, self.shown, self.dates, self._dated):
            if each:
                each.pop()


def print_step(run: OneRun, number: int) -> Iterator[str]:
    """Print a step of a run, its changes and the displayed texts."""
    step, date = run.taken[number], run.trace.date(number)
    source = run.taken[number - 1].target if number else run.initial
    yield f"c{number} --{f'at {date} ' if date else ''}{step.label}--> c{number + 1}"
    yield from (f"      {line}" for line in print_changes(source, step.target))
    yield from (f"      displayed: {text}" for text in run.shown[number])


def nothing_more(run: OneRun) -> str:
    """Return the reason why a run has ended."""
    reasons = "".join(f"; {fault.agent}: {fault}" for fault in run.expansion().faults)
    return f"nothing more is enabled{reasons}"


@dataclass(frozen=True, slots=True)
class Simulation:
    """One run, and the reason why it ended."""

    run: OneRun
    end: str


def simulate(initial: Configuration, seed: int, steps: int) -> Simulation:
    """Take one run of at most `steps` steps; all steps are equally likely, and with times all dates."""
    chance = random.Random(seed)  # a simulation, not a secret
    run = OneRun(initial)
    while run.choices():
        if len(run.taken) == steps:
            return Simulation(run, f"stopped after {counted(steps, 'step')}")
        run.take_by_chance(chance)
    return Simulation(run, nothing_more(run))


def print_simulation(simulation: Simulation) -> Iterator[str]:
    """Print a run in the paper's notation: its first configuration, its steps, its last configuration."""
    run = simulation.run
    yield f"c0 = {print_configuration(run.initial)}"
    for number in range(len(run.taken)):
        yield from print_step(run, number)
    if run.taken:
        yield f"c{len(run.taken)} = {print_configuration(run.at)}"
    yield simulation.end
