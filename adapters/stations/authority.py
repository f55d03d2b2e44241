"""The authority over a vehicle, merged from several links that read it at different times.

No message of a vehicle has the time at which its authority changed. A vehicle may answer only the station that it
obeys, and the network between stations may be faster than a link. So a change counts at once at the station that
commanded it, and when our own link is lost. Any other *change* on a link counts once it has lasted for another reading,
if no command came in between.

While our own link shows that a vehicle obeys us, no other station's entry on it counts.

A link that never showed an authority has not lost it: after a hand-over to us it has as long to read it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

from adapters.live.command_planning import is_authority, is_done
from adapters.plugin import HandOver, Published
from adapters.stations.entries import Said
from adapters.stations.merge import channels_of
from semantics.behaviours.reaction_rules import CONTROL_AUTHORITY

LASTING: Final = 12.0
"""Seconds within which a link reads its vehicle's authority again, even if one answer is lost."""

A_MOMENT: Final = 1e-6

Channels = tuple[tuple[str, ...], float]
"""The channels of a vehicle, and the time of their last change."""


@dataclass(slots=True)
class Authority:
    """The believed channels of the vehicles on one station's links.

    Attributes:
        station: The station.
        hand_overs: The hand-over that each vehicle was commanded, and has not shown yet.
        shown: The last channels that each link has shown.
        doubts: For each vehicle with contradicting channels: the time of its link's channels, and that of the others.
    """

    station: str
    hand_overs: dict[str, HandOver] = field(default_factory=dict)
    shown: dict[str, tuple[str, ...]] = field(default_factory=dict)
    doubts: dict[str, tuple[float, float]] = field(default_factory=dict)

    def channels(
        self, entity: str, published: Published, known: Said | None, now: float, missed: float = 0.0
    ) -> Channels:
        """Return a vehicle's channels, from those that its link shows and those that are known.

        The age of a doubt excludes the time without listening, `missed` seconds so far.
        """
        shown, before = channels_of(published), self.shown.get(entity)
        self.shown[entity] = shown
        if known is None:
            return shown, now
        believed = (channels_of(known.published), known.since)
        if shown == believed[0]:
            self.doubts.pop(entity, None)
            return believed
        if shown != before or (is_silent(shown) and not self._doubts(entity, known.since)):
            self.doubts[entity] = (now - missed, known.since)
        lost = is_silent(shown) and not is_silent(before or ())
        if self._counts(entity, shown, believed, now - missed, lost=lost):
            return shown, max(now, known.since + A_MOMENT)
        return believed

    def keeps(self, entity: str) -> bool:
        """Return whether our own link shows that a vehicle obeys us, and we have not handed it over.

        Then no other station's entry on it counts: a take-over by another station shows on our link, too.
        """
        ours = f"{CONTROL_AUTHORITY}:{self.station}"
        return ours in self.shown.get(entity, ()) and entity not in self.hand_overs

    def lags(self, entity: str, known: Said | None) -> bool:
        """Return whether a vehicle obeys us and our link has not read it yet: the link would refuse commands."""
        ours = f"{CONTROL_AUTHORITY}:{self.station}"
        shown = [channel for channel in self.shown.get(entity, ()) if is_authority(channel)]
        return (
            known is not None and ours in channels_of(known.published) and bool(shown) and ours not in shown
        )

    def _counts(
        self, entity: str, shown: tuple[str, ...], believed: Channels, listened: float, *, lost: bool
    ) -> bool:
        commanded = self.hand_overs.get(entity)
        if commanded is not None and is_done(commanded, shown):
            del self.hand_overs[entity]
            return True
        if is_silent(shown) and f"{CONTROL_AUTHORITY}:{self.station}" not in believed[0]:
            return False
        since = self.doubts[entity][0] if self._doubts(entity, believed[1]) else listened
        return lost or listened - since >= LASTING

    def _doubts(self, entity: str, since: float) -> bool:
        """Return whether a vehicle's channels, known since a time, are in doubt."""
        return entity in self.doubts and self.doubts[entity][1] == since


def is_silent(shown: tuple[str, ...]) -> bool:
    """Return whether a link shows no authority: it has lost the vehicle, or the vehicle has never answered it."""
    return not any(map(is_authority, shown))
