"""The arguments of `bigactors say`."""

from getpass import getuser

from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import named


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors say`."""
    parser.add_argument("agent", metavar="AGENT", help="a bigActor of the running mission")
    parser.add_argument("message", metavar="MESSAGE", help="what its environment section says may be said")
    add_by(parser)
    add_socket(parser)


def add_by(parser: Parser) -> None:
    """Add the option for the speaker's name."""
    parser.add_argument(
        "--by", metavar="NAME", default=_login(), help="who says so, as it is recorded (default: your login)"
    )


def _login() -> str:
    """Return the user's login; empty if it is unknown."""
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
        help="where the mission listens (default: the only one that runs)",
    )


COMMAND = Command(
    "say",
    "say something to a bigActor of a running mission",
    "Put a message into the mailbox of a bigActor, as the mission's environment section says that someone may:\n"
    "what it does not say is refused, with what may be said instead.",
    ("bigactors say op handover", "bigactors say op handover --by Ana"),
    fill,
)
