"""The options of `bigactors run` for vehicles and feeds: filters, fence, keys, times."""

import argparse
import re
from typing import Final

from bigactors.arguments.parser import Parser
from bigactors.arguments.values import corners, named, seconds

FILTERED: Final = ("ais", "detections")
LIVING: Final = {"ais": 600.0, "detections": 600.0, "locations": 60.0, "ros": 60.0, "vehicles": 30.0}
"""The default time to live of a feed's positions, in seconds."""


def fill_links(parser: Parser) -> None:
    """Add the options of vehicles and feeds."""
    parser.add_argument(
        "--fence",
        metavar="PLACE",
        default="world",
        help="the geofence that vehicles get before they are armed: a place of the mission, 'none', or 'world' "
        "(default): the smallest place that contains all places where vehicles may be, or a box around them",
    )
    parser.add_argument(
        "--key",
        metavar="FILE",
        type=named,
        help="sign with the MAVLink 2 key in FILE, and accept only what is signed with it; the newest time stamps are "
        "saved there (python -m adapters.mavlink.new_key FILE makes one)",
    )
    parser.add_argument(
        "--within",
        metavar="SOUTH,WEST,NORTH,EAST",
        type=corners,
        help="take only the AIS positions in this box, in degrees",
    )
    parser.add_argument(
        "--kinds",
        metavar="FEED=KIND,...",
        action="append",
        default=[],
        type=kinds,
        help="take only these kinds from a feed, such as ais=Vessel,BaseStation or detections=OilSpill (default: all "
        "of AIS; of detections, the mission's kinds that are not driven); may be repeated",
    )
    parser.add_argument(
        "--time-to-live",
        metavar="FEED=SECONDS",
        action="append",
        default=[],
        type=living,
        help="how long a position is valid without a newer one: "
        f"{', '.join(f'{feed} ({time:.0f})' for feed, time in LIVING.items())}; may be repeated",
    )
    parser.add_argument(
        "--token",
        metavar="FILE",
        type=named,
        help="posted detections must carry the token in FILE (Authorization: Bearer ...); without a token, "
        "detections=http:PORT accepts posts from this machine only",
    )


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
