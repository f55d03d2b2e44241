"""Worker processes that compute parts of a queue ahead of the main process, which takes the results in order.

A worker is a fork: it shares the memory of the main process, so nothing needs to be sent to it. It computes every n-th
piece of the queue, answers piece by piece, and ends. The main process computes the unanswered pieces of a failed worker
itself, so any error occurs as it would without workers.
"""

from __future__ import annotations

import gc
import os
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Generic, TypeAlias, TypeVar

if TYPE_CHECKING:
    from multiprocessing.connection import Connection
    from multiprocessing.context import ForkProcess

BEGIN: Final = 0.5
"""Seconds of processor time before workers start; small systems finish earlier."""
LEAST: Final = 0.1
"""The least work for which workers start, in seconds; copying the shared memory on write takes some 0.03 s each."""
PIECE: Final = 0.1
"""The longest duration of a piece, in seconds."""
PIECES: Final = 8
"""The number of pieces per worker, at most doubled: neighbouring states take equally long, distant ones do not."""
LOOK_EVERY: Final = 0.1
"""Seconds between two progress checks while the main process waits for a worker."""

Piece: TypeAlias = tuple[int, int]
"""The number of parts to skip after the previous piece, and the number of parts in this piece."""

Work: TypeAlias = Callable[[Sequence[Piece]], Iterator[bytes]]
"""A worker's task: it yields an answer for each piece."""


Memory = TypeVar("Memory")


@dataclass(eq=False, slots=True)
class _Worker(Generic[Memory]):
    """A running process, and the data needed to interpret its answers."""

    process: ForkProcess
    answers: Connection
    memory: Memory

    def end(self) -> None:
        """Kill the process and release its resources."""
        self.process.kill()
        self.process.join()
        self.process.close()
        self.answers.close()


class Workers(Generic[Memory]):
    """The workers of a queue, whose parts are numbered from 0 and take similar times."""

    def __init__(self, processes: int, work: Work, remember: Callable[[], Memory]) -> None:
        """Set the task; `remember` captures the state at the start of a worker and comes back with its answers."""
        self._processes = max(processes, 1) if hasattr(os, "fork") else 1
        self._work, self._remember = work, remember
        self._given: deque[tuple[int, _Worker[Memory]]] = (
            deque()
        )  # the first part of each piece, and its worker
        self._since, self._from = time.process_time(), 0
        self._at_once, self._frozen = 1, False
        self._pace = 0.0  # seconds per part in one process, recently measured

    def share(self, first: int, waiting: int) -> None:
        """Give workers parts from `first` on, if that is worthwhile and none are working."""
        if self._processes == 1 or self._given:
            return
        if self._at_once > 1 or time.process_time() - self._since >= BEGIN:
            self._measure(first, 1)
        if self._pace:
            turns, count = self._pieces(waiting)
            if turns and turns * count * self._pace >= LEAST:
                self._start(first, turns, count)

    def _pieces(self, waiting: int) -> tuple[int, int]:
        """Return the number of pieces per process, and the number of parts per piece."""
        parts = waiting // self._processes
        count = max(1, min(parts // PIECES, int(PIECE / self._pace)))
        return min(parts // count, 2 * PIECES), count

    def _measure(self, first: int, at_once: int) -> None:
        """Measure the time per part since the last call; `at_once` processes compute the next parts."""
        now = time.process_time()
        if first > self._from:
            self._pace = self._at_once * (now - self._since) / (first - self._from)
        self._since, self._from, self._at_once = now, first, at_once

    def _start(self, first: int, turns: int, count: int) -> None:
        """Start workers; this process computes the first piece of each turn."""
        self._frozen = True
        gc.freeze()  # a collection would copy all memory that the processes share
        between = (self._processes - 1) * count
        helpers: list[_Worker[Memory]] = []
        try:
            for place in range(1, self._processes):
                pieces = [(place * count, count), *[(between, count)] * (turns - 1)]
                helpers.append(self._started(pieces))
        except OSError:  # no resources for another process
            self._processes = 1 + len(helpers)
        for turn in range(turns):
            begin = first + turn * (between + count)
            self._given += [(begin + place * count, helper) for place, helper in enumerate(helpers, 1)]
        self._measure(first, 1 + len(helpers))

    def _started(self, pieces: Sequence[Piece]) -> _Worker[Memory]:
        """Return a new worker, which ignores Ctrl-C."""
        from multiprocessing import get_context  # noqa: PLC0415 - small systems need no workers
        from signal import SIG_BLOCK, SIG_SETMASK, SIGINT, pthread_sigmask  # noqa: PLC0415

        context = get_context("fork")
        answers, send = context.Pipe(duplex=False)
        process = context.Process(target=_run, args=(self._work, send, answers, pieces), daemon=True)
        mask = pthread_sigmask(SIG_BLOCK, {SIGINT})
        try:
            process.start()
        finally:
            pthread_sigmask(SIG_SETMASK, mask)
            send.close()
        return _Worker(process, answers, self._remember())

    def found(self, first: int, look: Callable[[], None]) -> tuple[Memory, bytes] | None:
        """Return a worker's answer for the piece that starts at a part, or None; call `look` while waiting."""
        if not self._given or self._given[0][0] != first:
            return None
        worker = self._given[0][1]
        try:
            while not worker.answers.poll(LOOK_EVERY):
                look()
            answer = worker.answers.recv_bytes()
        except (EOFError, OSError):
            self._leave(worker)
            return None
        self._given.popleft()
        if all(other is not worker for _, other in self._given):
            worker.end()
        return worker.memory, answer

    def _leave(self, worker: _Worker[Memory]) -> None:
        """Stop a worker and take back its unanswered pieces."""
        worker.end()
        self._given = deque((first, other) for first, other in self._given if other is not worker)

    def close(self) -> None:
        """Stop all workers."""
        while self._given:
            self._leave(self._given[0][1])
        if self._frozen:
            gc.unfreeze()


def _run(work: Work, send: Connection, answers: Connection, pieces: Sequence[Piece]) -> None:
    """Answer each piece, in a worker.

    The worker closes its copy of the receiving end, so that it notices the death of the main process.
    """
    answers.close()
    gc.disable()
    try:
        for answer in work(pieces):
            send.send_bytes(answer)
    except Exception:  # the main process meets the error in its turn
        raise SystemExit(1) from None
