"""The same flights with PX4's own code: where BIGACTORS_PX4 names a build folder with its simulator in the program."""

import asyncio
import os
import subprocess
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path

import pytest
from worlds import AREA, HOME, World, running, until

from adapters.addresses import parse_address
from adapters.mavlink import Autopilot, Craft
from adapters.mavlink.codec import Encoder
from adapters.mavlink.command import long
from adapters.mavlink.constants import Cmd
from adapters.mavlink.profiles import PX4_COPTER, PX4_DIALECT
from adapters.plugin import (
    Accepted,
    Arrived,
    Follow,
    GoTo,
    HandOver,
    Hold,
    Refused,
    Rejected,
    Return,
    TakenOver,
)
from adapters.simulated import run
from adapters.transport import open_port
from physical import box, contains, distance, point

FOLDER = os.environ.get("BIGACTORS_PX4", "")
SPEED = 10
"""On a busy machine its simulated accelerometer times out at this speed ("Accel #0 fail"): it does not get ready."""
INSTANCE = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
"""Simulators that run at once listen to ports of their own."""

HERE = dict(zip(("LAT", "LON", "ALT"), HOME, strict=True))

pytestmark = pytest.mark.skipif(not FOLDER, reason="BIGACTORS_PX4 names no folder with PX4's simulator")


@contextmanager
def px4(model, tmp_path, **parameters):
    """Start PX4 with its simulator in the same program; it talks to whoever speaks to its port first."""
    program = Path(FOLDER) / "bin" / "px4"
    if not program.exists():
        pytest.skip(f"{program} is not there")
    told = {f"PX4_PARAM_{name}": str(value) for name, value in parameters.items()}
    where = {f"PX4_HOME_{name}": str(value) for name, value in HERE.items()}
    simulator = {
        "PX4_SIM_MODEL": f"sihsim_{model}",
        "PX4_SIMULATOR": "sihsim",
        "PX4_SIM_SPEED_FACTOR": str(SPEED),
    }
    environment = os.environ | told | where | simulator
    command = [program, "-d", "-i", str(INSTANCE), "-w", tmp_path, Path(FOLDER) / "etc"]
    with (
        (tmp_path / "px4.log").open("w") as log,
        subprocess.Popen(command, env=environment, stdout=log, stderr=log) as process,
    ):
        try:
            yield process
        finally:
            process.kill()


@asynccontextmanager
async def linked(model, tmp_path, craft=None, **parameters):
    """Start a vehicle and its plugin, and wait until it has told where it is and what it may do."""
    craft = craft or Craft("uav0", system=INSTANCE + 1)
    world, plugin = World(), Autopilot("autopilot", f"udpout:127.0.0.1:{18570 + INSTANCE}", [craft])
    with px4(model, tmp_path, **parameters):
        async with running(plugin.run(world)):
            await until(lambda: world.property("uav0"))
            await until(plugin.is_known)
            yield world, plugin


async def other_station(mode):
    """Let another ground station change the mode: PX4 obeys it as it does ours."""
    async with open_port(parse_address(f"udpout:127.0.0.1:{14_580 + INSTANCE}"), lambda *_: None) as port:
        message = long(Cmd.DO_SET_MODE, INSTANCE + 1, 1, *PX4_DIALECT.mode_parameters(mode))
        for _ in range(5):
            port.send(Encoder(253, 190).pack(message), None)
            await asyncio.sleep(1.0)


PATH = (point(37.002, -8.602), point(37.004, -8.604))
FENCE = box((37.05, -8.55), (36.95, -8.65))


def test_a_real_px4_copter_flies_within_its_fence_holds_follows_a_path_and_returns(tmp_path):
    async def flies():
        craft = Craft("uav0", system=INSTANCE + 1, fence=FENCE)
        async with linked("quadx", tmp_path, craft) as (world, plugin):
            with pytest.raises(Refused, match="PX4 obeys every station on its link"):
                await plugin.command(HandOver("r0", "uav0", "control:gcs0", "control:gcs1"))
            await plugin.command(GoTo("far", "uav0", AREA))
            await until(lambda: world.of(Accepted, request="far"))
            await asyncio.sleep(30.0)
            await plugin.command(Hold("hold", "uav0"))
            await until(lambda: world.of(Arrived, request="hold"))
            await asyncio.sleep(20.0)
            here = world.property("uav0").geometry
            await asyncio.sleep(20.0)
            assert distance(here, world.property("uav0").geometry) < 5.0
            assert not contains(AREA, here)
            await plugin.command(Follow("r1", "uav0", PATH))
            await until(lambda: world.of(Arrived, request="r1"), 1_200)
            await plugin.command(GoTo("r2", "uav0", AREA))
            await until(lambda: world.of(Arrived, request="r2"), 1_200)
            assert contains(AREA, world.property("uav0").geometry)
            await plugin.command(Return("r3", "uav0"))
            await until(lambda: plugin.pilot("uav0").known.armed is False, 1_200)
            assert world.of(Rejected) == []
            assert world.of(TakenOver) == []

    run(flies(), SPEED)


def test_a_real_px4_copter_that_another_station_sends_home_is_taken_over(tmp_path):
    async def flies():
        async with linked("quadx", tmp_path) as (world, plugin):
            await plugin.command(GoTo("r1", "uav0", AREA))
            await until(lambda: world.of(Accepted, request="r1"))
            await asyncio.sleep(10.0)
            await other_station(PX4_COPTER.home)
            await until(lambda: world.of(TakenOver))
            assert world.of(TakenOver)[0].reason.startswith(
                "it is in AUTO.RTL, by itself or by a command from elsewhere"
            )
            with pytest.raises(Refused, match="it was taken over"):
                await plugin.command(GoTo("r2", "uav0", AREA))

    run(flies(), SPEED)


def test_a_real_px4_plane_refuses_a_path_while_it_wants_a_landing(tmp_path):
    async def refuses():
        async with linked("airplane", tmp_path) as (_, plugin):
            with pytest.raises(
                Refused, match="no path without a landing: its MIS_TKO_LAND_REQ is 2; set it to 0"
            ):
                await plugin.command(Follow("r0", "uav0", PATH))

    run(refuses(), SPEED)


def test_a_real_px4_copter_whose_fence_only_warns_is_not_sent_off(tmp_path):
    async def flies():
        craft = Craft("uav0", system=INSTANCE + 1, fence=FENCE)
        async with linked("quadx", tmp_path, craft, GF_ACTION=1) as (_, plugin):
            with pytest.raises(Refused, match="it keeps within no polygon: its GF_ACTION is 1; set it to 2"):
                await plugin.command(GoTo("r1", "uav0", AREA))

    run(flies(), SPEED)
