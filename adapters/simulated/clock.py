"""Event loops with a faster clock, so that tests of minutes take seconds.

Code that waits by asyncio does not notice. Time waits for the process: it passes no unserved timer. So a busy machine
makes a simulation slower, with the same results. Local sockets work with both clocks: data has arrived when the sender
continues.
"""

from __future__ import annotations

import asyncio
import selectors
import time
from collections.abc import Coroutine
from typing import Any, Final, TypeVar

Result = TypeVar("Result")

MADE_UP: Final = 1.0
"""Seconds of lost real time that a faster clock makes up for."""


class _Jumping(selectors.DefaultSelector):
    """Lets time jump to the next timer as soon as the loop is idle."""

    def __init__(self) -> None:
        super().__init__()
        self.now = 0.0

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        ready = super().select(timeout if timeout is None else 0)
        if not ready and timeout:
            self.now += timeout
        return ready


class _Hurried(selectors.DefaultSelector):
    """Waits the scaled time, and makes up for a little lost time."""

    def __init__(self, speed: float) -> None:
        super().__init__()
        self._speed = speed
        self._start = time.monotonic()
        self.now = 0.0

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        if timeout is not None and timeout <= 0:
            return super().select(0)
        waits = None if timeout is None else max(0.0, timeout - self._behind()) / self._speed
        ready = super().select(waits)
        passed = self._behind()
        self.now += passed if timeout is None else min(passed, timeout)
        return ready

    def _behind(self) -> float:
        """Return the seconds by which real time is ahead; a lag too long to make up for is dropped."""
        behind = (time.monotonic() - self._start) * self._speed - self.now
        lost = max(0.0, behind - MADE_UP * self._speed)
        self._start += lost / self._speed
        return behind - lost


class _Loop(asyncio.SelectorEventLoop):
    def __init__(self, selector: _Jumping | _Hurried) -> None:
        self._clock = selector
        super().__init__(selector)

    def time(self) -> float:
        return self._clock.now


def run(main: Coroutine[Any, Any, Result], speed: float | None = None) -> Result:
    """Run a coroutine at `speed` times real time; without one, as fast as possible."""
    clock = _Jumping() if speed is None else _Hurried(speed)
    with asyncio.Runner(loop_factory=lambda: _Loop(clock)) as runner:
        return runner.run(main)
