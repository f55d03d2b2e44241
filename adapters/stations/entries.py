"""The entries of a station's log: numbered, and encoded as plain data within bounds."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, Final

from msgspec import UNSET, Meta, Struct, UnsetType, field, to_builtins

from adapters.plugin import Aged, Gone, Published, entity_of
from adapters.typed_json import Text, Word, check_printable, typed
from physical import Band, PhysicalProperty, Velocity
from semantics.state.observation_serialization import geometry_json, geometry_of

MOST_BYTES: Final = 256 * 1024
"""The longest entry, as text."""

MOST_CHANNELS: Final = 100
MOST_WORDS: Final = 2_000
LARGEST: Final = 10**15
"""The largest number, index or time."""

Words = Annotated[tuple[Word, ...], Meta(max_length=MOST_CHANNELS)]
Whole = Annotated[int, Meta(ge=1, le=LARGEST)]
Count = Annotated[int, Meta(ge=0, le=LARGEST)]
Slot = Annotated[str, Meta(pattern=r"\A(parent|links)\Z")]
Seconds = Annotated[float, Meta(ge=-LARGEST, le=LARGEST)]


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


class VehicleSent(Struct, frozen=True):
    """A vehicle was sent to a node, or (an empty name) is no longer under way."""

    entity: Word = field(name="sent")
    to: Text
    time: Seconds

    @property
    def key(self) -> tuple[str, ...]:
        """The entries that it replaces: the vehicle's earlier destinations."""
        return ("sent", self.entity)


class Hosted(Struct, frozen=True):
    """The host of a bigActor that runs at the station."""

    agent: Word = field(name="hosted")
    host: Word
    time: Seconds

    @property
    def key(self) -> tuple[str, ...]:
        """The entries that it replaces: the agent's earlier hosts."""
        return ("hosted", self.agent)


class Believed(Struct, frozen=True):
    """The station has written a slot of L: a node's `parent` (no name if L lacks the node) or its `links`."""

    node: Word = field(name="believed")
    slot: Slot
    names: Words
    time: Seconds

    @property
    def key(self) -> tuple[str, ...]:
        """The entries that it replaces: the station's earlier writes to that slot."""
        return ("believed", self.slot, self.node)


class Broke(Struct, frozen=True):
    """The station has seen an assumption of the mission break; an empty text marks the start of a new run."""

    assumption: Annotated[str, Meta(max_length=MOST_WORDS)] = field(name="broke")
    time: Seconds

    @property
    def key(self) -> tuple[str, ...]:
        """The entries that it replaces: earlier broken assumptions."""
        return ("broke",)


class Posted(Struct, frozen=True, omit_defaults=True):
    """A parcel for another station.

    Attributes:
        to: The receiver.
        index: Its index among the parcels to that station.
        parcel: Its content, as plain data.
        knows: The last numbers of other stations that the sender had received: its content may depend on them.
        time: Time of its departure; `UNSET` in logs without it.
    """

    to: Word
    index: Whole
    parcel: Any
    knows: Annotated[dict[Word, Whole], Meta(max_length=MOST_CHANNELS)] = {}
    time: Seconds | UnsetType = UNSET

    @property
    def key(self) -> tuple[str, ...]:
        """A parcel replaces no entry: it stays until it is taken."""
        return ("posted", self.to, str(self.index))


class Took(Struct, frozen=True):
    """All parcels of another station up to an index were taken: the acknowledgement."""

    of: Word = field(name="took")
    index: Whole

    @property
    def key(self) -> tuple[str, ...]:
        """The entries that it replaces: earlier acknowledgements to the same station."""
        return ("took", self.of)


Content = Said | VehicleSent | Hosted | Believed | Broke | Posted | Took


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


class _Numbered(Struct, frozen=True):
    n: Whole


class _Ended(Struct, frozen=True):
    """A `Said` of the end of an entity."""

    entity: Word
    time: Seconds
    gone: bool
    since: Seconds
    owned: bool


class _Seen(Struct, frozen=True, omit_defaults=True, kw_only=True):
    """A `Said` of a property."""

    entity: Word
    kind: Word
    at: Any
    time: Seconds
    altitude: tuple[Seconds, Seconds] | None = None
    channels: Words = ()
    by: Word | None = None
    velocity: tuple[Seconds, Seconds] | None = None
    ttl: Seconds | UnsetType = UNSET
    clock: Whole | UnsetType = UNSET
    since: Seconds
    owned: bool


_Data = Took | VehicleSent | Hosted | Believed | Broke | Posted | _Ended | _Seen

_KINDS: Final[Mapping[str, type[_Data]]] = {
    "took": Took,
    "sent": VehicleSent,
    "hosted": Hosted,
    "believed": Believed,
    "broke": Broke,
    "parcel": Posted,
    "entity": _Seen,
}
"""The type of an entry, by a member that only its type has."""


def entry_text(entry: Entry) -> str:
    """Return an entry as one line of JSON, without its station."""
    content = _plain(entry.content) if isinstance(entry.content, Said) else entry.content
    data = {"n": entry.number, **to_builtins(content)}
    return json.dumps(data, ensure_ascii=False, separators=(",", ":"), allow_nan=False)


def entry_of(station: str, data: Any) -> Entry:
    """Read an entry of a station.

    Raises:
        ValueError: The data are not an entry, for the reason in the message.
    """
    number = typed(data, _Numbered).n
    kind = next((kind for member, kind in _KINDS.items() if member in data), None)
    if kind is None:
        raise ValueError("an entry is of no known kind")
    if kind is _Seen and data.get("gone") is True:
        kind = _Ended
    plain: _Data = typed(data, kind)
    check_printable(plain, "parcel")
    return Entry(station, number, _said(station, plain) if isinstance(plain, _Ended | _Seen) else plain)


def _plain(said: Said) -> _Ended | _Seen:
    ttl: float | None = None
    clock: int | None = None
    match said.published:
        case Gone(entity, time):
            return _Ended(entity, time, gone=True, since=said.since, owned=said.owned)
        case Aged(seen, ttl, clock):
            pass
        case seen:
            pass
    band, velocity = seen.altitude, seen.velocity
    return _Seen(
        entity=seen.entity,
        kind=seen.kind,
        at=geometry_json(seen.geometry),
        time=said.time,
        altitude=None if band is None else (band.low, band.high),
        channels=seen.channels,
        by=seen.carried_by,
        velocity=None if velocity is None else (velocity.speed, velocity.course),
        ttl=UNSET if ttl is None else ttl,
        clock=UNSET if clock is None else clock,
        since=said.since,
        owned=said.owned,
    )


def _said(station: str, plain: _Ended | _Seen) -> Said:
    if isinstance(plain, _Ended):
        return Said(Gone(plain.entity, plain.time, station), plain.since, plain.owned)
    seen = PhysicalProperty(
        plain.entity,
        plain.kind,
        geometry_of(plain.at),
        None if plain.altitude is None else Band(*plain.altitude),
        plain.channels,
        plain.by,
        plain.time,
        station,
        None if plain.velocity is None else Velocity(*plain.velocity),
    )
    if plain.ttl is UNSET:
        return Said(seen, plain.since, plain.owned)
    aged = Aged(seen, plain.ttl, None if plain.clock is UNSET else plain.clock)
    return Said(aged, plain.since, plain.owned)
