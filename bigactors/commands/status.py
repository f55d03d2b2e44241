"""`bigactors status`: how a running mission stands."""

from argparse import Namespace

from adapters.live.operator_socket import status
from bigactors.commands.say import heard_at
from bigactors.exits import Exit
from bigactors.terminal import say


def run(options: Namespace) -> Exit:
    """Ask, and print the answer."""
    for line in heard_at(options.socket, status).split("\n"):
        say(line)
    return Exit.HOLDS
