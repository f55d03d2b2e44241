"""The arguments of `bigactors say`."""

from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import named


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors say`."""
    parser.add_argument(
        "agent", metavar="AGENT", help="a bigActor of the running mission, or one of its vehicles"
    )
    parser.add_argument(
        "message",
        metavar="MESSAGE",
        help="a message that the environment section allows; for a vehicle 'is at HOST:PORT'",
    )
    add_socket(parser)


def add_socket(parser: Parser) -> None:
    """Add the option that says which running mission is meant."""
    parser.add_argument(
        "--socket",
        metavar="FILE",
        type=named,
        help="where the mission listens (default: the only one that runs)",
    )


COMMAND = Command(
    "say",
    "say something to a bigActor of a running mission",
    "Put a message into the mailbox of a bigActor, if the mission's environment section allows it; a refusal lists\n"
    "the allowed messages. For a vehicle on an unsigned link, give its new address once it is silent at the old one.",
    ("bigactors say op handover", "bigactors say uav0 'is at 192.168.1.7:14555'"),
    fill,
)
