"""The time that this process has listened: its own stalls do not count as the silence of others.

A process that is stopped, a machine that is suspended or too busy: the clock jumps, and what was said meanwhile waits
unread, or was never heard. So of what passes between two looks at the clock only a little counts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

MOST: Final = 1.5
"""Seconds between two looks that count: whoever listens looks every second at least, and reads in between."""


@dataclass(slots=True)
class Listening:
    """How long nobody listened.

    Attributes:
        looked: When the clock was looked at last.
        missed: The seconds so far that passed unheard.
    """

    looked: float
    missed: float = 0.0

    def look(self, now: float) -> float:
        """Look at the clock, and return its time less all that was missed.

        >>> listening = Listening(looked=100.0)
        >>> listening.look(100.5), listening.look(107.5), listening.look(108.0)
        (100.5, 102.0, 102.5)
        """
        self.missed += max(0.0, now - self.looked - MOST)
        self.looked = max(self.looked, now)
        return now - self.missed
