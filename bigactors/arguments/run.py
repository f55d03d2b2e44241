"""The arguments of `bigactors run`."""

import argparse
import re
from typing import Final

from bigactors.arguments.cameras import fill_cameras
from bigactors.arguments.common import MISSION
from bigactors.arguments.links import fill_links
from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.serving import ANYWHERE, add_serving, place
from bigactors.arguments.values import identity, named, seconds, substitute

DESCRIPTION: Final = """\
Fly a mission: the rules that were checked move one configuration, as telemetry and feeds let them. It begins only with
a verdict under 'control timed' that everything holds, of exactly this mission (check --verdict), and in a world as the
mission's environment section has it. What breaks an assumption, is refused or takes too long is said at once.

exit codes:
  0  the mission came to its end
  1  an assumption broke, the recording or a plugin failed, or the world was otherwise at the beginning
  2  a mistake in the input, no verdict, a vehicle that is not heard
  3  it was stopped before its end, by --for, Ctrl-C, SIGTERM or SIGHUP; vehicles go on as they were told last"""

ADDRESS: Final = "udp:127.0.0.1:14550"


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors run`."""
    parser.add_argument("file", metavar="FILE", help=MISSION)
    parser.add_argument(
        "--vehicle",
        metavar="NAME[:ID]=ADDRESS",
        action="append",
        default=[],
        type=vehicle,
        help=f"the vehicle NAME, with its MAVLink system id, is at ADDRESS, such as uav0={ADDRESS}; "
        "a robot of ROS 2: uav0=ros:tcp:HOST:PORT (docs/how-to/ros.md); `bigactors plugins` lists the schemes; "
        "may be repeated",
    )
    parser.add_argument(
        "--feed",
        metavar="KIND=ADDRESS",
        action="append",
        default=[],
        type=feed,
        help="positions come from ADDRESS, such as ais=udp:10110 or ais=file:harbour.nmea; the kinds are ais, "
        "places, detections, locations, ros, and those of installed plugins (`bigactors plugins`); may be repeated",
    )
    parser.add_argument(
        "--publish",
        metavar="ros=ADDRESS",
        type=published,
        help="publish what P and L hold for ROS 2, through the Zenoh router at ADDRESS (tcp:HOST:PORT[?domain=N]; "
        "docs/how-to/ros.md)",
    )
    parser.add_argument(
        "--station",
        metavar="NAME[=ID]",
        action="append",
        default=[],
        type=station,
        help="NAME alone: this run is that station, and runs the bigActors that it hosts; with ID, the MAVLink system "
        "id of a ground station (default: 255, 254, ... in the order of their names); may be repeated",
    )
    parser.add_argument(
        "--peers",
        metavar="FILE",
        type=named,
        help="the stations (TOML): where each is reached, what it hosts; all share what one sees "
        "(docs/how-to/stations.md)",
    )
    parser.add_argument(
        "--station-log",
        metavar="FILE",
        type=named,
        help="the log of what this station publishes, from which others catch up (default: MISSION.STATION.log, here)",
    )
    parser.add_argument(
        "--name",
        metavar="IDENTITY=NAME",
        action="append",
        default=[],
        type=identity,
        help="the name of a source in the mission: a transponder (mmsi:244660274=drifter0), a vehicle by its system id "
        "(mavlink:3=uav0) or by its autopilot's serial number (serial:2F003B=uav0); may be repeated",
    )
    fill_cameras(parser)
    fill_links(parser)
    parser.add_argument(
        "--record",
        metavar="FILE",
        type=named,
        help="record everything into FILE (MCAP), and every MAVLink frame into a tlog beside it",
    )
    parser.add_argument(
        "--console",
        metavar="[HOST:]PORT",
        nargs="?",
        const=ANYWHERE,
        type=place,
        help="serve the operator's console in the browser (default: on this machine only, port 8765 or a free one); "
        "the links are printed, and the run begins when Start is pressed there",
    )
    parser.add_argument(
        "--at-once",
        action="store_true",
        help="with --console: begin as soon as all is checked, without Start",
    )
    add_serving(parser)
    parser.add_argument(
        "--resume",
        metavar="FILE",
        type=named,
        help="resume the run that was recorded in FILE, after comparing the vehicles",
    )
    parser.add_argument(
        "--verdict", metavar="FILE", type=named, help="the verdict (default: beside the mission, or here)"
    )
    parser.add_argument(
        "--trust",
        metavar="KEY.pub",
        type=named,
        help="fly only with a verdict that is signed by the private key of KEY.pub (check --sign)",
    )
    parser.add_argument("--unverified", action="store_true", help="fly without a verdict, with a warning")
    parser.add_argument(
        "--take-over",
        action="store_true",
        help="command vehicles that are found under way on a mission that is on board, somebody's or an earlier run's",
    )
    parser.add_argument("--for", metavar="SECONDS", dest="duration", type=seconds, help="end after SECONDS")
    parser.add_argument(
        "--wait",
        metavar="SECONDS",
        type=seconds,
        default=60.0,
        help="wait at most SECONDS until every vehicle is heard (default 60)",
    )
    parser.add_argument(
        "--socket", metavar="FILE", type=named, help="where `bigactors say`, `hold` and others reach it"
    )
    parser.add_argument(
        "--source",
        metavar="NAME=FILE",
        action="append",
        default=[],
        type=substitute,
        help='read FILE where the mission has from "NAME"; may be repeated',
    )


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


COMMAND = Command(
    "run",
    "fly a mission that was checked",
    DESCRIPTION,
    (
        f"bigactors run oil_spill.mission --vehicle uav0={ADDRESS} --feed ais=udp:10110 --record run.mcap",
        f"bigactors run handover.mission --station gcs0 --peers peers.toml --vehicle uav0={ADDRESS}",
        f"bigactors run oil_spill.mission --vehicle uav0={ADDRESS} --resume run.mcap --record more.mcap",
    ),
    fill,
)
