"""A link to simulated vehicles within the run: both have one clock, so a rehearsal may be faster than life."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Sequence
from contextlib import suppress
from typing import Final

from adapters.mavlink.mavlink_plugin import Autopilot
from adapters.plugin import Command, World
from adapters.simulated.serving import Simulator
from adapters.simulated.simulated_vehicle import Vehicle

ADDRESS: Final = "udp:127.0.0.1:0"
"""The address at which the autopilot's link listens: a free port of this machine."""


class SimulatedLink:
    """A plugin: the link of an autopilot, with the vehicles at its other end.

    Attributes:
        plugin: The link; it speaks MAVLink with the vehicles over a socket.
    """

    def __init__(self, plugin: Autopilot, vehicles: Sequence[Vehicle]) -> None:
        self.plugin = plugin
        self._vehicles = vehicles

    @property
    def name(self) -> str:
        """The name of the link."""
        return self.plugin.name

    def owns(self, entity: str) -> bool:
        """Whether a vehicle is on the link."""
        return self.plugin.owns(entity)

    async def command(self, command: Command) -> None:
        """Take on a command; raises Refused."""
        await self.plugin.command(command)

    async def run(self, world: World) -> None:
        """Serve the link and fly its vehicles until cancelled."""
        flying = asyncio.ensure_future(self._fly())
        try:
            await self.plugin.run(world)
        finally:
            flying.cancel()
            with suppress(asyncio.CancelledError):
                await flying

    async def _fly(self) -> None:
        while self.plugin.local is None:
            await asyncio.sleep(0.05)
        epoch = time.time() - asyncio.get_running_loop().time()
        address = f"udpout:127.0.0.1:{self.plugin.local[1]}"
        await Simulator(address, self._vehicles, epoch=epoch).run()
