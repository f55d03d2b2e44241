"""Measure a run under a flood: 20,000 AIS positions and 5,000 foreign MAVLink packets a second.

Vehicles that fly and vessels that the mission names are one other process, the flood is a second one: vessels with
made-up numbers inside the mission's places, and packets from another address that speak in the vehicles' names. What
an operator says has to be answered meanwhile, flights have to be committed, and memory must not grow.
`python -m benchmarks.flood`.
"""

import argparse
import asyncio
import os
import resource
import socket
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from random import Random

from pyais.encode import encode_dict

from adapters.ais import AisFeed
from adapters.live.core import started
from adapters.live.loop import settle
from adapters.live.state import Plan, Saying
from adapters.mavlink import Craft
from adapters.mavlink.codec import Encoder
from adapters.mavlink.message import say as message_of
from adapters.naming import NamingService
from adapters.recording.writing import Recorder
from benchmarks.live import LANES, TimedRun
from benchmarks.wire import NAMED, WARM_UP, Link, Stopwatch, mission_text, mmsi
from bigactors.terminal import say
from bigactors.watchers import Tape
from semantics.contingencies import Fallback, Precautions
from semantics.state.setting import Control, Scheduler
from specs import Source
from specs.elaboration import Variation, elaborate
from specs.parser import parse

LINES = 20_000
"""Different lines that are sent again and again."""

SAYING = 0.05
"""Seconds between two sayings."""


def flood(vehicles: int, link: int, receiver: int, positions: int, packets: int) -> None:
    """Send until killed."""
    random = Random(1)
    lines = [_sentence(number, random) for number in range(LINES)]
    frames = [_lie(number % vehicles + 1, number) for number in range(1_000)]
    began, sent, told = time.monotonic(), 0, 0
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
        while True:
            passed = time.monotonic() - began
            for number in range(sent, int(passed * positions)):
                out.sendto(lines[number % LINES], ("127.0.0.1", receiver))
            for number in range(told, int(passed * packets)):
                out.sendto(frames[number % len(frames)], ("127.0.0.1", link))
            sent, told = int(passed * positions), int(passed * packets)
            time.sleep(0.002)


def _sentence(number: int, random: Random) -> bytes:
    lane, west = random.randrange(LANES), random.random() < 0.5
    at = {"lat": 37.0007 + lane * 0.002, "lon": -8.6495 if west else -8.6475}
    said = {"type": 1, "mmsi": 500_000_000 + number, **at, "speed": 0, "course": 0, "heading": 511}
    (line,) = encode_dict(said, talker_id="AI", sentence_type="VDM")
    return f"{line}\r\n".encode()


def _lie(system: int, number: int) -> bytes:
    fields = {"alt": 0, "relative_alt": 0, "vx": 0, "vy": 0, "vz": 0, "hdg": 0}
    at = {"lat": 370_007_500, "lon": -86_475_000}
    return Encoder(system, 1).pack(
        message_of("GLOBAL_POSITION_INT", time_boot_ms=10**8 + number, **at, **fields)
    )


async def measure(vehicles: int, seconds: float, positions: int, packets: int) -> dict[str, float]:
    """Fly, flood for some seconds, and return the figures."""
    source = Source("flood", mission_text(vehicles))
    mission = elaborate(parse(source), source, Path(), Variation(Scheduler.FCFS, Control.TIMED, {}))
    names = [f"uav{number}" for number in range(vehicles)]
    plan = Plan(mission.initial, dict.fromkeys(names, "fleet"), Precautions(Fallback.CONTINUE))
    link = Link([Craft(name, "UAV", number + 1) for number, name in enumerate(names)])
    table = {f"mmsi:{mmsi(number)}": f"boat{number}" for number in range(NAMED)}
    ais, watch = AisFeed("ais", "udp:127.0.0.1:0", NamingService(table)), Stopwatch(link)
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        header = {"mission": "flood", "text": source.text, "digest": "", "version": "", "verified": False}
        tape = Tape(Recorder(folder / "flood.mcap", {**header, "vehicles": {}}, time.time()), lambda _: ())
        async with TimedRun(plan, started(plan), [link, ais], [tape, watch]) as run:
            while not link.local or not ais.local:
                await asyncio.sleep(0.01)
            ports = [str(link.local[1]), str(ais.local[1])]
            fleet = _other(
                "benchmarks.wire", "--vehicles", str(vehicles), "--vessels", str(NAMED), "--simulate", *ports
            )
            stack.callback(stack.enter_context(fleet).kill)
            assert fleet.stdout is not None
            link.start = float(await asyncio.to_thread(fleet.stdout.readline))
            await run.begin(60.0)
            settle()
            await run.go(lambda _: False, seconds=WARM_UP)
            numbers = ["--vehicles", str(vehicles), "--rates", str(positions), str(packets)]
            foe = _other("benchmarks.flood", *numbers, "--flood", *ports)
            stack.callback(stack.enter_context(foe).kill)
            return await _flooded(run, watch, seconds)


def _other(module: str, *words: str) -> subprocess.Popen[str]:
    return subprocess.Popen([sys.executable, "-m", module, *words], stdout=subprocess.PIPE, text=True)


async def _flooded(run: TimedRun, watch: Stopwatch, seconds: float) -> dict[str, float]:
    answers: list[float] = []
    asking = asyncio.create_task(_ask(run, answers))
    await run.go(lambda _: False, seconds=min(10.0, seconds))  # the flood sets in, and strangers are taken in
    first, watch.delays, watch.heard, run.busy = _memory(), [], 0, []
    before, began = time.process_time(), time.monotonic()
    await run.go(lambda _: False, seconds=seconds)
    busy, took = time.process_time() - before, time.monotonic() - began
    asking.cancel()
    answers.sort()
    strangers = len(run.state.configuration.setting.kinds) - len(run.plan.first.setting.kinds)
    return {
        "positions taken a second": watch.heard / took,
        "strangers": strangers,
        "commits": len(watch.delays),
        "sayings": len(answers),
        "median answer ms": answers[len(answers) // 2] * 1000,
        "99th percentile ms": answers[int(len(answers) * 0.99)] * 1000,
        "worst answer ms": answers[-1] * 1000,
        "memory MB": _memory(),
        "of which new": _memory() - first,
        "load of one core": busy / took,
    }


async def _ask(run: TimedRun, answers: list[float]) -> None:
    while True:
        asked = time.perf_counter()
        await run.inbox.say(Saying("a0", "nothing"))
        answers.append(time.perf_counter() - asked)
        await asyncio.sleep(SAYING)


def _memory() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def main() -> None:
    """Print the figures, or be the flood."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vehicles", type=int, default=4)
    parser.add_argument("--seconds", type=float, default=180.0)
    parser.add_argument(
        "--rates", type=int, nargs=2, default=[20_000, 5_000], help="positions and packets a second"
    )
    parser.add_argument("--flood", type=int, nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.flood:
        flood(options.vehicles, *options.flood, *options.rates)
        return
    found = asyncio.run(measure(options.vehicles, options.seconds, *options.rates))
    say(f"{options.vehicles} vehicles, a flood of {options.rates} a second, {os.cpu_count()} cores")
    for name, value in found.items():
        say(f"  {name:<25} {value:10.1f}")


if __name__ == "__main__":
    main()
