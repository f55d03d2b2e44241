"""A world that remembers, and simulated flights in it: minutes of them in seconds, over real loopback sockets."""

import asyncio
import os
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

from adapters.mavlink import Autopilot, Craft, Stations
from adapters.mavlink.keys import Keeper
from adapters.plugin import Aged, Arrived, Gone, Rejected, Trouble
from adapters.simulated import Disturbance, Kind, Simulator, Vehicle
from physical import box, circle

ROOT = Path(__file__).parents[2]
DATA = Path(os.environ.get("BIGACTORS_DATA", ROOT.parent / "shared" / "data"))
NOTHING = Disturbance()
EPOCH = 1_600_000_000.0

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
class World:
    """What plugins have told, in the event loop's time."""

    published: list = field(default_factory=list)
    reports: list = field(default_factory=list)

    def publish(self, published):
        self.published.append(published)

    def report(self, report):
        self.reports.append(report)

    def now(self):
        return EPOCH + asyncio.get_running_loop().time()

    def of(self, kind, **wanted):
        return [
            report
            for report in self.reports
            if isinstance(report, kind)
            and all(getattr(report, name) == value for name, value in wanted.items())
        ]

    def troubles(self):
        return {report.what for report in self.of(Trouble)}

    def property(self, entity):
        """The newest of an entity, or None."""
        for published in reversed(self.published):
            said = published.property if isinstance(published, Aged) else published
            if said.entity == entity:
                return None if isinstance(said, Gone) else said
        return None


async def until(what: Callable[[], object], seconds: float = 600.0, every: float = 0.2):
    """Wait until something holds; fail if it doesn't in time."""
    loop = asyncio.get_running_loop()
    end = loop.time() + seconds
    while not (found := what()):
        assert loop.time() < end, f"{what} did not come to hold in {seconds} s"
        await asyncio.sleep(every)
    return found


@asynccontextmanager
async def running(*coroutines) -> AsyncIterator[None]:
    """Run beside the test; what fails there fails the test."""
    tasks = [asyncio.ensure_future(coroutine) for coroutine in coroutines]
    try:
        yield
        for task in tasks:
            if task.done():
                task.result()
    finally:
        for task in tasks:
            task.cancel()
            with suppress(asyncio.CancelledError):
                await task


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
