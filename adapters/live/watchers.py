"""Watchers of a run: the terminal, the recording, other stations. A watcher that fails is dropped; the run goes on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

from adapters.live.state import Heard, Turn
from adapters.plugin import Failed, Report


class Watcher(Protocol):
    """Who looks on: a terminal, a recording, a test. Called in the loop's thread, in this order for each turn."""

    def arrived(self, heard: Heard, now: float) -> None:
        """See something come in."""

    def reported(self, report: Report, now: float) -> None:
        """See what a plugin reports."""

    def turned(self, turn: Turn, now: float) -> None:
        """See what a turn came to, before its commands are sent."""


class Watchers:
    """All who look on, as one. Each is told in the order given; what one can't write is kept as a failure."""

    def __init__(self, watchers: Sequence[Watcher] = ()) -> None:
        self._watchers = list(watchers)
        self._failures: list[Failed] = []

    def arrived(self, heard: Heard, now: float) -> None:
        """Show all that something comes in."""
        self._tell(now, lambda watcher: watcher.arrived(heard, now))

    def reported(self, report: Report, now: float) -> None:
        """Show all what a plugin reports."""
        self._tell(now, lambda watcher: watcher.reported(report, now))

    def turned(self, turn: Turn, now: float) -> None:
        """Show all what a turn came to."""
        self._tell(now, lambda watcher: watcher.turned(turn, now))

    def failures(self) -> tuple[Failed, ...]:
        """Return who has failed since the last time."""
        found, self._failures = tuple(self._failures), []
        return found

    def _tell(self, now: float, tell: Callable[[Watcher], None]) -> None:
        for watcher in tuple(self._watchers):
            try:
                tell(watcher)
            except (OSError, ValueError) as error:
                self._watchers.remove(watcher)
                self._failures.append(Failed.by(error, "the recording", now))
