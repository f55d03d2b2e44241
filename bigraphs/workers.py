"""Processes that do a part of what waits, ahead of the one that asks; what they find is taken in order.

A worker is a fork, so that it knows all that is known and nothing has to be sent to it. It does one slice, answers, and
ends. A slice whose worker has failed, whatever the reason, is given back: who asks does it again, and meets an error
where it would have met it alone.
"""

from __future__ import annotations

import os
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from multiprocessing.connection import Connection
    from multiprocessing.context import ForkProcess

BEGIN: Final = 0.5
"""After how many seconds help is asked for: small systems are done by then."""
LEAST: Final = 0.02
"""For less seconds of work no worker is started."""
MOST: Final = 0.5
"""How many seconds of work a worker is given."""
LOOK_EVERY: Final = 0.1
"""Seconds between two looks around while a worker is waited for."""


@dataclass(frozen=True, slots=True)
class _Slice:
    """What a worker does: so many parts from a first one on."""

    first: int
    count: int
    process: ForkProcess
    answer: Connection


class Workers:
    """Those who help with parts that are numbered from 0, each of which takes about as long as those before it."""

    def __init__(self, processes: int, work: Callable[[int, int], bytes]) -> None:
        """Take what a worker does: how many of the parts that wait it skips, and how many it does."""
        self._helpers = processes - 1 if hasattr(os, "fork") else 0
        self._work = work
        self._slices: deque[_Slice] = deque()
        self._since, self._from = time.monotonic(), 0
        self._pace = 0.0

    def share(self, first: int, waiting: int) -> None:
        """Start workers on some of the parts that wait, from `first` on, if all those before them are done."""
        if not self._helpers or self._slices or first == self._from:
            return
        if self._pace == 0.0:
            seconds = time.monotonic() - self._since
            if seconds < BEGIN:
                return
            self._pace = seconds / (first - self._from)
        count = min(waiting // (self._helpers + 1), max(1, int(MOST / self._pace)))
        if count * self._pace < LEAST:
            return
        self._since, self._from = time.monotonic(), first
        for helper in range(1, self._helpers + 1):
            self._start(helper * count, first + helper * count, count)

    def _start(self, skipped: int, first: int, count: int) -> None:
        """Start a worker, to which Ctrl-C says nothing; without room for one more, do without."""
        from multiprocessing import get_context  # noqa: PLC0415 - small systems need no help
        from signal import SIG_BLOCK, SIG_SETMASK, SIGINT, pthread_sigmask  # noqa: PLC0415

        context = get_context("fork")
        answer, send = context.Pipe(duplex=False)
        process = context.Process(target=_run, args=(self._work, send, skipped, count), daemon=True)
        mask = pthread_sigmask(SIG_BLOCK, {SIGINT})
        try:
            process.start()
        except OSError:
            self._helpers = 0
        else:
            self._slices.append(_Slice(first, count, process, answer))
        finally:
            pthread_sigmask(SIG_SETMASK, mask)
            send.close()

    def found(self, first: int, look: Callable[[], None]) -> bytes | None:
        """Wait for what a worker has found from a part on; None if no worker has done it. Look around meanwhile."""
        if not self._slices or self._slices[0].first != first:
            return None
        if first == self._from + self._slices[0].count:  # the end of what was left to this process
            self._pace = (time.monotonic() - self._since) / self._slices[0].count
        given = self._slices[0]
        try:
            while not given.answer.poll(LOOK_EVERY):
                look()
            return given.answer.recv_bytes()
        except (EOFError, OSError):
            return None
        finally:
            self._end(self._slices.popleft())

    def close(self) -> None:
        """End the workers that are at work."""
        while self._slices:
            self._end(self._slices.popleft())

    def _end(self, given: _Slice) -> None:
        given.process.kill()
        given.process.join()
        given.process.close()
        given.answer.close()


def _run(work: Callable[[int, int], bytes], send: Connection, *given: int) -> None:
    """Do a slice in a worker, without collecting garbage: that would copy all memory that the processes share."""
    import gc  # noqa: PLC0415 - only workers need it

    gc.disable()
    try:
        send.send_bytes(work(*given))
    except Exception:  # noqa: BLE001 - who asks meets it in turn
        raise SystemExit(1) from None
