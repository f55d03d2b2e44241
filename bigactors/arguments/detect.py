"""The arguments of `bigactors detect`."""

import argparse
from typing import Final

from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import named, seconds

DESCRIPTION: Final = """\
Find slicks on the sea in the frames of a camera, and print their polygons' areas and positions. SOURCE is a folder of
pictures with their poses (poses.csv), a video with its flight log (VIDEO.csv beside it), or a satellite's GeoTIFF."""


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors detect`."""
    parser.add_argument("source", metavar="SOURCE", type=named, help="a folder, a video or a GeoTIFF")
    parser.add_argument(
        "--fov", metavar="DEGREES", type=degrees, default=60.0, help="horizontal field of view (default: 60)"
    )
    parser.add_argument(
        "--mount",
        metavar="PITCH[,YAW[,ROLL]]",
        type=mount,
        default=(-90.0, 0.0, 0.0),
        help="the camera's angles to the vehicle: -90 (default) looks down, --mount=-60 30° forward of that",
    )
    parser.add_argument(
        "--level",
        action="store_true",
        help="a gimbal holds it level: the vehicle's roll and pitch play no part",
    )
    parser.add_argument(
        "--every",
        metavar="SECONDS",
        type=seconds,
        default=1.0,
        help="take a video's frame every so often (default: 1)",
    )
    parser.add_argument(
        "--detector",
        metavar="NAME",
        type=named,
        help="a detector of your own: MODULE:NAME of a function, or the name of an installed one",
    )
    parser.add_argument("--kind", default="OilSpill", help="what is found (default: OilSpill)")
    parser.add_argument(
        "--name", default="oilSpill", help="what it is called, with a number (default: oilSpill)"
    )
    parser.add_argument(
        "--output", metavar="FILE", type=named, help="write the polygons as GeoJSON (RFC 7946)"
    )
    parser.add_argument(
        "--pictures", metavar="FOLDER", type=named, help="draw what was found over each frame, as PNG, there"
    )


def degrees(text: str) -> float:
    """Parse an angle in degrees.

    >>> degrees("62.5")
    62.5
    """
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text:.40}' is no angle in degrees") from None


def mount(text: str) -> tuple[float, float, float]:
    """Parse PITCH[,YAW[,ROLL]] in degrees.

    >>> mount("-60"), mount("-45,90")
    ((-60.0, 0.0, 0.0), (-45.0, 90.0, 0.0))
    """
    given = [degrees(part) for part in text.split(",")]
    if len(given) > 3:
        raise argparse.ArgumentTypeError(f"'{text:.40}' is not PITCH[,YAW[,ROLL]], such as -60,0,0")
    pitch, yaw, roll = (*given, 0.0, 0.0)[:3]
    return pitch, yaw, roll


COMMAND = Command(
    "detect",
    "find slicks in a camera's frames",
    DESCRIPTION,
    (
        "bigactors detect flight1 --fov 62 --output spill.geojson --pictures looked",
        "bigactors detect flight1.mp4 --fov 78 --mount=-60 --every 0.5",
        "bigactors detect sentinel.tif --output spill.geojson",
    ),
    fill,
)
