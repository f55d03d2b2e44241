"""Times in the text of loggers: ISO 8601, plain digits, or seconds since 1970 or fractions of them."""

from __future__ import annotations

import re
from datetime import UTC, datetime
from typing import Final

LATEST: Final = 2.0**32
"""The exclusive upper bound of times, in seconds since 1970 UTC (the year 2106): a file may contain any number."""

_UNITS: Final = ((10**11, 1), (10**14, 10**3), (10**17, 10**6), (10**20, 10**9))
"""Pairs of a limit and a divisor: a number below the limit is a time in units of 1/divisor seconds."""

_EPOCH: Final = re.compile(r"(\d{1,20})(?:\.(\d{1,12}))?")
_COMPACT: Final = r"(?:19|20)\d{6}T?\d{6}(?:\.\d{1,9})?Z?"
_CLOCK: Final = r"\d{4}[-/]\d\d[-/]\d\d[T ]\d\d:?\d\d:?\d\d(?:[.,]\d{1,9})?(?: ?(?:Z|UTC|[+-]\d\d:?\d\d))?"
_DIGITS: Final = r"\d{16}|\d{19}|\d{13}|\d{10}"
_TIME: Final = re.compile(
    rf"(?<![\w./-])(?:(?P<clock>{_CLOCK})|(?P<compact>{_COMPACT})|(?P<epoch>(?:{_DIGITS})(?:\.\d{{1,12}})?))(?![\w/-]|:\d)"
)
_EARLIEST: Final = 315_532_800.0
"""1980: smaller numbers beside a sentence are no times."""


def epoch_seconds(text: str) -> float:
    """Return seconds since 1970 from a number of seconds, milliseconds, microseconds or nanoseconds.

    >>> epoch_seconds("1772596000"), epoch_seconds("1772596000576705"), epoch_seconds("1772596000.25")
    (1772596000.0, 1772596000.576705, 1772596000.25)

    Raises:
        ValueError: If the text is no such number, or a time after 2106.
    """
    found = _EPOCH.fullmatch(text)
    if not found or not text.isascii():
        raise ValueError("a time is a number of seconds, milliseconds, microseconds or nanoseconds")
    whole = int(found[1])
    unit = next(unit for limit, unit in _UNITS if whole < limit)
    time = float(text) / unit if found[2] else whole / unit
    if time >= LATEST:
        raise ValueError("the time is after 2106")
    return time


def time_beside(text: str, *, last: bool = False) -> float | None:
    """Return the first time (or the last) in a logger's text, in seconds since 1970; UTC unless it has a zone.

    >>> time_beside("2026-03-04T03:57:10.000Z "), time_beside("( MSG: 1, timestamp: 20260304035711)")
    (1772596630.0, 1772596631.0)
    """
    times = [time for found in _TIME.finditer(text) if (time := _time(found)) is not None]
    return times[-1 if last else 0] if times else None


def moment_text(time: float) -> str:
    """Return a time as text, as in missions.

    >>> moment_text(1772596630.0)
    '2026-03-04T03:57:10Z'
    """
    moment = datetime.fromtimestamp(min(max(time, 0.0), LATEST), UTC)
    return moment.isoformat(timespec="seconds").replace("+00:00", "Z")


def _time(found: re.Match[str]) -> float | None:
    try:
        if found["epoch"]:
            time = epoch_seconds(found["epoch"])
        elif found["compact"]:
            digits, _, part = found["compact"].replace("T", "").rstrip("Z").partition(".")
            whole = datetime.strptime(digits, "%Y%m%d%H%M%S").replace(tzinfo=UTC).timestamp()
            time = whole + float(f"0.{part or 0}")
        else:
            time = _clock(found["clock"])
    except (ValueError, OverflowError):
        return None
    return time if _EARLIEST <= time < LATEST else None


def _clock(text: str) -> float:
    """Return a date and a time of day in seconds since 1970; UTC by default."""
    found = datetime.fromisoformat(_isoformat(text))
    return (found if found.tzinfo else found.replace(tzinfo=UTC)).timestamp()


def _isoformat(text: str) -> str:
    """Return the form of ISO 8601 that Python reads in all its versions."""
    date, clock = text[:10].replace("/", "-"), text[11:].replace(",", ".")
    found = re.fullmatch(r"(\d\d):?(\d\d):?(\d\d)(?:\.(\d+))? ?(Z|UTC|[+-]\d\d:?\d\d)?", clock)
    if found is None:
        raise ValueError("this is no time of day")
    hour, minute, second, part, zone = found.groups()
    shift = "+00:00" if zone in (None, "Z", "UTC") else f"{zone[:3]}:{zone[-2:]}"
    return f"{date}T{hour}:{minute}:{second}.{(part or '')[:6]:0<6}{shift}"
