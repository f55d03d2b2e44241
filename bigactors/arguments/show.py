"""The arguments of `bigactors show`."""

from bigactors.arguments.common import MISSION, varying
from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import at_least_zero, named


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors show`."""
    parser.add_argument("file", nargs="?", metavar="FILE", help=f"{MISSION}; with --trace it may be left out")
    parser.add_argument(
        "--output",
        metavar="FILE",
        type=named,
        help="the picture, .svg or .png (default: the mission's name .svg, here)",
    )
    parser.add_argument(
        "--trace", metavar="TRACE", type=named, help="a trace in JSON, as check --trace and simulate write it"
    )
    parser.add_argument(
        "--step",
        metavar="K",
        type=at_least_zero,
        help="show c_K of the trace (default: its last configuration)",
    )
    varying(parser)


COMMAND = Command(
    "show",
    "print and draw a configuration",
    "Print the initial configuration of a mission, or any one of a trace; draw its bigraph beside the map.",
    (
        "bigactors show oil_spill.mission --output oil_spill.png",
        "bigactors show oil_spill.mission --trace run.json --step 3",
    ),
    fill,
)
