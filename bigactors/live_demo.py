"""The live demonstration: the verified oil-spill mission, flown by a simulated plane beside a replayed AIS feed.

`python -m bigactors.live_demo` (or `make live-demo`) checks `spill_watch`, writes its verdict, flies it with everything
real but the plane and the water: MAVLink and AIS over sockets and files, the rules, the monitor, the recording. Time is
the simulation's, so that an hour takes seconds. Then the recording is replayed, compared, and drawn.
"""

from __future__ import annotations

import asyncio
import os
import sys
import time
from argparse import Namespace
from contextlib import suppress
from pathlib import Path
from typing import Final

from adapters.live.loop import Ending
from adapters.mavlink.autopilot import Autopilot
from adapters.simulated import Kind, Simulator, Vehicle
from adapters.simulated import run as run_simulated
from bigactors.arguments import parse_arguments
from bigactors.cli import main as command
from bigactors.commands.run import Flight, fly, prepare, record
from bigactors.drawings import draw
from bigactors.exits import Exit
from bigactors.recordings import open_recording, trace_of
from bigactors.terminal import say, tell
from bigactors.watchers import TOLD, Terminal
from checker import Trace
from physical import PhysicalProperty, circle, write_geojson
from physical.messages import counted
from specs.missions import shipped_missions

MISSION: Final = "spill_watch"
AIRFIELD: Final = (37.147, -8.582, 20.0)
SPILL: Final = circle((37.0, -8.7), 650.0)
FOUND_AFTER: Final = 60.0
"""Seconds over the search area after which the camera sees the spill."""

LONGEST: Final = 5_400.0


def main() -> int:
    """Fly the demonstration into a folder; return the exit code."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "live-demo")
    began = time.monotonic()
    _prepare(folder)
    verdict = str(folder / "verdict.json")
    if code := command(["check", "--no-traces", "--verdict", verdict, MISSION]):
        return code
    ending, broken = _fly(folder, verdict)
    equal = _replay(folder, ending)
    tell(f"the demonstration took {time.monotonic() - began:.1f} s")
    done = ending.reason == "the mission has ended" and not broken and equal
    return int(Exit.HOLDS if done else Exit.VIOLATED)


def _prepare(folder: Path) -> None:
    (folder / "camera").mkdir(parents=True, exist_ok=True)
    for old in ("run.mcap", "run.tlog", "camera/spill.geojson"):
        (folder / old).unlink(missing_ok=True)


def _options(folder: Path, verdict: str) -> Namespace:
    feed = shipped_missions()[MISSION].with_suffix(".nmea")
    return parse_arguments(
        [
            "run",
            MISSION,
            "--vehicle=uav0=udp:127.0.0.1:0",
            f"--feed=ais=file:{feed}",
            f"--feed=detections=folder:{folder / 'camera'}",
            "--name=mmsi:263999001=drifter0",
            "--name=mmsi:263999002=drifter1",
            f"--verdict={verdict}",
            f"--record={folder / 'run.mcap'}",
            f"--socket={folder / 'run.sock'}",
            f"--for={LONGEST}",
        ]
    )


def _fly(folder: Path, verdict: str) -> tuple[Ending, bool]:
    flight = prepare(_options(folder, verdict))
    terminal = Terminal(flight.resting)
    with record(flight) as tape:
        ending = run_simulated(_flying(flight, terminal, tape, folder))
        say(f"{ending.reason} after {ending.state.number} steps")
    return ending, terminal.broken


async def _flying(flight: Flight, terminal: Terminal, tape: object, folder: Path) -> Ending:
    watchers = [terminal, *([tape] if tape is not None else [])]
    flown = asyncio.ensure_future(fly(flight, watchers))  # type: ignore[arg-type]  # a tape is a watcher
    plane = Vehicle(Kind.PLANE, AIRFIELD)
    beside = [asyncio.ensure_future(_simulate(flight, plane)), asyncio.ensure_future(_film(plane, folder))]
    try:
        return await flown
    finally:
        for task in beside:
            task.cancel()
            with suppress(asyncio.CancelledError):
                await task


async def _simulate(flight: Flight, plane: Vehicle) -> None:
    """Put the simulated plane on the link on which the run listens."""
    autopilot = next(plugin for plugin in flight.plugins if isinstance(plugin, Autopilot))
    while autopilot.local is None:
        await asyncio.sleep(0.05)
    await Simulator(f"udpout:127.0.0.1:{autopilot.local[1]}", [plane]).run()


async def _film(plane: Vehicle, folder: Path) -> None:
    """Report the spill as a vision system does, once the plane has been over the search area for a while."""
    while plane.body.latitude > 37.02:
        await asyncio.sleep(1.0)
    await asyncio.sleep(FOUND_AFTER)
    spill = PhysicalProperty("oilSpill0", "OilSpill", SPILL, source="camera")
    while True:
        text = write_geojson([spill])
        target = folder / "camera" / "spill.geojson"
        part = target.with_suffix(".part")
        part.write_text(text, encoding="utf-8")
        os.replace(part, target)
        await asyncio.sleep(120.0)


def _replay(folder: Path, ending: Ending) -> bool:
    recording = open_recording(str(folder / "run.mcap"))
    flight_of = prepare(_options(folder, str(folder / "verdict.json"))).mission
    trace = trace_of(recording, flight_of)
    equal = trace.configurations[-1] == ending.state.configuration
    tell(
        f"{counted(len(trace), 'step')} replayed: {'the same configuration' if equal else 'ANOTHER configuration'}"
    )
    _draw(trace, folder)
    tell(f"recording, log and pictures are in {folder}/")
    return equal


def _draw(trace: Trace, folder: Path) -> None:
    """Draw the configurations in which something has changed in the world."""
    told = [number for number, step in enumerate(trace.steps, 1) if step.label.rule in TOLD]
    for number in told:
        label, before = trace.steps[number - 1].label, trace.configurations[number - 1]
        path = str(folder / f"c{number:04}.svg")
        draw(trace.configurations[number], path, f"{MISSION}, c{number}: {label}", before)


if __name__ == "__main__":
    sys.exit(main())
