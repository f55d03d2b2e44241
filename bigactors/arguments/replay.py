"""The arguments of `bigactors replay`."""

from typing import Final

from bigactors.arguments.common import varying
from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import identity, named, route, seconds

DESCRIPTION: Final = """\
Run a trace, or the recording of a live run, again through the rules, step by step. A step that they do not
allow ends it with exit code 1, and what was enabled instead is shown.

A telemetry log (.tlog) or an AIS recording is shown in the places of a mission: what changes in its bigraph,
what its environment section does not say, and the bigraph at the end."""


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors replay`."""
    parser.add_argument(
        "trace",
        metavar="TRACE",
        help="a trace in JSON, as check --trace and simulate write it, or a recording that run --record wrote",
    )
    parser.add_argument(
        "--mission",
        metavar="FILE",
        type=named,
        help="the mission to replay it on (default: the one that it names)",
    )
    parser.add_argument(
        "--speed",
        metavar="X",
        type=seconds,
        help="print a recording X times as fast as it was (default: at once)",
    )
    parser.add_argument(
        "--name",
        metavar="IDENTITY=NAME",
        action="append",
        default=[],
        type=identity,
        help="the name of a source in a recording by other programs: mavlink:1=uav0, mmsi:244660274=drifter0",
    )
    parser.add_argument(
        "--waypoints",
        metavar="VEHICLE=FILE",
        action="append",
        default=[],
        type=route,
        help="write the points that the trace sends a vehicle to, at its altitude there, for ground stations, as "
        "QGC WPL 110 (.waypoints) or as a plan (.plan); may be repeated",
    )
    parser.add_argument("--step", action="store_true", help="wait for Enter before each step")
    varying(parser)


COMMAND = Command(
    "replay",
    "run a trace again",
    DESCRIPTION,
    (
        "bigactors replay traces/oil_spill/over_the_spill-witness/trace.json",
        "bigactors replay run.json --mission changed.mission",
        "bigactors replay run.mcap --speed 10",
        "bigactors replay run.json --waypoints uav0=uav0.plan",
        "bigactors replay flight.tlog --mission oil_spill --name mavlink:1=uav0",
    ),
    fill,
)
