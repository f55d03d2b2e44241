"""The live demonstration: the verified oil-spill mission, flown by a simulated plane beside a replayed AIS feed.

`python -m bigactors.live_demo` (or `make live-demo`) checks `spill_watch`, writes its verdict, and flies it. Only the
plane and the water are simulated. MAVLink and AIS over sockets and files, the camera's pictures with the detection of
the spill, the rules, the monitor and the recording are real. Simulated time passes an hour in a minute. Then the
recording is replayed, compared, and shown as the page `flight.html`.

`--console` (`make live-demo CONSOLE=1`) opens the operator's console, at a pace that a person can follow.
"""

from __future__ import annotations

import asyncio
import os
import sys
import time
from argparse import ArgumentParser, Namespace
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from adapters.camera.camera_plugin import CameraFeed
from adapters.camera.libraries import opencv
from adapters.camera.sea_projection import Lens, Pose
from adapters.live.loop import Ending
from adapters.live.socket_file import is_taken
from adapters.mavlink.mavlink_plugin import Autopilot
from adapters.simulated import Kind, Simulator, Vehicle
from adapters.simulated import run as run_simulated
from adapters.simulated.camera import render
from bigactors.arguments import parse_arguments
from bigactors.cli import main as command
from bigactors.cli import reported
from bigactors.commands.run.flight import Flight, fly, prepare, record
from bigactors.ending_signals import as_process
from bigactors.exits import Exit
from bigactors.flight_watchers import Terminal
from bigactors.mistakes import Mistake, unreadable
from bigactors.pages import Story
from bigactors.picture_files import write_page
from bigactors.recordings import open_recording, trace_of
from bigactors.terminal import flying_output, say, tell
from physical import circle
from physical.wordings import counted
from specs.missions import shipped_missions

MISSION: Final = "spill_watch"
SOCKET: Final = "run.sock"
AIRFIELD: Final = (37.147, -8.582, 20.0)
SPILL: Final = circle((36.9915, -8.6925), 200.0)
"""The filmed spill, some 300 m from the middle of the search area, around which the plane circles."""

LENS: Final = Lens(fov=90.0, pitch=-30.0)
PIXELS: Final = (240, 180)
EVERY: Final = 6.0
"""Seconds between two pictures."""

KEPT: Final = 20
"""The number of pictures kept."""

COAST: Final = 37.05
"""The latitude north of which the camera is off: over land, the detector would find fields."""

LONGEST: Final = 5_400.0
FOLLOWED: Final = 10.0
"""Simulated seconds in a real second when an operator watches."""


def arguments() -> ArgumentParser:
    """Return the parser of the command line."""
    parser = ArgumentParser(
        prog="python -m bigactors.live_demo", description=(__doc__ or "").partition("\n")[0]
    )
    parser.add_argument("folder", type=Path, nargs="?", default="live-demo", help="default %(default)s")
    parser.add_argument(
        "--console", action="store_true", help="serve the operator's console, and print its link"
    )
    parser.add_argument(
        "--speed",
        type=float,
        help=f"times the pace of the clock on the wall (default: {FOLLOWED:.0f} with --console, else all that it can)",
    )
    return parser


def main() -> int:
    """Fly the demonstration into a folder; return the exit code."""
    asked = arguments().parse_args()
    return reported(lambda: demonstrate(asked.folder, asked.speed, console=asked.console))


def demonstrate(folder: Path, speed: float | None = None, *, console: bool = False) -> int:
    """Fly the demonstration into a folder, with the operator's console if requested; return the exit code."""
    speed = speed or (FOLLOWED if console else None)
    more = ("--console", "--at-once") if console else ()
    began = time.monotonic()
    _prepare(folder)
    verdict = str(folder / "verdict.json")
    if code := command(["check", "--no-traces", "--verdict", verdict, MISSION]):
        return code
    ending, broken = _fly(_options(folder, verdict, *more), speed)
    equal = _replay(folder, ending)
    tell(f"the demonstration took {time.monotonic() - began:.1f} s")
    done = ending.reason == "the mission has ended" and not broken and equal
    return int(Exit.HOLDS if done else Exit.VIOLATED)


def _prepare(folder: Path) -> None:
    """Make the folder and delete the previous flight, unless one flies there now."""
    if is_taken(folder / SOCKET):
        raise Mistake(
            "a demonstration flies into this folder", "wait for its end, or name another", str(folder)
        )
    try:
        (folder / "camera").mkdir(parents=True, exist_ok=True)
        for old in (folder / "run.mcap", folder / "run.tlog", *(folder / "camera").glob("*.png")):
            old.unlink(missing_ok=True)
    except OSError as error:
        raise unreadable(error.filename, error) from error


def _options(folder: Path, verdict: str, *more: str) -> Namespace:
    feed = shipped_missions()[MISSION].with_suffix(".nmea")
    return parse_arguments(
        [
            "run",
            MISSION,
            "--vehicle=uav0=udp:127.0.0.1:0",
            f"--feed=ais=file:{feed}",
            f"--camera=uav0=folder:{folder / 'camera'},fov={LENS.fov:g},pitch={LENS.pitch:g},every={EVERY:g}",
            "--name=mmsi:263999001=drifter0",
            "--name=mmsi:263999002=drifter1",
            f"--verdict={verdict}",
            f"--record={folder / 'run.mcap'}",
            f"--socket={folder / SOCKET}",
            f"--for={LONGEST}",
            *more,
        ]
    )


def _fly(options: Namespace, speed: float | None) -> tuple[Ending, bool]:
    flight = replace(prepare(options), rate=speed)
    folder = Path(options.record).parent
    terminal = Terminal(flight.resting, tuple(flight.plan.vehicles))
    with record(flight) as tape, flying_output():
        ending = run_simulated(_flying(flight, terminal, tape, folder), speed)
        if tape is not None:
            tape.reason = ending.reason
        terminal.ends()
        say(f"{ending.reason} after {counted(ending.state.number, 'step')}")
    return ending, terminal.broken


async def _flying(flight: Flight, terminal: Terminal, tape: object, folder: Path) -> Ending:
    watchers = [terminal, *([tape] if tape is not None else [])]
    for plugin in flight.plugins:
        if isinstance(plugin, CameraFeed):
            plugin.in_thread = False  # a thread cannot keep up with simulated time
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
    """Connect the simulated plane to the link of the run."""
    autopilot = next(plugin for plugin in flight.plugins if isinstance(plugin, Autopilot))
    while autopilot.local is None:
        await asyncio.sleep(0.05)
    await Simulator(f"udpout:127.0.0.1:{autopilot.local[1]}", [plane]).run()


async def _film(plane: Vehicle, folder: Path) -> None:
    """Take pictures of the sea below the plane; each file is named after its time."""
    clock = asyncio.get_running_loop()
    began, seed = time.time() - clock.time(), 0
    while True:
        await asyncio.sleep(EVERY)
        if plane.body.latitude < COAST:
            seed += 1
            taken = began + clock.time()
            (roll, pitch), body = plane.tilt, plane.body
            pose = Pose(
                taken, body.latitude, body.longitude, AIRFIELD[2] + body.height, roll, pitch, body.course
            )
            image = render(pose, LENS, PIXELS, [SPILL], seed=seed)
            _put(folder / "camera" / f"{taken:.3f}.png", image)


def _put(target: Path, image: Any) -> None:
    """Write a picture under its name once it is complete, and delete old ones."""
    _, data = opencv().imencode(".png", image)
    part = target.with_suffix(".part")
    part.write_bytes(data.tobytes())
    os.replace(part, target)
    for old in sorted(target.parent.glob("*.png"))[:-KEPT]:
        old.unlink()


def _replay(folder: Path, ending: Ending) -> bool:
    recording = open_recording(str(folder / "run.mcap"))
    flight_of = prepare(_options(folder, str(folder / "verdict.json"))).mission
    trace = trace_of(recording, flight_of)
    equal = trace.configurations[-1] == ending.state.configuration
    tell(
        f"{counted(len(trace), 'step')} replayed: {'the same configuration' if equal else 'ANOTHER configuration'}"
    )
    times = tuple(message.time for message in recording.of("steps"))
    page = str(folder / "flight.html")
    for line in write_page(Story(MISSION, "", False, trace, times=times), page):
        tell(line)
    tell(f"the flight, step by step: {page}; its recording and the log of its link: run.mcap, run.tlog there")
    return equal


if __name__ == "__main__":
    sys.exit(as_process(main))
