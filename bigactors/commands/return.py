# ruff: noqa: N999 - a command's module has the command's name
"""`bigactors return`: order a vehicle of a running mission, or all, to go home."""

from typing import Final

from bigactors.commands.hold import ORDER, add_arguments, run

__all__ = ["DESCRIPTION", "EXAMPLES", "add_arguments", "run"]

DESCRIPTION: Final = f"""\
Order a vehicle to return to its own home, in its mode RTL.
{ORDER}"""

EXAMPLES: Final = ("bigactors return uav0", "bigactors return --all --by Ana")
