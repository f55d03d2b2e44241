"""Parsers of argument and option values: each reads one word, or raises an error that explains its fault."""

import argparse
import math
import re
from datetime import UTC, datetime
from typing import Final

from bigactors.mistakes import suggestion

FORMATS: Final = ("json", "junit", "sarif", "github", "geojson")
"""The formats of `check --output`; `github` stands for the annotations of GitHub Actions."""


def named(text: str) -> str:
    """Return the name of a file or folder; refuse an empty one."""
    if not text:
        raise argparse.ArgumentTypeError("the name of a file is missing")
    return text


def output(word: str) -> tuple[str, str]:
    """Parse FORMAT:FILE.

    >>> output("sarif:report.sarif")
    ('sarif', 'report.sarif')
    """
    name, _, file = word.partition(":")
    if name not in FORMATS:
        near = suggestion(name, FORMATS)
        message = f"unknown format '{name:.40}': {near or 'the formats are ' + ', '.join(FORMATS)}"
        raise argparse.ArgumentTypeError(message)
    if not file:
        raise argparse.ArgumentTypeError(f"'{word:.60}' is not FORMAT:FILE, such as {name}:report")
    return name, file


def at_least_zero(text: str) -> int:
    """Return a whole number from 0."""
    if not re.fullmatch(r"[0-9]{1,12}", text):
        raise argparse.ArgumentTypeError(f"'{text:.40}' is not a whole number from 0")
    return int(text)


def substitute(word: str) -> tuple[str, str]:
    """Parse NAME=FILE."""
    name, equals, file = word.partition("=")
    if not (name and equals and file):
        raise argparse.ArgumentTypeError(
            f"'{word:.60}' is not NAME=FILE, such as harbour_watch.nmea=marina.nmea"
        )
    return name, file


def at_least_one(text: str) -> int:
    """Return a whole number from 1; it may have thousands separators."""
    plain = text.replace(",", "").replace("_", "")
    if not re.fullmatch(r"[0-9]{1,12}", plain) or not int(plain):
        raise argparse.ArgumentTypeError(f"'{text:.40}' is not a whole number from 1")
    return int(plain)


def seconds(text: str) -> float:
    """Return a number of seconds above 0."""
    value = _number(text)
    if value is None or value <= 0:
        raise argparse.ArgumentTypeError(f"'{text:.40}' is not a number of seconds above 0")
    return value


def times(text: str) -> float:
    """Return a factor from 0.1 to 1000."""
    value = _number(text)
    if value is None or not 0.1 <= value <= 1000:
        raise argparse.ArgumentTypeError(f"'{text:.40}' is not a number from 0.1 to 1000")
    return value


def time_of(text: str) -> float:
    """Return a time in seconds since 1970; a time without a zone is UTC.

    >>> time_of("2020-04-07T21:42:00Z")
    1586295720.0
    """
    value = _number(text)
    if value is not None:
        return value
    try:
        time = datetime.fromisoformat(text)
        return (time if time.tzinfo else time.replace(tzinfo=UTC)).timestamp()
    except (ValueError, OverflowError):
        message = f"'{text:.40}' is no time: write it as 2020-04-07T21:42:00Z, or in seconds since 1970"
        raise argparse.ArgumentTypeError(message) from None


def corners(text: str) -> tuple[float, float, float, float]:
    """Return the south, west, north and east of a box."""
    found = [value for part in text.split(",") if (value := _number(part)) is not None]
    if len(found) != 4 or text.count(",") != 3:
        message = (
            f"'{text:.60}' is no box: write SOUTH,WEST,NORTH,EAST in degrees, such as 52.83,5.66,52.87,5.72"
        )
        raise argparse.ArgumentTypeError(message)
    south, west, north, east = found
    return south, west, north, east


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def identity(word: str) -> tuple[str, str]:
    """Parse IDENTITY=NAME; a serial number is converted to upper case.

    >>> identity("mmsi:244660274=drifter0"), identity("serial:2f003b=uav0")
    (('mmsi:244660274', 'drifter0'), ('serial:2F003B', 'uav0'))
    """
    found = re.fullmatch(r"(\w+):(\w+)=(\w+)", word)
    if not found:
        raise argparse.ArgumentTypeError(
            f"'{word:.60}' is not IDENTITY=NAME, such as mmsi:244660274=drifter0"
        )
    number = found[2].upper() if found[1] == "serial" else found[2]
    return f"{found[1]}:{number}", found[3]


def route(word: str) -> tuple[str, str]:
    """Parse VEHICLE=FILE.

    >>> route("uav0=uav0.plan")
    ('uav0', 'uav0.plan')
    """
    name, _, file = word.partition("=")
    if not (name and file):
        raise argparse.ArgumentTypeError(f"'{word:.60}' is not VEHICLE=FILE, such as uav0=uav0.plan")
    return name, file


REDUCTIONS: Final = ("por", "symmetry")
"""The values of `check --reduce`."""


def reductions(text: str) -> tuple[str, ...]:
    """Parse names of reductions, separated by commas.

    >>> reductions("por,symmetry")
    ('por', 'symmetry')
    """
    names = tuple(dict.fromkeys(text.split(",")))
    for name in names:
        if name not in REDUCTIONS:
            raise argparse.ArgumentTypeError(f"'{name:.60}' is none of {', '.join(REDUCTIONS)}")
    return names


def size(text: str) -> int:
    """Return a number of bytes; the suffixes k, M and G multiply by 10³, 10⁶ and 10⁹.

    >>> size("800M")
    800000000
    """
    unit = {"k": 10**3, "M": 10**6, "G": 10**9}.get(text[-1:], 1)
    value = _number(text if unit == 1 else text[:-1])
    if value is None or value <= 0:
        raise argparse.ArgumentTypeError(f"'{text:.60}' is no size: write one such as 800M or 12G")
    return int(value * unit)


def place(word: str) -> tuple[str, int]:
    """Parse [HOST:]PORT.

    >>> place("8765"), place("0.0.0.0:8765"), place("[::1]:0")
    (('127.0.0.1', 8765), ('0.0.0.0', 8765), ('::1', 0))
    """
    host, _, port = word.rpartition(":")
    if not (port.isascii() and port.isdigit() and int(port) < 65_536):
        raise argparse.ArgumentTypeError(f"'{word:.60}' is not [HOST:]PORT, such as 8765 or 0.0.0.0:8765")
    return host.removeprefix("[").removesuffix("]") or "127.0.0.1", int(port)
