"""`bigactors status`: the situation of a running mission."""

from argparse import Namespace
from typing import Final

from bigactors.arguments.options import SOCKET
from bigactors.exits import Exit
from bigactors.terminal import say

DESCRIPTION: Final = """\
Print the state of a running mission on one screen: the place, destination, mode and battery of each vehicle, and who
has taken it over; the pending requests; the messages that are permitted now."""

EXAMPLES: Final = ("bigactors status", "watch bigactors status")

ARGUMENTS: Final = SOCKET


def run(options: Namespace) -> Exit:
    """Request the situation, and print it."""
    from adapters.live.operator_socket import status
    from bigactors.sockets import heard_at

    for line in heard_at(options.socket, status).split("\n"):
        say(line)
    return Exit.HOLDS
