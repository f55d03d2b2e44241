"""The arguments of `bigactors plugins`."""

from bigactors.arguments.parser import Command, Parser


def fill(_parser: Parser) -> None:
    """Add nothing: it has no arguments."""


COMMAND = Command(
    "plugins",
    "list the plugins of vehicles and feeds that are installed",
    "List how `bigactors run` can be connected: what --vehicle and --feed take, which package has it, in which "
    "version, and what the package says of itself. No plugin is loaded for that.",
    ("bigactors plugins",),
    fill,
)
