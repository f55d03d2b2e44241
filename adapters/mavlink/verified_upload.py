"""Synchronise a mission or fence: upload, read back, compare; repeat until both are equal."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from adapters.mavlink import download as reading
from adapters.mavlink import upload as writing
from adapters.mavlink.constants import MissionResult, MissionType
from adapters.mavlink.item_merging import is_on_board
from adapters.mavlink.items import Items
from adapters.mavlink.message import MavlinkMessage

ROUNDS: Final = 5
"""Read-backs that may differ before the vehicle counts as refusing."""


@dataclass(frozen=True, slots=True)
class Sync:
    """A mission or fence that is being uploaded by one `speaker`.

    `rounds` counts the read-backs that differed. `answer` is the vehicle's last answer that is no acceptance.
    """

    items: Items
    kind: MissionType
    system: int
    speaker: int
    doing: writing.Upload | reading.Download
    rounds: int = 0
    confirmed: bool = False
    ready: bool = False
    answer: int | None = None

    @property
    def refusal(self) -> str | None:
        """The final refusal, if any."""
        if isinstance(self.doing, writing.Upload) and self.doing.refusal is not None:
            return f"the vehicle refuses the {self.kind.name.lower()}: {_named(self.doing.refusal)}"
        if self.rounds >= ROUNDS:
            no = f", and the vehicle answers {self.objection}" if self.objection else ""
            return f"the {self.kind.name.lower()} on board still differs after {ROUNDS} uploads{no}"
        return None

    @property
    def objection(self) -> str:
        """The vehicle's last answer to the upload, if it was no acceptance."""
        return "" if self.answer is None else _named(self.answer)

    @property
    def reached(self) -> tuple[int, int, int]:
        """The progress: rounds, whether the items are read back, number of items."""
        reads = isinstance(self.doing, reading.Download)
        items = self.doing.items if isinstance(self.doing, reading.Download) else self.doing.wanted
        return self.rounds, int(reads), len(items)


Step = tuple[Sync, tuple[MavlinkMessage, ...]]


def begin(items: Items, kind: MissionType, system: int, speaker: int, *, ready: bool = False) -> Sync:
    """Begin with an upload; one station's system id sends all messages and receives all answers.

    A vehicle that is `ready` has all the space that it will ever have.
    """
    return Sync(items, kind, system, speaker, writing.Upload(items, kind, system, ready=ready), ready=ready)


def tick(sync: Sync, now: float) -> Step:
    """Advance to the time `now`."""
    if isinstance(sync.doing, writing.Upload):
        upload, sent = writing.tick(sync.doing, now)
        return _onwards(replace(sync, doing=upload), sent, now)
    download, sent = reading.tick(sync.doing, now)
    return _onwards(replace(sync, doing=download), sent, now)


def hear(sync: Sync, message: MavlinkMessage, now: float) -> Step:
    """Take a message of the vehicle, if the speaker is its target."""
    if message.target not in (0, sync.speaker):
        return sync, ()
    if isinstance(sync.doing, writing.Upload):
        upload, sent = writing.hear(sync.doing, message, now)
        return _onwards(replace(sync, doing=upload), sent, now)
    download, sent = reading.hear(sync.doing, message, now)
    return _onwards(replace(sync, doing=download), sent, now)


def _onwards(sync: Sync, sent: tuple[MavlinkMessage, ...], now: float) -> Step:
    """Continue from the upload to the download, and from a difference to the next upload."""
    sent = tuple(replace(message, system=sync.speaker) for message in sent)
    if isinstance(sync.doing, writing.Upload) and sync.doing.answer is not None:
        sync = replace(sync, answer=sync.doing.answer)
    if sync.confirmed or not sync.doing.over or sync.refusal:
        return sync, sent
    if isinstance(sync.doing, writing.Upload):
        download, asked = reading.tick(reading.Download(sync.kind, sync.system), now)
        said = tuple(replace(message, system=sync.speaker) for message in asked)
        return replace(sync, doing=download), (*sent, *said)
    if is_on_board(sync.items, sync.doing.items, sync.kind):
        return replace(sync, confirmed=True), sent
    again = begin(sync.items, sync.kind, sync.system, sync.speaker, ready=sync.ready)
    return replace(again, rounds=sync.rounds + 1, answer=sync.answer), sent


def _named(result: int) -> str:
    """Return the MAVLink name of a result."""
    known = result in tuple(MissionResult)
    return MissionResult(result).name if known else f"MAV_MISSION_RESULT {result}"
