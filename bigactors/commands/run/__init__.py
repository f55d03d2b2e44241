"""`bigactors run`: fly a verified mission."""

from argparse import Namespace
from typing import Final

from bigactors.arguments.options import MISSION, add_serving, add_source
from bigactors.arguments.parser import Parser
from bigactors.arguments.values import corners, identity, named, place, seconds
from bigactors.commands.run.option_values import (
    ADDRESS,
    LIVING,
    SETTINGS,
    camera,
    feed,
    kinds,
    living,
    published,
    station,
    vehicle,
)
from bigactors.exits import Exit

DESCRIPTION: Final = """\
Fly a mission: the rules that were checked move one configuration, as telemetry and feeds let them. It begins only with
a verdict under 'control timed' that everything holds, of exactly this mission (check --verdict), and in a world as the
mission's environment section has it. What breaks an assumption, is refused or takes too long is said at once.

exit codes:
  0  the mission came to its end
  1  an assumption broke, the recording or a plugin failed, or the world was otherwise at the beginning
  2  a mistake in the input, no verdict, a vehicle that is not heard
  3  it was stopped before its end, by --for, Ctrl-C, SIGTERM or SIGHUP; vehicles go on as they were told last"""

EXAMPLES: Final = (
    f"bigactors run oil_spill.mission --vehicle uav0={ADDRESS} --feed ais=udp:10110 --record run.mcap",
    f"bigactors run handover.mission --station gcs0 --peers peers.toml --vehicle uav0={ADDRESS}",
    f"bigactors run oil_spill.mission --vehicle uav0={ADDRESS} --resume run.mcap --record more.mcap",
)

ANYWHERE: Final = ("", 0)
"""The value of `--console` without an address: this machine only, at the usual port or a free one."""


def add_arguments(parser: Parser) -> None:
    """Add the arguments of `bigactors run`."""
    parser.add_argument("file", metavar="FILE", help=MISSION)
    _vehicles_and_feeds(parser)
    _stations(parser)
    _names_and_cameras(parser)
    _safety(parser)
    _filters(parser)
    _recording(parser)
    _permission(parser)
    _course(parser)
    add_source(parser)


def _vehicles_and_feeds(parser: Parser) -> None:
    """Add the options that connect vehicles, feeds and ROS 2."""
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


def _stations(parser: Parser) -> None:
    """Add the options of one among several stations."""
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


def _names_and_cameras(parser: Parser) -> None:
    """Add the options that name sources and connect cameras."""
    parser.add_argument(
        "--name",
        metavar="IDENTITY=NAME",
        action="append",
        default=[],
        type=identity,
        help="the name of a source in the mission: a transponder (mmsi:244660274=drifter0), a vehicle by its system id "
        "(mavlink:3=uav0) or by its autopilot's serial number (serial:2F003B=uav0); may be repeated",
    )
    parser.add_argument(
        "--camera",
        metavar="VEHICLE=SOURCE[,SETTING=VALUE...][,level]",
        action="append",
        default=[],
        type=camera,
        help="find what a vehicle's camera sees, such as uav0=rtsp://10.0.0.7/main,fov=78,pitch=-30 or "
        f"uav0=folder:PATH; settings as `bigactors detect` has them: {', '.join(SETTINGS)}; may be repeated",
    )


def _safety(parser: Parser) -> None:
    """Add the options of fences and keys."""
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


def _filters(parser: Parser) -> None:
    """Add the options that filter reports."""
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


def _recording(parser: Parser) -> None:
    """Add the options of the recording and the console."""
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


def _permission(parser: Parser) -> None:
    """Add the options of the verdict."""
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


def _course(parser: Parser) -> None:
    """Add the options of the beginning and the end."""
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


def run(options: Namespace) -> Exit:
    """Fly a mission that has a verdict that everything holds, or with `--unverified`."""
    from bigactors.commands.run.flight import run_mission

    return run_mission(options)
