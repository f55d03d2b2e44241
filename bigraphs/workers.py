"""Processes that do a part of what waits, ahead of the one that asks; what they find is taken in order.

A worker is a fork: it knows all that is known, and nothing has to be sent to it. It does every n-th piece of what
waits, answers piece by piece, and ends. What a worker that failed has not answered, whatever the reason, is left to
the one that asks, who meets an error where it would have met it alone.
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
"""After how many seconds help is asked for, of the processor as all here: small systems are done by then."""
LEAST: Final = 0.1
"""For less seconds of work no worker is started: to copy the memory that both write takes some 0.03 of each."""
PIECE: Final = 0.1
"""How many seconds of work a piece is, at most."""
PIECES: Final = 8
"""How many pieces a worker is given, or up to twice as many: neighbours take equally long, others do not."""
LOOK_EVERY: Final = 0.1
"""Seconds between two looks around while a worker is waited for."""

Piece: TypeAlias = tuple[int, int]
"""How many parts that wait are skipped after the piece before, and how many are in it."""

Work: TypeAlias = Callable[[Sequence[Piece]], Iterator[bytes]]
"""What a worker does: yields an answer for each piece."""


Memory = TypeVar("Memory")


def cores() -> int:
    """Return how many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@dataclass(eq=False, slots=True)
class _Worker(Generic[Memory]):
    """A process that is at work, and what its answers are understood by."""

    process: ForkProcess
    answers: Connection
    memory: Memory

    def end(self) -> None:
        """End it, whatever it does."""
        self.process.kill()
        self.process.join()
        self.process.close()
        self.answers.close()


class Workers(Generic[Memory]):
    """Those who help with parts that are numbered from 0, each of which takes about as long as those before it."""

    def __init__(self, processes: int, work: Work, remember: Callable[[], Memory]) -> None:
        """Take what is to be remembered of the moment at which a worker was started: it comes with its answers."""
        self._processes = max(processes, 1) if hasattr(os, "fork") else 1
        self._work, self._remember = work, remember
        self._given: deque[tuple[int, _Worker[Memory]]] = (
            deque()
        )  # the first part of each piece, and who does it
        self._since, self._from = time.process_time(), 0
        self._at_once, self._frozen = 1, False
        self._pace = 0.0  # seconds that one process takes for a part, lately

    def share(self, first: int, waiting: int) -> None:
        """Give workers some of the parts that wait, from `first` on, if it is worth it and nothing is given."""
        if self._processes == 1 or self._given:
            return
        if self._at_once > 1 or time.process_time() - self._since >= BEGIN:
            self._measure(first, 1)
        if self._pace:
            turns, count = self._pieces(waiting)
            if turns and turns * count * self._pace >= LEAST:
                self._start(first, turns, count)

    def _pieces(self, waiting: int) -> tuple[int, int]:
        """Return how many pieces each process is to do, and how many parts a piece has."""
        parts = waiting // self._processes
        count = max(1, min(parts // PIECES, int(PIECE / self._pace)))
        return min(parts // count, 2 * PIECES), count

    def _measure(self, first: int, at_once: int) -> None:
        """Note how long a part has taken since it was last noted, and how many processes do the next ones."""
        now = time.process_time()
        if first > self._from:
            self._pace = self._at_once * (now - self._since) / (first - self._from)
        self._since, self._from, self._at_once = now, first, at_once

    def _start(self, first: int, turns: int, count: int) -> None:
        """Start workers; this process does the first piece of each turn."""
        self._frozen = True
        gc.freeze()  # a collection would copy all memory that the processes share
        between = (self._processes - 1) * count
        helpers: list[_Worker[Memory]] = []
        try:
            for place in range(1, self._processes):
                pieces = [(place * count, count), *[(between, count)] * (turns - 1)]
                helpers.append(self._started(pieces))
        except OSError:  # there is no room for one more
            self._processes = 1 + len(helpers)
        for turn in range(turns):
            begin = first + turn * (between + count)
            self._given += [(begin + place * count, helper) for place, helper in enumerate(helpers, 1)]
        self._measure(first, 1 + len(helpers))

    def _started(self, pieces: Sequence[Piece]) -> _Worker[Memory]:
        """Return a worker, to which Ctrl-C says nothing."""
        from multiprocessing import get_context  # noqa: PLC0415 - small systems need no help
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
        """Wait for what a worker has found from a part on; None if no worker does it. Look around meanwhile."""
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
        """Take back what a worker has not done."""
        worker.end()
        self._given = deque((first, other) for first, other in self._given if other is not worker)

    def close(self) -> None:
        """End the workers that are at work."""
        while self._given:
            self._leave(self._given[0][1])
        if self._frozen:
            gc.unfreeze()


def _run(work: Work, send: Connection, answers: Connection, pieces: Sequence[Piece]) -> None:
    """Answer for each piece, in a worker; its own way to hear them is closed, so that it notices when nobody does."""
    answers.close()
    gc.disable()
    try:
        for answer in work(pieces):
            send.send_bytes(answer)
    except Exception:  # who asks meets it in turn
        raise SystemExit(1) from None
