"""What is known of another station: its log so far, its waiting parcels, its clock, its reachability."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from adapters.stations.entries import Posted
from adapters.stations.messages import Message
from adapters.stations.skew import Skew


@dataclass(slots=True)
class Other:
    """Another station.

    Attributes:
        heard: Up to which number everything that it said has been heard.
        last: The last number that it is known to have given.
        parcels: Its parcels for us that have not entered yet, by index.
        delivered: Up to which of them the run was told.
        skew: How far its clock is ahead.
        answered: When it answered last.
        reached: Whether it answers; None before anybody knows.
        skewed: Whether its clock is off by more than it may be.
        awake: Set where it has to be asked at once.
    """

    heard: int = 0
    last: int = 0
    parcels: dict[int, Posted] = field(default_factory=dict)
    delivered: int = 0
    skew: Skew = field(default_factory=Skew)
    answered: float = 0.0
    reached: bool | None = None
    skewed: bool = False
    awake: asyncio.Event = field(default_factory=asyncio.Event)

    def follow(self, message: Message, *, whole: bool) -> bool:
        """Count what a message told, all of it or not; return whether nothing before it is missing."""
        self.last = max(self.last, message.last)
        whole = whole and message.after <= self.heard
        if whole:
            self.heard = max(self.heard, message.upto)
        return whole

    def due(self, others: Mapping[str, Other], took: int) -> Iterator[tuple[int, Posted]]:
        """Yield the parcels that may enter now, in order.

        A parcel rests on what its sender had seen and heard: that comes first, as far as it can be had. So who is told
        that a vehicle was handed on sees it handed on.
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
