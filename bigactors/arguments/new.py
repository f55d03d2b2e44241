"""The arguments of `bigactors new`."""

from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import named


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors new`."""
    parser.add_argument(
        "name",
        metavar="NAME",
        type=named,
        help="the mission's name, or the path of its file; .mission may be left out",
    )


COMMAND = Command(
    "new",
    "write a first mission to begin with",
    "Write a small mission with comments into NAME.mission. It holds; a line in it says how to break it, and what is\n"
    "seen then. A file that exists is left alone.",
    ("bigactors new patrol", "bigactors new missions/patrol", "bigactors check --watch patrol.mission"),
    fill,
)
