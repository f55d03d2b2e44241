"""Read back the mission or fence on board: a pure state machine.

Every message is requested by timer until it comes; unrequested messages are ignored.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from adapters.mavlink.constants import MissionResult, MissionType
from adapters.mavlink.items import Items, item_of
from adapters.mavlink.message import MavlinkMessage, say

ASK_AGAIN: Final = 1.0
MAX_ITEMS: Final = 2_000
"""The most items that are read: no autopilot holds more."""


@dataclass(frozen=True, slots=True)
class Download:
    """A download in progress.

    Attributes:
        kind: Mission, fence or rally points.
        system: The vehicle's system id.
        count: The number of items on board; None until the vehicle has sent it.
        items: The received items.
        asked: Time of the last request.
    """

    kind: MissionType
    system: int
    count: int | None = None
    items: Items = ()
    asked: float | None = None

    @property
    def over(self) -> bool:
        """Whether all items are there."""
        return self.count is not None and len(self.items) == self.count


Step = tuple[Download, tuple[MavlinkMessage, ...]]


def tick(download: Download, now: float) -> Step:
    """Request the next missing message, again if the answer seems lost."""
    waiting = download.asked is not None and now - download.asked < ASK_AGAIN
    return (download, ()) if download.over or waiting else _ask(download, now)


def hear(download: Download, message: MavlinkMessage, now: float) -> Step:
    """Take a message of the vehicle that is meant for us."""
    said = message.fields
    if download.over or said.get("mission_type") != download.kind:
        return download, ()
    if message.name == "MISSION_COUNT" and download.count is None and said["count"] <= MAX_ITEMS:
        return _next(replace(download, count=said["count"]), now)
    if (
        message.name == "MISSION_ITEM_INT"
        and download.count is not None
        and said["seq"] == len(download.items)
    ):
        return _next(replace(download, items=(*download.items, item_of(said))), now)
    if message.name == "MISSION_ACK":
        return _refused(download, said["type"]), ()
    return download, ()


def _refused(download: Download, result: int) -> Download:
    """Begin anew if somebody writes meanwhile; a vehicle has no items of a kind that it does not support."""
    if result == MissionResult.UNSUPPORTED and download.count is None:
        return replace(download, count=0)
    return download if result == MissionResult.ACCEPTED else replace(download, count=None, items=())


def _next(download: Download, now: float) -> Step:
    return (download, (_thanks(download),)) if download.over else _ask(download, now)


def _ask(download: Download, now: float) -> Step:
    whom = {"target_system": download.system, "target_component": 1, "mission_type": int(download.kind)}
    if download.count is None:
        question = say("MISSION_REQUEST_LIST", **whom)
    else:
        question = say("MISSION_REQUEST_INT", seq=len(download.items), **whom)
    return replace(download, asked=now), (question,)


def _thanks(download: Download) -> MavlinkMessage:
    return say(
        "MISSION_ACK",
        target_system=download.system,
        target_component=1,
        type=int(MissionResult.ACCEPTED),
        mission_type=int(download.kind),
    )
