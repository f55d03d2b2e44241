"""Check a mission and fly it with simulated vehicles, with the operator's console beside it: a process of its own.

`python -m bigactors.studio.simulated_flight FILE FOLDER`. It prints what `bigactors run --console` prints, the links of
the console among it. Only the vehicles are simulated, and time passes ten times as fast.
"""

from __future__ import annotations

import asyncio
import sys
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Final

from adapters.live.loop import Ending
from adapters.live.run_watchers import Watcher
from adapters.mavlink.mavlink_plugin import Autopilot
from adapters.simulated import Kind, Simulator, Vehicle
from adapters.simulated import run as run_simulated
from bigactors.arguments import parse_arguments
from bigactors.cli import main as command
from bigactors.cli import reported
from bigactors.commands.run.flight import Flight, conclude, fly, prepare, record
from bigactors.flight_watchers import Terminal
from bigactors.mission_lookup import open_mission
from bigactors.mistakes import Mistake
from bigactors.terminal import flying_output
from physical.frame import E7
from specs.elaboration import ElaboratedMission, Variation

SPEED: Final = 10.0
ADDRESS: Final = "udp:127.0.0.1:0"
GROUND: Final = 20.0
"""The metres above the sea at which vehicles begin."""


def main() -> int:
    """Fly a mission's file with recording, verdict and socket in a folder; return the exit code."""
    file, folder = sys.argv[1:]
    return reported(lambda: _flown(file, Path(folder)))


def _flown(file: str, folder: Path) -> int:
    verdict = str(folder / "verdict.json")
    if code := command(["check", "--no-traces", "--control", "timed", "--verdict", verdict, file]):
        return code
    vehicles = _vehicles(open_mission(file, Variation()))
    names = [f"--vehicle={name}:{vehicle.system}={ADDRESS}" for name, vehicle in vehicles.items()]
    files = [f"--verdict={verdict}", f"--record={folder / 'run.mcap'}", f"--socket={folder / 'run.sock'}"]
    flight = replace(prepare(parse_arguments(["run", file, "--console", *names, *files])), rate=SPEED)
    terminal = Terminal(flight.resting, tuple(flight.plan.vehicles))
    with record(flight) as tape, flying_output():
        watchers: tuple[Watcher, ...] = (terminal,) if tape is None else (terminal, tape)
        flying = _flying(flight, watchers, None if tape is None else tape.preflight, list(vehicles.values()))
        ending = run_simulated(flying, SPEED)
        terminal.ends()
    return int(conclude(ending, broken=terminal.broken, property_broken=terminal.property_broken))


def _vehicles(mission: ElaboratedMission) -> dict[str, Vehicle]:
    """Return a copter for each entity that a bigActor can drive, where the mission has it; raises Mistake."""
    physical, signature = mission.initial.structure.physical, mission.setting.signature
    found = {}
    for number, name in enumerate(sorted(physical.entities()), 1):
        at = physical.position(name) if signature[mission.setting.kind(name)].driven else None
        if at is not None:
            north, east = at.geometry.ring[0]
            found[name] = Vehicle(Kind.COPTER, (north / E7, east / E7, GROUND), number)
    if not found:
        raise Mistake(
            "the mission drives nothing that could fly", "place an entity of a driven kind in the world"
        )
    return found


async def _flying(
    flight: Flight, watchers: tuple[Watcher, ...], preflight: object, vehicles: list[Vehicle]
) -> Ending:
    flown = asyncio.ensure_future(fly(flight, watchers, preflight))  # type: ignore[arg-type]  # a tape's
    simulated = asyncio.ensure_future(_simulate(flight, vehicles))
    try:
        return await flown
    finally:
        simulated.cancel()
        with suppress(asyncio.CancelledError):
            await simulated


async def _simulate(flight: Flight, vehicles: list[Vehicle]) -> None:
    """Connect the simulated vehicles to the link of the run."""
    autopilot = next(plugin for plugin in flight.plugins if isinstance(plugin, Autopilot))
    while autopilot.local is None:
        await asyncio.sleep(0.05)
    await Simulator(f"udpout:127.0.0.1:{autopilot.local[1]}", vehicles).run()


if __name__ == "__main__":
    sys.exit(main())
