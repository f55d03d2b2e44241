"""`bigactors status`: the situation of a running mission."""

from argparse import Namespace

from adapters.live.operator_socket import status
from bigactors.commands.say import heard_at
from bigactors.exits import Exit
from bigactors.terminal import say


def run(options: Namespace) -> Exit:
    """Request the situation, and print it."""
    for line in heard_at(options.socket, status).split("\n"):
        say(line)
    return Exit.HOLDS
