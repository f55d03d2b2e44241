"""Parsers of argument and option values: each reads one word, or raises an error that explains its fault."""

import argparse
import math
import re
from collections.abc import Callable
from datetime import UTC, datetime
from typing import Final

from bigactors.mistakes import suggestion

ADDRESS: Final = "udp:127.0.0.1:14550"

FILTERED: Final = ("ais", "detections")
LIVING: Final = {"ais": 600.0, "detections": 600.0, "locations": 60.0, "ros": 60.0, "vehicles": 30.0}
"""The default time to live of a feed's positions, in seconds."""

NUMBERS: Final = {"fov": 60.0, "pitch": -90.0, "yaw": 0.0, "roll": 0.0}
"""The default angles of a camera in degrees."""

PERIODS: Final = {"every": 1.0, "delay": 0.0}
WORDS: Final = {"kind": "OilSpill", "name": "oilSpill", "detector": ""}
SETTINGS: Final = (*NUMBERS, *PERIODS, *WORDS)

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


def port_number(text: str) -> int:
    """Return the number of a port; 0 is any free one."""
    if not re.fullmatch(r"[0-9]{1,5}", text) or int(text) >= 65_536:
        raise argparse.ArgumentTypeError(f"'{text:.40}' is no port: a whole number to 65535")
    return int(text)


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


def multiple(text: str) -> float:
    """Return a factor above 0."""
    value = _number(text)
    if value is None or value <= 0:
        raise argparse.ArgumentTypeError(f"'{text:.40}' is not a number above 0")
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


def vehicle(word: str) -> tuple[str, int | None, str]:
    """Parse NAME[:ID]=ADDRESS.

    >>> vehicle("uav0:3=udp:14550"), vehicle("uav0=udp:14550")
    (('uav0', 3, 'udp:14550'), ('uav0', None, 'udp:14550'))
    """
    found = re.fullmatch(r"(\w+)(?::([0-9]{1,3}))?=(.+)", word)
    if not found:
        raise argparse.ArgumentTypeError(f"'{word:.60}' is not NAME[:ID]=ADDRESS, such as uav0={ADDRESS}")
    return found[1], None if found[2] is None else int(found[2]), found[3]


def feed(word: str) -> tuple[str, str]:
    """Parse KIND=ADDRESS.

    >>> feed("ais=udp:10110")
    ('ais', 'udp:10110')
    """
    kind, _, address = word.partition("=")
    if not (kind and address):
        raise argparse.ArgumentTypeError(f"'{word:.60}' is not KIND=ADDRESS, such as ais=udp:10110")
    return kind, address


def published(word: str) -> str:
    """Parse ros=ADDRESS.

    >>> published("ros=tcp:127.0.0.1:7447")
    'tcp:127.0.0.1:7447'
    """
    way, _, address = word.partition("=")
    if way != "ros" or not address:
        raise argparse.ArgumentTypeError(f"'{word:.60}' is not ros=ADDRESS, such as ros=tcp:127.0.0.1:7447")
    return address


def station(word: str) -> tuple[str, int | None]:
    """Parse NAME[=ID].

    >>> station("gcs0=255"), station("gcs0")
    (('gcs0', 255), ('gcs0', None))
    """
    found = re.fullmatch(r"(\w+)(?:=([0-9]{1,3}))?", word)
    if not found or (found[2] and not 0 < int(found[2]) < 256):
        raise argparse.ArgumentTypeError(
            f"'{word:.60}' is not NAME or NAME=ID, such as gcs0=255; ids are from 1 to 255"
        )
    return found[1], None if found[2] is None else int(found[2])


def kinds(word: str) -> tuple[str, frozenset[str]]:
    """Parse FEED=KIND,...

    >>> kinds("detections=OilSpill")
    ('detections', frozenset({'OilSpill'}))
    """
    found = re.fullmatch(rf"({'|'.join(FILTERED)})=(\w+(?:,\w+)*)", word)
    if not found:
        raise argparse.ArgumentTypeError(
            f"'{word:.60}' is not FEED=KIND,... for a feed of {' or '.join(FILTERED)}"
        )
    return found[1], frozenset(found[2].split(","))


def living(word: str) -> tuple[str, float]:
    """Parse FEED=SECONDS.

    >>> living("ais=120")
    ('ais', 120.0)
    """
    feed, _, time = word.partition("=")
    if feed not in LIVING or not time:
        raise argparse.ArgumentTypeError(f"'{word:.60}' is not FEED=SECONDS for one of {', '.join(LIVING)}")
    return feed, seconds(time)


def misses(word: str) -> tuple[float, int]:
    """Parse SHARE[,SEED].

    >>> misses("0.3"), misses("0.3,7")
    ((0.3, 0), (0.3, 7))
    """
    found = re.fullmatch(r"(0(?:\.[0-9]{1,9})?|1(?:\.0)?)(?:,([0-9]{1,9}))?", word)
    if not found:
        raise argparse.ArgumentTypeError(f"'{word:.60}' is not SHARE[,SEED], such as 0.3,7")
    return float(found[1]), int(found[2] or 0)


def camera(word: str) -> argparse.Namespace:
    """Parse VEHICLE=SOURCE[,SETTING=VALUE...][,level].

    >>> found = camera("uav0=rtsp://10.0.0.7/a,b,fov=78,level")
    >>> found.vehicle, found.source, found.fov, found.pitch, found.level
    ('uav0', 'rtsp://10.0.0.7/a,b', 78.0, -90.0, True)
    """
    vehicle, equals, rest = word.partition("=")
    found = argparse.Namespace(vehicle=vehicle, level=False, **NUMBERS, **PERIODS, **WORDS)
    while setting := re.search(rf",(?:(level)|({'|'.join(SETTINGS)})=([^,]*))\Z", rest):
        rest = rest[: setting.start()]
        if setting[1]:
            found.level = True
        else:
            setattr(found, setting[2], _value(setting[2], setting[3]))
    unknown = re.search(r",(\w+)=[^,/]*\Z", rest)
    if not (re.fullmatch(r"\w+", vehicle) and equals and rest) or unknown:
        what = f"'{unknown[1]}' is no setting of a camera" if unknown else f"'{word:.60}' is no camera"
        expected = f"write VEHICLE=SOURCE, then any of {', '.join(SETTINGS)} and level"
        raise argparse.ArgumentTypeError(f"{what}: {expected}")
    found.source = rest
    return found


def _value(name: str, text: str) -> float | str:
    if name in WORDS:
        return text
    if name in PERIODS:
        return 0.0 if text == "0" else seconds(text)
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{name}={text:.40} is no angle in degrees") from None


def degrees(text: str) -> float:
    """Parse an angle in degrees.

    >>> degrees("62.5")
    62.5
    """
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text:.40}' is no angle in degrees") from None


def mount(text: str) -> tuple[float, float, float]:
    """Parse PITCH[,YAW[,ROLL]] in degrees.

    >>> mount("-60"), mount("-45,90")
    ((-60.0, 0.0, 0.0), (-45.0, 90.0, 0.0))
    """
    given = [degrees(part) for part in text.split(",")]
    if len(given) > 3:
        raise argparse.ArgumentTypeError(f"'{text:.40}' is not PITCH[,YAW[,ROLL]], such as -60,0,0")
    pitch, yaw, roll = (*given, 0.0, 0.0)[:3]
    return pitch, yaw, roll


def constant(word: str) -> tuple[str, int | float | str]:
    """Parse NAME=VALUE; a numeric value becomes a number.

    >>> constant("t=0.5"), constant("n=3"), constant("who=ann")
    (('t', 0.5), ('n', 3), ('who', 'ann'))
    """
    name, equals, value = word.partition("=")
    if not (name and equals and value):
        raise argparse.ArgumentTypeError(f"'{word:.60}' is not NAME=VALUE, such as n=3")
    for kind in (int, float):
        try:
            return name, kind(value)
        except ValueError:
            continue
    return name, value


VALUES: Final[dict[str, Callable[[str], object]]] = {
    **dict.fromkeys(("ADDRESS", "CERT", "DIR", "FILE", "FOLDER", "HOST:PORT", "KEY", "KEY.pub"), named),
    **dict.fromkeys(("PREDICATE", "PREFIX", "TRACE"), named),
    "DEGREES": degrees,
    "FEED=KIND,...": kinds,
    "FEED=SECONDS": living,
    "FORMAT:FILE": output,
    "IDENTITY=NAME": identity,
    "K": at_least_zero,
    "KIND=ADDRESS": feed,
    "N": at_least_one,
    "NAME=FILE": substitute,
    "NAME=VALUE": constant,
    "NAME[=ID]": station,
    "NAME[:ID]=ADDRESS": vehicle,
    "NAMES": reductions,
    "PITCH[,YAW[,ROLL]]": mount,
    "PORT": port_number,
    "SECONDS": seconds,
    "SHARE[,SEED]": misses,
    "SIZE": size,
    "SOUTH,WEST,NORTH,EAST": corners,
    "TIME": time_of,
    "TIMES": times,
    "VEHICLE=FILE": route,
    "VEHICLE=SOURCE[,SETTING=VALUE...][,level]": camera,
    "X": multiple,
    "[HOST:]PORT": place,
    "ros=ADDRESS": published,
}
"""The parser of an option's value, by the name of the value in the help; others are taken as they are."""
