# ruff: noqa: N999 - a command's module has the command's name
"""`bigactors return`: order a vehicle of a running mission, or all, to go home."""

from bigactors.commands.hold import run

__all__ = ["run"]
