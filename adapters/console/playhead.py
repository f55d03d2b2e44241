"""The play head of one browser: the newest moment of the time line, or an earlier one, paused or playing."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

SLOWEST: Final = 0.5
FASTEST: Final = 100.0
"""The bounds of the speed: seconds of the recording per second of wall time."""


@dataclass(frozen=True, slots=True)
class Playhead:
    """A browser's place on the time line.

    Attributes:
        at: The recording's time that was shown at `since`; None for the newest moment, even as new messages come.
        since: The time of a monotonic clock.
        playing: Whether the shown time goes on.
        speed: Seconds of the recording per second of wall time.
    """

    at: float | None = None
    since: float = 0.0
    playing: bool = False
    speed: float = 1.0

    @property
    def live(self) -> bool:
        """Whether the newest moment is shown."""
        return self.at is None

    def now(self, clock: float, newest: float) -> float:
        """Return the shown time, at most the newest.

        >>> Playhead(100.0, since=5.0, playing=True, speed=10.0).now(7.0, 1000.0)
        120.0
        """
        if self.at is None:
            return newest
        passed = (clock - self.since) * self.speed if self.playing else 0.0
        return min(newest, self.at + passed)

    def seek(self, time: float, clock: float, begin: float, newest: float) -> Playhead:
        """Return the play head at another time; a playing one goes on playing."""
        return replace(self, at=max(begin, min(newest, time)), since=clock)

    def play(self, speed: float, clock: float, newest: float) -> Playhead:
        """Return the play head playing from the shown time at a speed."""
        return Playhead(self.now(clock, newest), clock, playing=True, speed=speed)

    def pause(self, clock: float, newest: float) -> Playhead:
        """Return the play head paused at the shown time."""
        return Playhead(self.now(clock, newest), clock, speed=self.speed)

    def caught_up(self, clock: float, newest: float, *, ended: bool) -> Playhead:
        """Return the play head, live if it has played up to the newest moment; paused there if the run has ended."""
        if not self.playing or self.now(clock, newest) < newest:
            return self
        return self.pause(clock, newest) if ended else Playhead()
