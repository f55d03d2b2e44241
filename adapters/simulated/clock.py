"""Event loops with a faster clock, so that tests of minutes take seconds.

Code that waits by asyncio does not notice. Local sockets work with both clocks: data has arrived when the sender
continues.
"""

from __future__ import annotations

import asyncio
import selectors
import time
from collections.abc import Coroutine
from typing import Any, TypeVar

Result = TypeVar("Result")


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
    """Waits the part of the time that a faster clock leaves."""

    def __init__(self, speed: float) -> None:
        super().__init__()
        self._speed = speed
        self._start = time.monotonic()

    @property
    def now(self) -> float:
        return (time.monotonic() - self._start) * self._speed

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        return super().select(None if timeout is None else timeout / self._speed)


class _Loop(asyncio.SelectorEventLoop):
    def __init__(self, selector: _Jumping | _Hurried) -> None:
        self._clock = selector
        super().__init__(selector)

    def time(self) -> float:
        return self._clock.now


def run(main: Coroutine[Any, Any, Result], speed: float | None = None) -> Result:
    """Run a coroutine at `speed` times the clock's pace; without one, as fast as it can be computed."""
    clock = _Jumping() if speed is None else _Hurried(speed)
    with asyncio.Runner(loop_factory=lambda: _Loop(clock)) as runner:
        return runner.run(main)
