"""The texts of a vehicle: STATUSTEXT, whose long texts MAVLink 2 sends in chunks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

CHUNK: Final = 50
"""Characters of a chunk that is not the last; the last one is shorter."""

PATIENCE: Final = 2.0
"""Seconds of waiting for the rest of a text."""

LOST: Final = "..."
"""The mark for lost chunks."""

LEAST_SEVERE: Final = 7
"""MAV_SEVERITY_DEBUG."""


@dataclass(frozen=True, slots=True)
class VehicleText:
    """A whole text, and its severity: from 0 (emergency) to 7 (debug)."""

    text: str
    severity: int


@dataclass(frozen=True, slots=True)
class Chunks:
    """The received part of a long text: its number, its chunks, the next index, and the time of the last chunk."""

    number: int
    severity: int
    parts: tuple[str, ...] = ()
    next: int = 0
    at: float = 0.0


Joined = tuple[Chunks | None, tuple[VehicleText, ...]]
"""The incomplete text, and the completed ones."""


def join(chunks: Chunks | None, said: Mapping[str, Any], now: float) -> Joined:
    """Take a STATUSTEXT; a text with lost chunks is returned with a mark in their place."""
    number, index = said.get("id", 0), said.get("chunk_seq", 0)
    text, severity = str(said["text"]), min(said["severity"], LEAST_SEVERE)
    if not number:
        return chunks, _whole((text,), severity)
    before: tuple[VehicleText, ...] = ()
    if chunks is not None and chunks.number != number:
        before, chunks = _whole((*chunks.parts, LOST), chunks.severity), None
    known = chunks or Chunks(number, severity)
    if index < known.next:  # a duplicate, or late
        return known, before
    parts = (*known.parts, *([LOST] if index > known.next else []), text)
    if len(text) < CHUNK:
        return None, (*before, *_whole(parts, known.severity))
    return replace(known, parts=parts, next=index + 1, at=now), before


def give_up(chunks: Chunks | None, now: float) -> Joined:
    """Return the received part of a text, once the wait for its rest has ended."""
    if chunks is None or now - chunks.at <= PATIENCE:
        return chunks, ()
    return None, _whole((*chunks.parts, LOST), chunks.severity)


def _whole(parts: tuple[str, ...], severity: int) -> tuple[VehicleText, ...]:
    text = "".join(filter(str.isprintable, "".join(parts))).strip()
    return (VehicleText(text, severity),) if text else ()
