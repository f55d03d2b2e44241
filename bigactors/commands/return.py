# ruff: noqa: N999 - commands are found by their names
"""`bigactors return`: a vehicle of a running mission, or all, goes home."""

from bigactors.commands.hold import run

__all__ = ["run"]
