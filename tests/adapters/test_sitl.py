"""The same flights with ArduPilot's own code: where BIGACTORS_SITL names the folder of its simulators."""

import asyncio
import os
import subprocess
from contextlib import contextmanager
from pathlib import Path

import pytest
from worlds import AREA, HOME, World, running, until

from adapters.mavlink import Autopilot, Craft, Stations
from adapters.plugin import Arrived, Follow, GoTo, HandOver, Rejected, Return
from adapters.simulated import run
from bigactors.arguments import parse_arguments
from bigactors.cli import main
from bigactors.commands.run import fly, prepare, record
from physical import box, contains, point

FOLDER = os.environ.get("BIGACTORS_SITL", "")
SPEED = 10
STATIONS = Stations({"gcs0": 255, "gcs1": 254}, ("gcs0", "gcs1"))
CRAFT = Craft("uav0", system=1)
PROGRAMS = {"plane": "arduplane", "quad": "arducopter", "rover": "ardurover"}

pytestmark = pytest.mark.skipif(
    not FOLDER, reason="BIGACTORS_SITL names no folder with ArduPilot's simulators"
)


INSTANCE = os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw")
"""Simulators that run at once listen to ports of their own."""


@contextmanager
def autopilot(model, port, tmp_path):
    """Start ArduPilot's simulator, talking to a port of ours."""
    program = Path(FOLDER) / PROGRAMS[model]
    if not program.exists():
        pytest.skip(f"{program} is not there")
    defaults = Path(FOLDER) / f"{model}.parm"
    where = ",".join(map(str, (*HOME, 0)))
    command = [
        program,
        "-w",
        "-I",
        INSTANCE,
        "--model",
        model,
        "--speedup",
        str(SPEED),
        "--home",
        where,
        "--sysid",
        "1",
    ]
    command += ["--serial0", f"udpclient:127.0.0.1:{port}"]
    command += ["--defaults", defaults] if defaults.exists() else []
    with subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as process:
        try:
            yield
        finally:
            process.kill()


async def flown(model, tmp_path, *told, craft=CRAFT):
    """Tell one thing after the other, each when the one before has ended."""
    world, plugin = World(), Autopilot("autopilot", "udp:127.0.0.1:0", [craft], STATIONS)
    async with running(plugin.run(world)):
        await until(lambda: plugin.local)
        with autopilot(model, plugin.local[1], tmp_path):
            await until(lambda: world.property("uav0"))
            for number, each in enumerate(told, 1):
                await plugin.command(each)
                await until(lambda: len([*world.of(Arrived), *world.of(Rejected)]) == number, 1_200)  # noqa: B023
    return world, plugin


@pytest.mark.parametrize("model", PROGRAMS)
def test_the_real_autopilot_goes_to_a_place_within_its_fence_and_is_handed_over(model, tmp_path):
    craft = Craft("uav0", system=1, fence=box((37.05, -8.55), (36.95, -8.65)))
    told = GoTo("r1", "uav0", AREA), HandOver("r2", "uav0", "control:gcs0", "control:gcs1")
    world, plugin = run(flown(model, tmp_path, *told, craft=craft), SPEED)
    assert [report.request for report in world.of(Arrived)] == ["r1", "r2"], world.reports
    assert contains(AREA, world.property("uav0").geometry)
    assert plugin.pilot("uav0").known.fenced
    assert world.property("uav0").channels == ("control:gcs1",)


@pytest.mark.parametrize("model", PROGRAMS)
def test_the_real_autopilot_follows_a_path_and_returns(model, tmp_path):
    path = (point(37.004, -8.604), point(37.008, -8.610))
    world, _ = run(flown(model, tmp_path, Follow("r1", "uav0", path), Return("r2", "uav0")), SPEED)
    assert [report.request for report in world.of(Arrived)] == ["r1", "r2"], world.reports


MISSION = """
mission tour
signature { kind Location contains Location, UAV, Station kind UAV driven kind Station }
world {
  field0: Location = circle (37.0, -8.6) radius 900 m
  area0: Location = box (37.03, -8.61) (37.01, -8.64)
  gcs0: Station = point (37.001, -8.601) linked control:gcs0
  gcs1: Station = point (37.002, -8.601) linked control:gcs1
  uav0: UAV = point (37.0, -8.6) linked control:gcs0
}
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO area0)
  observe(CHILDREN(PARENT(HOST)))
  react { case obs => send "there" to op }
}
BigActor op hosted_at gcs0 with_behavior { react { case "there" => control(HAND uav0 TO gcs1) } }
environment { uav0 arrives }
"""


@pytest.mark.parametrize("model", PROGRAMS)
def test_a_verified_mission_flies_the_real_autopilot(model, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("tour.mission").write_text(MISSION)
    checked = ["check", "--no-traces", "--control", "timed", "--verdict", "tour.verdict.json", "tour.mission"]
    assert main(checked) == 0
    line = ["run", "tour.mission", "--vehicle=uav0:1=udp:127.0.0.1:0", "--socket=s", "--record=r.mcap"]
    flight = prepare(parse_arguments([*line, "--for=1200", "--wait=180"]))

    async def fly_it():
        task = asyncio.ensure_future(fly(flight, (tape,)))
        await until(lambda: flight.plugins[0].local)
        with autopilot(model, flight.plugins[0].local[1], tmp_path):
            return await task

    with record(flight) as tape:
        ending = run(fly_it(), SPEED)
    assert ending.reason == "the mission has ended"
    logical = ending.state.configuration.structure.logical
    assert (logical.parent("uav0"), logical.links("uav0")) == ("area0", ("control:gcs1",))
