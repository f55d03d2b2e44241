"""Read NMEA 0183 sentences: checksums, tag blocks, fragments of AIS messages, and the times that some of them say.

Text only: what an AIS payload says is `ais_decode`'s business. Every function is pure and total over bytes:
what cannot be read comes back as a `Reason`, never as an exception, because one bad line must not end a feed.
"""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from enum import StrEnum
from functools import reduce
from operator import xor

from physical.written_times import LATEST, epoch_seconds

MAX_LINE = 8_192
"""The longest line read, in bytes: a sentence has at most 82 and a tag block 80, but some loggers end no lines."""

_ARMOUR = bytes(range(48, 88)) + bytes(range(96, 120))
_OLD_GROUP = re.compile(r"(\d+)G(\d+):(.+)")  # `1G2:1234`, as some write `g:1-2-1234`


class Reason(StrEnum):
    """Why a line, or a message, gave nothing (or not all that it could)."""

    OVERLONG = "line too long"
    MALFORMED = "malformed sentence"
    NO_SENTENCE = "line without a sentence"
    NO_CHECKSUM = "checksum missing"
    CHECKSUM = "checksum wrong"
    TAG_BLOCK = "tag block unreadable"
    TIME = "time unreadable"
    EMPTY = "empty payload"
    ARMOUR = "payload with characters that AIS does not use"
    INCOMPLETE = "multi-part message incomplete"
    UNKNOWN = "unknown message type"
    TRUNCATED = "message too short"
    UNDECODABLE = "message undecodable"
    NOT_AVAILABLE = "position not available"


@dataclass(frozen=True, slots=True)
class TagBlock:
    """What stands before a sentence between two backslashes.

    `time` is in seconds since 1970, `source` the station that received the sentence, `group` the number that
    lines belonging together share; the sentence is the one numbered `number` of `total` in it.
    """

    time: float | None = None
    source: str | None = None
    group: str | None = None
    number: int = 1
    total: int = 1


@dataclass(frozen=True, slots=True)
class Sentence:
    """One sentence whose checksum is right; `raw` runs from the start delimiter to the checksum."""

    raw: bytes
    address: str
    fields: tuple[bytes, ...]


@dataclass(frozen=True, slots=True)
class Part:
    """One fragment of an AIS message, `number` of `total`; `bits` is how many bits its payload carries."""

    raw: bytes
    talker: str
    sequence: bytes
    channel: bytes
    total: int
    number: int
    payload: bytes
    bits: int


def checksum(body: bytes) -> int:
    """XOR all bytes, as between the start delimiter and the asterisk of a sentence.

    >>> f"{checksum(b'AIVDM,1,1,,B,,0'):02X}"
    '25'
    """
    return reduce(xor, body, 0)


def parse_tag_block(block: bytes) -> TagBlock | Reason:
    r"""Read the time (`c:`), source (`s:`) and group (`g:`) of a tag block; other fields are passed over.

    >>> parse_tag_block(b"g:1-2-1234,s:r3669961,c:1120959341*0D")
    TagBlock(time=1120959341.0, source='r3669961', group='1234', number=1, total=2)
    """
    body, found, stated = block.rpartition(b"*")
    if not found or not block.isascii() or _hexadecimal(stated) != checksum(body):
        return Reason.TAG_BLOCK
    fields = [_field(field) for field in body.decode("ascii").split(",") if ":" in field]
    try:
        coded = dict(fields)
        time = epoch_seconds(coded["c"]) if "c" in coded else None
        return TagBlock(time, coded.get("s"), *_group(coded.get("g")))
    except ValueError:
        return Reason.TAG_BLOCK


def together(blocks: Iterable[TagBlock]) -> TagBlock | None:
    """Return what several tag blocks before one sentence say; of two that say the same thing the first counts."""
    known: TagBlock | None = None
    for block in blocks:
        if known is None:
            known = block
            continue
        grouped = known if known.group is not None else block
        time = block.time if known.time is None else known.time
        source = known.source or block.source
        known = TagBlock(time, source, grouped.group, grouped.number, grouped.total)
    return known


def address(sentence: bytes) -> str:
    """Name the talker and kind of a sentence without looking at the rest of it: `AIVDM`, `GPRMC`, `PGHP`.

    Empty for what does not start like a sentence.
    """
    if sentence[:1] not in (b"!", b"$"):
        return ""
    head = sentence[1:8].split(b",", 1)[0]
    # `--` is what some software writes where it does not know the talker
    return head.decode("ascii") if head.removeprefix(b"--").isalnum() else ""


def parse_sentence(text: bytes) -> Sentence | Reason:
    """Check the checksum of a sentence, which ends it, and split it into its fields."""
    star = text.find(b"*")
    if star < 0 or len(text) < star + 3:
        return Reason.NO_CHECKSUM
    if not text.isascii() or len(text) > star + 3:
        return Reason.MALFORMED
    if _hexadecimal(text[star + 1 : star + 3]) != checksum(text[1:star]):
        return Reason.CHECKSUM
    head, *fields = text[1:star].split(b",")
    return Sentence(text, head.decode("ascii"), tuple(fields))


def part_of(sentence: Sentence) -> Part | Reason:
    """Read the fragment that a `VDM` or `VDO` sentence carries."""
    if len(sentence.fields) != 6:
        return Reason.MALFORMED
    total, number, sequence, channel, payload, fill = sentence.fields
    counted = _digit(total), _digit(number), _digit(fill or b"0")
    if not 1 <= counted[1] <= counted[0] or not 0 <= counted[2] <= 5 or len(channel) > 1:
        return Reason.MALFORMED
    if not payload:
        return Reason.EMPTY
    if payload.translate(None, _ARMOUR):
        return Reason.ARMOUR
    bits = 6 * len(payload) - counted[2]
    return Part(sentence.raw, sentence.address[:2], sequence, channel, counted[0], counted[1], payload, bits)


def is_clock(address: str) -> bool:
    """Tell whether sentences with an address say the date and the time of what comes after them."""
    return address == "PGHP" or address[2:] in ("RMC", "ZDA")


def clock_of(sentence: Sentence) -> float | Reason | None:
    """Read the time, in seconds since 1970, that a `$PGHP`, `$..RMC` or `$..ZDA` gives to the sentences after it.

    None where the sentence says itself that it has no valid time (a receiver without a fix).
    """
    reader = _pghp_time if sentence.address == "PGHP" else _CLOCKS[sentence.address[2:]]
    return _read_time(reader, sentence.fields)


def _read_time(
    reader: Callable[[tuple[bytes, ...]], float | None], fields: tuple[bytes, ...]
) -> float | Reason | None:
    try:
        time = reader(fields)
    except (ValueError, IndexError, OverflowError):
        return Reason.TIME
    return time if time is None or 0 <= time < LATEST else Reason.TIME


def _pghp_time(fields: tuple[bytes, ...]) -> float:
    """Read Gatehouse's `$PGHP,1,year,month,day,hour,minute,second,millisecond,...`."""
    year, month, day, hour, minute, second, millisecond = (int(field) for field in fields[1:8])
    when = datetime(year, month, day, hour, minute, second, tzinfo=UTC) + timedelta(milliseconds=millisecond)
    return when.timestamp()


def _rmc_time(fields: tuple[bytes, ...]) -> float | None:
    """Read `$GPRMC,hhmmss.ss,status,...,ddmmyy,...`; the two-digit year is in 1980 … 2079."""
    if fields[1] != b"A":
        return None
    date = fields[8].decode("ascii")
    if len(date) != 6:
        raise ValueError("RMC needs ddmmyy")
    year = int(date[4:])
    midnight = datetime(year + (1900 if year >= 80 else 2000), int(date[2:4]), int(date[:2]), tzinfo=UTC)
    return _at(midnight, fields[0])


def _zda_time(fields: tuple[bytes, ...]) -> float | None:
    """Read `$GPZDA,hhmmss.ss,dd,mm,yyyy,...`, which is UTC; what follows is the local zone."""
    if not any(fields[:4]):
        return None
    day, month, year = (int(field) for field in fields[1:4])
    return _at(datetime(year, month, day, tzinfo=UTC), fields[0])


def _at(midnight: datetime, field: bytes) -> float:
    clock = field.decode("ascii")
    if len(clock) < 6:
        raise ValueError("a time of day needs hhmmss")
    hours, minutes, seconds = int(clock[:2]), int(clock[2:4]), float(clock[4:])
    if not (0 <= hours < 24 and 0 <= minutes < 60 and 0 <= seconds < 61):
        raise ValueError("this is no time of day")
    return (midnight + timedelta(hours=hours, minutes=minutes, seconds=seconds)).timestamp()


_CLOCKS = {"RMC": _rmc_time, "ZDA": _zda_time}


def _field(text: str) -> tuple[str, str]:
    """Return the code of a field of a tag block and its value; a group in the old form as in the new."""
    if old := _OLD_GROUP.fullmatch(text):
        return "g", "-".join(old.groups())
    code, _, value = text.partition(":")
    return code, value


def _group(text: str | None) -> tuple[str | None, int, int]:
    """Take the shared number of a group written `sentence-total-number`, the sentence's number and the total."""
    if text is None:
        return None, 1, 1
    number, total, group = text.split("-")
    if not all(each.isascii() and each.isdigit() and len(each) <= 4 for each in (number, total)):
        raise ValueError("a tag block's group is written 1-2-1234")
    return group, int(number), int(total)


def _hexadecimal(text: bytes) -> int:
    """Read the two digits of a checksum; -1, which no checksum is, where they are none."""
    try:
        return int(text, 16) if len(text) <= 2 and text.isalnum() else -1
    except ValueError:
        return -1


def _digit(text: bytes) -> int:
    """Read one decimal digit; -1 for anything else."""
    return text[0] - 48 if len(text) == 1 and text.isdigit() else -1
