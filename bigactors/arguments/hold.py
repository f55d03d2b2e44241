"""The arguments of `bigactors hold`."""

from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.say import add_by, add_socket


def fill(parser: Parser) -> None:
    """Add the arguments of an order, `hold` or `return`."""
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("vehicle", metavar="VEHICLE", nargs="?", help="a vehicle of the running mission")
    which.add_argument(
        "--all",
        action="store_true",
        help="every vehicle that this station commands, but for those that others have taken over",
    )
    add_by(parser)
    add_socket(parser)


ORDER = """\
It is told at once, and the mission commands it no more until `bigactors give-back VEHICLE`: what agents ask of it
stays pending, all else goes on, and nothing that it does is an arrival. A vehicle that a pilot or a fail-safe has taken
over is overruled only by its own name. One that is not heard is told as soon as it is; one that obeys another station
is ordered there. The answer of the vehicle is awaited for 10 s: the exit code is 0 once it shows that it does it, 1 if
it refuses, and 3 if neither is known. What is refused is told again until it is done, and the run says when."""

COMMAND = Command(
    "hold",
    "order a vehicle of a running mission, or all, to stay where it is",
    f"Order a vehicle to stay where it is, as well as it can: a plane circles.\n{ORDER}",
    ("bigactors hold uav0", "bigactors hold --all --by Ana"),
    fill,
)
