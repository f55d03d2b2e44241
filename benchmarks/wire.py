"""Measure the latency from a telemetry packet in our socket to the committed rule, decoding included.

A hundred simulated vehicles, which speak MAVLink at 10 Hz, and a receiver that sends a thousand AIS positions a second
are another process; here run the autopilot plugin, the AIS plugin, the loop, the rules and the recording. The clock is
the system's, which says of each packet when it arrived. The time since it was sent, by the vehicle's own clock, is told
too: it includes what the simulators wait for the processor. `python -m benchmarks.wire`; with `--parts` it prints where
the time goes instead (`benchmarks.parts`).
"""

import argparse
import asyncio
import fcntl
import os
import socket
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from pathlib import Path
from typing import Any, Final

from pyais.encode import encode_dict

from adapters.ais import AisFeed
from adapters.live.batch import Heard
from adapters.live.core import started
from adapters.live.loop import LiveRun, settle
from adapters.live.plan import Plan
from adapters.live.turn_result import Turn
from adapters.mavlink import Autopilot, Craft
from adapters.mavlink.message import MavlinkMessage
from adapters.naming import NamingService
from adapters.plugin import Aged, Command, GoTo, Report
from adapters.recording.writing import Recorder
from adapters.simulated import Kind, Simulator, Vehicle
from adapters.transport import Remote
from benchmarks.parts import Parts
from bigactors import __version__
from bigactors.flight_watchers import Tape
from bigactors.mission_lookup import digest_of
from bigactors.terminal import say
from physical import Geometry, contains
from semantics.state.setting import Control, Scheduler
from specs import Source
from specs.elaboration import Variation, elaborate
from specs.parser import parse

WARM_UP = 45.0
"""Seconds for booting, arming and taking off."""

RATE = 10.0
LANES = 10
GROUPS = 10
"""Vehicles send in as many groups, one after the other in each tenth of a second."""

APART = 100
"""Vehicles that begin each 0.7 m east of the one before: 0.07 s of flight."""

SIOCGSTAMP: Final = 0x8906
"""Linux' question for the time of the datagram that was read last."""

NAMED = 50
"""Vessels that the mission names; the others pass by outside of its places."""


def mission_text(vehicles: int) -> str:
    """Return a mission in which each vehicle goes to and fro between two places of its lane, 90 m apart."""
    places, movers, agents = [], [], []
    for lane in range(LANES):
        south, north = 37.0 + lane * 0.002, 37.0015 + lane * 0.002
        places.append(f"  west{lane}: Location = box ({north:.4f}, -8.649) ({south:.4f}, -8.650)")
        places.append(f"  east{lane}: Location = box ({north:.4f}, -8.647) ({south:.4f}, -8.648)")
    for number in range(vehicles):
        latitude, longitude = home(number)
        lane = number % LANES
        movers.append(f"  uav{number}: UAV = point ({latitude:.5f}, {longitude:.5f}) linked control:gcs0")
        agents.append(
            f"BigActor a{number} hosted_at uav{number} with_behavior {{ loop {{ control(MOVE_HOST_TO east{lane})\n"
            f" control(MOVE_HOST_TO west{lane})\n observe(CHILDREN(HOST))\n react {{ case seen => skip }} }} }}"
        )
    boats = [berth(number) for number in range(NAMED)]
    movers += [
        f"  boat{number}: Vessel = point ({at[0]:.4f}, {at[1]:.4f})" for number, at in enumerate(boats)
    ]
    kinds = "kind Location contains Location, UAV, Vessel, Station kind UAV driven kind Vessel kind Station"
    world = "\n".join([*places, "  gcs0: Station = point (37.5, -8.6) linked control:gcs0", *movers])
    return f"signature {{ {kinds} }}\nworld {{\n{world}\n}}\n" + "\n".join(agents)


def home(number: int) -> tuple[float, float]:
    """Return where a vehicle begins: in the west of its lane; no two together, so that not all arrive at once."""
    return 37.00075 + number % LANES * 0.002, -8.6499 + number % APART * 0.000008


def berth(number: int) -> tuple[float, float]:
    """Return where a vessel lies."""
    return 37.0 + number % LANES * 0.02, -8.63 if number < NAMED else -8.9 - number * 1e-4


def mmsi(number: int) -> int:
    """Return the number of a vessel."""
    return 244_000_001 + number


# --- the other process ------------------------------------------------------------------------------------------


async def simulate(vehicles: int, vessels: int, link: int, receiver: int) -> None:
    """Fly vehicles and send AIS until killed; print when the vehicles' clock began, on the system's clock."""
    start = asyncio.get_running_loop().time()
    sys.stdout.write(f"{start}\n")
    sys.stdout.flush()
    settle()
    groups = [range(first, vehicles, GROUPS) for first in range(min(GROUPS, vehicles))]
    await asyncio.gather(_send_ais(vessels, receiver), *(_fly(group, link, start) for group in groups))


async def _fly(group: range, link: int, start: float) -> None:
    await asyncio.sleep(group.start / GROUPS / RATE)
    flown = [Vehicle(Kind.COPTER, (*home(number), 20.0), number + 1) for number in group]
    simulator = Simulator(f"udpout:127.0.0.1:{link}", flown, epoch=-start)
    running = asyncio.ensure_future(simulator.run())
    while simulator.local is None:
        await asyncio.sleep(0.01)
    for vehicle in flown:
        vehicle.booted = 0.0  # so that all their clocks say how long this process has run
        simulator.every(vehicle.system, "GLOBAL_POSITION_INT", 1 / RATE)
    await running


async def _send_ais(vessels: int, receiver: int) -> None:
    lines = [_sentence(number) for number in range(vessels)]
    began, sent = asyncio.get_running_loop().time(), 0
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        while True:
            due = int((asyncio.get_running_loop().time() - began) * vessels)
            for number in range(sent, due):
                link.sendto(lines[number % vessels], ("127.0.0.1", receiver))
            sent = due
            await asyncio.sleep(0.005)


def _sentence(number: int) -> bytes:
    latitude, longitude = berth(number)
    said = {"lat": latitude, "lon": longitude, "speed": 0, "course": 0, "heading": 511}
    (line,) = encode_dict({"type": 1, "mmsi": mmsi(number), **said}, talker_id="AI", sentence_type="VDM")
    return f"{line}\r\n".encode()


# --- this process -----------------------------------------------------------------------------------------------


class Link(Autopilot):
    """The plugin, which remembers when each vehicle's last position was sent and came, and where it was told to go."""

    start = 0.0
    arrived = 0.0

    def __init__(self, crafts: list[Craft]) -> None:
        super().__init__("fleet", "udp:127.0.0.1:0", crafts)
        self.sent: dict[int, tuple[float, float]] = {}
        self.goals: dict[str, Geometry] = {}

    def _receive(self, remote: Remote, data: bytes) -> None:
        self.arrived = _arrival(self._port)
        super()._receive(remote, data)

    def _hear(self, remote: Remote, message: MavlinkMessage) -> None:
        if message.name == "GLOBAL_POSITION_INT":
            self.sent[message.system] = self.start + message["time_boot_ms"] / 1000, self.arrived
        super()._hear(remote, message)

    async def command(self, command: Command) -> None:
        """Remember where a vehicle goes, and tell it."""
        if isinstance(command, GoTo):
            self.goals[command.entity] = command.place
        await super().command(command)


def _arrival(port: Any) -> float:
    """Return when the system took the datagram that was read last, by the monotonic clock."""
    seconds: int
    parts: int
    try:
        seconds, parts = struct.unpack("ll", fcntl.ioctl(port._link, SIOCGSTAMP, bytes(16)))  # noqa: SLF001 - its socket
    except OSError:  # the first one: from now on it is told
        return time.monotonic()
    return time.monotonic() - (time.time() - seconds - parts / 1e6)


class Stopwatch:
    """Takes the time from the first position in the place that was sent to the commit that it allowed."""

    def __init__(self, link: Link) -> None:
        self.link, self.steps, self.broken, self.heard = link, 0, 0, 0
        self.arrived_at: dict[str, tuple[float, float]] = {}
        self.delays: list[float] = []
        self.since_sent: list[float] = []

    def arrived(self, heard: Heard, now: float) -> None:  # noqa: ARG002 - as watchers have it
        """Take the time of the first position in the place that a vehicle goes to."""
        self.heard += 1
        published = heard.published
        if heard.plugin != "fleet" or not isinstance(published, Aged):
            return
        entity, goal = published.property.entity, self.link.goals.get(published.property.entity)
        if goal is not None and entity not in self.arrived_at and contains(goal, published.property.geometry):
            self.arrived_at[entity] = self.link.sent[int(entity[3:]) + 1]

    def reported(self, report: Report, now: float) -> None:
        """Take no time."""

    def turned(self, turn: Turn, now: float) -> None:  # noqa: ARG002 - as watchers have it
        """Take the time of each commit."""
        self.steps += len(turn.steps)
        self.broken += sum(finding.kind == "broken assumption" for finding in turn.findings)
        for step in turn.steps:
            if step.transition.label.rule == "commit":
                entity = f"uav{str(step.transition.label.agent)[1:]}"
                self.link.goals.pop(entity, None)
                sent, arrived = self.arrived_at.pop(entity)
                self.delays.append(time.monotonic() - arrived)
                self.since_sent.append(time.monotonic() - sent)


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


@asynccontextmanager
async def flown(vehicles: int, vessels: int, recording: Path) -> AsyncIterator[tuple[TimedRun, Stopwatch]]:
    """Yield a run whose vehicles have taken off; its recording is closed when it is left."""
    source = Source("wire", mission_text(vehicles))
    mission = elaborate(parse(source), source, Path(), Variation(Scheduler.FCFS, Control.TIMED, {}))
    plan = Plan(mission.initial, {f"uav{number}": "fleet" for number in range(vehicles)})
    link = Link([Craft(f"uav{number}", "UAV", number + 1) for number in range(vehicles)])
    table = {f"mmsi:{mmsi(number)}": f"boat{number}" for number in range(NAMED)}
    ais, watch = AisFeed("ais", "udp:127.0.0.1:0", NamingService(table)), Stopwatch(link)
    header = {"mission": "wire", "text": source.text, "digest": digest_of(mission), "version": __version__}
    header |= {"verified": False, "vehicles": dict(plan.vehicles)}
    async with AsyncExitStack() as stack:
        recorder = Recorder(recording, header, time.time(), mission.setting.kinds)
        stack.callback(lambda: recorder.close("it was measured", time.time()))
        tape = Tape(recorder, lambda _finding: ())
        run = await stack.enter_async_context(TimedRun(plan, started(plan), [link, ais], [tape, watch]))
        while not link.local or not ais.local:
            await asyncio.sleep(0.01)
        line = ["--simulate", str(link.local[1]), str(ais.local[1])]
        line += ["--vehicles", str(vehicles), "--vessels", str(vessels)]
        others = stack.enter_context(
            subprocess.Popen(
                [sys.executable, "-m", "benchmarks.wire", *line], stdout=subprocess.PIPE, text=True
            )
        )
        stack.callback(others.kill)
        assert others.stdout is not None
        link.start = float(await asyncio.to_thread(others.stdout.readline))
        await run.begin(60.0)
        settle()
        await run.go(seconds=WARM_UP)
        yield run, watch


async def parted(vehicles: int, vessels: int, seconds: float) -> None:
    """Run for some seconds and print where the time went."""
    with tempfile.TemporaryDirectory() as folder, Parts().watching() as parts:
        async with flown(vehicles, vessels, Path(folder) / "wire.mcap") as (run, watch):
            parts.spent.clear()
            found = await measured(run, watch, seconds)
            parts.tell(seconds, found["load of one core"] * seconds)


async def measure(vehicles: int, vessels: int, seconds: float) -> dict[str, float]:
    """Run for some seconds and return the figures."""
    with tempfile.TemporaryDirectory() as folder:
        async with flown(vehicles, vessels, Path(folder) / "wire.mcap") as (run, watch):
            return await measured(run, watch, seconds)


async def measured(run: TimedRun, watch: Stopwatch, seconds: float) -> dict[str, float]:
    """Go on for some seconds and return the figures."""
    watch.delays, watch.since_sent, watch.steps, watch.heard, run.busy = [], [], 0, 0, []
    before, began = time.process_time(), time.monotonic()
    await run.go(seconds=seconds)
    busy, took = time.process_time() - before, time.monotonic() - began
    delays = sorted(watch.delays)
    assert not watch.broken, "the mission holds: no assumption may break"
    assert delays, "no flight has ended: measure for longer"
    return {
        "positions a second": watch.heard / took,
        "steps a second": watch.steps / took,
        "commits": len(delays),
        "median ms": delays[len(delays) // 2] * 1000,
        "99th percentile ms": delays[int(len(delays) * 0.99)] * 1000,
        "worst ms": delays[-1] * 1000,
        "99th p. ms since sent": sorted(watch.since_sent)[int(len(delays) * 0.99)] * 1000,
        "99th p. of turns, CPU": sorted(run.busy)[int(len(run.busy) * 0.99)] * 1000,
        "load of one core": busy / took,
        "CPU µs a position": busy / watch.heard * 1e6,
    }


def main() -> None:
    """Print the figures, or be the other process."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vehicles", type=int, default=100)
    parser.add_argument("--vessels", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--parts", action="store_true", help="where the time goes, by parts")
    parser.add_argument("--simulate", type=int, nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.simulate:
        asyncio.run(simulate(options.vehicles, options.vessels, *options.simulate))
        return
    say(
        f"{options.vehicles} vehicles and {options.vessels} vessels in another process, {os.cpu_count()} cores"
    )
    if options.parts:
        asyncio.run(parted(options.vehicles, options.vessels, options.seconds))
        return
    found = asyncio.run(measure(options.vehicles, options.vessels, options.seconds))
    for name, value in found.items():
        say(f"  {name:<22} {value:10.1f}")


if __name__ == "__main__":
    main()
