"""The arguments of `bigactors keygen`."""

from bigactors.arguments.parser import Command, Parser
from bigactors.arguments.values import named


def fill(parser: Parser) -> None:
    """Add the arguments of `bigactors keygen`."""
    parser.add_argument(
        "file", metavar="FILE", type=named, help="where the key is written; FILE.pub is beside it"
    )


COMMAND = Command(
    "keygen",
    "make a key pair to sign verdicts with",
    "Write a new Ed25519 private key into FILE (PEM), readable by its owner only, and the public key into FILE.pub.\n"
    "It has no passphrase: keep it where verdicts are reached, and nowhere else.",
    (
        "bigactors keygen release.key",
        "bigactors check --control timed --verdict m.verdict.json --sign release.key m.mission",
        "bigactors run m.mission --trust release.key.pub --vehicle uav0=udp:127.0.0.1:14550",
    ),
    fill,
)
