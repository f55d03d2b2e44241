"""`bigactors keygen`: a key pair for signing verdicts."""

from argparse import Namespace
from pathlib import Path

from bigactors.exits import Exit
from bigactors.signatures import fingerprint, load_trusted, new_pair
from bigactors.terminal import say


def run(options: Namespace) -> Exit:
    """Make the key pair, and print its paths."""
    public = new_pair(Path(options.file))
    say(f"{options.file}: the key to sign with (check --sign); keep it to yourself")
    say(f"{public}: what others trust (run --trust): {fingerprint(load_trusted(str(public)))}")
    return Exit.HOLDS
