"""`bigactors say`: send a message to a bigActor of a running mission."""

from argparse import Namespace
from typing import Final

from bigactors.arguments.options import SOCKET, SPEAKER
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import say

DESCRIPTION: Final = """\
Put a message into the mailbox of a bigActor. The mission's environment section lists the permitted messages; any
other message is refused, and the permitted ones are printed."""

EXAMPLES: Final = ("bigactors say op handover", "bigactors say op handover --by Ana")

ARGUMENTS: Final = f"""\
  agent AGENT  a bigActor of the running mission
  message MESSAGE  a message that the environment section of the mission permits
{SPEAKER}
{SOCKET}"""


def run(options: Namespace) -> Exit:
    """Send the message, and print the answer."""
    from adapters.live.operator_socket import say as send
    from bigactors.sockets import check_texts, heard_at, speaker

    by = speaker(options.by)
    check_texts("a message", options.agent, by, options.message)
    refusal = heard_at(options.socket, lambda path: send(path, options.agent, options.message, by))
    if refusal:
        raise Mistake(refusal, "the environment section of the mission lists the permitted messages")
    say(f"said to {options.agent}: {options.message}")
    return Exit.HOLDS
