"""Deadlock under fairness: where may a fair run stay for ever although something is left to be done?"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from checker.engines.graph import Bools, Graph
from checker.limits import look
from checker.properties.findings import Finding
from checker.properties.temporal.components import Conditions, fair_components
from checker.properties.temporal.digraph import shortest
from checker.properties.temporal.lassos import Lasso
from checker.properties.temporal.shortest import run_into


@dataclass(frozen=True, eq=False)
class Deadlock:
    """What is left to be done where fair runs may stay.

    Attributes:
        finding: What it is, at the configuration of the smallest number.
        components: The fair components of such configurations, -1 elsewhere.
    """

    finding: Finding
    components: np.ndarray[tuple[int], np.dtype[np.int64]]


@dataclass(frozen=True, eq=False)
class Deadlocks:
    """Looks for fair runs along which nothing but the environment can move any more.

    Along a cycle of the environment's steps neither agents nor requests change. So what is left to be done is asked of
    one configuration of each fair component.

    Attributes:
        graph: What was explored, total.
        fairness: What fair runs do infinitely often.
        stuck: What is left to be done in a configuration where no agent can move, None where nothing is.
    """

    graph: Graph
    fairness: Conditions
    stuck: Callable[[int], Finding | None]

    def still(self) -> Bools:
        """Return for each configuration whether nothing but the environment can move."""
        agents = np.fromiter((label.agent is not None for label in self.graph.labels), dtype=np.bool_)
        return ~self.graph.enabled(self.graph.taken(agents)) & ~self.graph.open

    def found(self) -> tuple[Deadlock, ...]:
        """Return what is left to be done somewhere, each thing once, the nearest first."""
        components = fair_components(self.graph, self.fairness, self.still())
        numbers, firsts = np.unique(components, return_index=True)
        found: dict[str, tuple[Finding, list[int]]] = {}
        for first, number in sorted(zip(firsts.tolist(), numbers.tolist(), strict=True)):
            look()
            finding = self.stuck(first) if number >= 0 else None
            if finding is not None:
                found.setdefault(finding.subject, (finding, []))[1].append(number)
        return tuple(
            Deadlock(finding, np.where(np.isin(components, among), components, -1))
            for finding, among in found.values()
        )

    def run(self, deadlock: Deadlock) -> Lasso:
        """Return a run that stays there for ever."""
        return run_into(self.graph, deadlock.components, self.fairness, deadlock.finding.at)

    def led_on(self, among: Bools) -> Lasso | None:
        """Return a shortest run to a configuration from which fair runs lead on, None where there is none."""
        path = shortest(self.graph, 0, among[self.graph.targets])
        return None if path is None else Lasso(path, shortest=True)
