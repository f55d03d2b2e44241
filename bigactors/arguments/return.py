# ruff: noqa: N999 - a command's module has the command's name
"""The arguments of `bigactors return`."""

from bigactors.arguments.hold import ORDER, fill
from bigactors.arguments.parser import Command

COMMAND = Command(
    "return",
    "order a vehicle of a running mission, or all, to go home",
    f"Order a vehicle to go to its own home, in its own way (RTL).\n{ORDER}",
    ("bigactors return uav0", "bigactors return --all --by Ana"),
    fill,
)
