"""The common part of plugins that only listen: they command no entity, and take long lists in slices."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterable
from typing import Final, TypeVar

from adapters.plugin import Command, Refused


class Feed:
    """A plugin that takes no commands.

    Arguments:
        name: Its name in reports.
        heard: Its source of entities, as a predicate for messages: "was detected".
    """

    def __init__(self, name: str, heard: str) -> None:
        self._name = name
        self._heard = heard

    @property
    def name(self) -> str:
        """Its name in reports."""
        return self._name

    def owns(self, entity: str) -> bool:  # noqa: ARG002 - a plugin's interface
        """Return False: a feed takes no commands for any entity."""
        return False

    async def command(self, command: Command) -> None:
        """Refuse the command."""
        raise Refused(f"{command.entity} {self._heard}, and takes no commands")


AT_ONCE: Final = 50

Item = TypeVar("Item")


async def in_slices(items: Iterable[Item]) -> AsyncIterator[Item]:
    """Yield the items, and let the event loop continue after every 50 of them."""
    for number, item in enumerate(items, 1):
        yield item
        if number % AT_ONCE == 0:
            await asyncio.sleep(0)
