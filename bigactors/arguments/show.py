"""The arguments of `bigactors show`."""

from bigactors.arguments.common import MISSION, varying
from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import at_least_zero, identity, named


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors show`."""
    parser.add_argument("file", nargs="?", metavar="FILE", help=f"{MISSION}; with --trace it may be left out")
    parser.add_argument(
        "--output",
        "--out",
        metavar="FILE",
        type=named,
        help="the picture, .svg or .png (default: MISSION.svg, here), or a page that steps through the "
        "whole trace, .html, or the tracks of a trace or recording, .geojson",
    )
    parser.add_argument(
        "--trace",
        metavar="TRACE",
        type=named,
        help="a trace in JSON, as check --trace and simulate write it, a recording of run, or a telemetry log (.tlog) "
        "or AIS recording, seen in the mission's places",
    )
    parser.add_argument(
        "--step",
        metavar="K",
        type=at_least_zero,
        help="show c_K of the trace (default: its last configuration)",
    )
    parser.add_argument(
        "--lanes",
        action="store_true",
        help="print the trace with a lane for each agent and only what each step changed; a picture only with --output",
    )
    parser.add_argument(
        "--timeline",
        action="store_true",
        help="explore a mission with timing, and draw who flies when over all of its runs, from the earliest moment to "
        "the latest (default: MISSION-timeline.svg, here); the table of check --times is printed",
    )
    parser.add_argument(
        "--all",
        action="store_true",
        help="give each step a row: otherwise steps in a row that only repeat others, as an agent does that observes "
        "again and again, are folded",
    )
    parser.add_argument(
        "--against",
        metavar="TRACE",
        type=named,
        help="print where the trace and this one differ; draw nothing",
    )
    parser.add_argument(
        "--name",
        metavar="IDENTITY=NAME",
        action="append",
        default=[],
        type=identity,
        help="the name of a source in a recording by other programs: mavlink:1=uav0, mmsi:244660274=drifter0",
    )
    varying(parser)


COMMAND = Command(
    "show",
    "print and draw a configuration or a trace",
    "Print the initial configuration of a mission, or any one of a trace; draw its bigraph beside the map. Show a\n"
    "whole trace in lanes, as a page that steps through it, or against another one. Show who flies when.",
    (
        "bigactors show oil_spill.mission --output oil_spill.png",
        "bigactors show oil_spill.mission --trace run.json --step 3",
        "bigactors show endurance.mission --timeline --output endurance.png",
        "bigactors show --trace run.json --lanes",
        "bigactors show --trace run.json --output run.html",
        "bigactors show --trace run.mcap --output tracks.geojson",
        "bigactors show --trace run.json --against other.json",
        "bigactors show oil_spill --trace flight.tlog --name mavlink:1=uav0 --output flight.html",
    ),
    fill,
)
