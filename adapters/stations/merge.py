"""The merge: one world from the entries of all stations, in spite of loss, duplication and reordering.

Each station's newest entry on an entity (its word) is a register. Registers are joined by `newer`, which is
commutative, associative and idempotent, so the same entries lead to the same registers in any order. The state of an
entity depends only on its registers and the time: the newest time stamp wins, and ties are decided by station and
number. Clocks decide only between the words of two stations.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final

from adapters.live.fresh_placements import MOST_AHEAD
from adapters.plugin import Aged, Gone, Published
from adapters.stations.entries import Believed, Entry, Hosted, Said, VehicleSent, stamped_at
from physical import PhysicalProperty

ABREAST: Final = 5.0
"""Seconds within which words of several links are compared by the vehicle's clock; later it may have rebooted."""

MOST_ENTITIES: Final = 20_000
"""The most entities that one station may report."""

Words = Mapping[str, Entry]
"""The newest word of each station on one entity."""


def newer(one: Entry, other: Entry) -> Entry:
    """Return the newer of two entries of one station on the same subject."""
    return max(one, other, key=_numbered)


def _numbered(entry: Entry) -> tuple[int, str]:
    return (
        entry.number,
        repr(entry.content),
    )  # numbers are unique; a faulty station's duplicates are ordered all the same


class Merge:
    """The registers of all stations.

    Attributes:
        words: For each entity the newest word of each station.
        legs: For each vehicle the last destination by each station.
        homes: For each bigActor the last host by each station.
        beliefs: For each slot of L the last write of each station.
    """

    def __init__(self) -> None:
        self.words: dict[str, dict[str, Entry]] = {}
        self.legs: dict[str, dict[str, Entry]] = {}
        self.homes: dict[str, dict[str, Entry]] = {}
        self.beliefs: dict[str, dict[str, Entry]] = {}
        self._counts: dict[str, int] = {}

    def hear(self, entry: Entry) -> str | None:
        """Join an entry to its register; return the entity if that made a difference.

        Raises:
            ValueError: The station reports too many entities.
        """
        match entry.content:
            case Said() as said:
                return said.entity if self._join(self.words, said.entity, entry) else None
            case VehicleSent(entity):
                return entity if self._join(self.legs, entity, entry) else None
            case Hosted(agent):
                return agent if self._join(self.homes, agent, entry) else None
            case Believed(node, slot):
                return node if self._join(self.beliefs, f"{slot} {node}", entry) else None
            case _:
                return None

    def _join(self, registers: dict[str, dict[str, Entry]], entity: str, entry: Entry) -> bool:
        known = registers.get(entity, {}).get(entry.station)
        if known is None:
            count = self._counts.get(entry.station, 0)
            if count >= MOST_ENTITIES:
                raise ValueError(f"it reports more than {MOST_ENTITIES:,} entities")
            self._counts[entry.station] = count + 1
        elif newer(known, entry) is known:
            return False
        registers.setdefault(entity, {})[entry.station] = entry
        return True

    def leg(self, entity: str) -> Entry | None:
        """Return a vehicle's last destination by time stamp."""
        return max(self.legs.get(entity, {}).values(), key=_stamp, default=None)

    def home(self, agent: str) -> Entry | None:
        """Return a bigActor's last host by time stamp."""
        return max(self.homes.get(agent, {}).values(), key=_stamp, default=None)

    def belief(self, slot: str, node: str) -> Entry | None:
        """Return the last write to a slot of L by time stamp."""
        return max(self.beliefs.get(f"{slot} {node}", {}).values(), key=_stamp, default=None)

    def holds(self, entity: str, now: float) -> Said | None:
        """Return the state of an entity at a time, None if no word counts yet."""
        return holding(self.words.get(entity, {}), now)

    def own(self, entity: str, station: str, now: float) -> Said | None:
        """Return the word of one station on an entity, None if it has none that counts."""
        entry = self.words.get(entity, {}).get(station)
        return None if entry is None or not _counts(entry.content, now) else holding({station: entry}, now)

    def ahead(self, now: float) -> list[Entry]:
        """Return the words whose time stamps lie too far in the future to count."""
        return [
            entry
            for words in self.words.values()
            for entry in words.values()
            if not _counts(entry.content, now)
        ]


def holding(words: Words, now: float) -> Said | None:
    """Return the state of an entity at a time: the newest word on it, with the newest change of its channels.

    Two stations may hear a vehicle before one of them has read its new authority. So the newest *change* of channels
    counts, among the words that were valid at the time of the newest. Among positions the newest by the vehicle's own
    clock counts: a slow link stamps positions late, and would put the vehicle at an old position.
    """
    found = [entry for entry in words.values() if _counts(entry.content, now)]
    if not found:
        return None
    newest = _newest(found, now)
    if isinstance(newest.published, Gone):
        return newest
    if newest.until <= now:  # a late receiver gets the same world as a station that saw it expire
        return Said(Gone(newest.entity, newest.time, ""), newest.since, newest.owned)
    told = [
        entry
        for entry in found
        if not isinstance(_said(entry).published, Gone) and _said(entry).until >= newest.time
    ]
    latest = _said(max(told, key=_since)) if told else newest
    if latest is newest:  # always, if one station alone hears it
        return newest
    return replace(newest, published=on(newest.published, channels_of(latest.published)), since=latest.since)


def _newest(found: Sequence[Entry], now: float) -> Said:
    newest = max(found, key=_stamp)
    time = _said(newest).time
    if _said(newest).clock is None:
        return _said(newest)
    abreast = [
        entry for entry in found if _said(entry).time >= time - ABREAST and _said(entry).until > now
    ] or [newest]
    ahead = _said(max(abreast, key=lambda entry: (_said(entry).clock or 0, _stamp(entry))))
    if ahead.time == time:
        return ahead
    # Its time becomes the later one: time stamps must grow, or a run would keep an older report.
    return replace(ahead, published=stamped_at(ahead.published, time))


def _said(entry: Entry) -> Said:
    assert isinstance(entry.content, Said)
    return entry.content


def _counts(content: object, now: float) -> bool:
    return isinstance(content, Said) and content.time <= now + MOST_AHEAD


def _stamp(entry: Entry) -> tuple[float, str, int]:
    assert isinstance(entry.content, Said | VehicleSent | Hosted | Believed)
    return (entry.content.time, entry.station, entry.number)


def _since(entry: Entry) -> tuple[float, str, int]:
    return (_said(entry).since, entry.station, entry.number)


def channels_of(published: Published) -> tuple[str, ...]:
    """Return the channels on which an entity was seen; none if it is gone."""
    match published:
        case Aged(said, _):
            return said.channels
        case PhysicalProperty():
            return published.channels
        case _:
            return ()


def on(published: Published, channels: Iterable[str]) -> Published:
    """Return a publication with other channels."""
    match published:
        case Aged(said):
            return replace(published, property=said.on(channels))
        case PhysicalProperty():
            return published.on(channels)
        case _:
            return published
