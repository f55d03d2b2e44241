"""Watchers of a run: the terminal, the recording, other stations. A watcher that fails is dropped; the run goes on."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from adapters.live.batch import Heard
from adapters.live.turn_result import Turn
from adapters.plugin import Failed, Report

SHOWN_RULES = frozenset({"env", "say", "command", "commit", "actuate", "migrate", "spawn"})
"""The rules whose steps are shown to the operator; the recording has the others too."""


class Watcher:
    """A watcher: a terminal, a recording, a test. Called in the loop's thread, in this order for each turn.

    One that leaves a method as it is here looks at nothing of that.
    """

    def arrived(self, heard: Heard, now: float) -> None:
        """Receive a publication."""

    def reported(self, report: Report, now: float) -> None:
        """Receive a plugin's report."""

    def turned(self, turn: Turn, now: float) -> None:
        """Receive the result of a turn, before its commands are sent."""


class Watchers:
    """All watchers as one, called in the given order. A watcher's error is kept as a failure."""

    def __init__(self, watchers: Sequence[Watcher] = ()) -> None:
        self._watchers = list(watchers)
        self._failures: list[Failed] = []

    def arrived(self, heard: Heard, now: float) -> None:
        """Pass a publication to all."""
        self._tell(now, lambda watcher: watcher.arrived(heard, now))

    def reported(self, report: Report, now: float) -> None:
        """Pass a plugin's report to all."""
        self._tell(now, lambda watcher: watcher.reported(report, now))

    def turned(self, turn: Turn, now: float) -> None:
        """Pass the result of a turn to all."""
        self._tell(now, lambda watcher: watcher.turned(turn, now))

    def failures(self) -> tuple[Failed, ...]:
        """Return the failures since the last call."""
        found, self._failures = tuple(self._failures), []
        return found

    def _tell(self, now: float, tell: Callable[[Watcher], None]) -> None:
        for watcher in tuple(self._watchers):
            try:
                tell(watcher)
            except (OSError, ValueError) as error:
                self._watchers.remove(watcher)
                self._failures.append(Failed.by(error, getattr(watcher, "name", "the recording"), now))
