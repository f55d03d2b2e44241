"""The place on the time line at which one browser looks: the newest moment, or an earlier one, at rest or in motion."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

SLOWEST: Final = 0.5
FASTEST: Final = 100.0
"""How many seconds of the recording pass in one of the clock on the wall."""


@dataclass(frozen=True, slots=True)
class Playhead:
    """Where somebody looks.

    Attributes:
        at: The time of the recording that was shown at `since`; None for the newest moment, whatever it is.
        since: When that was, by a clock that never goes back.
        playing: Whether the time that is shown goes on.
        speed: How fast.
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
        """Return the time that is shown, which is not after the newest.

        >>> Playhead(100.0, since=5.0, playing=True, speed=10.0).now(7.0, 1000.0)
        120.0
        """
        if self.at is None:
            return newest
        passed = (clock - self.since) * self.speed if self.playing else 0.0
        return min(newest, self.at + passed)

    def seek(self, time: float, clock: float, begin: float, newest: float) -> Playhead:
        """Show another time; it goes on playing if it did."""
        return replace(self, at=max(begin, min(newest, time)), since=clock)

    def play(self, speed: float, clock: float, newest: float) -> Playhead:
        """Go on from what is shown, at a speed."""
        return Playhead(self.now(clock, newest), clock, playing=True, speed=speed)

    def pause(self, clock: float, newest: float) -> Playhead:
        """Stay at what is shown."""
        return Playhead(self.now(clock, newest), clock, speed=self.speed)

    def caught_up(self, clock: float, newest: float, *, ended: bool) -> Playhead:
        """Return what becomes of it: who plays up to the newest moment is live, or at rest once the run has ended."""
        if not self.playing or self.now(clock, newest) < newest:
            return self
        return self.pause(clock, newest) if ended else Playhead()
