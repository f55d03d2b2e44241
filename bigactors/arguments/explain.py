"""The arguments of `bigactors explain`."""

from bigactors.arguments.parser import Command, Parser


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors explain`."""
    parser.add_argument(
        "code", nargs="?", metavar="CODE", help="such as LS201; without it all codes are listed"
    )


COMMAND = Command(
    "explain",
    "explain a diagnostic code",
    "Say what a diagnostic code means and what to do about it.",
    ("bigactors explain LS201", "bigactors explain"),
    fill,
)
