"""Explore with learned trees, up to the same bounds as the reference explorer."""

import time
from collections.abc import Sequence
from typing import overload

from checker.exploration import (
    INTERRUPTION,
    Exploration,
    Inspect,
    Limits,
    Progress,
    Report,
    crowd_met,
    limit_met,
    time_met,
)
from checker.fast.engine import Space
from checker.fast.inspecting import inspect_fast
from checker.fast.learner import Learner
from checker.fast.survey import Survey
from semantics.configuration import Configuration

CHUNK = 1 << 16
"""Configurations that are expanded between two looks at the clock."""


class Origins(Sequence[int]):
    """For each configuration the one that it was first reached from."""

    def __init__(self, space: Space) -> None:
        self.space = space

    def __len__(self) -> int:
        return self.space.size

    @overload
    def __getitem__(self, number: int) -> int: ...

    @overload
    def __getitem__(self, number: slice) -> Sequence[int]: ...

    def __getitem__(self, number: int | slice) -> int | Sequence[int]:
        if isinstance(number, slice):
            return [self[each] for each in range(*number.indices(len(self)))]
        return int(self.space.origins.room[range(len(self))[number]])


class Configurations(Sequence[Configuration]):
    """The configurations of a space, each made anew where it is looked at."""

    def __init__(self, space: Space) -> None:
        self.space = space

    def __len__(self) -> int:
        return self.space.size

    @overload
    def __getitem__(self, number: int) -> Configuration: ...

    @overload
    def __getitem__(self, number: slice) -> Sequence[Configuration]: ...

    def __getitem__(self, number: int | slice) -> Configuration | Sequence[Configuration]:
        if isinstance(number, slice):
            return [self[each] for each in range(*number.indices(len(self)))]
        return self.space.configuration(range(len(self))[number])


def explore_fast(
    initial: Configuration,
    inspect: tuple[Inspect, ...],
    limits: Limits,
    report: Report | None,
    every: float,
) -> Exploration:
    """Visit everything that is reachable (see `checker.exploration.explore`)."""
    return _Explorer(initial, limits, report, every).run(inspect)


class _Explorer:
    def __init__(self, initial: Configuration, limits: Limits, report: Report | None, every: float) -> None:
        self.limits = limits
        self.report = report
        self.every = every
        self.learner = Learner(initial.setting, initial.state, limits.pending)  # type: ignore[arg-type]  # a stored one
        self.space = Space(self.learner, limits.configurations)
        self.depth = 0
        self.bounds: list[str] = []

    def run(self, inspect: tuple[Inspect, ...]) -> Exploration:
        started = time.monotonic()
        try:
            self.visit_all(started)
        except KeyboardInterrupt:
            self.bounds.append(INTERRUPTION)
        space, configurations = self.space, Configurations(self.space)
        inspect_fast(Survey(space), inspect)
        rules = space.rules()
        return Exploration(
            configurations,
            Origins(space),
            self.depth,
            space.expanded,
            sum(rules.values()),
            rules,
            sorted(self.bounds + self.met()),
            time.monotonic() - started,
            self.learner.runs,
        )

    def met(self) -> list[str]:
        most = self.limits.configurations
        cut = [limit_met(most)] if self.space.was_cut and most is not None else []
        return cut + ([crowd_met(self.limits.pending)] if self.space.is_crowded else [])

    def visit_all(self, started: float) -> None:
        layer_end, reported = 1, started
        while self.space.expanded < self.space.size:
            self.space.advance(min(self.space.expanded + CHUNK, layer_end))
            if self.space.expanded == layer_end and self.space.size > layer_end:
                layer_end = self.space.size
                self.depth += 1
            now = time.monotonic()
            most = self.limits.seconds
            if most is not None and now - started + self.limits.spent > most:
                self.bounds.append(time_met(most))
                return
            if self.report is not None and now - reported >= self.every:
                self.report(self.progress(now - started))
                reported = now

    def progress(self, seconds: float) -> Progress:
        space = self.space
        rate = space.expanded / max(seconds, 1e-9)
        transitions = int(space.counts.used.sum())
        return Progress(space.size, transitions, self.depth, space.size - space.expanded, rate)
