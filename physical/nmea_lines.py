r"""The sentences of a line, and the text of loggers around them: tag blocks, times, other words.

A line may hold no sentence, one, or several. A sentence begins with `!` or `$` and an address, and ends with its
checksum.

>>> [framed.sentence for framed in framed_in(rb"1772596000.883 !AIVDM,1,1,,B,,0*25")]
[b'!AIVDM,1,1,,B,,0*25']
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from physical.nmea import DecodingFailure, TagBlock, parse_tag_block, together
from physical.written_times import time_beside

_BEGINNING: Final = rb"[!$](?=(?:--)?[A-Za-z0-9]{1,8}[,*])"
_FRAME: Final = re.compile(
    rb"(?P<tags>(?:\\[^\\!$\r\n]*\\[ \t]*){0,8})"
    rb"(?P<sentence>" + _BEGINNING + rb"[^*\\\r\n!$]*(?:(?!" + _BEGINNING + rb")[!$][^*\\\r\n!$]*)*"
    rb"(?:\*[^\\\s!$]{0,2})?)"
)
_BLOCK: Final = re.compile(rb"\\([^\\]*)\\")
_TORN: Final = re.compile(rb"\\(?:[a-z]|\d+G\d+):")
"""The beginning of a tag block without its end."""


@dataclass(frozen=True, slots=True)
class Framed:
    """One sentence of a line; empty for a line with only a tag block.

    Attributes:
        sentence: From its start delimiter to its checksum.
        tag: The union of the tag blocks before it, if there are any.
        time: The logger's time beside it, in seconds since 1970.
        reasons: The mistakes in its tag blocks.
    """

    sentence: bytes
    tag: TagBlock | None = None
    time: float | None = None
    reasons: tuple[DecodingFailure, ...] = ()


def framed_in(line: bytes) -> tuple[Framed, ...]:
    """Return the sentences of a line, in order.

    A logger writes its text before each sentence, or behind each: before, if there is a time before the first sentence.
    A sentence without a time takes that of its neighbour.
    """
    found = list(_FRAME.finditer(line))
    if not found:
        return _lone_blocks(line)
    if found[0].span() == (0, len(line)):  # most lines
        return (_framed(found[0], None, torn=False),)
    ends = [0, *(each.end() for each in found)]
    starts = [*(each.start() for each in found), len(line)]
    around = [line[end:start] for end, start in zip(ends, starts, strict=True)]
    times = _times(around)
    torn = [bool(_TORN.search(text)) for text in around]
    told = zip(found, times, torn, strict=False)
    return tuple(_framed(each, time, torn=is_torn) for each, time, is_torn in told)


def has_frame(text: bytes) -> bool:
    """Whether a text contains a sentence."""
    return _FRAME.search(text) is not None


def _lone_blocks(line: bytes) -> tuple[Framed, ...]:
    if not line.startswith(b"\\") or not _BLOCK.match(line):
        return ()
    tag, reasons = _tag(line)
    return (Framed(b"", tag, reasons=reasons),)


def _framed(found: re.Match[bytes], time: float | None, *, torn: bool) -> Framed:
    tag, reasons = _tag(found["tags"])
    return Framed(
        found["sentence"].rstrip(), tag, time, (*reasons, DecodingFailure.TAG_BLOCK) if torn else reasons
    )


def _times(around: list[bytes]) -> list[float | None]:
    """Return the time of each sentence, from the texts around them."""
    first = _time(around[0])
    if first is not None:
        return _carried([first, *map(_time, around[1:-1])])
    behind = [_last_time(text) for text in around[1:]]
    return _carried(behind[::-1])[::-1]


def _carried(times: list[float | None]) -> list[float | None]:
    """Return times in which each missing one is replaced by the previous one."""
    found, known = list[float | None](), None
    for time in times:
        known = known if time is None else time
        found.append(known)
    return found


def _time(text: bytes) -> float | None:
    return time_beside(_untorn(text)) if text else None


def _last_time(text: bytes) -> float | None:
    return time_beside(_untorn(text), last=True) if text else None


def _untorn(text: bytes) -> str:
    """Return a logger's text, without a torn tag block."""
    torn = _TORN.search(text)
    return (text[: torn.start()] if torn else text).decode("ascii", errors="replace")


def _tag(text: bytes) -> tuple[TagBlock | None, tuple[DecodingFailure, ...]]:
    parsed = [parse_tag_block(found[1]) for found in _BLOCK.finditer(text)]
    known = [block for block in parsed if isinstance(block, TagBlock)]
    return together(known), tuple(block for block in parsed if isinstance(block, DecodingFailure))
