"""Deadlock under fairness: fair runs that stay for ever although work is left."""

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
    """The remaining work at configurations where fair runs may stay.

    Attributes:
        finding: The deadlock, at the configuration of the smallest number.
        components: The fair components of such configurations, -1 elsewhere.
    """

    finding: Finding
    components: np.ndarray[tuple[int], np.dtype[np.int64]]


@dataclass(frozen=True, eq=False)
class Deadlocks:
    """Searches for fair runs along which only the environment can move any more.

    Along a cycle of the environment's steps neither agents nor requests change. So one configuration of each fair
    component determines the remaining work.

    Attributes:
        graph: The explored graph, total.
        fairness: The conditions of fair runs.
        stuck: Returns the deadlock at a configuration where no agent can move, None without remaining work.
    """

    graph: Graph
    fairness: Conditions
    stuck: Callable[[int], Finding | None]

    def still(self) -> Bools:
        """Return for each configuration whether only the environment can move."""
        agents = np.fromiter((label.agent is not None for label in self.graph.labels), dtype=np.bool_)
        return ~self.graph.enabled(self.graph.taken(agents)) & ~self.graph.open

    def found(self) -> tuple[Deadlock, ...]:
        """Return the different deadlocks, the nearest first."""
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
        """Return a run that stays in a deadlock for ever."""
        return run_into(self.graph, deadlock.components, self.fairness, deadlock.finding.at)

    def led_on(self, among: Bools) -> Lasso | None:
        """Return a shortest run to one of the given configurations, None if none is reachable."""
        path = shortest(self.graph, 0, among[self.graph.targets])
        return None if path is None else Lasso(path, shortest=True)
