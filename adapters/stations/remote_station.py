"""What is known of another station: its log so far, its waiting parcels, its clock, its reachability."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from adapters.plugin import Presence
from adapters.stations.entries import Posted
from adapters.stations.messages import Message
from adapters.stations.skew import Skew

SELDOM: Final = 2.0
"""Seconds between two reports of when a station was heard."""


@dataclass(slots=True)
class Other:
    """Another station.

    Attributes:
        heard: The number up to which all its entries were received.
        last: The last number that it is known to have used.
        parcels: Its parcels for us that have not entered yet, by index.
        delivered: The index up to which the run has received them.
        skew: How far its clock is ahead.
        answered: When it answered last.
        reached: Whether it answers; None if that is not known yet.
        skewed: Whether its clock is off by more than the bound.
        met: When it answered last, by the run's clock; None if it never did.
        shown: What the run was last told of its presence.
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
    shown: Presence | None = None
    awake: asyncio.Event = field(default_factory=asyncio.Event)

    def presence(self, station: str, now: float) -> Presence | None:
        """Return what the run should know of its presence: whether it is reached at once, when it was heard seldom."""
        found, before = Presence(station, now, self.reached, self.met), self.shown
        same = before is not None and before.reached == found.reached
        if same and before is not None and (before.heard == found.heard or now - before.time < SELDOM):
            return None
        self.shown = found
        return found

    def here(self, time: float) -> float:
        """Return a time of its clock by the clock here, as far as it is known how far it is ahead."""
        best = self.skew.best
        return time if best is None else time - best.ahead

    def follow(self, message: Message, *, whole: bool) -> bool:
        """Count the entries of a message; return whether no earlier ones are missing."""
        self.last = max(self.last, message.last)
        whole = whole and message.after <= self.heard
        if whole:
            self.heard = max(self.heard, message.upto)
        return whole

    def due(self, others: Mapping[str, Other], took: int) -> Iterator[tuple[int, Posted]]:
        """Yield the parcels that may enter now, in order.

        A parcel depends on what its sender had observed, which comes first as far as it can be reached. So an agent
        that is told of a hand-over also sees it.
        """
        self.delivered = max(self.delivered, took)
        while (parcel := self.parcels.get(self.delivered + 1)) is not None:
            if self.heard < self.last or not all(_is_known(others, *known) for known in parcel.knows):
                return
            self.delivered += 1
            yield self.delivered, parcel

    def drop(self, upto: int) -> None:
        """Forget the parcels that have entered."""
        for index in [index for index in self.parcels if index <= upto]:
            del self.parcels[index]


def _is_known(others: Mapping[str, Other], station: str, number: int) -> bool:
    other = others.get(station)
    return other is None or other.reached is False or other.heard >= number
