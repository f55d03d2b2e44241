"""The arguments of `bigactors give-back`."""

from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.say import add_socket


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors give-back`."""
    parser.add_argument("vehicle", metavar="VEHICLE", help="a vehicle of the running mission")
    add_socket(parser)


COMMAND = Command(
    "give-back",
    "give a vehicle that was taken over back to a running mission",
    "Let a running mission command a vehicle again that a pilot, another station, a fail-safe or a reboot has taken\n"
    "over, or that has refused a command. Its command is sent again, in whatever mode it is: check the vehicle first.",
    ("bigactors give-back uav0",),
    fill,
)
