"""The arguments of `bigactors world`."""

from typing import Final

from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import corners, named, time_of

DESCRIPTION: Final = """\
Read GeoJSON, waypoint files, plans of QGroundControl and AIS recordings into one world, print its bigraph A(P),
and count by kind what was in the files and not read."""


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors world`."""
    parser.add_argument(
        "files",
        nargs="+",
        metavar="FILE",
        help="places (.geojson, .json, .waypoints, .plan), or AIS (NMEA)",
    )
    parser.add_argument(
        "--at",
        metavar="TIME",
        type=time_of,
        help="the time of the recording, such as 2020-04-07T21:42:00Z",
    )
    parser.add_argument(
        "--within",
        metavar="SOUTH,WEST,NORTH,EAST",
        type=corners,
        help="take only what is in this box, in degrees",
    )
    parser.add_argument("--kinds", metavar="KIND,...", help="only entities of these kinds")
    parser.add_argument(
        "--output",
        metavar="FILE",
        type=named,
        help="draw it too: a picture, .svg or .png; or write it for other programs as GeoJSON, .geojson (RFC 7946)",
    )


COMMAND = Command(
    "world",
    "print and draw the bigraph of places and recordings",
    DESCRIPTION,
    (
        "bigactors world harbour.geojson --output harbour.svg",
        "bigactors world harbour.geojson vessels.nmea --at 2020-04-07T21:42:00Z --kinds Vessel,Harbour",
        "bigactors world survey.plan harbour.geojson",
        "bigactors world vessels.nmea --at 2020-04-07T21:42:00Z --output vessels.geojson",
        "bigactors world vessels.nmea --within 52.83,5.66,52.87,5.72",
    ),
    fill,
)
