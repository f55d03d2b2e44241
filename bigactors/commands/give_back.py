"""`bigactors give-back`: return a vehicle, taken over or heard from another address, to a running mission."""

from argparse import Namespace
from typing import Final

from bigactors.arguments.options import add_socket, add_speaker
from bigactors.arguments.parser import Parser
from bigactors.arguments.values import named
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import say, tell

DESCRIPTION: Final = """\
Let a running mission command a vehicle again that a pilot, another station, a fail-safe, a reboot or an operator's
order (hold, return) has taken over, or that has refused a command. What it was told before it is told anew, in
whatever mode it is: look first. A vehicle on an unsigned link that sends from another address than before is believed
there only once you say so by --at; was it taken over, it stays so until it is given back."""

EXAMPLES: Final = ("bigactors give-back uav0", "bigactors give-back uav0 --at 192.168.1.7:14555")


def add_arguments(parser: Parser) -> None:
    """Add the arguments of `bigactors give-back`."""
    parser.add_argument("vehicle", metavar="VEHICLE", help="a vehicle of the running mission")
    parser.add_argument(
        "--at",
        metavar="HOST:PORT",
        type=named,
        help="do not command it again, but believe it there from now on: it is silent where it was heard before",
    )
    add_speaker(parser)
    add_socket(parser)


def run(options: Namespace) -> Exit:
    """Give the vehicle back, and print the answer."""
    from adapters.live.operator_socket import give_back
    from bigactors.sockets import check_texts, heard_at

    vehicle, at = options.vehicle, options.at or ""
    check_texts("a vehicle or an address", vehicle, options.by, at)
    refusal, _, notes = heard_at(options.socket, lambda path: give_back(path, vehicle, at, options.by))
    if refusal:
        raise Mistake(refusal, "`bigactors status` says which vehicles were taken over, or are silent")
    for note in notes:
        tell(note, "note:")
    say(f"{vehicle} is believed at {at} from now on" if at else f"{vehicle} is given back")
    return Exit.HOLDS
