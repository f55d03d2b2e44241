"""Dates: moments of a run, counted from its start, and the durations between them."""

import re
from typing import Final

from semantics.behaviours.durations import duration_text

_PART: Final = re.compile(r"[0-9]{1,6}(?:\.[0-9]{1,3})?")


def clock_text(milliseconds: int) -> str:
    """Return a moment as minutes and seconds, with hours from the first hour on.

    >>> clock_text(751_000), clock_text(3_600_000), clock_text(1_250)
    ('12:31', '1:00:00', '0:01.25')
    """
    seconds, rest = divmod(milliseconds, 1000)
    minutes, seconds = divmod(seconds, 60)
    hours, minutes = divmod(minutes, 60)
    whole = f"{hours}:{minutes:02}:{seconds:02}" if hours else f"{minutes}:{seconds:02}"
    return f"{whole}.{rest:03}".rstrip("0") if rest else whole


def lapse_text(milliseconds: int) -> str:
    """Return a duration in one unit if that is exact and short, else in the form of a clock.

    >>> lapse_text(480_000), lapse_text(13_000), lapse_text(1_715_000)
    ('8 min', '13 s', '28:35')
    """
    said = duration_text(milliseconds / 1000)
    return clock_text(milliseconds) if said.endswith(" s") and milliseconds > 120_000 else said


def milliseconds_at(moment: str) -> int:
    """Return the milliseconds of a moment written as a clock or in seconds; raises ValueError.

    >>> milliseconds_at("12:31"), milliseconds_at("1:00:00"), milliseconds_at("0:01.25"), milliseconds_at("90")
    (751000, 3600000, 1250, 90000)
    """
    parts = moment.split(":")
    if len(parts) > 3 or not all(map(_PART.fullmatch, parts)):
        raise ValueError("write minutes and seconds, 1:30, or seconds, 90")
    seconds = 0.0
    for part in parts:
        seconds = seconds * 60 + float(part)
    return round(seconds * 1000)
