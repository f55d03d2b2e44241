"""A line-by-line AIS decoder: a pure state machine from NMEA lines to reports.

`hear(ear, line)` depends only on its arguments; recordings fold it over a file, live feeds over a socket. The state
holds the recording's clock, the parts of incomplete messages, and the times of groups of lines. It is bounded for any
input.
"""

from dataclasses import dataclass, replace
from typing import Final

from physical.ais_decode import decode, type_of
from physical.ais_fragments import EMPTY, Fragments, join
from physical.ais_reports import PositionReport, Report
from physical.nmea import (
    MAX_LINE,
    DecodingFailure,
    Fragment,
    TagBlock,
    address,
    clock_of,
    is_clock,
    parse_sentence,
    part_of,
)
from physical.nmea_lines import Framed, framed_in

GROUP_TABLE = 64
"""The largest number of groups of lines in the state."""

POSITION: Final = "position"
STATIC: Final = "message with a name or a type of ship"
PART: Final = "part of a message"
TIME: Final = "time"
COMMENT: Final = "comment"
TAKEN: Final = frozenset({POSITION, STATIC, PART, TIME, COMMENT})
"""The kinds of pieces that contribute to the result."""


@dataclass(frozen=True, slots=True)
class FragmentGroup:
    """The first line of a group of lines, and the number of its last line so far."""

    first: TagBlock
    last: int


@dataclass(frozen=True, slots=True)
class ReceiverState:
    """The state after the lines so far; the oldest group comes first."""

    clock: float | None = None
    fragments: Fragments = EMPTY
    groups: tuple[FragmentGroup, ...] = ()


@dataclass(frozen=True, slots=True)
class ReceivedLine:
    """The result of one line: the new state, reports and mistakes.

    Attributes:
        ear: The new state.
        reports: The reports.
        reasons: One reason for each mistake.
        pieces: The kind of each sentence, or of the line if it has none: one of `TAKEN`, or the reason for its
            rejection.
        given_up: The number of parts, this line's or earlier ones, that no longer belong to a message.
    """

    ear: ReceiverState
    reports: tuple[Report, ...] = ()
    reasons: tuple[DecodingFailure, ...] = ()
    pieces: tuple[str, ...] = ()
    given_up: int = 0


def hear(ear: ReceiverState, line: bytes, now: float | None = None) -> ReceivedLine:
    r"""Decode one line, received at `now` (seconds since 1970; None for a recording).

    The time of a message comes from its tag blocks, else from its logger's text, else it is `now`, else it comes from
    the latest `$PGHP`, `$..RMC` or `$..ZDA` line. Blank lines, comments (`#`) and other sentences have no reports.

    >>> heard = hear(ReceiverState(), rb"!AIVDM,1,1,,B,35VwAv0300QcEQ`EGcpN40jD0PUQ,0*61")
    >>> heard.reports[0].mmsi, heard.reports[0].lat
    (376427000, 37.346935)

    Raises:
        AisError: If pyais is missing.
    """
    if len(line) > MAX_LINE:
        return _failed(ear, DecodingFailure.OVERLONG)
    text = line.strip()
    if not text:
        return ReceivedLine(ear)
    if text.startswith(b"#"):
        return ReceivedLine(ear, pieces=(COMMENT,))
    frames = framed_in(text)
    if not frames:
        return _failed(ear, DecodingFailure.NO_SENTENCE)
    heard = ReceivedLine(ear)
    for framed in frames:
        heard = _after(heard, _framed(heard.ear, framed, now))
    return heard


def _after(before: ReceivedLine, here: ReceivedLine) -> ReceivedLine:
    """Return the combined result of two pieces of a line."""
    if not before.pieces:
        return here
    return ReceivedLine(
        here.ear,
        before.reports + here.reports,
        before.reasons + here.reasons,
        before.pieces + here.pieces,
        before.given_up + here.given_up,
    )


def _failed(ear: ReceiverState, reason: DecodingFailure) -> ReceivedLine:
    return ReceivedLine(ear, reasons=(reason,), pieces=(reason.value,))


def _framed(ear: ReceiverState, framed: Framed, now: float | None) -> ReceivedLine:
    tag = framed.tag
    if tag is not None:
        ear, tag = _grouped(ear, tag)
    heard = _sentence(ear, framed, now, tag)
    return replace(heard, reasons=framed.reasons + heard.reasons) if framed.reasons else heard


def _grouped(ear: ReceiverState, tag: TagBlock) -> tuple[ReceiverState, TagBlock]:
    """Complete a tag block with the first line of its group, or store it as the first line.

    A number out of sequence starts a new group, since group numbers recur.
    """
    if tag.group is None:
        return ear, tag
    known = next((entry for entry in reversed(ear.groups) if _follows(tag, entry)), None)
    others = tuple(
        entry
        for entry in ear.groups
        if entry is not known and (entry.first.group != tag.group or not _of_one_source(tag, entry.first))
    )
    if known is not None:
        first = known.first
        time = first.time if tag.time is None else tag.time
        tag = replace(tag, time=time, source=first.source or tag.source)
    first = tag if known is None else known.first
    if tag.number >= tag.total:  # the group is complete
        return replace(ear, groups=others), tag
    return replace(ear, groups=(*others, FragmentGroup(first, tag.number))[-GROUP_TABLE:]), tag


def _follows(tag: TagBlock, group: FragmentGroup) -> bool:
    """Whether a line continues a group: it comes after the group's last line, and has the same total."""
    first = group.first
    return (
        first.group == tag.group
        and _of_one_source(tag, first)
        and first.total == tag.total
        and group.last < tag.number
    )


def _of_one_source(one: TagBlock, other: TagBlock) -> bool:
    return one.source is None or other.source is None or one.source == other.source


def _sentence(ear: ReceiverState, framed: Framed, now: float | None, tag: TagBlock | None) -> ReceivedLine:
    kind = address(framed.sentence)
    if kind[2:] in ("VDM", "VDO"):
        return _ais(ear, framed, now, tag)
    if is_clock(kind):
        return _clock(ear, framed.sentence)
    return ReceivedLine(ear, pieces=(f"sentence {kind}" if kind else "tag block without a sentence",))


def _clock(ear: ReceiverState, text: bytes) -> ReceivedLine:
    sentence = parse_sentence(text)
    clock = sentence if isinstance(sentence, DecodingFailure) else clock_of(sentence)
    if isinstance(clock, DecodingFailure):
        return _failed(ear, clock)
    return ReceivedLine(ReceiverState(clock, ear.fragments, ear.groups), pieces=(TIME,))


def _ais(ear: ReceiverState, framed: Framed, now: float | None, tag: TagBlock | None) -> ReceivedLine:
    sentence = parse_sentence(framed.sentence)
    if isinstance(sentence, DecodingFailure):
        return _failed(ear, sentence)
    part = part_of(sentence)
    if isinstance(part, DecodingFailure):
        return _failed(ear, part)
    time = _first(tag.time if tag else None, framed.time, now, ear.clock)
    if part.total == 1:
        return _message(ear, (part,), time)
    joined = join(ear.fragments, part, time, None if tag is None else tag.group)
    ear = replace(ear, fragments=joined.fragments)
    lost, given_up = (
        (DecodingFailure.INCOMPLETE,) * len(joined.lost),
        sum(each.sentences for each in joined.lost),
    )
    if joined.complete is None:
        return ReceivedLine(ear, reasons=lost, pieces=(PART,), given_up=given_up)
    heard = _message(ear, joined.complete.parts, joined.complete.time)
    return replace(heard, reasons=lost + heard.reasons, given_up=given_up)


def _first(*times: float | None) -> float | None:
    return next((time for time in times if time is not None), None)


def _message(ear: ReceiverState, parts: tuple[Fragment, ...], time: float | None) -> ReceivedLine:
    reports, reason = decode(parts, time)
    if any(isinstance(report, PositionReport) for report in reports):
        piece = POSITION
    elif reason is not None:
        piece = reason.value
    else:
        piece = STATIC if reports else f"message of type {type_of(parts)}, without a position of its sender"
    return ReceivedLine(ear, reports, () if reason is None else (reason,), (piece,))
