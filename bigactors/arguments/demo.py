"""The arguments of `bigactors demo`."""

from typing import Final

from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import named

DESCRIPTION: Final = """\
Check the oil spill of the paper and the watch over a harbour, print their verdicts, and write their
pictures and traces."""


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors demo`."""
    parser.add_argument(
        "--out", metavar="DIR", type=named, default="demo", help="where pictures and traces go (default demo)"
    )


COMMAND = Command(
    "demo",
    "check two missions that ship, and draw them",
    DESCRIPTION,
    ("bigactors demo --out demo",),
    fill,
)
