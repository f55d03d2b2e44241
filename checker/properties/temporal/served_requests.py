"""Progress: is every pending request eventually served, on every fair run?"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from checker.engines.graph import Bools, Graph, Numbers
from checker.limits import look
from checker.properties.temporal.components import Conditions, fair_components
from checker.properties.temporal.digraph import shortest
from checker.properties.temporal.fairness import arrives
from checker.properties.temporal.lassos import Lasso
from checker.properties.temporal.shortest import run_into
from semantics.properties.temporal import SERVES
from semantics.state.configuration import Configuration, Label
from semantics.state.requests import FLY, READY, Request, request_key
from semantics.state.signature import Name

Pending = Mapping[Request, Sequence[int] | Numbers]
"""For each request, the configurations in which it is pending."""

OFTEN = 1024
"""The number of configurations between two checks of the time."""


def pending_requests(configurations: Iterable[Configuration]) -> Pending:
    """Return the configurations in which each request is pending."""
    found: dict[Request, list[int]] = {}
    for number, c in enumerate(configurations):
        if number % OFTEN == 0:
            look()
        for request in dict.fromkeys(each.request for each in c.eta.all()):
            found.setdefault(request, []).append(number)
    return found


def owed(pending: Pending, arriving: Collection[Name]) -> Pending:
    """Return the requests to serve: all except ready observations, and flights without a promise to arrive."""
    return {request: numbers for request, numbers in pending.items() if _is_owed(request, arriving)}


def _is_owed(request: Request, arriving: Collection[Name]) -> bool:
    if isinstance(request, FLY):
        return arrives(Label("commit", request.agent, request), arriving)
    return not isinstance(request, READY)


@dataclass(frozen=True, slots=True)
class Starved:
    """A request that a fair run never serves.

    Attributes:
        request: The request.
        run: The run; in its loop the request stays pending.
        now_and_then: Whether some step of the loop's configurations would serve it.
        behind: The flights of its agent that may end in the loop, without a promise.
    """

    request: Request
    run: Lasso
    now_and_then: bool
    behind: tuple[Request, ...]


@dataclass(frozen=True, eq=False)
class ProgressSearch:
    """Searches for requests that are never served.

    Attributes:
        graph: The explored graph, total.
        pending: The configurations in which each request is pending.
        fairness: The conditions of fair runs.
        arriving: The entities whose flights end.
    """

    graph: Graph
    pending: Pending
    fairness: Conditions
    arriving: Collection[Name]

    def starved(self) -> tuple[tuple[Starved, ...], int]:
        """Return the nearest starved request of each kind, and the number of starved requests."""
        first: dict[str, tuple[int, Request]] = {}
        count = 0
        for request in sorted(self.pending, key=request_key):  # engines find them in different orders
            entries = np.flatnonzero(self.waiting(request) >= 0)
            if len(entries):
                count += 1
                sort = type(request).__name__
                entry = int(entries[0])  # configurations are numbered by distance
                if sort not in first or entry < first[sort][0]:
                    first[sort] = (entry, request)
        return tuple(self._starved(request, entry) for entry, request in first.values()), count

    def waiting(self, request: Request) -> "np.ndarray[tuple[int], np.dtype[np.int64]]":
        """Return the components in which a fair run may stay for ever without serving a request."""
        within = np.zeros(self.graph.size, dtype=np.bool_)
        within[self.pending[request]] = True
        return fair_components(
            self.graph, self.fairness, within & ~self.graph.open, by=~self.serving(request)
        )

    def serving(self, request: Request) -> Bools:
        """Return for each edge whether it serves a request."""
        labels = (label.rule in SERVES and label.about == request for label in self.graph.labels)
        return self.graph.taken(np.fromiter(labels, dtype=np.bool_, count=len(self.graph.labels)))

    def served(self) -> Lasso | None:
        """Return a shortest run that ends by serving one of the requests; None if there is none."""
        labels = (label.rule in SERVES and label.about in self.pending for label in self.graph.labels)
        goal = self.graph.taken(np.fromiter(labels, dtype=np.bool_, count=len(self.graph.labels)))
        path = shortest(self.graph, 0, goal)
        return None if path is None else Lasso(path, shortest=True)

    def _starved(self, request: Request, entry: int) -> Starved:
        serving = self.serving(request)
        run = run_into(self.graph, self.waiting(request), self.fairness, entry, by=~serving)
        enabled = self.graph.enabled(serving)
        places = [int(self.graph.sources[edge]) for edge in run.loop]
        return Starved(request, run, bool(enabled[places].any()), self._behind(request, places))

    def _behind(self, request: Request, places: Iterable[int]) -> tuple[Request, ...]:
        found: dict[Request, None] = {}
        for place in places:
            for action in self.graph.actions[self.graph.starts[place] : self.graph.starts[place + 1]]:
                label = self.graph.labels[action] if action >= 0 else None
                if label is None or label.agent != request.agent or arrives(label, self.arriving):
                    continue
                assert isinstance(label.about, FLY)
                found[label.about] = None
        return tuple(found)
