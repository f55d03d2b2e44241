"""`bigactors give-back`: return a vehicle, taken over or heard from another address, to a running mission."""

from argparse import Namespace

from adapters.live.operator_socket import give_back
from bigactors.commands.say import check_texts, heard_at
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import say, tell


def run(options: Namespace) -> Exit:
    """Give the vehicle back, and print the answer."""
    vehicle, at = options.vehicle, options.at or ""
    check_texts("a vehicle or an address", vehicle, options.by, at)
    refusal, _, notes = heard_at(options.socket, lambda path: give_back(path, vehicle, at, options.by))
    if refusal:
        raise Mistake(refusal, "`bigactors status` says which vehicles were taken over, or are silent")
    for note in notes:
        tell(note, "note:")
    say(f"{vehicle} is believed at {at} from now on" if at else f"{vehicle} is given back")
    return Exit.HOLDS
