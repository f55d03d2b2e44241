"""The option `--camera` of `bigactors run`: the camera of a vehicle, its source and its settings."""

import argparse
import re
from argparse import Namespace
from typing import Final

from bigactors.arguments.parser import Parser
from bigactors.arguments.values import seconds

NUMBERS: Final = {"fov": 60.0, "pitch": -90.0, "yaw": 0.0, "roll": 0.0}
"""The default angles of a camera in degrees."""

PERIODS: Final = {"every": 1.0, "delay": 0.0}
WORDS: Final = {"kind": "OilSpill", "name": "oilSpill", "detector": ""}
SETTINGS: Final = (*NUMBERS, *PERIODS, *WORDS)


def fill_cameras(parser: Parser) -> None:
    """Add the option `--camera`."""
    parser.add_argument(
        "--camera",
        metavar="VEHICLE=SOURCE[,SETTING=VALUE...][,level]",
        action="append",
        default=[],
        type=camera,
        help="find what a vehicle's camera sees, such as uav0=rtsp://10.0.0.7/main,fov=78,pitch=-30 or "
        f"uav0=folder:PATH; settings as `bigactors detect` has them: {', '.join(SETTINGS)}; may be repeated",
    )


def camera(word: str) -> Namespace:
    """Parse VEHICLE=SOURCE[,SETTING=VALUE...][,level].

    >>> found = camera("uav0=rtsp://10.0.0.7/a,b,fov=78,level")
    >>> found.vehicle, found.source, found.fov, found.pitch, found.level
    ('uav0', 'rtsp://10.0.0.7/a,b', 78.0, -90.0, True)
    """
    vehicle, equals, rest = word.partition("=")
    found = Namespace(vehicle=vehicle, level=False, **NUMBERS, **PERIODS, **WORDS)
    while setting := re.search(rf",(?:(level)|({'|'.join(SETTINGS)})=([^,]*))\Z", rest):
        rest = rest[: setting.start()]
        if setting[1]:
            found.level = True
        else:
            setattr(found, setting[2], _value(setting[2], setting[3]))
    unknown = re.search(r",(\w+)=[^,/]*\Z", rest)
    if not (re.fullmatch(r"\w+", vehicle) and equals and rest) or unknown:
        what = f"'{unknown[1]}' is no setting of a camera" if unknown else f"'{word:.60}' is no camera"
        expected = f"write VEHICLE=SOURCE, and of {', '.join(SETTINGS)} and level what differs"
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
