"""Explore by decision diagrams: first some configurations one by one, for the rules to be learned, then all at once."""

import time
from collections import Counter
from collections.abc import Callable

from checker.bounding import BoundMet, bounded, look
from checker.exploration import EngineError, Exploration, Inspect, Progress, Report
from checker.fast.engine import Space
from checker.fast.learner import Learner
from checker.limits import INTERRUPTION, Limits, crowd_met, limit_met, memory_met
from checker.symbolic.inspecting import HOW, View, inspect_symbolic
from checker.symbolic.reaching import Reach
from semantics.configuration import Configuration
from semantics.setting import Scheduler

FIRST = 1 << 17
"""Configurations that are explored one by one: most of the rules are learned there."""

CHUNK = 1 << 14
"""Of them so many between two looks at the clock."""


def explore_symbolic(
    initial: Configuration,
    inspect: tuple[Inspect, ...],
    limits: Limits,
    report: Report | None,
    every: float,
) -> Exploration:
    """Reach everything that is reachable (see `checker.exploration.explore`).

    The configurations of the result are those on the runs that were asked for; how many there are is its `count`.

    Raises:
        EngineError: The extra is missing, or the mission is one that it can't explore.
    """
    if initial.setting.scheduler is Scheduler.FCFS:
        raise EngineError(
            "the symbolic engine does not do scheduler fcfs: who is first is asked of all at once"
        )
    if any(type(each) not in HOW for each in inspect):
        raise EngineError("the symbolic engine does not look at configurations one by one")
    return _Explorer(initial, limits, report, every).run(inspect)


class _Explorer:
    def __init__(self, initial: Configuration, limits: Limits, report: Report | None, every: float) -> None:
        self.limits = limits
        self.report = report
        self.every = every
        self.learner = Learner(initial.setting, initial.state, limits.pending)  # type: ignore[arg-type]  # a stored one
        self.reach = Reach(self.learner, limits)
        self.began = self.told = time.monotonic()
        self.bounds: list[str] = []

    def run(self, inspect: tuple[Inspect, ...]) -> Exploration:
        with bounded(self.limits, self.began):
            self.within_bounds(self.visit)
            view = View(self.reach)
            if not self.bounds:
                self.within_bounds(lambda: inspect_symbolic(view, inspect))
        rules: Counter[str] = Counter()
        for step, count in view.steps.items():
            rules[self.learner.steps[step].rule] += count
        return Exploration(
            view.rings.configurations,
            view.rings.origins,
            None,
            len(view.rings.configurations),
            sum(rules.values()),
            rules,
            sorted(self.bounds + self.met()),
            time.monotonic() - self.began,
            self.learner.runs,
            count=self.reach.count,
        )

    def within_bounds(self, work: Callable[[], None]) -> None:
        """Do some work, and note the bound that ends it, if one does."""
        try:
            work()
        except BoundMet as bound:
            self.bounds.append(str(bound))
        except MemoryError:
            self.bounds.append(
                memory_met(self.limits) if self.limits.memory else "the room for decision diagrams"
            )
        except KeyboardInterrupt:
            self.bounds.append(INTERRUPTION)

    def visit(self) -> None:
        self.learn_from_some()
        self.reach.build()
        self.reach.run(self.tell)
        self.count()

    def learn_from_some(self) -> None:
        """Explore some configurations one by one; that they can be reached is found out once more, all at once."""
        space = Space(self.learner, FIRST)
        while space.expanded < space.size:
            look()
            space.advance(min(space.expanded + CHUNK, space.size))

    def tell(self) -> None:
        now = time.monotonic()
        if now - self.told < self.every:
            return
        self.told = now
        count = self.count()
        if self.report is not None:
            self.report(Progress(count, 0, None, None, count / (now - self.began)))

    def count(self) -> int:
        """Count what was reached, as far as that may go."""
        count, most = self.reach.count, self.limits.configurations
        if most is not None and count > most:
            raise BoundMet(limit_met(most))
        return count

    def met(self) -> list[str]:
        return [crowd_met(self.limits.pending)] if self.reach.is_crowded else []
