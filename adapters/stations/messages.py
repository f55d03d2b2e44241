"""The messages between stations: the mission, the time, and entries of a log up to a number."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from adapters.stations.entries import Entry, entry_text
from physical import read_json

MOST_ENTRIES: Final = 500
MOST_TEXT: Final = 2**20
MOST_BYTES: Final = 2 * MOST_TEXT
"""The longest message that is read."""


@dataclass(frozen=True, slots=True)
class Message:
    """What a station says.

    Attributes:
        mission: The digest of what it flies.
        time: What its clock says.
        after: The entries are all that is still true after this number,
        upto: up to this one.
        last: The last number that it has given.
        entries: As plain data.
    """

    mission: str
    time: float
    after: int
    upto: int
    last: int
    entries: Sequence[Any] = ()


def fitting(entries: Sequence[Entry], upto: int) -> tuple[list[str], int]:
    """Return as many of the first entries as go into one message, as texts, and up to where they tell everything."""
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
    """Write a message with entries that are texts already."""
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
        ValueError: It is none.
    """
    match read_json(said, MOST_BYTES):
        case {
            "mission": str(mission),
            "time": int() | float() as time,
            "after": int(after),
            "upto": int(upto),
            "last": int(last),
            "entries": [*entries],
        } if len(entries) <= 2 * MOST_ENTRIES:
            return Message(mission, float(time), after, upto, last, entries)
    raise ValueError("this is no message of a station")
