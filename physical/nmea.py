"""Read NMEA 0183 sentences: checksums, tag blocks, fragments of AIS messages, and the times beside them.

Text only: what an AIS payload says is `ais_decode`'s business. Every function is pure and total over bytes:
what cannot be read comes back as a `Reason`, never as an exception, because one bad line must not end a feed.
"""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from enum import StrEnum
from functools import reduce
from operator import xor

MAX_LINE = 1024
"""The longest line read, in bytes: a sentence has at most 82, a tag block 80; the rest is leniency."""

_ARMOUR = bytes(range(48, 88)) + bytes(range(96, 120))
_MILLISECONDS = 1e11  # a `c:` above this cannot be seconds (year 5138): it is milliseconds (year 1973)


class Reason(StrEnum):
    """Why a line, or a message, gave nothing (or not all that it could)."""

    OVERLONG = "line too long"
    MALFORMED = "malformed sentence"
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
    lines belonging together share.
    """

    time: float | None = None
    source: str | None = None
    group: str | None = None


@dataclass(frozen=True, slots=True)
class Sentence:
    """One sentence whose checksum is right; `raw` runs from the start delimiter to the checksum.

    `time` is the time of reception, in seconds since 1970, that some coast guards append.
    """

    raw: bytes
    address: str
    fields: tuple[bytes, ...]
    time: float | None = None


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


def split_tag_block(line: bytes) -> tuple[bytes | None, bytes]:
    r"""Separate a line into its tag block, if it has one, and its sentence.

    >>> split_tag_block(rb"\c:1671533231*5D\!AIVDM,1,1,,B,,0*25")
    (b'c:1671533231*5D', b'!AIVDM,1,1,,B,,0*25')
    """
    if not line.startswith(b"\\"):
        return None, line
    block, _, sentence = line[1:].partition(b"\\")
    return block, sentence.lstrip()


def parse_tag_block(block: bytes) -> TagBlock | Reason:
    r"""Read the time (`c:`), source (`s:`) and group (`g:`) of a tag block; other fields are passed over.

    >>> parse_tag_block(b"g:1-2-1234,s:r3669961,c:1120959341*0D")
    TagBlock(time=1120959341.0, source='r3669961', group='1234')
    """
    body, found, stated = block.rpartition(b"*")
    if not found or not block.isascii() or _hexadecimal(stated) != checksum(body):
        return Reason.TAG_BLOCK
    coded = dict(field.split(":", 1) for field in body.decode("ascii").split(",") if ":" in field)
    try:
        return TagBlock(_epoch(coded.get("c")), coded.get("s"), _group(coded.get("g")))
    except ValueError:
        return Reason.TAG_BLOCK


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
    """Check the checksum of a sentence and split it into its fields.

    Of what some coast guards append to it (`,r003669945,1306879500`) only a time at the end is kept.
    """
    star = text.find(b"*")
    if star < 0 or len(text) < star + 3:
        return Reason.NO_CHECKSUM
    if not text.isascii() or text[star + 3 : star + 4] not in (b"", b","):
        return Reason.MALFORMED
    if _hexadecimal(text[star + 1 : star + 3]) != checksum(text[1:star]):
        return Reason.CHECKSUM
    head, *fields = text[1:star].split(b",")
    return Sentence(text[: star + 3], head.decode("ascii"), tuple(fields), _appended(text[star + 3 :]))


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


def clock_of(sentence: Sentence) -> float | Reason | None:
    """Read the time, in seconds since 1970, that a `$PGHP` or `$..RMC` gives to the sentences after it.

    None where the sentence says itself that it has no valid time (a receiver without a fix).
    """
    reader = _pghp_time if sentence.address == "PGHP" else _rmc_time
    return _read_time(reader, sentence.fields)


def _read_time(
    reader: Callable[[tuple[bytes, ...]], float | None], fields: tuple[bytes, ...]
) -> float | Reason | None:
    try:
        return reader(fields)
    except (ValueError, IndexError, OverflowError):
        return Reason.TIME


def _pghp_time(fields: tuple[bytes, ...]) -> float:
    """Read Gatehouse's `$PGHP,1,year,month,day,hour,minute,second,millisecond,...`."""
    year, month, day, hour, minute, second, millisecond = (int(field) for field in fields[1:8])
    when = datetime(year, month, day, hour, minute, second, tzinfo=UTC) + timedelta(milliseconds=millisecond)
    return when.timestamp()


def _rmc_time(fields: tuple[bytes, ...]) -> float | None:
    """Read `$GPRMC,hhmmss.ss,status,...,ddmmyy,...`; the two-digit year is in 1980 … 2079."""
    if fields[1] != b"A":
        return None
    clock, date = fields[0].decode("ascii"), fields[8].decode("ascii")
    if len(date) != 6 or len(clock) < 6:
        raise ValueError("RMC needs hhmmss and ddmmyy")
    year = int(date[4:])
    midnight = datetime(year + (1900 if year >= 80 else 2000), int(date[2:4]), int(date[:2]), tzinfo=UTC)
    hours, minutes, seconds = int(clock[:2]), int(clock[2:4]), float(clock[4:])
    if not (0 <= hours < 24 and 0 <= minutes < 60 and 0 <= seconds < 61):
        raise ValueError("RMC needs a time of day")
    return (midnight + timedelta(hours=hours, minutes=minutes, seconds=seconds)).timestamp()


def _epoch(text: str | None) -> float | None:
    if text is None:
        return None
    if not text.isdigit() or len(text) > 16:
        raise ValueError("a tag block's time is a whole number of seconds or milliseconds")
    value = float(text)
    return value / 1000 if value > _MILLISECONDS else value


def _appended(tail: bytes) -> float | None:
    last = tail.rpartition(b",")[2]
    return float(last) if last.isdigit() and len(last) == 10 else None


def _group(text: str | None) -> str | None:
    """Take the shared number of a group written `sentence-total-number`."""
    if text is None:
        return None
    number, total, group = text.split("-")
    if not (number.isdigit() and total.isdigit()):
        raise ValueError("a tag block's group is written 1-2-1234")
    return group


def _hexadecimal(text: bytes) -> int:
    """Read the two digits of a checksum; -1, which no checksum is, where they are none."""
    try:
        return int(text, 16) if len(text) <= 2 and text.isalnum() else -1
    except ValueError:
        return -1


def _digit(text: bytes) -> int:
    """Read one decimal digit; -1 for anything else."""
    return text[0] - 48 if len(text) == 1 and text.isdigit() else -1
