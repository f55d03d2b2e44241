"""The entries of a station's log: numbered, and encoded as plain data within bounds."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, replace
from typing import Any, Final

from adapters.plugin import (
    Aged,
    Gone,
    Published,
    entity_of,
)
from physical import PhysicalProperty, Velocity, is_word
from semantics.state.observation_serialization import band_of, geometry_json, geometry_of

MOST_BYTES: Final = 256 * 1024
"""The longest entry, as text."""

MOST_CHANNELS: Final = 100
MOST_WORDS: Final = 2_000
LARGEST: Final = 10**15
"""The largest number, index or time."""


@dataclass(frozen=True, slots=True)
class Said:
    """An observation of an entity: a property, or its end; its time is set.

    Attributes:
        published: The property, perhaps with a time to live, or the end of the entity.
        since: Time of the last change of the entity's channels.
        owned: Whether it came over the entity's own link: for a vehicle, no other source counts.
    """

    published: Published
    since: float
    owned: bool = False

    @property
    def key(self) -> tuple[str, ...]:
        """The entries that it replaces: older ones on the same entity."""
        return ("said", self.entity)

    @property
    def entity(self) -> str:
        """The entity."""
        return entity_of(self.published)

    @property
    def time(self) -> float:
        """The time of the observation."""
        said = self.published.property if isinstance(self.published, Aged) else self.published
        assert said.time is not None
        return said.time

    @property
    def clock(self) -> int | None:
        """The same time by the entity's own clock, if its link reports it."""
        return self.published.clock if self.owned and isinstance(self.published, Aged) else None

    @property
    def until(self) -> float:
        """The end of its validity in P."""
        return self.time + self.published.time_to_live if isinstance(self.published, Aged) else math.inf


@dataclass(frozen=True, slots=True)
class Sent:
    """A vehicle was sent to a node, or (an empty name) is no longer under way."""

    entity: str
    to: str
    time: float

    @property
    def key(self) -> tuple[str, ...]:
        """The entries that it replaces: the vehicle's earlier destinations."""
        return ("sent", self.entity)


@dataclass(frozen=True, slots=True)
class Hosted:
    """The host of a bigActor that runs at the station."""

    agent: str
    host: str
    time: float

    @property
    def key(self) -> tuple[str, ...]:
        """The entries that it replaces: the agent's earlier hosts."""
        return ("hosted", self.agent)


@dataclass(frozen=True, slots=True)
class Believed:
    """The station has written a slot of L: a node's `parent` (no name if L lacks the node) or its `links`."""

    node: str
    slot: str
    names: tuple[str, ...]
    time: float

    @property
    def key(self) -> tuple[str, ...]:
        """The entries that it replaces: the station's earlier writes to that slot."""
        return ("believed", self.slot, self.node)


@dataclass(frozen=True, slots=True)
class Broke:
    """The station has seen an assumption of the mission break; an empty text marks the start of a new run."""

    assumption: str
    time: float

    @property
    def key(self) -> tuple[str, ...]:
        """The entries that it replaces: earlier broken assumptions."""
        return ("broke",)


@dataclass(frozen=True, slots=True)
class Posted:
    """A parcel for another station.

    Attributes:
        to: The receiver.
        index: Its index among the parcels to that station.
        parcel: Its content, as plain data.
        knows: The last numbers of other stations that the sender had received: its content may depend on them.
        time: Time of its departure; None in logs without it.
    """

    to: str
    index: int
    parcel: Any
    knows: tuple[tuple[str, int], ...] = ()
    time: float | None = None

    @property
    def key(self) -> tuple[str, ...]:
        """A parcel replaces no entry: it stays until it is taken."""
        return ("posted", self.to, str(self.index))


@dataclass(frozen=True, slots=True)
class Took:
    """All parcels of another station up to an index were taken: the acknowledgement."""

    of: str
    index: int

    @property
    def key(self) -> tuple[str, ...]:
        """The entries that it replaces: earlier acknowledgements to the same station."""
        return ("took", self.of)


Content = Said | Sent | Hosted | Believed | Broke | Posted | Took


@dataclass(frozen=True, slots=True)
class Entry:
    """One entry of a station's log. A station never uses a number twice, and its numbers grow."""

    station: str
    number: int
    content: Content


def stamped_at(published: Published, time: float) -> Published:
    """Return a publication with another time."""
    if isinstance(published, Aged):
        return replace(published, property=replace(published.property, time=time))
    return replace(published, time=time)


def stamped(published: Published, now: float) -> Published:
    """Return a publication with its time set, by default to now."""
    match published:
        case PhysicalProperty(time=None):
            return replace(published, time=now)
        case Aged(PhysicalProperty(time=None) as said):
            return replace(published, property=replace(said, time=now))
        case _:
            return published


# --- as plain data --------------------------------------------------------------------------------------


def entry_json(entry: Entry) -> dict[str, Any]:
    """Return an entry as plain data, without its station."""
    match entry.content:
        case Said(published, since, owned):
            return {"n": entry.number, **_published_json(published), "since": since, "owned": owned}
        case Sent(entity, to, time):
            return {"n": entry.number, "sent": entity, "to": to, "time": time}
        case Hosted(agent, host, time):
            return {"n": entry.number, "hosted": agent, "host": host, "time": time}
        case Believed(node, slot, names, time):
            data = {"n": entry.number, "believed": node, "slot": slot, "names": list(names)}
            return {**data, "time": time}
        case Broke(assumption, time):
            return {"n": entry.number, "broke": assumption, "time": time}
        case Posted(to, index, parcel, knows, time):
            data = {"n": entry.number, "to": to, "index": index, "parcel": parcel}
            dated = {} if time is None else {"time": time}
            return data | ({"knows": dict(knows)} if knows else {}) | dated
        case Took(of, index):
            return {"n": entry.number, "took": of, "index": index}


def entry_text(entry: Entry) -> str:
    """Return an entry as one line of JSON."""
    return json.dumps(entry_json(entry), ensure_ascii=False, separators=(",", ":"), allow_nan=False)


def entry_of(station: str, data: Any) -> Entry:
    """Read an entry of a station.

    Raises:
        ValueError: The data are not an entry, for the reason in the message.
    """
    if not isinstance(data, dict):
        raise ValueError(f"{data!r:.60} is no entry")
    number = _whole(data, "n")
    match data:
        case {"took": str()}:
            return Entry(station, number, Took(_word(data, "took"), _whole(data, "index")))
        case {"sent": str(), "to": str(to)}:
            goal = _word(data, "to") if to else ""
            return Entry(station, number, Sent(_word(data, "sent"), goal, seconds(data.get("time"))))
        case {"hosted": str()}:
            home = Hosted(_word(data, "hosted"), _word(data, "host"), seconds(data.get("time")))
            return Entry(station, number, home)
        case {"believed": str(), "slot": "parent" | "links" as slot, "names": names}:
            node, time = _word(data, "believed"), seconds(data.get("time"))
            return Entry(station, number, Believed(node, slot, _channels(names), time))
        case {"broke": str(assumption)} if len(assumption) <= MOST_WORDS and assumption.isprintable():
            return Entry(station, number, Broke(assumption, seconds(data.get("time"))))
        case {"to": str(), "parcel": parcel}:
            knows = _knows(data.get("knows", {}))
            left = seconds(data["time"]) if "time" in data else None
            return Entry(
                station, number, Posted(_word(data, "to"), _whole(data, "index"), parcel, knows, left)
            )
        case {"entity": str(), "since": since, "owned": bool(owned)}:
            return Entry(station, number, Said(_published(station, data), seconds(since), owned))
    raise ValueError("an entry says or does none of what stations do")


def _published_json(published: Published) -> dict[str, Any]:
    if isinstance(published, Gone):
        return {"entity": published.entity, "time": published.time, "gone": True}
    said = published.property if isinstance(published, Aged) else published
    data: dict[str, Any] = {"entity": said.entity, "kind": said.kind, "at": geometry_json(said.geometry)}
    data["time"] = said.time
    if said.altitude is not None:
        data["altitude"] = [said.altitude.low, said.altitude.high]
    if said.channels:
        data["channels"] = list(said.channels)
    if said.carried_by is not None:
        data["by"] = said.carried_by
    if said.velocity is not None:
        data["velocity"] = [said.velocity.speed, said.velocity.course]
    if not isinstance(published, Aged):
        return data
    clock = {} if published.clock is None else {"clock": published.clock}
    return {**data, "ttl": published.time_to_live, **clock}


def _published(station: str, data: dict[str, Any]) -> Published:
    entity, time = _word(data, "entity"), seconds(data.get("time"))
    if data.get("gone") is True:
        return Gone(entity, time, station)
    said = PhysicalProperty(
        entity,
        _word(data, "kind"),
        geometry_of(data.get("at")),
        band_of(data.get("altitude")),
        _channels(data.get("channels", [])),
        None if data.get("by") is None else _word(data, "by"),
        time,
        station,
        _velocity(data.get("velocity")),
    )
    if "ttl" not in data:
        return said
    return Aged(said, seconds(data["ttl"]), _whole(data, "clock") if "clock" in data else None)


def _knows(data: Any) -> tuple[tuple[str, int], ...]:
    if not isinstance(data, dict) or len(data) > MOST_CHANNELS:
        raise ValueError("'knows' should give a number to each station")
    return tuple((name, _whole(data, name)) for name in sorted(data))


def _channels(data: Any) -> tuple[str, ...]:
    if not isinstance(data, list) or len(data) > MOST_CHANNELS:
        raise ValueError(f"channels should be a list of at most {MOST_CHANNELS}")
    return tuple(_word({"channel": each}, "channel") for each in data)


def _velocity(data: Any) -> Velocity | None:
    match data:
        case None:
            return None
        case [int() | float() as speed, int() | float() as course]:
            return Velocity(seconds(speed), seconds(course))
    raise ValueError(f"{data!r:.60} is no speed and course")


def _word(data: dict[str, Any], name: str) -> str:
    value = data.get(name)
    if not is_word(value):
        raise ValueError(f"'{name}' should be a word of 1 to 200 characters, not {value!r:.60}")
    return value


def _whole(data: dict[str, Any], name: str) -> int:
    value = data.get(name)
    if isinstance(value, bool) or not isinstance(value, int) or not 0 < value <= LARGEST:
        raise ValueError(f"'{name}' should be a whole number from 1, not {value!r:.60}")
    return value


def count(value: Any) -> int:
    """Return a whole number from 0 on; raises ValueError."""
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= LARGEST:
        raise ValueError(f"{value!r:.60} is no whole number from 0 on")
    return value


def seconds(value: Any) -> float:
    """Return a number of seconds, or another number; raises ValueError."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= LARGEST:
        raise ValueError(f"{value!r:.60} is no number of seconds")
    return float(value)
