"""Whom a vehicle obeys, as several links know it: each reads it now and then, and another has handed it on meanwhile.

No message of a vehicle says when it began to obey whom, and the network between stations may be faster than a link. So
a change counts at once where it was commanded, and where our own link is lost; what else contradicts what is known
counts once it has lasted so long that the link has read it again.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

from adapters.live.orders import is_authority, is_done
from adapters.plugin import HandOver, Published
from adapters.stations.entries import Said
from adapters.stations.merge import channels_of
from semantics.reactions import CONTROL_AUTHORITY

LASTING: Final = 12.0
"""Seconds after which a link has read anew whom its vehicle obeys, though one answer may be lost."""

A_MOMENT: Final = 1e-6

Channels = tuple[tuple[str, ...], float]
"""The channels that a vehicle is on, and since when."""


@dataclass(slots=True)
class Authority:
    """What one station's links are believed of the channels of their vehicles.

    Attributes:
        station: The station.
        handing: The hand-over that each vehicle was told, and has not shown yet.
        doubts: What each link says otherwise than is known, and since when.
    """

    station: str
    handing: dict[str, HandOver] = field(default_factory=dict)
    doubts: dict[str, Channels] = field(default_factory=dict)

    def channels(self, entity: str, published: Published, known: Said | None, now: float) -> Channels:
        """Return what counts of a vehicle's channels where its link shows some, and others are known."""
        shown = channels_of(published)
        if known is None:
            return shown, now
        believed = (channels_of(known.published), known.since)
        if shown == believed[0]:
            self.doubts.pop(entity, None)
            return believed
        if self._counts(entity, shown, believed[0], now):
            return shown, max(now, known.since + A_MOMENT)
        return believed

    def _counts(self, entity: str, shown: tuple[str, ...], believed: tuple[str, ...], now: float) -> bool:
        told = self.handing.get(entity)
        if told is not None and is_done(told, shown):
            del self.handing[entity]
            return True
        if not any(map(is_authority, shown)):  # it is lost, or does not tell
            return f"{CONTROL_AUTHORITY}:{self.station}" in believed
        doubted, since = self.doubts.get(entity, ((), now))
        if doubted != shown:
            self.doubts[entity] = (shown, now)
            return False
        return now - since >= LASTING
