"""The messages between stations: the mission, the time, and entries of a log up to a number."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, Final

from msgspec import Meta, Raw, Struct

from adapters.stations.entries import Count, Entry, Seconds, entry_text
from adapters.typed_json import read_typed

MOST_ENTRIES: Final = 500
MOST_TEXT: Final = 2**20
MOST_BYTES: Final = 2 * MOST_TEXT
"""The longest message that is read."""


class StationMessage(Struct, frozen=True):
    """A message of a station.

    Attributes:
        mission: The digest of its mission.
        time: The time of its clock.
        after: The entries are all valid ones after this number,
        upto: up to this one.
        last: The last number that it has used.
        entries: As plain data, or encoded.
        logical: The digest of its L; empty before its first turn.
        begun: Whether its run has begun.
    """

    mission: str
    time: Seconds
    after: Count
    upto: Count
    last: Count
    entries: Annotated[Sequence[Any], Meta(max_length=2 * MOST_ENTRIES)]
    logical: Annotated[str, Meta(max_length=64)] = ""
    begun: bool = True


class Question(Struct, frozen=True):
    """A request for the entries after a number."""

    after: Count


def fitting(entries: Sequence[Entry], upto: int) -> tuple[list[Raw], int]:
    """Return the first entries that fit into one message, encoded, and the number up to which they are complete."""
    size = 0
    texts: list[Raw] = []
    for entry, before in zip(entries, (None, *entries), strict=False):
        text = entry_text(entry)
        size += len(text)
        if before is not None and (size > MOST_TEXT or len(texts) >= MOST_ENTRIES):
            return texts, before.number
        texts.append(Raw(text))
    return texts, upto


def read(said: bytes) -> StationMessage:
    """Read a message.

    Raises:
        ValueError: It is not a message.
    """
    return read_typed(said, MOST_BYTES, StationMessage)
