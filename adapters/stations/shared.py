"""A plugin of a station: whatever it publishes, and is told to do, is told to the station, which tells all."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from adapters.plugin import Command, Plugin, Published, Report, World


class Station(Protocol):
    """Who shares."""

    def publish(self, plugin: Plugin, world: World, published: Published) -> None:
        """Take what a plugin publishes."""

    def commanded(self, command: Command) -> None:
        """Take note of what a plugin was told."""


@dataclass(frozen=True, slots=True)
class Shared:
    """A plugin whose world is that of all stations."""

    plugin: Plugin
    station: Station

    @property
    def name(self) -> str:
        """What reports call it."""
        return self.plugin.name

    def owns(self, entity: str) -> bool:
        """Whether the entity takes commands from it."""
        return self.plugin.owns(entity)

    async def command(self, command: Command) -> None:
        """Hand on a command."""
        self.station.commanded(command)
        await self.plugin.command(command)

    async def run(self, world: World) -> None:
        """Publish until cancelled."""
        await self.plugin.run(SharedWorld(world, self))


@dataclass(frozen=True, slots=True)
class SharedWorld:
    """The world of a plugin at a station."""

    world: World
    shared: Shared

    def publish(self, published: Published) -> None:
        """Take what is known of an entity now."""
        self.shared.station.publish(self.shared.plugin, self.world, published)

    def now(self) -> float:
        """Return the time."""
        return self.world.now()

    def report(self, report: Report) -> None:
        """Take a report."""
        self.world.report(report)
