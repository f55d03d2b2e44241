"""The options of commands that serve a console."""

import argparse
from typing import Final

from bigactors.arguments.parser import Parser
from bigactors.arguments.values import named

ANYWHERE: Final = ("", 0)
"""The value of `--console` without an address: this machine only, at the usual port or a free one."""


def place(word: str) -> tuple[str, int]:
    """Parse [HOST:]PORT.

    >>> place("8765"), place("0.0.0.0:8765"), place("[::1]:0")
    (('127.0.0.1', 8765), ('0.0.0.0', 8765), ('::1', 0))
    """
    host, _, port = word.rpartition(":")
    if not (port.isascii() and port.isdigit() and int(port) < 65_536):
        raise argparse.ArgumentTypeError(f"'{word:.60}' is not [HOST:]PORT, such as 8765 or 0.0.0.0:8765")
    return host.removeprefix("[").removesuffix("]") or "127.0.0.1", int(port)


def add_serving(parser: Parser) -> None:
    """Add the options for the console's map and its security."""
    parser.add_argument(
        "--tiles",
        metavar="FILE",
        type=named,
        help="a map to draw under the console's chart, as PMTiles (vector tiles of the Protomaps schema, or pictures)",
    )
    parser.add_argument(
        "--tls",
        metavar=("CERT", "KEY"),
        nargs=2,
        type=named,
        help="serve the console by https, with this certificate and its key (PEM)",
    )
    parser.add_argument(
        "--insecure",
        action="store_true",
        help="let the console listen for other machines without --tls: whoever reads the network can act",
    )
