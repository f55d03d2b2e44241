"""A crew in this process: the same workers without Ray, each told only what can be pickled; one may be lost."""

import pickle
from typing import Any

from checker.engines.cluster.crew import LostError
from checker.engines.cluster.worker import Worker
from semantics.state.configuration import Configuration


class LocalCrew:
    """Workers that are called in turn.

    Attributes:
        dies: After how many calls a worker is lost, and which.
    """

    def __init__(
        self, initial: Configuration, workers: int, pending: int = 64, dies: tuple[tuple[int, int], ...] = ()
    ) -> None:
        self.workers = [Worker(initial, pending, me, workers) for me in range(workers)]
        self.initial, self.pending = initial, pending
        self.dies = dies
        self.called: list[str] = []
        self.lost: set[int] = set()
        self.revived = 0

    @property
    def size(self) -> int:
        return len(self.workers)

    @property
    def calls(self) -> int:
        return len(self.called)

    def one(self, worker: int, method: str, *arguments: Any) -> Any:
        self.called.append(method)
        if self.dies and self.calls >= self.dies[0][0]:
            self.lost.add(self.dies[0][1])
            self.dies = self.dies[1:]
        if worker in self.lost:
            raise LostError
        return sent(getattr(self.workers[worker], method)(*sent(arguments)))

    def every(self, method: str, *arguments: Any) -> list[Any]:
        return [self.one(worker, method, *arguments) for worker in range(self.size)]

    def exchange(self, giving: str, taking: str, *arguments: Any) -> list[Any]:
        given = self.every(giving, *arguments)
        return [self.one(worker, taking, *(each[worker] for each in given)) for worker in range(self.size)]

    def revive(self) -> None:
        for worker in self.lost:
            self.workers[worker] = Worker(self.initial, self.pending, worker, self.size)
            self.revived += 1
        self.lost = set()


def sent(value: Any) -> Any:
    return pickle.loads(pickle.dumps(value))
