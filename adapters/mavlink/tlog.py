"""Telemetry logs: for each frame 8 bytes of microseconds since 1970, most significant first, then the raw frame."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from typing import IO, Final

from adapters.mavlink.codec import Decoder
from adapters.mavlink.constants import AUTOPILOT_COMPONENT
from adapters.mavlink.message import MavlinkMessage
from adapters.mavlink.telemetry import Telemetry, absorb, property_of
from adapters.mavlink.vehicle_identities import Craft
from physical import PhysicalError, PhysicalProperty, open_file
from physical.file_account import Counting

_V1, _V2 = 0xFE, 0xFD
_SIGNED: Final = 1
_STAMP: Final = 8
_LONGEST: Final = _STAMP + 10 + 255 + 2 + 13
CHUNK: Final = 65_536

_BEGINNING: Final = re.compile(rb"(?=\x00[\x00-\x0f][\x00-\xff]{6}[\xfd\xfe])")
"""An entry: a time before 2112, then the first byte of a frame."""

APART: Final = 3 * 86_400.0
"""Seconds between the times of two entries, at most: a farther time is damaged, unless the next one agrees."""

THINGS: Final = ("message or damaged stretch", "messages and damaged stretches")
"""The name of one item of a log, and of several."""

POSITION: Final = "GLOBAL_POSITION_INT"
_OTHER_POSITIONS: Final = frozenset(
    {
        "GPS_RAW_INT",
        "GPS2_RAW",
        "GPS_INPUT",
        "AHRS2",
        "HIGH_LATENCY",
        "HIGH_LATENCY2",
        "SIMSTATE",
        "SIM_STATE",
    }
)
"""Messages that have a position too, but not the one that the autopilot flies by."""


@dataclass(frozen=True, slots=True)
class Damage:
    """Bytes of a log that are no entry."""

    size: int


@dataclass(frozen=True, slots=True)
class Unread:
    """An unreadable message in its frame, and the reason."""

    reason: str


def entry(time: float, frame: bytes) -> bytes:
    """Return one entry of a log, in the form that a plugin's tap writes."""
    return round(time * 1e6).to_bytes(8, "big") + frame


def read_tlog(
    path: str | PathLike[str], counting: Counting | None = None
) -> Iterator[tuple[float, MavlinkMessage]]:
    """Yield the messages of a log with their times; damaged parts are skipped and counted.

    Raises PhysicalError if the file can't be read or has no message.
    """
    counting = counting or Counting()
    try:
        with open_file(path) as file:
            yield from messages_in(file, counting)
    except OSError as problem:
        raise PhysicalError("tlog", f"cannot read it: {problem.strerror}", "", str(path)) from None


def positions_of(
    log: Iterable[tuple[float, MavlinkMessage]], crafts: Mapping[int, Craft], counting: Counting | None = None
) -> Iterator[tuple[float, PhysicalProperty]]:
    """Yield the physical properties in a log of the vehicles with the given system ids.

    Every message is counted: as a position, or under the reason why it shows none.
    """
    counting = counting or Counting()
    known: dict[int, Telemetry] = {}
    for time, message in log:
        craft = crafts.get(message.system)
        if craft is None:
            counting.leave(_foreign(message, "which is not named here"))
            continue
        before = known.get(message.system, Telemetry())
        after = known[message.system] = absorb(before, message, time)
        if after.position is not None and after.position is not before.position:
            counting.take("position")
            yield time, property_of(craft, after.position, craft.channels)
        else:
            counting.leave(_placeless(message, after, time))


def _foreign(message: MavlinkMessage, why: str) -> str:
    """Describe a message of another sender; the sender matters only for positions."""
    positioned = message.name == POSITION or message.name in _OTHER_POSITIONS
    return f"{message.name} of system {message.system}, {why}" if positioned else message.name


def _placeless(message: MavlinkMessage, after: Telemetry, time: float) -> str:
    """Return the reason why a message of a named vehicle shows no position."""
    if message.name in _OTHER_POSITIONS:
        return f"{message.name}: the positions that count are those of {POSITION}"
    if message.name != POSITION:
        return message.name
    if message.component != AUTOPILOT_COMPONENT:
        return (
            f"{POSITION} of component {message.component} of system {message.system}, which is no autopilot"
        )
    if not after.is_placed(time):
        return f"{POSITION} without a GPS fix"
    return f"{POSITION} that came late, or lies at latitude 0 and longitude 0"


# --- entries --------------------------------------------------------------------------------------


def messages_in(file: IO[bytes], counting: Counting) -> Iterator[tuple[float, MavlinkMessage]]:
    """Yield the messages of an open log, like `read_tlog`."""
    clock, found = _Clock(), False
    for stamp, each in entries(file):
        match each:
            case MavlinkMessage():
                found = True
                yield clock.time(stamp, counting), each
            case Unread(reason):
                counting.leave(reason)
            case Damage(size):
                counting.leave("damaged stretch")
                counting.note("byte in damaged stretches", size)
    if not found and counting.left_out:
        raise PhysicalError("tlog", "no MAVLink frame is in it", "give a telemetry log (.tlog)")


def entries(file: IO[bytes]) -> Iterator[tuple[float, MavlinkMessage | Unread | Damage]]:
    """Yield the contents of a log with their times in seconds: messages, unreadable frames, damaged stretches.

    Together they cover all bytes of the file.
    """
    log = _Bytes(file)
    while log.begins_something():
        found = _entry(log)
        if found is None:
            yield 0.0, Damage(_skip(log))
        else:
            size, each = found
            time = int.from_bytes(log.ahead(_STAMP), "big") / 1e6
            log.advance(size)
            yield time, each


class _Clock:
    """Follows the times of entries: a time far from all others is replaced by the one before."""

    def __init__(self) -> None:
        self._last: float | None = None
        self._suspect: float | None = None

    def time(self, stamp: float, counting: Counting) -> float:
        """Return the time of the next entry."""
        close = self._last is None or abs(stamp - self._last) <= APART
        if close or (self._suspect is not None and abs(stamp - self._suspect) <= APART):
            self._last, self._suspect = stamp, None
            return stamp
        self._suspect = stamp
        counting.note("message with a time far from all others: it has that of the one before")
        assert self._last is not None
        return self._last


class _Bytes:
    """A file as bytes with look-ahead, in bounded memory."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        self._held = b""
        self._at = 0
        self._ended = False

    def begins_something(self) -> bool:
        """Whether there is another byte."""
        return bool(self.ahead(1))

    def ahead(self, size: int, start: int = 0) -> bytes:
        """Return bytes from some way ahead; fewer at the end of the file."""
        while len(self._held) - self._at < start + size and not self._ended:
            chunk = self._file.read(CHUNK)
            self._ended = not chunk
            self._held, self._at = self._held[self._at :] + chunk, 0
        return self._held[self._at + start : self._at + start + size]

    def advance(self, size: int) -> None:
        """Advance by some bytes that were looked at."""
        self._at += size

    def next_beginning(self) -> int | None:
        """Return the distance to the next possible beginning of an entry in the held bytes; None if there is none."""
        found = _BEGINNING.search(self._held, self._at + 1)
        return None if found is None else found.start() - self._at

    @property
    def held(self) -> int:
        """The number of bytes held ahead."""
        return len(self._held) - self._at

    @property
    def ended(self) -> bool:
        """Whether all remaining bytes are held."""
        return self._ended


def _entry(log: _Bytes, *, sure: bool = False) -> tuple[int, MavlinkMessage | Unread] | None:
    """Return the entry that begins here and its size, or None.

    A frame that can't be checked counts if another entry, or the end, follows it, unless the entry must be `sure`.
    """
    head = log.ahead(_STAMP + 3)
    if len(head) < _STAMP + 3 or not _BEGINNING.match(head):
        return None
    marker, length, flags = head[_STAMP:]
    size = _STAMP + length + (8 if marker == _V1 else 12 + 13 * (flags & _SIGNED))
    whole = log.ahead(size)
    if len(whole) < size:
        return None
    decoded = Decoder().feed(whole[_STAMP:])
    if len(decoded) == 1 and isinstance(decoded[0], MavlinkMessage):
        return size, decoded[0]
    after = log.ahead(_STAMP + 1, size)
    if sure or not (after == b"" or _BEGINNING.match(after)):
        return None
    return size, Unread(
        "message with a wrong checksum" if decoded else "message that the dialect does not have"
    )


def _skip(log: _Bytes) -> int:
    """Advance to the next sure entry, or to the end; return the number of skipped bytes."""
    skipped = 0
    while True:
        log.ahead(2 * _LONGEST)
        step = log.next_beginning()
        if step is None:
            step = log.held if log.ended else max(1, log.held - _STAMP)
        skipped += step
        log.advance(step)
        if not log.begins_something() or _entry(log, sure=True) is not None:
            return skipped
