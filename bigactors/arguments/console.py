"""The arguments of `bigactors console`."""

import argparse

from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.serving import add_serving, place
from bigactors.arguments.values import named

DESCRIPTION = """\
Serve the operator's console of a recording: the map beside the bigraph, a card for each vehicle, what was found wrong,
and a time line that can be played. `bigactors run --console` serves it of a run, and its operators can act.

It prints a link with a token, and ends with Ctrl-C. docs/how-to/console.md shows it."""


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors console`."""
    parser.add_argument("recording", metavar="RECORDING", help="a recording, as run --record writes it")
    parser.add_argument(
        "--listen",
        metavar="[HOST:]PORT",
        type=place,
        help="where to listen (default: this machine only, port 8765 or a free one)",
    )
    parser.add_argument(
        "--follow", action="store_true", help="the recording is still being written: show the newest moment"
    )
    parser.add_argument(
        "--socket",
        metavar="FILE",
        type=named,
        help="the run's socket, by which operators may act; needs --follow",
    )
    # Only for `run --console`: whether the run keeps its recording.
    parser.add_argument("--beside", choices=["kept", "unkept"], help=argparse.SUPPRESS)
    add_serving(parser)


COMMAND = Command(
    "console",
    "show a recording, or a run, beside its map in the browser",
    DESCRIPTION,
    (
        "bigactors console run.mcap",
        "bigactors console run.mcap --follow",
        "bigactors console run.mcap --listen 0.0.0.0:8765 --tls cert.pem key.pem --tiles portimao.pmtiles",
    ),
    fill,
)
