"""Make a signing key from a passphrase, as ground stations do: `python -m bigactors.adapters.mavlink.new_key FILE`."""

from __future__ import annotations

import argparse
import sys
from getpass import getpass
from pathlib import Path

from adapters.mavlink import signing
from adapters.mavlink.signing import Signing


def main() -> int:
    """Make a key file; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m bigactors.adapters.mavlink.new_key", description=__doc__)
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
