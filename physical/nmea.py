"""NMEA 0183 sentences: checksums, tag blocks, fragments of AIS messages, and the times in some sentences.

This module reads only the text; `ais_decode` decodes the payloads. Every function is pure and total over bytes:
unreadable input yields a `DecodingFailure`, never an exception, because one bad line must not end a feed.
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
"""The longest line in bytes: a sentence has at most 82 and a tag block 80, but some loggers write no line ends."""

_ARMOUR = bytes(range(48, 88)) + bytes(range(96, 120))
_OLD_GROUP = re.compile(r"(\d+)G(\d+):(.+)")  # `1G2:1234`, as some write `g:1-2-1234`


class DecodingFailure(StrEnum):
    """The reason for a missing or incomplete result of a line or message."""

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
    """The block between two backslashes before a sentence.

    `time` is in seconds since 1970, `source` the station that received the sentence, `group` the common number of a
    group of lines. The sentence is number `number` of `total` in the group.
    """

    time: float | None = None
    source: str | None = None
    group: str | None = None
    number: int = 1
    total: int = 1


@dataclass(frozen=True, slots=True)
class Sentence:
    """A sentence with a correct checksum; `raw` runs from the start delimiter to the checksum."""

    raw: bytes
    address: str
    fields: tuple[bytes, ...]


@dataclass(frozen=True, slots=True)
class Fragment:
    """One fragment of an AIS message, `number` of `total`; `bits` is the number of bits in its payload."""

    raw: bytes
    talker: str
    sequence: bytes
    channel: bytes
    total: int
    number: int
    payload: bytes
    bits: int


def checksum(body: bytes) -> int:
    """Return the XOR of all bytes, as between the start delimiter and the asterisk of a sentence.

    >>> f"{checksum(b'AIVDM,1,1,,B,,0'):02X}"
    '25'
    """
    return reduce(xor, body, 0)


def parse_tag_block(block: bytes) -> TagBlock | DecodingFailure:
    r"""Return the time (`c:`), source (`s:`) and group (`g:`) of a tag block; other fields are ignored.

    >>> parse_tag_block(b"g:1-2-1234,s:r3669961,c:1120959341*0D")
    TagBlock(time=1120959341.0, source='r3669961', group='1234', number=1, total=2)
    """
    body, found, stated = block.rpartition(b"*")
    if not found or not block.isascii() or _hexadecimal(stated) != checksum(body):
        return DecodingFailure.TAG_BLOCK
    fields = [_field(field) for field in body.decode("ascii").split(",") if ":" in field]
    try:
        coded = dict(fields)
        time = epoch_seconds(coded["c"]) if "c" in coded else None
        return TagBlock(time, coded.get("s"), *_group(coded.get("g")))
    except ValueError:
        return DecodingFailure.TAG_BLOCK


def together(blocks: Iterable[TagBlock]) -> TagBlock | None:
    """Return the union of several tag blocks before one sentence; the first value of each field counts."""
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
    """Return the talker and kind of a sentence, without a check of its rest: `AIVDM`, `GPRMC`, `PGHP`.

    Empty for text that does not start like a sentence.
    """
    if sentence[:1] not in (b"!", b"$"):
        return ""
    head = sentence[1:8].split(b",", 1)[0]
    # some software writes `--` for an unknown talker
    return head.decode("ascii") if head.removeprefix(b"--").isalnum() else ""


def parse_sentence(text: bytes) -> Sentence | DecodingFailure:
    """Return the fields of a sentence, after a check of the checksum at its end."""
    star = text.find(b"*")
    if star < 0 or len(text) < star + 3:
        return DecodingFailure.NO_CHECKSUM
    if not text.isascii() or len(text) > star + 3:
        return DecodingFailure.MALFORMED
    if _hexadecimal(text[star + 1 : star + 3]) != checksum(text[1:star]):
        return DecodingFailure.CHECKSUM
    head, *fields = text[1:star].split(b",")
    return Sentence(text, head.decode("ascii"), tuple(fields))


def part_of(sentence: Sentence) -> Fragment | DecodingFailure:
    """Return the fragment in a `VDM` or `VDO` sentence."""
    if len(sentence.fields) != 6:
        return DecodingFailure.MALFORMED
    total, number, sequence, channel, payload, fill = sentence.fields
    counted = _digit(total), _digit(number), _digit(fill or b"0")
    if not 1 <= counted[1] <= counted[0] or not 0 <= counted[2] <= 5 or len(channel) > 1:
        return DecodingFailure.MALFORMED
    if not payload:
        return DecodingFailure.EMPTY
    if payload.translate(None, _ARMOUR):
        return DecodingFailure.ARMOUR
    bits = 6 * len(payload) - counted[2]
    return Fragment(
        sentence.raw, sentence.address[:2], sequence, channel, counted[0], counted[1], payload, bits
    )


def is_clock(address: str) -> bool:
    """Whether sentences with an address carry the date and time of the following ones."""
    return address == "PGHP" or address[2:] in ("RMC", "ZDA")


def clock_of(sentence: Sentence) -> float | DecodingFailure | None:
    """Return the time, in seconds since 1970, that a `$PGHP`, `$..RMC` or `$..ZDA` gives to the following sentences.

    None if the sentence declares its time invalid (a receiver without a fix).
    """
    reader = _pghp_time if sentence.address == "PGHP" else _CLOCKS[sentence.address[2:]]
    return _read_time(reader, sentence.fields)


def _read_time(
    reader: Callable[[tuple[bytes, ...]], float | None], fields: tuple[bytes, ...]
) -> float | DecodingFailure | None:
    try:
        time = reader(fields)
    except (ValueError, IndexError, OverflowError):
        return DecodingFailure.TIME
    return time if time is None or 0 <= time < LATEST else DecodingFailure.TIME


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
    """Read `$GPZDA,hhmmss.ss,dd,mm,yyyy,...` in UTC; the local zone follows."""
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
    """Return the code and the value of a tag block's field; the old form of a group becomes the new one."""
    if old := _OLD_GROUP.fullmatch(text):
        return "g", "-".join(old.groups())
    code, _, value = text.partition(":")
    return code, value


def _group(text: str | None) -> tuple[str | None, int, int]:
    """Return the group's common number, the sentence's number and the total of `number-total-group`."""
    if text is None:
        return None, 1, 1
    number, total, group = text.split("-")
    if not all(each.isascii() and each.isdigit() and len(each) <= 4 for each in (number, total)):
        raise ValueError("a tag block's group is written 1-2-1234")
    return group, int(number), int(total)


def _hexadecimal(text: bytes) -> int:
    """Return the value of a checksum's two digits; -1, which no checksum has, for other text."""
    try:
        return int(text, 16) if len(text) <= 2 and text.isalnum() else -1
    except ValueError:
        return -1


def _digit(text: bytes) -> int:
    """Return the value of one decimal digit; -1 for other text."""
    return text[0] - 48 if len(text) == 1 and text.isdigit() else -1
