"""`bigactors give-back`: a vehicle that was taken over, back to a running mission."""

from argparse import Namespace

from adapters.live.operator_socket import give_back
from bigactors.commands.say import heard_at
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import say


def run(options: Namespace) -> Exit:
    """Give it back, and print what came of it."""
    refusal = heard_at(options.socket, lambda path: give_back(path, options.vehicle))
    if refusal:
        raise Mistake(refusal, "the mission says which vehicles were taken over")
    say(f"{options.vehicle} is given back")
    return Exit.HOLDS
