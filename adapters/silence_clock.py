"""The time that this process has listened: its own stalls do not count as the silence of others.

When a process is stopped, or its machine is suspended or overloaded, the clock jumps, and messages wait unread or are
lost. So only a bounded part of the time between two readings of the clock counts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

MOST: Final = 1.5
"""The most seconds between two readings that count: a listener reads the clock at least every second."""


@dataclass(slots=True)
class Listening:
    """A clock that counts the time without listening.

    Attributes:
        looked: The last reading of the clock.
        missed: The seconds without listening so far.
    """

    looked: float
    missed: float = 0.0

    def look(self, now: float) -> float:
        """Read the clock, and return its time less all missed seconds.

        >>> listening = Listening(looked=100.0)
        >>> listening.look(100.5), listening.look(107.5), listening.look(108.0)
        (100.5, 102.0, 102.5)
        """
        self.missed += max(0.0, now - self.looked - MOST)
        self.looked = max(self.looked, now)
        return now - self.missed
