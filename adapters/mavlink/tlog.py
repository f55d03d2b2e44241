"""Telemetry logs: for each frame 8 bytes of microseconds since 1970, most significant first, then the raw frame."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from os import PathLike
from typing import IO, Final

from adapters.mavlink.codec import Decoder, Garbage
from adapters.mavlink.fleet import Craft
from adapters.mavlink.message import Message
from adapters.mavlink.telemetry import Telemetry, absorb, property_of
from physical import PhysicalError, PhysicalProperty, open_file

_V1, _V2 = 0xFE, 0xFD
_SIGNED: Final = 1


def entry(time: float, frame: bytes) -> bytes:
    """Return one entry of a log, as a plugin's tap writes it."""
    return round(time * 1e6).to_bytes(8, "big") + frame


def read_tlog(path: str | PathLike[str]) -> Iterator[tuple[float, Message]]:
    """Yield the messages of a log with their times; skip anything else.

    Raises PhysicalError if the file can't be read or is not such a log.
    """
    try:
        with open_file(path) as file:
            yield from _messages(file)
    except OSError as problem:
        raise PhysicalError("tlog", f"cannot read it: {problem.strerror}", "", str(path)) from None


def positions_of(
    log: Iterable[tuple[float, Message]], crafts: Mapping[int, Craft]
) -> Iterator[tuple[float, PhysicalProperty]]:
    """Yield the physical properties that a log shows of the vehicles with the given system ids."""
    known: dict[int, Telemetry] = {}
    for time, message in log:
        craft = crafts.get(message.system)
        if craft is None:
            continue
        before = known.get(message.system, Telemetry())
        after = known[message.system] = absorb(before, message, time)
        if after.position is not None and after.position is not before.position:
            yield time, property_of(craft, after.position, craft.channels)


def _messages(file: IO[bytes]) -> Iterator[tuple[float, Message]]:
    decoder = Decoder()
    while len(stamp := file.read(8)) == 8:
        time = int.from_bytes(stamp, "big") / 1e6
        for found in decoder.feed(_frame(file)):
            if not isinstance(found, Garbage):
                yield time, found


def _frame(file: IO[bytes]) -> bytes:
    head = file.read(3)
    if len(head) < 3:
        return b""
    marker, length, flags = head
    if marker not in (_V1, _V2):
        raise PhysicalError(
            "tlog", f"no MAVLink frame at byte {file.tell() - 3}", "give a telemetry log (.tlog)"
        )
    rest = length + (5 if marker == _V1 else 9 + 13 * (flags & _SIGNED))
    return head + file.read(rest)
