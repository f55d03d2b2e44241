"""Decode AIS line by line: a pure state machine from NMEA lines to reports.

`hear(ear, line)` is a function of its arguments alone; recordings fold it over a file, live feeds over a
socket. The state holds what later lines need: the recording's clock, the parts of incomplete messages, and the
times of groups of lines. It is bounded for any input.
"""

from dataclasses import dataclass, replace

from physical.ais_decode import decode, type_of
from physical.ais_fragments import EMPTY, Fragments, join
from physical.ais_reports import Report
from physical.nmea import (
    MAX_LINE,
    Part,
    Reason,
    TagBlock,
    address,
    clock_of,
    parse_sentence,
    parse_tag_block,
    part_of,
    split_tag_block,
)

GROUP_TABLE = 64
"""How many groups of lines are remembered."""


@dataclass(frozen=True, slots=True)
class Ear:
    """What remains of the lines heard so far; the oldest group first."""

    clock: float | None = None
    fragments: Fragments = EMPTY
    groups: tuple[tuple[str, TagBlock], ...] = ()


@dataclass(frozen=True, slots=True)
class Heard:
    """What one line brought: the new state, reports, and what went wrong.

    `msg_type` is the type of the message that the line completed, `sentence` whether the line was a
    sound AIS sentence.
    """

    ear: Ear
    reports: tuple[Report, ...] = ()
    msg_type: int | None = None
    reasons: tuple[Reason, ...] = ()
    sentence: bool = False


def hear(ear: Ear, line: bytes, now: float | None = None) -> Heard:
    r"""Hear one line, received at `now` (seconds since 1970; None for a recording).

    A message's time is that of its tag block, else one appended to the sentence, else `now`, else what the
    latest `$PGHP` or `$..RMC` line said. Blank lines, comments (`#`) and other sentences
    bring nothing. Raises AisError where pyais is missing.

    >>> heard = hear(Ear(), rb"!AIVDM,1,1,,B,35VwAv0300QcEQ`EGcpN40jD0PUQ,0*61")
    >>> heard.reports[0].mmsi, heard.reports[0].lat
    (376427000, 37.346935)
    """
    if len(line) > MAX_LINE:
        return Heard(ear, reasons=(Reason.OVERLONG,))
    block, text = split_tag_block(line.strip())
    if block is None:
        return _sentence(ear, text, now, None)
    tag = parse_tag_block(block)
    if isinstance(tag, Reason):
        heard = _sentence(ear, text, now, None)
        return replace(heard, reasons=(tag, *heard.reasons))
    ear, tag = _grouped(ear, tag)
    return _sentence(ear, text, now, tag)


def _grouped(ear: Ear, tag: TagBlock) -> tuple[Ear, TagBlock]:
    """Complete a tag block by what the first line of its group said, or remember it as such."""
    if tag.group is None:
        return ear, tag
    for group, first in ear.groups:
        if group == tag.group and tag.source in (None, first.source):
            return ear, TagBlock(first.time if tag.time is None else tag.time, first.source, tag.group)
    others = tuple(entry for entry in ear.groups if entry[0] != tag.group)
    return replace(ear, groups=(*others, (tag.group, tag))[-GROUP_TABLE:]), tag


def _sentence(ear: Ear, text: bytes, now: float | None, tag: TagBlock | None) -> Heard:
    kind = address(text)
    if kind[2:] in ("VDM", "VDO"):
        return _ais(ear, text, now, tag)
    if kind == "PGHP" or kind[2:] == "RMC":
        return _clock(ear, text)
    if kind or not text or text.startswith(b"#"):
        return Heard(ear)
    return Heard(ear, reasons=(Reason.MALFORMED,))


def _clock(ear: Ear, text: bytes) -> Heard:
    sentence = parse_sentence(text)
    clock = sentence if isinstance(sentence, Reason) else clock_of(sentence)
    if isinstance(clock, Reason):
        return Heard(ear, reasons=(clock,))
    return Heard(Ear(clock, ear.fragments, ear.groups))


def _ais(ear: Ear, text: bytes, now: float | None, tag: TagBlock | None) -> Heard:
    sentence = parse_sentence(text)
    if isinstance(sentence, Reason):
        return Heard(ear, reasons=(sentence,))
    part = part_of(sentence)
    if isinstance(part, Reason):
        return Heard(ear, reasons=(part,))
    time = _first(tag.time if tag else None, sentence.time, now, ear.clock)
    if part.total == 1:
        return _message(ear, (part,), time)
    joined = join(ear.fragments, part, time, None if tag is None else tag.group)
    ear = replace(ear, fragments=joined.fragments)
    lost = (Reason.INCOMPLETE,) * joined.lost
    if joined.complete is None:
        return Heard(ear, reasons=lost, sentence=True)
    return _message(ear, joined.complete.parts, joined.complete.time, lost)


def _first(*times: float | None) -> float | None:
    return next((time for time in times if time is not None), None)


def _message(ear: Ear, parts: tuple[Part, ...], time: float | None, lost: tuple[Reason, ...] = ()) -> Heard:
    reports, reason = decode(parts, time)
    return Heard(ear, reports, type_of(parts), lost if reason is None else (*lost, reason), sentence=True)
