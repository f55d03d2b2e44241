"""Measure the latency from telemetry to a committed rule: 100 vehicles at 10 Hz, 1,000 vessels at 1 Hz, one loop.

The vehicles are in the same process, as plugins that publish what a decoded message says: what is measured is the loop,
the rules and the recording. Beside the time that passed stands the processor time of turns, which other work on the
machine does not lengthen: a commit waits for a turn that is under way, gathers for 4 ms, and is made in the next.
`python -m benchmarks.live` prints the figures.
"""

import argparse
import asyncio
import os
import random
import tempfile
import time
from pathlib import Path
from typing import Any

from adapters.live.core import started
from adapters.live.loop import LiveRun, settle
from adapters.live.state import Heard, Plan, Turn
from adapters.plugin import Accepted, Aged, Command, GoTo, Report, World
from adapters.recording.writing import Recorder
from bigactors.terminal import say
from bigactors.watchers import Tape
from physical import PhysicalProperty, centroid, point
from semantics.state.setting import Control, Scheduler
from specs import Source
from specs.elaboration import Variation, elaborate
from specs.parser import parse

LANES = 10
RATE = 10.0


def mission_text(vehicles: int, vessels: int) -> str:
    """Return a mission in which each vehicle goes to and fro between two places of its lane."""
    places, movers, agents = [], [], []
    for lane in range(LANES):
        south, north = 37.0 + lane * 0.02, 37.015 + lane * 0.02
        places.append(f"  west{lane}: Location = box ({north:.3f}, -8.64) ({south:.3f}, -8.66)")
        places.append(f"  east{lane}: Location = box ({north:.3f}, -8.60) ({south:.3f}, -8.62)")
    for number in range(vehicles):
        lane = number % LANES
        at = f"point ({37.0075 + lane * 0.02:.4f}, -8.65)"
        movers.append(f"  uav{number}: UAV = {at} linked control:gcs0")
        agents.append(
            f"BigActor a{number} hosted_at uav{number} with_behavior {{ loop {{ control(MOVE_HOST_TO east{lane})\n"
            f" control(MOVE_HOST_TO west{lane})\n observe(CHILDREN(HOST))\n react {{ case seen => skip }} }} }}"
        )
    movers += [
        f"  boat{number}: Vessel = point ({37.0075 + number % LANES * 0.02:.4f}, -8.63)"
        for number in range(vessels)
    ]
    kinds = "kind Location contains Location, UAV, Vessel, Station kind UAV driven kind Vessel kind Station"
    world = "\n".join([*places, "  gcs0: Station = point (37.5, -8.6) linked control:gcs0", *movers])
    return f"signature {{ {kinds} }}\nworld {{\n{world}\n}}\n" + "\n".join(agents)


class Fleet:
    """Vehicles that are where they were sent after `flight` seconds, and say where they are at 10 Hz."""

    name = "fleet"

    def __init__(self, vehicles: int, flight: float) -> None:
        self.flight = flight
        self.at = {f"uav{n}": (37.0075 + n % LANES * 0.02, -8.65) for n in range(vehicles)}
        self.goals: dict[str, tuple[float, tuple[float, float]]] = {}
        self.arrived: dict[str, float] = {}
        self.published = 0
        self.random = random.Random(1)
        self.world: World | None = None

    async def run(self, world: World) -> None:
        """Publish until cancelled."""
        self.world = world
        names = list(self.at)
        start = asyncio.get_running_loop().time()
        sent = 0
        while True:
            due = int((asyncio.get_running_loop().time() - start) * RATE * len(names))
            for number in range(sent, due):
                self._say(world, names[number % len(names)])
            sent = max(sent, due)
            await asyncio.sleep(0.005)

    def _say(self, world: World, name: str) -> None:
        goal = self.goals.get(name)
        if goal is not None and time.perf_counter() >= goal[0]:
            self.at[name] = goal[1]
            del self.goals[name]
            self.arrived[name] = time.perf_counter()
        said = PhysicalProperty(
            name, "UAV", point(*self.at[name]), channels=("control:gcs0",), time=world.now(), source="fleet"
        )
        self.published += 1
        world.publish(Aged(said, 30.0))

    async def command(self, command: Command) -> None:
        """Set out for a place."""
        if isinstance(command, GoTo):
            goal = centroid(command.place).vertices[0]
            flight = self.flight * (0.75 + 0.5 * self.random.random())
            self.goals[command.entity] = (time.perf_counter() + flight, goal)
            assert self.world is not None
            self.world.report(Accepted(command.request, command.entity, self.world.now()))

    def owns(self, entity: str) -> bool:
        """Tell whether it is one of the fleet."""
        return entity in self.at


class Vessels:
    """Vessels at 1 Hz, a few of which the mission names; the others pass by outside of its places."""

    name = "ais"

    def __init__(self, count: int, named: int) -> None:
        self.count, self.named, self.published = count, named, 0

    async def run(self, world: World) -> None:
        """Publish until cancelled."""
        start = asyncio.get_running_loop().time()
        sent = 0
        while True:
            due = int((asyncio.get_running_loop().time() - start) * self.count)
            for number in range(sent, due):
                self._say(world, number % self.count, number // self.count)
            sent = max(sent, due)
            await asyncio.sleep(0.005)

    def _say(self, world: World, number: int, turn: int) -> None:
        name = f"boat{number}" if number < self.named else f"mmsi{number}"
        west = -8.63 if number < self.named else -8.9 - number * 1e-4
        at = point(37.0075 + number % LANES * 0.02 + turn % 100 * 1e-6, west)
        self.published += 1
        world.publish(Aged(PhysicalProperty(name, "Vessel", at, time=world.now(), source="ais"), 180.0))

    async def command(self, command: Command) -> None:
        """Refuse."""
        raise AssertionError(command)

    def owns(self, _entity: str) -> bool:
        """Tell that nobody is commanded here."""
        return False


class Stopwatch:
    """Takes the time from the arrival that was published to the commit that it allowed."""

    def __init__(self, fleet: Fleet) -> None:
        self.fleet, self.steps, self.broken = fleet, 0, 0
        self.delays: list[float] = []

    def arrived(self, heard: Heard, now: float) -> None:
        """Take no time."""

    def reported(self, report: Report, now: float) -> None:
        """Take no time."""

    def turned(self, turn: Turn, now: float) -> None:  # noqa: ARG002 - as watchers have it
        """Take the time of each commit."""
        self.steps += len(turn.steps)
        self.broken += sum(finding.kind == "broken assumption" for finding in turn.findings)
        for step in turn.steps:
            label = step.transition.label
            if label.rule == "commit":
                arrived = self.fleet.arrived.pop(f"uav{str(label.agent)[1:]}")
                self.delays.append(time.perf_counter() - arrived)


class TimedRun(LiveRun):
    """Takes the processor time of each turn."""

    def __init__(self, *settings: Any) -> None:
        super().__init__(*settings)
        self.busy: list[float] = []

    def _turn(self) -> Turn:
        before = time.process_time()
        turn = super()._turn()
        self.busy.append(time.process_time() - before)
        return turn


async def measure(
    vehicles: int, vessels: int, seconds: float, flight: float, *, record: bool
) -> dict[str, float]:
    """Run for some seconds and return the figures."""
    source = Source("live", mission_text(vehicles, 50))
    mission = elaborate(parse(source), source, Path(), Variation(Scheduler.FCFS, Control.TIMED, {}))
    plan = Plan(mission.initial, {f"uav{n}": "fleet" for n in range(vehicles)})
    fleet, ais = Fleet(vehicles, flight), Vessels(vessels, 50)
    watch = Stopwatch(fleet)
    with tempfile.TemporaryDirectory() as folder:
        watchers = [watch]
        if record:
            header = {"mission": "live", "text": source.text, "digest": "", "version": "", "verified": False}
            recorder = Recorder(Path(folder) / "live.mcap", {**header, "vehicles": {}}, time.time())
            watchers = [Tape(recorder, lambda _finding: ()), watch]
        async with TimedRun(plan, started(plan), [fleet, ais], watchers) as run:
            await run.begin(5.0)
            settle()
            before, began = time.process_time(), time.perf_counter()
            published = fleet.published + ais.published
            await run.go(seconds=seconds)
            busy, took = time.process_time() - before, time.perf_counter() - began
            published = fleet.published + ais.published - published
    delays = sorted(watch.delays)
    assert not watch.broken, "the mission holds: no assumption may break"
    return {
        "positions a second": published / took,
        "steps a second": watch.steps / took,
        "commits": len(delays),
        "median ms": delays[len(delays) // 2] * 1000,
        "99th percentile ms": delays[int(len(delays) * 0.99)] * 1000,
        "worst ms": delays[-1] * 1000,
        "99th p. of turns, CPU": sorted(run.busy)[int(len(run.busy) * 0.99)] * 1000,
        "load of one core": busy / took,
    }


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vehicles", type=int, default=100)
    parser.add_argument("--vessels", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--flight", type=float, default=3.0, help="how long each flight takes")
    parser.add_argument("--no-record", action="store_true")
    options = parser.parse_args()
    found = asyncio.run(
        measure(
            options.vehicles, options.vessels, options.seconds, options.flight, record=not options.no_record
        )
    )
    say(f"{options.vehicles} vehicles, {options.vessels} vessels, {os.cpu_count()} cores")
    for name, value in found.items():
        say(f"  {name:<22} {value:10.1f}")


if __name__ == "__main__":
    main()
