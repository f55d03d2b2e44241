"""A station's own plugin, wrapped: the station shares its publications and commands with all others."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from typing import Final, Protocol

from adapters.plugin import Command, Plugin, Published, Refused, Rejected, Report, World
from adapters.stations.authority import LASTING

LOOK: Final = 0.1
"""Seconds between two checks whether a link has read its vehicle's authority."""


class Station(Protocol):
    """The interface of a station to its shared plugins."""

    def publish(self, plugin: Plugin, world: World, published: Published) -> None:
        """Take a plugin's publication."""

    def commanded(self, command: Command) -> None:
        """Record a command to a plugin."""

    def lags(self, entity: str) -> bool:
        """Return whether a vehicle obeys us, and our link has not read it yet."""


class Shared:
    """A plugin whose world is that of all stations."""

    def __init__(self, plugin: Plugin, station: Station) -> None:
        self.plugin = plugin
        self.station = station
        self._world: World | None = None
        self._waiting: set[asyncio.Task[None]] = set()

    @property
    def name(self) -> str:
        """Its name in reports."""
        return self.plugin.name

    def owns(self, entity: str) -> bool:
        """Whether the entity takes commands from it."""
        return self.plugin.owns(entity)

    async def command(self, command: Command) -> None:
        """Pass on a command, as soon as the link knows that the vehicle was handed to us."""
        self.station.commanded(command)
        if not self.station.lags(command.entity):
            await self.plugin.command(command)
            return
        task = asyncio.create_task(self._command_later(command))
        self._waiting.add(task)
        task.add_done_callback(self._waiting.discard)

    async def _command_later(self, command: Command) -> None:
        for _ in range(round(LASTING / LOOK)):
            await asyncio.sleep(LOOK)
            if not self.station.lags(command.entity):
                break
        try:
            await self.plugin.command(command)
        except Refused as refused:
            if self._world is not None:
                now = self._world.now()
                self._world.report(Rejected(command.request, command.entity, now, refused.reason))

    async def run(self, world: World) -> None:
        """Publish until cancelled."""
        self._world = world
        try:
            await self.plugin.run(SharedWorld(world, self))
        finally:
            for task in self._waiting:
                task.cancel()


@dataclass(frozen=True, slots=True)
class SharedWorld:
    """The world of a plugin at a station."""

    world: World
    shared: Shared

    def publish(self, published: Published) -> None:
        """Take a publication on an entity."""
        self.shared.station.publish(self.shared.plugin, self.world, published)

    def now(self) -> float:
        """Return the time."""
        return self.world.now()

    def report(self, report: Report) -> None:
        """Take a report."""
        self.world.report(report)
