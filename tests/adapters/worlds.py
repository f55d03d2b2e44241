"""Simulated flights in a world that remembers: minutes of them in seconds, over real loopback sockets."""

import inspect
import os
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from functools import wraps
from pathlib import Path

import aiohttp.web
import pytest

from adapters.mavlink import Autopilot, Craft, Stations
from adapters.mavlink.keys import Keeper
from adapters.plugin import Accepted, Arrived, Refused, Rejected
from adapters.simulated import Disturbance, Kind, Simulator, Vehicle, run
from bigactors.testing import EPOCH, World, running, until
from physical import box, circle

ROOT = Path(__file__).parents[2]
DATA = Path(os.environ.get("BIGACTORS_DATA", ROOT.parent / "shared" / "data"))
NOTHING = Disturbance()

HOME = (37.0, -8.6, 20.0)
AREA = box((37.015, -8.61), (37.005, -8.625))
FIELD = circle((37.0, -8.6), 900)
TINY = circle((37.01, -8.61), 60)

ROUND = """
mission round
signature { kind Location contains Location, UAV, Station kind UAV driven kind Station }
world {
  home0: Location = circle (37.0, -8.6) radius 300 m
  mid0: Location = circle (37.015, -8.6) radius 300 m
  north0: Location = circle (37.03, -8.6) radius 300 m
  side0: Location = circle (37.015, -8.56) radius 300 m
  gcs0: Station = point (37.001, -8.601) linked control:gcs0
  uav0: UAV = point (37.0, -8.6) linked control:gcs0
}
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO north0)
  control(MOVE_HOST_TO mid0)
  control(MOVE_HOST_TO side0)
  control(MOVE_HOST_TO home0)
}
environment { uav0 arrives }
"""
"""The way back from north0 leads over mid0, and home is where the mission ends."""


@dataclass
class Flight:
    """A vehicle, its link, its plugin and the world that this is told to."""

    vehicle: Vehicle
    simulator: Simulator
    plugin: Autopilot
    world: World

    async def ended(self, request, seconds=600.0):
        """Wait for the report that ends a request."""
        ends = lambda: [*self.world.of(Arrived, request=request), *self.world.of(Rejected, request=request)]  # noqa: E731
        return (await until(ends, seconds))[0]

    async def does(self, command, seconds=600.0):
        """Tell a command, and wait for its end."""
        await self.plugin.command(command)
        return await self.ended(command.request, seconds)

    async def completes(self, command, seconds=600.0):
        end = await self.does(command, seconds)
        assert isinstance(end, Arrived), end
        return end

    async def rejects(self, command, seconds=600.0):
        end = await self.does(command, seconds)
        assert isinstance(end, Rejected), end
        return end

    async def refuses(self, command, why):
        with pytest.raises(Refused, match=why):
            await self.plugin.command(command)

    async def accepts(self, command):
        """Tell a command, and wait until the vehicle does it."""
        await self.plugin.command(command)
        await until(lambda: self.world.of(Accepted, request=command.request))


@asynccontextmanager
async def flight(
    kind=Kind.PLANE,
    disturbance=NOTHING,
    *,
    craft: Craft | None = None,
    stations: Stations | None = None,
    seed=0,
    key_file=None,
    tap=None,
    **vehicle,
) -> AsyncIterator[Flight]:
    world = World()
    keeper = Keeper(key_file) if key_file else None
    plugin = Autopilot("autopilot", "udp:127.0.0.1:0", [craft or Craft("uav0")], stations, keeper, tap)
    async with running(plugin.run(world)):
        await until(lambda: plugin.local)
        flown = Vehicle(kind, HOME, **vehicle)
        simulator = Simulator(f"udpout:127.0.0.1:{plugin.local[1]}", [flown], disturbance, seed, EPOCH)
        async with running(simulator.run()):
            yield Flight(flown, simulator, plugin, world)


@asynccontextmanager
async def answering(answer):
    """Serve a page over HTTP with what a function returns; yield its address."""
    application = aiohttp.web.Application()
    application.router.add_get("/", answer)
    runner = aiohttp.web.AppRunner(application, access_log=None)
    await runner.setup()
    await aiohttp.web.TCPSite(runner, "127.0.0.1", 0).start()
    try:
        yield f"http://127.0.0.1:{runner.addresses[0][1]}/"
    finally:
        await runner.cleanup()


def simulated(test):
    """Run a test, which is a coroutine, in simulated time."""

    @wraps(test)
    def runs(*given, **more):
        run(test(*given, **more))

    return runs


def flown(*fixed, by="", speed=None, **how):
    """Run a test in simulated time in a flight, its first argument; `by` names parameters that are the flight's."""

    def decorated(test):
        _, *own = inspect.signature(test).parameters
        names = dict.fromkeys([*own, *by.split()])

        async def main(given):
            async with flight(*fixed, **how, **{name: given[name] for name in by.split()}) as f:
                await test(f, **{name: given[name] for name in own})

        @wraps(test)
        def runs(**given):
            run(main(given), speed)

        keyword = inspect.Parameter.POSITIONAL_OR_KEYWORD
        runs.__signature__ = inspect.Signature([inspect.Parameter(name, keyword) for name in names])
        return runs

    return decorated
