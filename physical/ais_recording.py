"""AIS recordings: files of NMEA lines, read lazily and within bounds, with an account of their content."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from io import BytesIO
from os import PathLike
from typing import IO, Final

from physical.ais_receiver import PART, POSITION, STATIC, TAKEN, ReceivedLine, ReceiverState, hear
from physical.ais_reports import AisError, PositionReport, Report, StaticReport
from physical.file_account import Counting, FileAccount
from physical.nmea import MAX_LINE, DecodingFailure
from physical.regular_files import open_file

CHUNK: Final = 65_536
NOTHING: Final = FileAccount()
_END: Final = re.compile(rb"[\r\n]+")

MAX_RECORDING = 256 * 2**20
"""The default limit of a recording in bytes; an hour of a busy coast is about 40 MB."""


@dataclass(frozen=True, slots=True)
class AISRecording:
    """The reports of a recording, in order of arrival, and the account of its sentences and other lines."""

    reports: tuple[Report, ...]
    tally: FileAccount = NOTHING

    @property
    def positions(self) -> tuple[PositionReport, ...]:
        """The positions, in order of arrival."""
        return tuple(report for report in self.reports if isinstance(report, PositionReport))

    @property
    def statics(self) -> tuple[StaticReport, ...]:
        """The static data, in order of arrival."""
        return tuple(report for report in self.reports if isinstance(report, StaticReport))


def read_recording(
    source: str | PathLike[str] | bytes | Iterable[bytes], limit: int = MAX_RECORDING
) -> AISRecording:
    """Return the recording at a path, in bytes, or in an iterable of lines.

    Bad lines are counted, never fatal. Memory grows with the reports, about 300 bytes each.

    Raises:
        AisError: If the file is unreadable or longer than `limit` bytes, or if pyais is missing.
    """
    if isinstance(source, bytes):
        return record(_lines(BytesIO(source), limit))
    if not isinstance(source, str | PathLike):
        return record(_bounded(source, limit))
    try:
        with open_file(source) as file:
            return record(_lines(file, limit))
    except OSError as error:
        message, hint = f"cannot read it: {error.strerror or error}", "give the path of a file of NMEA lines"
        raise AisError("ais-unreadable", message, hint, str(source)) from error


def record(lines: Iterable[bytes]) -> AISRecording:
    """Return the recording of these lines, by a fold of `hear`."""
    ear, reports, counting, total = ReceiverState(), list[Report](), Counting(), 0
    for line in lines:
        heard = hear(ear, line)
        ear = heard.ear
        reports.extend(heard.reports)
        total += len(heard.pieces)
        count(counting, heard)
    _give_up(counting, sum(each.sentences for each in ear.fragments.waiting))
    return AISRecording(tuple(reports), counting.tally(total, *PIECES))


PIECES: Final = ("sentence or other line", "sentences and other lines")
"""Singular and plural of the counted pieces: a line may hold no sentence, one, or several."""

INCOMPLETE: Final = "part of an incomplete message"


def count(counting: Counting, heard: ReceivedLine) -> None:
    """Count the pieces of a line."""
    for piece in heard.pieces:
        (counting.take if piece in TAKEN else counting.leave)(piece)
    if DecodingFailure.TAG_BLOCK in heard.reasons:
        counting.note(DecodingFailure.TAG_BLOCK.value, heard.reasons.count(DecodingFailure.TAG_BLOCK))
    _give_up(counting, heard.given_up)


def _give_up(counting: Counting, parts: int) -> None:
    """Move accepted parts to the count of incomplete messages."""
    if parts:
        counting.take(PART, -parts)
        counting.leave(INCOMPLETE, parts)


def has_sentences(tally: FileAccount) -> bool:
    """Whether a recording contains a sentence of AIS."""
    return any(kind in (POSITION, STATIC, PART) for kind, _ in tally.taken) or any(
        kind == INCOMPLETE or kind.startswith("message") or kind in _IN_SENTENCES
        for kind, _ in tally.left_out
    )


def without_sentences(tally: FileAccount) -> str | None:
    """Return a message about lines of which none has a sentence of AIS, with what they are; None if one has."""
    if not tally.total or has_sentences(tally):
        return None
    kinds = sorted(tally.left_out, key=lambda each: -each[1])[:3]
    found = ", ".join(f"{count:,} x {kind}" for kind, count in kinds)
    return f"none of its {tally.total:,} lines is an AIS sentence, or has one in it (!AIVDM,...): {found}"


_IN_SENTENCES: Final = frozenset(
    {
        DecodingFailure.NOT_AVAILABLE,
        DecodingFailure.UNKNOWN,
        DecodingFailure.TRUNCATED,
        DecodingFailure.UNDECODABLE,
        DecodingFailure.EMPTY,
        DecodingFailure.ARMOUR,
    }
)


def _lines(file: IO[bytes], limit: int) -> Iterator[bytes]:
    r"""Yield lines of bounded length, ended by \n or \r; the rest of an overlong line is skipped."""
    rest, skipping = b"", False
    for chunk in _bounded(iter(lambda: file.read(CHUNK), b""), limit):
        *lines, rest = _END.split(rest + chunk)
        for line in lines:
            if not skipping:
                yield line
            skipping = False
        if skipping:
            rest = b""
        elif len(rest) > MAX_LINE:
            yield rest[: MAX_LINE + 1]
            rest, skipping = b"", True
    if rest:
        yield rest


def _bounded(chunks: Iterable[bytes], limit: int) -> Iterator[bytes]:
    size = 0
    for chunk in chunks:
        size += len(chunk)
        if size > limit:
            hint = "cut it to the time that matters, or raise the limit"
            raise AisError("ais-too-large", f"the recording is longer than {limit} bytes", hint)
        yield chunk
