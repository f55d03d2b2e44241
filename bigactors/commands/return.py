# ruff: noqa: N999 - a command's module has the command's name
"""`bigactors return`: order a vehicle of a running mission, or all, to go home."""

from typing import Final

from bigactors.commands.hold import ARGUMENTS, run

__all__ = ["ARGUMENTS", "DESCRIPTION", "EXAMPLES", "run"]

DESCRIPTION: Final = """\
Order a vehicle to return to its own home, in its mode RTL. From then on the mission does not command it until
`bigactors give-back VEHICLE`. `bigactors hold --help` has the rest, which is the same for both orders."""

EXAMPLES: Final = ("bigactors return uav0", "bigactors return --all --by Ana")
