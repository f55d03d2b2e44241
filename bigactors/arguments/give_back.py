"""The arguments of `bigactors give-back`."""

from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.say import add_by, add_socket
from bigactors.arguments.values import named


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors give-back`."""
    parser.add_argument("vehicle", metavar="VEHICLE", help="a vehicle of the running mission")
    parser.add_argument(
        "--at",
        metavar="HOST:PORT",
        type=named,
        help="do not command it again, but believe it there from now on: it is silent where it was heard before",
    )
    add_by(parser)
    add_socket(parser)


COMMAND = Command(
    "give-back",
    "give a vehicle back to a running mission: taken over, or heard elsewhere",
    "Let a running mission command a vehicle again that a pilot, another station, a fail-safe, a reboot or an\n"
    "operator's order (hold, return) has taken over, or that has refused a command. What it was told before it is\n"
    "told anew, in whatever mode it is: look first. A vehicle on an unsigned link that sends from another address\n"
    "than before is believed there only once you say so by --at; was it taken over, it stays so until it is given\n"
    "back.",
    ("bigactors give-back uav0", "bigactors give-back uav0 --at 192.168.1.7:14555"),
    fill,
)
