"""ArduPilot's own simulators, and another ground station that speaks to them over a link of its own."""

import os
import socket
import subprocess
import time
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path

import pytest
from worlds import HOME, World, running, until

from adapters.mavlink import Autopilot, Craft, Stations
from adapters.mavlink.codec import Decoder, Encoder
from adapters.mavlink.items import item_message, item_of
from adapters.mavlink.message import MavlinkMessage, say

FOLDER = os.environ.get("BIGACTORS_SITL", "")
SPEED = 10
STATIONS = Stations({"gcs0": 255, "gcs1": 254}, ("gcs0", "gcs1"))
CRAFT = Craft("uav0", system=1)
PROGRAMS = {"plane": "arduplane", "quad": "arducopter", "rover": "ardurover"}
HOLD_AT_START = ("MODE6", 4)
"""The mode of the simulated radio: Rover 4.7 leaves MANUAL for HOLD only, unless by its radio."""

needs_simulators = pytest.mark.skipif(
    not FOLDER, reason="BIGACTORS_SITL names no folder with ArduPilot's simulators"
)

INSTANCE = os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw")
"""Simulators that run at once listen to ports of their own."""


@contextmanager
def autopilot(model, port, tmp_path, parameters=()):
    """Start ArduPilot's simulator, talking to a port of ours."""
    program = Path(FOLDER) / PROGRAMS[model]
    if not program.exists():
        pytest.skip(f"{program} is not there")
    given, defaults = Path(FOLDER) / f"{model}.parm", tmp_path / f"{model}.parm"
    lines = [given.read_text()] if given.exists() else []
    parameters = (HOLD_AT_START, *parameters) if model == "rover" else parameters
    defaults.write_text("\n".join([*lines, *(f"{name} {value}" for name, value in parameters), ""]))
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
    command += ["--defaults", defaults]
    with subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as process:
        try:
            yield process
        finally:
            process.kill()


@asynccontextmanager
async def linked(model, tmp_path, craft=CRAFT, parameters=(), **more):
    """Start a vehicle and its plugin, and wait until it has told where it is and what it may do."""
    world, plugin = World(), Autopilot("autopilot", "udp:127.0.0.1:0", [craft], STATIONS, **more)
    async with running(plugin.run(world)):
        await until(lambda: plugin.local)
        with autopilot(model, plugin.local[1], tmp_path, parameters):
            await until(lambda: world.property("uav0"))
            await until(plugin.is_known)
            yield world, plugin


class Station:
    """Another ground station, on a link that ours does not hear."""

    def __init__(self, system):
        self.system, self.encoder, self.decoder = system, Encoder(system, 190), Decoder()

    def __enter__(self):
        self.link = socket.create_connection(("127.0.0.1", 5762 + 10 * int(INSTANCE)), timeout=5.0)
        return self

    def __exit__(self, *_):
        time.sleep(0.2)  # it reads what has come only while it is connected
        self.link.close()

    def send(self, *messages):
        for message in messages:
            self.link.sendall(self.encoder.pack(message))

    def heard(self, *names, seconds=20.0):
        """Yield the vehicle's messages of some names."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            for message in self.decoder.feed(self.link.recv(4096)):
                if isinstance(message, MavlinkMessage) and message.name in names:
                    yield message
        pytest.fail(f"the simulator sends no {names}")

    def upload(self, kind, items):
        """Write what is on board, by the mission protocol."""
        self.send(
            say(
                "MISSION_COUNT", target_system=1, target_component=1, count=len(items), mission_type=int(kind)
            )
        )
        for message in self.heard("MISSION_REQUEST_INT", "MISSION_REQUEST", "MISSION_ACK"):
            if message["mission_type"] != kind:
                continue
            if message.name == "MISSION_ACK":
                assert message["type"] == 0, message
                return
            self.send(item_message(items[message["seq"]], message["seq"], int(kind), 1))

    def download(self, kind):
        """Read what is on board, by the mission protocol."""
        request = say("MISSION_REQUEST_LIST", target_system=1, target_component=1, mission_type=int(kind))
        self.send(request)
        items, count = [], None
        for message in self.heard("MISSION_COUNT", "MISSION_ITEM_INT"):
            if message["mission_type"] != kind:
                continue
            if message.name == "MISSION_COUNT":
                count = message["count"]
            elif message["seq"] == len(items):
                items.append(item_of(message.fields))
            if len(items) == count:
                return tuple(items)
            self.send(
                say(
                    "MISSION_REQUEST_INT",
                    target_system=1,
                    target_component=1,
                    seq=len(items),
                    mission_type=int(kind),
                )
            )
        return None


def tell(system, *messages):
    """Send messages as another ground station does."""
    with Station(system) as station:
        station.send(*messages)
