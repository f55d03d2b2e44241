"""`bigactors completion`: a script by which a shell completes command lines."""

from argparse import Namespace

from bigactors.completion import script
from bigactors.exits import Exit
from bigactors.terminal import say_text


def run(options: Namespace) -> Exit:
    """Print the script for a shell."""
    say_text(script(options.shell))
    return Exit.HOLDS
