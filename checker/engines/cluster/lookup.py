"""Access to the results of a crew: configurations, origins and the graph, each from its worker."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.cluster.cluster_worker import Edges
from checker.engines.cluster.crew import Crew
from checker.engines.cluster.numbering import Places
from checker.engines.contract import Inspect
from checker.engines.graph import Graph
from checker.engines.made_on_access import MadeOnAccess
from semantics.properties.propositions import Proposition
from semantics.state.configuration import Configuration, Label
from semantics.state.requests import Request
from semantics.state.setting import Setting
from semantics.successors import expand

BLOCK = 1 << 16
"""Rows of each worker in one request for transitions."""


class CrewRows:
    """The rows of a crew after its exploration.

    Attributes:
        crew: The workers.
        surely: Calls the crew, and again if a worker was lost.
        setting: The mission.
        places: The numbering of rows.
        expanded: The number of expanded rows of each worker.
        puts_off: Whether a transition without a target is one that partial-order reduction does not follow.
        crowded: Whether some rows were not expanded because an agent is crowded.
    """

    def __init__(self, crew: Crew, surely: Callable[[Callable[[], Any]], Any], setting: Setting) -> None:
        self.crew = crew
        self.surely = surely
        self.setting = setting
        self.places = Places((), (0,))
        self.expanded: list[int] = []
        self.crowded = self.puts_off = False

    def one(self, worker: int, method: str, *arguments: Any) -> Any:
        """Return the result of a method of one worker."""
        return self.surely(lambda: self.crew.one(worker, method, *arguments))

    def every(self, method: str, *arguments: Any) -> list[Any]:
        """Return the results of a method of all workers."""
        found: list[Any] = self.surely(lambda: self.crew.every(method, *arguments))
        return found

    @property
    def configurations(self) -> Sequence[Configuration]:
        """The configurations, each fetched at its access."""

        def fetched(number: int) -> Configuration:
            worker, row = self.places.find(number)
            [cells] = self.one(worker, "rows", [row])
            return Configuration(self.setting, cells)

        return MadeOnAccess(fetched, range(len(self.places)))

    @property
    def origins(self) -> Sequence[int]:
        """The configuration from which each configuration was first reached."""

        def fetched(number: int) -> int:
            worker, row = self.places.find(number)
            return self.places.number(*self.one(worker, "origin", row))

        return MadeOnAccess(fetched, range(len(self.places)))

    def spread(self, values: Sequence[NDArray[np.bool_]]) -> NDArray[np.bool_]:
        """Return the workers' values of rows, ordered by number."""
        found = np.zeros(len(self.places), np.bool_)
        for worker, told in enumerate(values):
            found[self.places.all_of(worker, np.arange(len(told), dtype=np.int64))] = told
        return found


def look_at_each(found: CrewRows, inspections: Iterable[Inspect]) -> None:
    """Run inspections on every expanded configuration: those that can't be merged from workers."""
    looking = tuple(inspections)
    configurations = found.configurations
    for number in range(len(found.places) if looking else 0):
        worker, row = found.places.find(number)
        if row < found.expanded[worker]:
            c = configurations[number]
            expansion = expand(c)
            for each in looking:
                each(number, c, expansion)


class CrewSurvey:
    """The survey for temporal properties: the leader gathers all data and decides them."""

    def __init__(self, found: CrewRows) -> None:
        self.found = found

    def valuation(self, asked: Iterable[Proposition]) -> dict[Proposition, NDArray[np.bool_]]:
        """Return the configurations in which each proposition is true."""
        formulas = tuple(dict.fromkeys(asked))
        told = self.found.every("truths", formulas)
        return {
            formula: self.found.spread([each[rank] for each in told]) for rank, formula in enumerate(formulas)
        }

    def is_still(self, asked: Iterable[Proposition]) -> bool:
        """Return whether everything that the atoms read is constant."""
        return all(self.found.every("is_still", tuple(asked)))

    def pending(self) -> dict[Request, NDArray[Any]]:
        """Return, for each request, the configurations in which it is pending, in ascending order."""
        gathered: dict[Request, list[NDArray[np.int64]]] = {}
        for worker, told in enumerate(self.found.every("pending")):
            for request, rows in told.items():
                numbers = self.found.places.all_of(worker, rows.astype(np.int64))
                gathered.setdefault(request, []).append(numbers)
        return {request: np.sort(np.concatenate(parts)) for request, parts in gathered.items()}

    def graph(self) -> Graph:
        """Return every transition of the expanded configurations, in the order of the rules."""
        found, size = self.found, len(self.found.places)
        labels: dict[Label, int] = {}
        parts = [(np.zeros(0, np.int64), np.zeros(0, np.int32), np.zeros(0, np.int64))]
        for first in range(0, max(found.expanded, default=0), BLOCK):
            edges = found.every("edges", first, BLOCK)
            parts += [self._gathered(worker, told, labels) for worker, told in enumerate(edges)]
        sources, actions, targets = (np.concatenate(each) for each in zip(*parts, strict=True))
        order = np.argsort(sources, kind="stable")
        sources, actions, targets = sources[order], actions[order], targets[order]
        there = targets >= 0
        cut_off = self._unfollowed(sources)
        if not found.puts_off:
            cut_off[sources[~there]] = True
        starts = np.concatenate(([0], np.cumsum(np.bincount(sources[there], minlength=size))))
        return Graph(
            starts.astype(np.int64),
            targets[there].astype(np.int32),
            actions[there],
            tuple(labels),
            cut_off if cut_off.any() else None,
        )

    def _unfollowed(self, sources: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Return the configurations that were not expanded; crowded ones are known by their lack of transitions."""
        found = self.found
        rows = zip(found.places.begins, found.expanded, strict=True)
        missing = ~found.spread([np.arange(begins[-1]) < expanded for begins, expanded in rows])
        if found.crowded:
            missing |= np.bincount(sources, minlength=len(missing)) == 0
        return missing

    def _gathered(
        self, worker: int, edges: Edges, labels: dict[Label, int]
    ) -> tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int64]]:
        """Return a worker's transitions with global numbers."""
        places = self.found.places
        rows, actions, owners, reached, told = edges
        targets = np.full(len(rows), -1, np.int64)
        for owner in range(self.found.crew.size):
            known = np.flatnonzero((owners == owner) & (reached >= 0))
            targets[known] = places.all_of(owner, reached[known])
        numbers = np.array([labels.setdefault(label, len(labels)) for label in told], np.int32)
        return places.all_of(worker, rows), numbers[actions], targets
