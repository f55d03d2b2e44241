"""Read the items on board: missions, fences and rally points, before the first command and repeatedly.

Anybody may change them at any time, on the ground and in the air, and a vehicle reports a change only to its author. So
only items read back since the last possible change count as on board.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import Final

from adapters.mavlink import download as reading
from adapters.mavlink.constants import MissionType
from adapters.mavlink.items import Items
from adapters.mavlink.message import MavlinkMessage

SILENT: Final = 8.0
"""Seconds without an answer after which a reading is given up."""

RETRY: Final = 5.0
"""Seconds before it is tried again."""

PER_ITEM: Final = 0.2
"""Seconds by which each item delays the next reading: a long mission takes long to read."""

ANSWERS: Final = frozenset({"MISSION_COUNT", "MISSION_ITEM_INT", "MISSION_ACK"})

ALL_KINDS: Final = 255
"""MAV_MISSION_TYPE_ALL."""

_WRITES: Final = frozenset(
    {
        "MISSION_CLEAR_ALL",
        "MISSION_COUNT",
        "MISSION_ITEM",
        "MISSION_ITEM_INT",
        "MISSION_WRITE_PARTIAL_LIST",
    }
)
"""The messages of a station that writes."""

_ASKS: Final = frozenset({"MISSION_ACK", "MISSION_REQUEST", "MISSION_REQUEST_INT"})
"""The messages of a vehicle to a writer."""

_POINTS: Final = {"FENCE_POINT": MissionType.FENCE, "RALLY_POINT": MissionType.RALLY}
"""The messages of older protocols."""

NEVER: Final = float("-inf")
"""Earlier than any time."""


@dataclass(frozen=True, slots=True)
class Survey:
    """The reading of the items on board.

    Attributes:
        reading: The current download.
        progress: Time of its last answer.
        read: Time of the last reading of each kind.
        found: The items of the last reading of each kind; they may have changed since.
        given_up: Time of the last abandoned reading of each kind.
    """

    reading: reading.Download | None = None
    progress: float = 0.0
    read: Mapping[MissionType, float] = field(default_factory=dict)
    found: Mapping[MissionType, Items] = field(default_factory=dict)
    given_up: Mapping[MissionType, float] = field(default_factory=dict)

    @property
    def settled(self) -> bool:
        """Whether each kind was read, or could not be read."""
        return all(kind in self.found or kind in self.given_up for kind in MissionType)


Step = tuple[Survey, tuple[MavlinkMessage, ...]]


def tick(
    survey: Survey,
    every: Mapping[MissionType, float],
    certain: Collection[MissionType],
    system: int,
    now: float,
) -> Step:
    """Continue a reading, or begin the next: uncertain kinds first, then each kind after its period in `every`."""
    if survey.reading is not None and now - survey.progress > SILENT:
        survey = replace(survey, reading=None, given_up={**survey.given_up, survey.reading.kind: now})
    if survey.reading is None:
        kind = _next(survey, every, certain, now)
        if kind is None:
            return survey, ()
        survey = replace(survey, reading=reading.Download(kind, system), progress=now)
    assert survey.reading is not None
    going, sent = reading.tick(survey.reading, now)
    return replace(survey, reading=going), sent


def hear(
    survey: Survey, message: MavlinkMessage, now: float
) -> tuple[Survey, tuple[MavlinkMessage, ...], MissionType | None]:
    """Take an answer of the vehicle; return the kind whose reading it completes, if any."""
    before = survey.reading
    if before is None:
        return survey, (), None
    going, sent = reading.hear(before, message, now)
    if going == before:
        return survey, sent, None
    if not going.over:
        return replace(survey, reading=going, progress=now), sent, None
    return settle(replace(survey, reading=None), going.kind, going.items, now), sent, going.kind


def settle(survey: Survey, kind: MissionType, items: Items, now: float) -> Survey:
    """Record the items found on board."""
    found = {**survey.found, kind: items}
    given_up = {each: at for each, at in survey.given_up.items() if each != kind}
    return replace(survey, read={**survey.read, kind: now}, found=found, given_up=given_up)


def doubt(survey: Survey, kinds: Collection[MissionType]) -> Survey:
    """Abandon a reading that may be out of date, and read these kinds as soon as possible."""
    given_up = {kind: at for kind, at in survey.given_up.items() if kind not in kinds}
    given_up |= {kind: NEVER for kind in survey.given_up if kind in kinds}
    if survey.reading is not None and survey.reading.kind in kinds:
        survey = replace(survey, reading=None)
    return replace(survey, given_up=given_up, read={**survey.read, **dict.fromkeys(kinds, NEVER)})


def soon(survey: Survey, kind: MissionType) -> Survey:
    """Read a kind as soon as possible; the last reading counts until then."""
    return replace(survey, read={**survey.read, kind: NEVER})


def changed_by(message: MavlinkMessage, vehicle: int) -> tuple[MissionType, ...]:
    """Return the kinds of items that a message between this vehicle and another station may change."""
    if message.name in _POINTS:
        return (_POINTS[message.name],)
    if message.name not in (_ASKS if message.system == vehicle else _WRITES):
        return ()
    said = message.fields.get("mission_type", 0)
    return tuple(MissionType) if said == ALL_KINDS else tuple(kind for kind in MissionType if kind == said)


def _next(
    survey: Survey, every: Mapping[MissionType, float], certain: Collection[MissionType], now: float
) -> MissionType | None:
    """Return the kind to read next."""
    due = [
        (kind in certain, max(survey.read.get(kind, NEVER), survey.given_up.get(kind, NEVER)), kind)
        for kind, seconds in every.items()
        if now - survey.given_up.get(kind, NEVER) > RETRY
        and (kind not in certain or now - survey.read.get(kind, NEVER) >= _period(survey, kind, seconds))
    ]
    return min(due)[2] if due else None


def _period(survey: Survey, kind: MissionType, seconds: float) -> float:
    return seconds + PER_ITEM * len(survey.found.get(kind, ()))
