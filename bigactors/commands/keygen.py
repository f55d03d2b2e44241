"""`bigactors keygen`: a key pair for signing verdicts."""

from argparse import Namespace
from pathlib import Path
from typing import Final

from bigactors.exits import Exit
from bigactors.terminal import say

DESCRIPTION: Final = """\
Write a new Ed25519 private key into FILE (PEM), readable by its owner only, and the public key into FILE.pub. The
private key has no passphrase: keep it only on the machine that signs verdicts."""

EXAMPLES: Final = (
    "bigactors keygen release.key",
    "bigactors check --control timed --verdict m.verdict.json --sign release.key m.mission",
)

ARGUMENTS: Final = """\
  file FILE as named  the file of the private key; the public key goes into FILE.pub"""


def run(options: Namespace) -> Exit:
    """Make the key pair, and print its paths."""
    from bigactors.signatures import fingerprint, load_trusted, new_pair

    public = new_pair(Path(options.file))
    say(f"{options.file}: the key to sign with (check --sign); keep it to yourself")
    say(f"{public}: the key that others trust (run --trust): {fingerprint(load_trusted(str(public)))}")
    return Exit.HOLDS
