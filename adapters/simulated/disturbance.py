"""A simulated bad link: loss, duplication, delay (and so reordering), blackouts; reproducible by its seed."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random


@dataclass(frozen=True, slots=True)
class Disturbance:
    """What befalls packets on a link.

    Attributes:
        loss: The probability that one is lost.
        duplication: The probability that one comes twice.
        delay: The shortest and longest time that one takes, in seconds: they overtake each other.
        blackouts: From when to when nothing gets through, in seconds of the sender's clock.
    """

    loss: float = 0.0
    duplication: float = 0.0
    delay: tuple[float, float] = (0.0, 0.0)
    blackouts: tuple[tuple[float, float], ...] = ()

    def arrivals(self, now: float, random: Random) -> tuple[float, ...]:
        """Return after how many seconds a packet sent now arrives: nothing if it is lost, two if twice."""
        if any(start <= now < end for start, end in self.blackouts) or random.random() < self.loss:
            return ()
        copies = 2 if random.random() < self.duplication else 1
        return tuple(random.uniform(*self.delay) for _ in range(copies))


NONE = Disturbance()
