"""The options of `bigactors run` that say how vehicles and feeds are to be heard: filters, fence, keys, times."""

import argparse
import re
from typing import Final

from bigactors.arguments.parser import Parser
from bigactors.arguments.values import corners, named, seconds

FILTERED: Final = ("ais", "detections")
LIVING: Final = {"ais": 600.0, "detections": 600.0, "locations": 60.0, "vehicles": 30.0}
"""For how many seconds a position counts that nothing newer follows, if nothing else is said."""


def fill_links(parser: Parser) -> None:
    """Add them."""
    parser.add_argument(
        "--fence",
        metavar="PLACE",
        default="world",
        help="the geofence that vehicles are given before they are armed: a place of the mission, 'none', or 'world' "
        "(default): the place that holds all places where vehicles may be, else a box around them",
    )
    parser.add_argument(
        "--key",
        metavar="FILE",
        type=named,
        help="sign with the MAVLink 2 key in FILE, and believe only what is signed by it; the newest time stamps are "
        "kept there (python -m adapters.mavlink.new_key FILE makes one)",
    )
    parser.add_argument(
        "--within",
        metavar="SOUTH,WEST,NORTH,EAST",
        type=corners,
        help="of AIS, only what is inside this box, in degrees",
    )
    parser.add_argument(
        "--kinds",
        metavar="FEED=KIND,...",
        action="append",
        default=[],
        type=kinds,
        help="of a feed, only these kinds, such as ais=Vessel,BaseStation or detections=OilSpill (default: of AIS "
        "all, of detections the mission's that nothing drives); may be repeated",
    )
    parser.add_argument(
        "--time-to-live",
        metavar="FEED=SECONDS",
        action="append",
        default=[],
        type=living,
        help="how long a position counts that nothing newer follows: "
        f"{', '.join(f'{feed} ({time:.0f})' for feed, time in LIVING.items())}; may be repeated",
    )
    parser.add_argument(
        "--token",
        metavar="FILE",
        type=named,
        help="posts of detections must carry the token in FILE (Authorization: Bearer ...); without one, "
        "detections=http:PORT hears this machine only",
    )


def kinds(word: str) -> tuple[str, frozenset[str]]:
    """Read FEED=KIND,...

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
    """Read FEED=SECONDS.

    >>> living("ais=120")
    ('ais', 120.0)
    """
    feed, _, time = word.partition("=")
    if feed not in LIVING or not time:
        raise argparse.ArgumentTypeError(f"'{word:.60}' is not FEED=SECONDS for one of {', '.join(LIVING)}")
    return feed, seconds(time)
