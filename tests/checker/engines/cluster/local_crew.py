"""A crew in this process: the same workers without Ray, each a thread that is told only what can be pickled.

Some may be lost: in the middle of what they exchange, as between questions.
"""

import pickle
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier, BrokenBarrierError
from typing import Any

from checker.engines.cluster.cluster_worker import Worker
from checker.engines.cluster.crew import LostError
from checker.engines.cluster.explorer import Expedition
from checker.engines.contract import Exploration, Inspect, Options
from checker.reduction.reducer import Reduced
from semantics.state.configuration import Configuration


class Board:
    """Where workers lay down what they exchange."""

    def __init__(self, workers: int) -> None:
        self.given: list[Any] = [None] * workers
        self.barrier = Barrier(workers)


class LocalLinks:
    """A worker's links to the others of its crew."""

    def __init__(self, crew: "LocalCrew", me: int) -> None:
        self.crew = crew
        self.me = me

    def exchange(self, given: Any) -> list[Any]:
        self.crew.count(self.me, "exchange")
        board = self.crew.board
        board.given[self.me] = given
        try:
            board.barrier.wait()
            found = [sent(each[self.me]) for each in board.given]
            board.barrier.wait()
        except BrokenBarrierError:
            raise LostError from None
        return found


class LocalCrew:
    """Workers that are asked together.

    Attributes:
        dies: Which worker is lost, and after how many questions and exchanges, one after another.
        called: What each was asked.
    """

    def __init__(
        self,
        initial: Configuration,
        workers: int,
        pending: int = 64,
        dies: tuple[tuple[int, int], ...] = (),
        reduce: Reduced | None = None,
    ) -> None:
        self.initial, self.pending, self.reduce = initial, pending, reduce
        self.workers = [self._worker(me, workers) for me in range(workers)]
        self.board = Board(workers)
        self.dies = dies
        self.called: list[list[str]] = [[] for _ in range(workers)]
        self.lost: set[int] = set()
        self.revived = 0

    def _worker(self, me: int, workers: int) -> Worker:
        return Worker(self.initial, self.pending, me, workers, LocalLinks(self, me), sent(self.reduce))

    @property
    def size(self) -> int:
        return len(self.workers)

    @property
    def calls(self) -> int:
        """How many questions and exchanges the worker had that had least."""
        return min(map(len, self.called))

    def count(self, worker: int, method: str) -> None:
        """Count a question or an exchange of a worker, unless it is lost."""
        self.called[worker].append(method)
        if self.dies and self.dies[0][1] == worker and len(self.called[worker]) >= self.dies[0][0]:
            self.lost.add(worker)
            self.dies = self.dies[1:]
        if worker in self.lost:
            raise LostError

    def one(self, worker: int, method: str, *arguments: Any) -> Any:
        try:
            self.count(worker, method)
            return sent(getattr(self.workers[worker], method)(*sent(arguments)))
        except BaseException:
            self.board.barrier.abort()
            raise

    def every(self, method: str, *arguments: Any) -> list[Any]:
        with ThreadPoolExecutor(self.size) as threads:
            answers = [threads.submit(self.one, worker, method, *arguments) for worker in range(self.size)]
        failures = [error for error in (each.exception() for each in answers) if error is not None]
        if failures:
            raise min(failures, key=lambda error: isinstance(error, LostError))
        return [each.result() for each in answers]

    def revive(self) -> None:
        for worker in self.lost:
            self.workers[worker] = self._worker(worker, self.size)
            self.revived += 1
        self.lost = set()
        self.board = Board(self.size)


def explore_in_threads(initial: Configuration, inspect: tuple[Inspect, ...], options: Options) -> Exploration:
    """Explore as the engine Ray does, with workers in this process."""
    crew = LocalCrew(initial, options.cluster.workers, options.limits.pending, reduce=options.reduce)
    return Expedition(crew, initial, options).run(inspect)


def sent(value: Any) -> Any:
    return pickle.loads(pickle.dumps(value))
