"""The messages between stations: the mission, the time, and entries of a log up to a number."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from adapters.stations.entries import Entry, count, entry_text, seconds
from physical import read_json

MOST_ENTRIES: Final = 500
MOST_TEXT: Final = 2**20
MOST_BYTES: Final = 2 * MOST_TEXT
"""The longest message that is read."""


@dataclass(frozen=True, slots=True)
class Message:
    """A message of a station.

    Attributes:
        mission: The digest of its mission.
        time: The time of its clock.
        after: The entries are all valid ones after this number,
        upto: up to this one.
        last: The last number that it has used.
        entries: As plain data.
    """

    mission: str
    time: float
    after: int
    upto: int
    last: int
    entries: Sequence[Any] = ()


def fitting(entries: Sequence[Entry], upto: int) -> tuple[list[str], int]:
    """Return the first entries that fit into one message, as texts, and the number up to which they are complete."""
    size = 0
    texts: list[str] = []
    for entry, before in zip(entries, (None, *entries), strict=False):
        text = entry_text(entry)
        size += len(text)
        if before is not None and (size > MOST_TEXT or len(texts) >= MOST_ENTRIES):
            return texts, before.number
        texts.append(text)
    return texts, upto


def written(head: Message, entries: Sequence[str]) -> bytes:
    """Return a message with entries as texts."""
    said = {
        "mission": head.mission,
        "time": head.time,
        "after": head.after,
        "upto": head.upto,
        "last": head.last,
    }
    return f'{json.dumps(said)[:-1]}, "entries": [{",".join(entries)}]}}'.encode()


def read(said: bytes) -> Message:
    """Read a message.

    Raises:
        ValueError: It is not a message.
    """
    match read_json(said, MOST_BYTES):
        case {
            "mission": str(mission),
            "time": time,
            "after": after,
            "upto": upto,
            "last": last,
            "entries": [*entries],
        } if len(entries) <= 2 * MOST_ENTRIES:
            return Message(mission, seconds(time), count(after), count(upto), count(last), entries)
    raise ValueError("this is no message of a station")
