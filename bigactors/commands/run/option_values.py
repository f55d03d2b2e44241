"""Parsers of the values of `bigactors run`: vehicles, feeds, stations and cameras."""

import argparse
import re
from typing import Final

from bigactors.arguments.values import seconds

ADDRESS: Final = "udp:127.0.0.1:14550"

FILTERED: Final = ("ais", "detections")
LIVING: Final = {"ais": 600.0, "detections": 600.0, "locations": 60.0, "ros": 60.0, "vehicles": 30.0}
"""The default time to live of a feed's positions, in seconds."""

NUMBERS: Final = {"fov": 60.0, "pitch": -90.0, "yaw": 0.0, "roll": 0.0}
"""The default angles of a camera in degrees."""

PERIODS: Final = {"every": 1.0, "delay": 0.0}
WORDS: Final = {"kind": "OilSpill", "name": "oilSpill", "detector": ""}
SETTINGS: Final = (*NUMBERS, *PERIODS, *WORDS)


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
