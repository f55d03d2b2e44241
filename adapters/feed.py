"""What plugins have in common that only hear: nobody is theirs to command."""

from __future__ import annotations

from adapters.plugin import Command, Refused


class Feed:
    """A plugin that takes no commands.

    Arguments:
        name: Its name in reports.
        heard: How it comes to know of entities, said of one: "was detected".
    """

    def __init__(self, name: str, heard: str) -> None:
        self._name = name
        self._heard = heard

    @property
    def name(self) -> str:
        """What reports call it."""
        return self._name

    def owns(self, entity: str) -> bool:  # noqa: ARG002 - a plugin's interface
        """Nobody is owned by whom he is only heard."""
        return False

    async def command(self, command: Command) -> None:
        """Refuse."""
        raise Refused(f"{command.entity} {self._heard}, and takes no commands")
