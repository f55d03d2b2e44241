"""`bigactors hold`: a vehicle of a running mission, or all, stays where it is."""

from argparse import Namespace

from adapters.live.operator_socket import order
from bigactors.commands.say import check_texts, heard_at
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import say, tell


def run(options: Namespace) -> Exit:
    """Order it, and print what came of it; `return` is run by this, too."""
    what, vehicle = options.command, options.vehicle
    check_texts("a vehicle", vehicle or "", options.by)
    refusal, left_out, notes = heard_at(options.socket, lambda path: order(path, what, vehicle, options.by))
    if refusal:
        raise Mistake(refusal, "`bigactors status` says how the run stands")
    for note in (*left_out.values(), *notes):
        tell(note, "note:")
    say(f"told to {what}: {vehicle or 'all vehicles of this station'}; the run says when it is confirmed")
    return Exit.HOLDS
