"""A simulated bad link: loss, duplication, delay (and so reordering), blackouts; reproducible by its seed."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random


@dataclass(frozen=True, slots=True)
class Disturbance:
    """The disturbance of packets on a link.

    Attributes:
        loss: The probability that a packet is lost.
        duplication: The probability that a packet comes twice.
        delay: The shortest and longest delay in seconds: packets may overtake each other.
        blackouts: Start and end of each total outage, in seconds of the sender's clock.
    """

    loss: float = 0.0
    duplication: float = 0.0
    delay: tuple[float, float] = (0.0, 0.0)
    blackouts: tuple[tuple[float, float], ...] = ()

    def arrivals(self, now: float, random: Random) -> tuple[float, ...]:
        """Return the delays of a packet sent now, one for each arrival: none if it is lost, two if it is duplicated."""
        if any(start <= now < end for start, end in self.blackouts) or random.random() < self.loss:
            return ()
        copies = 2 if random.random() < self.duplication else 1
        return tuple(random.uniform(*self.delay) for _ in range(copies))


NONE = Disturbance()
