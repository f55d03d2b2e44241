"""Keys on disk: a signing key with its newest time stamps, shared by all links that sign with it.

`python -m adapters.mavlink.keys FILE` makes one of a passphrase, as ground stations do.
"""

from __future__ import annotations

import argparse
import sys
from getpass import getpass
from pathlib import Path

from adapters.mavlink import signing
from adapters.mavlink.message import Message
from adapters.mavlink.signing import Signing, Verdict


class Keeper:
    """Signs, judges signatures, and keeps what must not be forgotten between two runs.

    Raises PhysicalError where the file is no such state.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._signing = signing.load(path)

    @property
    def key(self) -> bytes:
        """The key."""
        return self._signing.key

    def judge(self, message: Message) -> Verdict:
        """Judge one packet by its frame, and remember its time stamp."""
        self._signing, verdict = signing.check(self._signing, message)
        return verdict

    def stamp(self, now: float) -> int:
        """Return the time stamp to send with."""
        self._signing = signing.stamp(self._signing, now)
        return self._signing.timestamp

    def save(self) -> None:
        """Write it to its file."""
        signing.save(self._signing, self._path)


def main() -> int:
    """Make a key file; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m adapters.mavlink.keys", description=__doc__)
    parser.add_argument("file", type=Path)
    path: Path = parser.parse_args().file
    if path.exists():
        parser.error(f"{path} is there already: its time stamps would be lost")
    passphrase = getpass("passphrase: ") if sys.stdin.isatty() else sys.stdin.readline().rstrip("\n")
    if not passphrase:
        parser.error("the passphrase is empty")
    try:
        signing.save(Signing(signing.new_key(passphrase)), path)
    except OSError as error:
        parser.error(f"{path}: {error.strerror or error}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
