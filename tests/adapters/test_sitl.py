"""The same flights with ArduPilot's own code: where BIGACTORS_SITL names the folder of its simulators."""

import os
import subprocess
from contextlib import contextmanager
from pathlib import Path

import pytest
from worlds import AREA, HOME, World, running, until

from adapters.mavlink import Autopilot, Craft
from adapters.plugin import Arrived, Follow, GoTo, Rejected
from adapters.simulated import run
from physical import contains, point

FOLDER = os.environ.get("BIGACTORS_SITL", "")
SPEED = 10
PROGRAMS = {"plane": "arduplane", "quad": "arducopter", "rover": "ardurover"}

pytestmark = pytest.mark.skipif(
    not FOLDER, reason="BIGACTORS_SITL names no folder with ArduPilot's simulators"
)


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
        "0",
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


async def flown(model, told, tmp_path):
    world, plugin = World(), Autopilot("autopilot", "udp:127.0.0.1:0", [Craft("uav0", system=1)])
    async with running(plugin.run(world)):
        await until(lambda: plugin.local)
        with autopilot(model, plugin.local[1], tmp_path):
            await plugin.command(told)
            await until(lambda: world.of(Arrived) or world.of(Rejected), 1_200)
    return world


@pytest.mark.parametrize("model", PROGRAMS)
def test_the_real_autopilot_goes_to_a_place(model, tmp_path):
    world = run(flown(model, GoTo("r1", "uav0", AREA), tmp_path), SPEED)
    assert world.of(Arrived), world.reports
    assert contains(AREA, world.property("uav0").geometry)


@pytest.mark.parametrize("model", PROGRAMS)
def test_the_real_autopilot_follows_a_path(model, tmp_path):
    path = (point(37.004, -8.604), point(37.008, -8.610))
    world = run(flown(model, Follow("r1", "uav0", path), tmp_path), SPEED)
    assert world.of(Arrived), world.reports
