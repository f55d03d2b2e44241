"""`bigactors run`: fly a verified mission."""

from argparse import Namespace
from typing import Final

from bigactors.arguments.options import MISSION, add_serving, add_source
from bigactors.arguments.parser import Parser
from bigactors.arguments.values import corners, identity, named, place, seconds, times
from bigactors.commands.run.option_values import (
    ADDRESS,
    LIVING,
    SETTINGS,
    camera,
    feed,
    kinds,
    living,
    misses,
    published,
    station,
    vehicle,
)
from bigactors.exits import Exit

DESCRIPTION: Final = """\
Fly a mission: the verified rules move one configuration, as telemetry and feeds permit. A run begins only with a
verdict on exactly this mission under 'control timed' that everything holds (check --verdict), and in a world as in the
mission's environment section. A broken assumption, an invariant about ways that is false of what is seen, a refused
command and a late report are printed at once.

exit codes:
  0  the mission came to its end
  1  an assumption or an invariant about ways broke, the recording or a plugin failed, or the world at the
     beginning was not the mission's
  2  a mistake in the input, no verdict, or a silent vehicle
  3  stopped before its end, by --for, Ctrl-C, SIGTERM or SIGHUP; each vehicle goes on with its last command"""

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
    group = parser.add_argument_group("vehicles and feeds")
    group.add_argument(
        "--vehicle",
        metavar="NAME[:ID]=ADDRESS",
        action="append",
        default=[],
        type=vehicle,
        help=f"the address of the vehicle NAME, and its MAVLink system id, such as uav0={ADDRESS}; for a robot of "
        "ROS 2, uav0=ros:tcp:HOST:PORT (docs/how-to/ros.md); for a rehearsal, simulated:plane; `bigactors plugins` "
        "lists all forms; may be repeated",
    )
    group.add_argument(
        "--feed",
        metavar="KIND=ADDRESS",
        action="append",
        default=[],
        type=feed,
        help="a source of positions, such as ais=udp:10110 or ais=file:harbour.nmea; the kinds are ais, places, "
        "detections, locations, ros, and those of `bigactors plugins`; may be repeated",
    )
    group.add_argument(
        "--misses",
        metavar="SHARE[,SEED]",
        type=misses,
        help="simulate a sensor that misses, with the probability SHARE in each look, an entity that the mission lets "
        "observations miss (observe may miss OilSpill)",
    )
    group.add_argument(
        "--publish",
        metavar="ros=ADDRESS",
        type=published,
        help="publish the physical and the logical model for ROS 2, through the Zenoh router at ADDRESS "
        "(tcp:HOST:PORT[?domain=N]; docs/how-to/ros.md)",
    )


def _stations(parser: Parser) -> None:
    """Add the options of one among several stations."""
    group = parser.add_argument_group("one of several stations (docs/how-to/stations.md)")
    group.add_argument(
        "--station",
        metavar="NAME[=ID]",
        action="append",
        default=[],
        type=station,
        help="NAME alone: this run is the station NAME, and executes its bigActors; with ID, the MAVLink system "
        "id of a ground station (default: 255, 254, ... in the order of their names); may be repeated",
    )
    group.add_argument(
        "--peers",
        metavar="FILE",
        type=named,
        help="a list of the stations (TOML): their addresses and bigActors; they share all observations",
    )
    group.add_argument(
        "--station-log",
        metavar="FILE",
        type=named,
        help="the log of this station, from which the others catch up (default: MISSION.STATION.log in this "
        "folder)",
    )


def _names_and_cameras(parser: Parser) -> None:
    """Add the options that name sources and connect cameras."""
    group = parser.add_argument_group("names and cameras")
    group.add_argument(
        "--name",
        metavar="IDENTITY=NAME",
        action="append",
        default=[],
        type=identity,
        help="the name of a source in the mission: a transponder (mmsi:244660274=drifter0), a vehicle by its "
        "system id (mavlink:3=uav0) or by its autopilot's serial number (serial:2F003B=uav0); may be "
        "repeated",
    )
    group.add_argument(
        "--camera",
        metavar="VEHICLE=SOURCE[,SETTING=VALUE...][,level]",
        action="append",
        default=[],
        type=camera,
        help="detect regions in the frames of a vehicle's camera, such as uav0=rtsp://10.0.0.7/main,fov=78,pitch=-30 "
        f"or uav0=folder:PATH; the settings are options of `bigactors detect`: {', '.join(SETTINGS)}; may be repeated",
    )


def _safety(parser: Parser) -> None:
    """Add the options of fences, keys and take-overs."""
    group = parser.add_argument_group("safety of vehicles")
    group.add_argument(
        "--fence",
        metavar="PLACE",
        default="world",
        help="the geofence of the vehicles, sent before they are armed: a place of the mission, 'none', or "
        "'world' (default: the smallest place around all possible places of vehicles, or a box)",
    )
    group.add_argument(
        "--key",
        metavar="FILE",
        type=named,
        help="sign messages with the MAVLink 2 key in FILE, and accept only signed ones; FILE also keeps the "
        "newest time stamps (python -m bigactors.adapters.mavlink.new_key FILE makes one; default: no signing)",
    )
    group.add_argument(
        "--take-over",
        action="store_true",
        help="also command vehicles that already fly another mission, or an earlier run's",
    )


def _filters(parser: Parser) -> None:
    """Add the options that filter reports."""
    group = parser.add_argument_group("reports of feeds and vehicles")
    group.add_argument(
        "--within",
        metavar="SOUTH,WEST,NORTH,EAST",
        type=corners,
        help="take only the AIS positions in this box, in degrees (default: all)",
    )
    group.add_argument(
        "--kinds",
        metavar="FEED=KIND,...",
        action="append",
        default=[],
        type=kinds,
        help="take only these kinds from a feed, such as ais=Vessel,BaseStation or detections=OilSpill (default: "
        "all of AIS; of detections, the mission's kinds that are not driven); may be repeated",
    )
    group.add_argument(
        "--time-to-live",
        metavar="FEED=SECONDS",
        action="append",
        default=[],
        type=living,
        help="the seconds for which a position is valid without a newer one; the defaults are "
        f"{', '.join(f'{feed} ({time:.0f})' for feed, time in LIVING.items())}; may be repeated",
    )
    group.add_argument(
        "--token",
        metavar="FILE",
        type=named,
        help="accept only posted detections with the token in FILE (Authorization: Bearer ...); default: no "
        "token, and detections=http:PORT accepts posts from this machine only",
    )


def _recording(parser: Parser) -> None:
    """Add the options of the recording and the console."""
    group = parser.add_argument_group("recording and console")
    group.add_argument(
        "--record",
        metavar="FILE",
        type=named,
        help="record the run into FILE (MCAP), and every MAVLink frame into a telemetry log beside it (.tlog)",
    )
    group.add_argument(
        "--console",
        metavar="[HOST:]PORT",
        nargs="?",
        const=ANYWHERE,
        type=place,
        help="serve the operator's console in the browser, and print its links; the run begins when an operator "
        "presses Start (default: on this machine only, port 8765 or a free one)",
    )
    group.add_argument(
        "--at-once",
        action="store_true",
        help="with --console: begin after the checks, without Start",
    )
    add_serving(group)
    group.add_argument(
        "--resume",
        metavar="FILE",
        type=named,
        help="continue the run in the recording FILE, after a comparison with the vehicles",
    )


def _permission(parser: Parser) -> None:
    """Add the options of the verdict."""
    group = parser.add_argument_group("verdict")
    group.add_argument(
        "--verdict",
        metavar="FILE",
        type=named,
        help="the verdict on the mission (default: beside the mission, or in this folder)",
    )
    group.add_argument(
        "--trust",
        metavar="KEY.pub",
        type=named,
        help="fly only with a verdict signed by the private key of KEY.pub (check --sign)",
    )
    group.add_argument("--unverified", action="store_true", help="fly without a verdict, with a warning")


def _course(parser: Parser) -> None:
    """Add the options of the beginning and the end."""
    group = parser.add_argument_group("begin, reach and end the run")
    group.add_argument(
        "--for",
        metavar="SECONDS",
        dest="duration",
        type=seconds,
        help="end the run after SECONDS (default: at the end of the mission)",
    )
    group.add_argument(
        "--speed",
        metavar="TIMES",
        default=1.0,
        type=times,
        help="rehearse TIMES as fast as life: the run and its vehicles, all `simulated`, share one clock "
        "(default: 1)",
    )
    group.add_argument(
        "--wait",
        metavar="SECONDS",
        type=seconds,
        default=60.0,
        help="wait at most SECONDS for a message of every vehicle (default: 60)",
    )
    group.add_argument(
        "--socket",
        metavar="FILE",
        type=named,
        help="the socket for `bigactors say`, `hold` and others (default: MISSION.sock in a folder of yours)",
    )


def run(options: Namespace) -> Exit:
    """Fly a mission that has a verdict that everything holds, or with `--unverified`."""
    from bigactors.commands.run.flight import run_mission

    return run_mission(options)
