"""The arguments of `bigactors give-back`."""

from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.say import add_socket
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
    add_socket(parser)


COMMAND = Command(
    "give-back",
    "give a vehicle back to a running mission: taken over, or heard elsewhere",
    "Let a running mission command a vehicle again that a pilot, another station, a fail-safe or a reboot has\n"
    "taken over, or that has refused a command. What it was told before it is told anew, in whatever mode it is:\n"
    "look first. A vehicle on an unsigned link that sends from another address than before is believed there only\n"
    "once you say so by --at; was it taken over, it stays so until it is given back.",
    ("bigactors give-back uav0", "bigactors give-back uav0 --at 192.168.1.7:14555"),
    fill,
)
