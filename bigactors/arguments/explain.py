"""The arguments of `bigactors explain`."""

from bigactors.arguments.parser import Command, Parser


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors explain`."""
    parser.add_argument(
        "code",
        nargs="*",
        metavar="CODE",
        help="a code such as LS201, or a word of a report such as stale-observation; without it all are listed",
    )


COMMAND = Command(
    "explain",
    "explain a diagnostic code, or a word of a report",
    "Say what a diagnostic code or a word of a report means, and what to do about it.",
    ("bigactors explain LS201", "bigactors explain stale-observation race", "bigactors explain"),
    fill,
)
