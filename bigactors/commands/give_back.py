"""`bigactors give-back`: return a vehicle, taken over or heard from another address, to a running mission."""

from argparse import Namespace
from typing import Final

from bigactors.arguments.options import SOCKET, SPEAKER
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import say, tell

DESCRIPTION: Final = """\
Let a running mission command a vehicle again after a take-over (by a pilot, another station, a fail-safe, a reboot or
an operator's order), or after a refused command. The mission sends its last command again, in whatever mode the vehicle
is: look first."""

EXAMPLES: Final = ("bigactors give-back uav0", "bigactors give-back uav0 --at 192.168.1.7:14555")

ARGUMENTS: Final = f"""\
  vehicle VEHICLE  a vehicle of the running mission
  --at HOST:PORT  accept the vehicle on an unsigned link at this address, instead of its silent old one, and do not
      command it again
{SPEAKER}
{SOCKET}"""


def run(options: Namespace) -> Exit:
    """Give the vehicle back, and print the answer."""
    from adapters.live.operator_socket import give_back
    from bigactors.sockets import check_texts, heard_at, speaker

    vehicle, at, by = options.vehicle, options.at or "", speaker(options.by)
    check_texts("a vehicle or an address", vehicle, by, at)
    refusal, _, notes = heard_at(options.socket, lambda path: give_back(path, vehicle, at, by))
    if refusal:
        raise Mistake(refusal, "`bigactors status` lists the vehicles that were taken over, or are silent")
    for note in notes:
        tell(note, "note:")
    say(f"{vehicle} is accepted at {at} from now on" if at else f"{vehicle} is given back")
    return Exit.HOLDS
