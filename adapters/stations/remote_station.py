"""The state of another station: its log so far, its waiting parcels, its clock, its reachability."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from hashlib import sha256
from typing import Final

from adapters.plugin import Presence
from adapters.stations.entries import Posted
from adapters.stations.station_messages import StationMessage
from semantics.state.logical_model import LogicalModel

KEPT: Final = 8
"""The number of remembered round trips; the shortest is the most exact."""


@dataclass(frozen=True, slots=True)
class Measure:
    """Seconds by which a clock is ahead of ours, and the error bound."""

    ahead: float
    error: float

    def exceeds(self, bound: float) -> bool:
        """Return whether the clock is off by more than a bound, for any error within the error bound."""
        return abs(self.ahead) - self.error > bound


def measured(sent: float, theirs: float, received: float) -> Measure:
    """Measure by one round trip: the answer was written at some time in between.

    >>> measured(10.0, 13.5, 11.0)
    Measure(ahead=3.0, error=0.5)
    """
    return Measure(theirs - (sent + received) / 2, (received - sent) / 2)


@dataclass(slots=True)
class Skew:
    """The last measures of one clock."""

    measures: deque[Measure] = field(default_factory=lambda: deque(maxlen=KEPT))

    def add(self, measure: Measure) -> None:
        """Remember a measure."""
        self.measures.append(measure)

    @property
    def best(self) -> Measure | None:
        """The most exact of them."""
        return min(self.measures, key=lambda measure: measure.error, default=None)


SETTLED: Final = 5.0
"""Seconds for which two different digests of L must stay the same before the stations are said to differ."""

SELDOM: Final = 2.0
"""Seconds between two reports of the time at which a station was last heard."""


@dataclass(slots=True)
class Other:
    """Another station.

    Attributes:
        heard: The number up to which all its entries were received.
        last: The last number that it is known to have used.
        parcels: Its parcels for us that have not entered yet, by index.
        delivered: The index up to which the run has received them.
        skew: The lead of its clock.
        answered: Time of its last answer.
        reached: Whether it answers; None if that is not known yet.
        skewed: Whether its clock is off by more than the bound.
        met: Time of its last answer, by the run's clock; None before the first.
        compared: Its digest of L and ours, and the time since which they have been these.
        agrees: Whether its L is the same as ours; None while that is not known.
        begun: Whether its run has begun; None while that is not known.
        shown: The last report of its presence to the run.
        awake: Set if it must be asked at once.
    """

    heard: int = 0
    last: int = 0
    parcels: dict[int, Posted] = field(default_factory=dict)
    delivered: int = 0
    skew: Skew = field(default_factory=Skew)
    answered: float = 0.0
    reached: bool | None = None
    skewed: bool = False
    met: float | None = None
    compared: tuple[str, str, float] = ("", "", 0.0)
    agrees: bool | None = None
    begun: bool | None = None
    shown: Presence | None = None
    awake: asyncio.Event = field(default_factory=asyncio.Event)

    def presence(self, station: str, now: float) -> Presence | None:
        """Return a report of its presence: at once if more than its time has changed, else seldom; None if not due."""
        agrees = self.agrees if self.reached else None
        found, before = Presence(station, now, self.reached, self.met, agrees, self.begun), self.shown
        same = before is not None and replace(found, time=before.time, heard=before.heard) == before
        if same and before is not None and (before.heard == found.heard or now - before.time < SELDOM):
            return None
        self.shown = found
        return found

    def compare(self, theirs: str, ours: str, now: float) -> bool:
        """Compare the digests of L; return whether they differ from now on.

        Changes take their time to the other station: two digests differ only if both have stayed so for a while.
        """
        if self.compared[:2] != (theirs, ours):
            self.compared = (theirs, ours, now)
        before, same = self.agrees, theirs == ours
        if theirs and ours and (same or now - self.compared[2] >= SETTLED):
            self.agrees = same
        return self.agrees is False and before is not False

    def here(self, time: float) -> float:
        """Convert a time of its clock to the clock here, as far as its lead is known."""
        best = self.skew.best
        return time if best is None else time - best.ahead

    def follow(self, message: StationMessage, *, whole: bool) -> bool:
        """Count the entries of a message; return whether no earlier ones are missing."""
        self.last = max(self.last, message.last)
        whole = whole and message.after <= self.heard
        if whole:
            self.heard = max(self.heard, message.upto)
        return whole

    def due(self, others: Mapping[str, Other], took: int) -> Iterator[tuple[int, Posted]]:
        """Yield the parcels that may enter now, in order.

        A parcel depends on its sender's observations, which come first if they can be fetched. So an agent that is
        informed of a hand-over also sees it.
        """
        self.delivered = max(self.delivered, took)
        while (parcel := self.parcels.get(self.delivered + 1)) is not None:
            if self.heard < self.last or not all(_is_known(others, *known) for known in parcel.knows.items()):
                return
            self.delivered += 1
            yield self.delivered, parcel

    def drop(self, upto: int) -> None:
        """Remove the parcels that have entered."""
        for index in [index for index in self.parcels if index <= upto]:
            del self.parcels[index]


def _is_known(others: Mapping[str, Other], station: str, number: int) -> bool:
    other = others.get(station)
    return other is None or other.reached is False or other.heard >= number


def logical_digest(logical: LogicalModel) -> str:
    """Return a digest of the nodes of L with their parents and links; it is the same in each process."""
    nodes = [(name, logical.parent(name), sorted(logical.links(name))) for name in sorted(logical.nodes())]
    return sha256(repr(nodes).encode()).hexdigest()[:32]
