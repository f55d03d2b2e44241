"""Arguments, options and paragraphs of help that several commands share."""

import argparse
from typing import Final

from bigactors.arguments.parser import Parser
from bigactors.arguments.values import identity, named, seconds, size, substitute

EXITS: Final = """\
exit codes:
  0  every property holds
  1  a property is violated; a trace does not replay; a file would be formatted
  2  a mistake in the input
  3  incomplete: a bound was reached or the machine failed; nothing is decided beyond it
  4  a bug of bigactors

For several missions the gravest code counts: 4, then 2, 1, 3, 0."""

MISSION: Final = "a mission file, or the name of a shipped mission, such as oil_spill"


def add_variation(parser: Parser) -> None:
    """Add the options that replace parts of a mission."""
    group = parser.add_argument_group("replace parts of the mission")
    group.add_argument(
        "--scheduler",
        choices=("program_order", "unordered", "fcfs"),
        help="the order of requests (default: the mission's)",
    )
    group.add_argument(
        "--control",
        choices=("atomic", "timed"),
        help="controls are one step (atomic) or take time (timed; default: the mission's)",
    )
    add_source(group)


def add_source(parser: argparse._ActionsContainer) -> None:
    """Add the option that reads another file in the place of one that the mission names."""
    parser.add_argument(
        "--source",
        metavar="NAME=FILE",
        action="append",
        default=[],
        type=substitute,
        help='read FILE where the mission has from "NAME"; may be repeated',
    )


def add_foreign_names(parser: Parser) -> None:
    """Add the option that names the sources in a recording by other programs."""
    parser.add_argument(
        "--name",
        metavar="IDENTITY=NAME",
        action="append",
        default=[],
        type=identity,
        help="the mission's name of a source in another program's recording, such as mavlink:1=uav0 or "
        "mmsi:244660274=drifter0; may be repeated",
    )


def add_memory(parser: argparse._ActionsContainer) -> None:
    """Add the option that limits the memory of a search."""
    parser.add_argument(
        "--max-memory",
        metavar="SIZE",
        type=size,
        help="stop when the process or a worker takes more than SIZE bytes, such as 800M or 12G (default: no limit)",
    )


def add_checkpoints(parser: argparse._ActionsContainer) -> None:
    """Add the options that save a search and continue it."""
    parser.add_argument(
        "--checkpoint",
        metavar="DIR",
        type=named,
        help="save the search in DIR, regularly and at the end, so that --resume can continue it",
    )
    parser.add_argument(
        "--every",
        metavar="SECONDS",
        type=seconds,
        default=60.0,
        help="the time between two checkpoints (default: 60)",
    )
    parser.add_argument(
        "--resume", action="store_true", help="continue from the checkpoint in DIR, if there is one"
    )


def add_spill(parser: argparse._ActionsContainer, moved: str) -> None:
    """Add the option that continues a search in files when memory ends."""
    parser.add_argument(
        "--spill",
        metavar="DIR",
        type=named,
        help=f"when --max-memory is reached, move {moved} to unnamed temporary files in DIR, which should "
        "be on a disk",
    )


def add_speaker(parser: Parser) -> None:
    """Add the option for the name of the user who speaks to a running mission."""
    parser.add_argument(
        "--by", metavar="NAME", default=_login(), help="your name in the recording (default: your login)"
    )


def _login() -> str:
    """Return the user's login; empty if it is unknown."""
    from getpass import getuser  # noqa: PLC0415 - only commands that speak to a running mission need it

    try:
        return getuser()
    except (OSError, KeyError):
        return ""


def add_socket(parser: Parser) -> None:
    """Add the option that selects the running mission."""
    parser.add_argument(
        "--socket",
        metavar="FILE",
        type=named,
        help="the socket of the running mission (default: that of the only one)",
    )


def add_serving(parser: argparse._ActionsContainer) -> None:
    """Add the options for the console's map and its security."""
    parser.add_argument(
        "--tiles",
        metavar="FILE",
        type=named,
        help="a background map, as PMTiles: vector tiles of the Protomaps schema, or pictures (default: none)",
    )
    parser.add_argument(
        "--tls",
        metavar=("CERT", "KEY"),
        nargs=2,
        type=named,
        help="serve the console by HTTPS, with this certificate and its key (PEM)",
    )
    parser.add_argument(
        "--insecure",
        action="store_true",
        help="let other machines reach the console without --tls: the whole network can then read its token",
    )
