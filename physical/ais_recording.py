"""Read AIS recordings: files of NMEA lines, lazily and within bounds, with a count of unusable lines."""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from io import BytesIO
from os import PathLike
from typing import IO

from physical.ais_receiver import Ear, hear
from physical.ais_reports import AisError, PositionReport, Report, StaticReport
from physical.files import open_file
from physical.nmea import MAX_LINE, Reason

MAX_RECORDING = 256 * 2**20
"""The most bytes read of a recording, unless told otherwise; an hour of a busy coast is about 40 MB."""


@dataclass(frozen=True, slots=True)
class Counts:
    """The account of a recording: what it had, and how often which reason kept something out.

    `messages` counts complete messages by type, `reasons` by reason; both are sorted.
    """

    lines: int
    sentences: int
    messages: tuple[tuple[int, int], ...]
    reasons: tuple[tuple[Reason, int], ...]

    def __str__(self) -> str:
        return "\n".join(self.rows())

    def rows(self) -> tuple[str, ...]:
        """Describe the account, a line each: the totals, then every reason."""
        decoded = sum(number for _, number in self.messages)
        total = f"{self.lines} lines, {self.sentences} AIS sentences, {decoded} messages"
        return (total, *(f"{number} x {reason}" for reason, number in self.reasons))


@dataclass(frozen=True, slots=True)
class Recording:
    """The reports of a recording, in order of arrival, and the account of its lines."""

    reports: tuple[Report, ...]
    counts: Counts

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
) -> Recording:
    """Read a recording from a path, from bytes, or from an iterable of lines.

    Bad lines are counted, never fatal. Memory grows with the reports: about 300 bytes each. Raises AisError
    where the file cannot be read, is longer than `limit` bytes, or pyais is missing.
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


def record(lines: Iterable[bytes]) -> Recording:
    """Fold `hear` over lines."""
    ear, reports = Ear(), list[Report]()
    messages, reasons = Counter[int](), Counter[Reason]()
    count = sentences = 0
    for line in lines:
        heard = hear(ear, line)
        ear = heard.ear
        reports.extend(heard.reports)
        count += 1
        sentences += heard.sentence
        if heard.msg_type is not None:
            messages[heard.msg_type] += 1
        if heard.reasons:
            reasons.update(heard.reasons)
    reasons[Reason.INCOMPLETE] += len(ear.fragments.waiting)
    found = tuple(sorted((reason, number) for reason, number in reasons.items() if number))
    return Recording(tuple(reports), Counts(count, sentences, tuple(sorted(messages.items())), found))


def _lines(file: IO[bytes], limit: int) -> Iterator[bytes]:
    """Read lines of bounded length; what an overlong one has beyond that is passed over."""
    begins = True
    for chunk in _bounded(iter(lambda: file.readline(MAX_LINE + 1), b""), limit):
        if begins:
            yield chunk
        begins = chunk.endswith(b"\n")


def _bounded(chunks: Iterable[bytes], limit: int) -> Iterator[bytes]:
    size = 0
    for chunk in chunks:
        size += len(chunk)
        if size > limit:
            hint = "cut it to the time that matters, or raise the limit"
            raise AisError("ais-too-large", f"the recording is longer than {limit} bytes", hint)
        yield chunk
