"""Upload a mission or fence: the ground's side of the protocol, a pure state machine.

The vehicle requests item after item, repeats a request after a second, and gives up after eight. So only the count is
sent by timer. ArduPlane sends MISSION_REQUEST, others MISSION_REQUEST_INT: both get MISSION_ITEM_INT. An ACK proves
nothing: `adapters.mavlink.verified_upload` reads the items back.

A vehicle takes one upload at a time, from one system id. It answers others with DENIED (ArduPilot) or ERROR (PX4) until
that upload is over. So these answers are final only after a vehicle's timeout. A vehicle that has just booted answers
NO_SPACE; once it is ready, the second such answer is final.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from adapters.mavlink.constants import MissionResult, MissionType
from adapters.mavlink.items import Items, item_message
from adapters.mavlink.message import MavlinkMessage, say

COUNT_AGAIN: Final = 2.0
"""Seconds without a request before the count is sent again."""

GIVEN_UP: Final = 9.0
"""Seconds of silence during an upload after which the vehicle, too, has given it up."""

BUSY: Final = 25.0
"""Seconds for which another's upload may cause a refusal: three times a vehicle's timeout, by its own clock."""

ACK_LOST: Final = 3.0
"""Seconds of silence after the last item that mean a lost ACK."""

_BUSY: Final = {MissionResult.DENIED, MissionResult.ERROR}
_OUT_OF_STEP: Final = {MissionResult.INVALID_SEQUENCE, MissionResult.CANCELLED}
_NOT_FINAL: Final = {*_OUT_OF_STEP, MissionResult.NO_SPACE}
NO_SPACE_TWICE: Final = 2


@dataclass(frozen=True, slots=True)
class Upload:
    """An upload in progress.

    Attributes:
        items: The items to upload.
        kind: Mission or fence.
        system: The vehicle's system id.
        counted: Time of the last count sent.
        asked: Time of the last request for an item; None before the first.
        wanted: The items requested so far.
        denied: Start of the vehicle's busy answers without a request.
        over: Whether it has ended, with or without success.
        refusal: The vehicle's final refusal, if any.
        answer: Its last answer that is neither an acceptance nor about lost items.
        ready: Whether it has been up for long enough to know its space.
        full: The number of its NO_SPACE answers.
    """

    items: Items
    kind: MissionType
    system: int
    counted: float | None = None
    asked: float | None = None
    wanted: frozenset[int] = frozenset()
    denied: float | None = None
    over: bool = False
    refusal: int | None = None
    answer: int | None = None
    ready: bool = False
    full: int = 0


Step = tuple[Upload, tuple[MavlinkMessage, ...]]


def tick(upload: Upload, now: float) -> Step:
    """Advance to `now`: send the count, again if it seems lost, or detect a lost ACK."""
    if upload.over:
        return upload, ()
    if upload.counted is None:
        return _count(upload, now)
    if upload.asked is None:
        return _count(upload, now) if now - upload.counted >= COUNT_AGAIN else (upload, ())
    if len(upload.wanted) == len(upload.items) and now - upload.asked >= ACK_LOST:
        return replace(upload, over=True), ()
    return _count(upload, now) if now - upload.asked >= GIVEN_UP else (upload, ())


def hear(upload: Upload, message: MavlinkMessage, now: float) -> Step:
    """Take a message from the vehicle to us."""
    if upload.over or message.fields.get("mission_type") != upload.kind:
        return upload, ()
    if message.name in ("MISSION_REQUEST", "MISSION_REQUEST_INT"):
        return _give(upload, message["seq"], now)
    if message.name == "MISSION_ACK" and upload.counted is not None:
        return _answered(upload, message["type"], now), ()
    return upload, ()


def _count(upload: Upload, now: float) -> Step:
    count = say(
        "MISSION_COUNT",
        target_system=upload.system,
        target_component=1,
        count=len(upload.items),
        mission_type=int(upload.kind),
    )
    return replace(upload, counted=now, asked=None, wanted=frozenset()), (count,)


def _give(upload: Upload, index: int, now: float) -> Step:
    if not 0 <= index < len(upload.items):
        return upload, ()
    item = item_message(upload.items[index], index, upload.kind, upload.system)
    return replace(upload, asked=now, wanted=upload.wanted | {index}, denied=None), (item,)


def _answered(upload: Upload, result: int, now: float) -> Upload:
    complete = len(upload.wanted) == len(upload.items)
    if result == MissionResult.ACCEPTED:
        return replace(upload, over=complete)
    told = upload.answer if result in _OUT_OF_STEP else result
    upload = replace(upload, answer=told, full=upload.full + (result == MissionResult.NO_SPACE))
    too_much = upload.ready and upload.full >= NO_SPACE_TWICE
    if (
        result in _NOT_FINAL and not too_much
    ):  # booting, or out of step with lost items: the count comes again
        return upload if result == MissionResult.INVALID_SEQUENCE else replace(upload, asked=None)
    since = now if upload.denied is None else upload.denied
    if result in _BUSY and complete and upload.items:
        return replace(upload, over=True)  # the read-back decides
    if result in _BUSY and now - since <= BUSY:
        return replace(upload, asked=None, denied=since)
    return replace(upload, over=True, refusal=result)
