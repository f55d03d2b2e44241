"""MAVSDK, which shares no code with us, finds, reads and commands our simulated vehicle."""

import asyncio
import threading
import time
from contextlib import contextmanager

import pytest

from adapters.mavlink.constants import MissionType
from adapters.simulated import Kind, Simulator, Vehicle, run

pytest.importorskip("mavsdk", reason="the extra `peers` (MAVSDK) is not installed", exc_type=ImportError)

from mavsdk.mavsdk import Configuration, Mavsdk
from mavsdk.plugins.action.action import Action
from mavsdk.plugins.mission_raw.mission_raw import MissionItem, MissionRaw
from mavsdk.plugins.telemetry.telemetry import Telemetry

SPEED = 20.0
PORT = 15_871


def item(index, command):
    at = (370_000_000 + index * 20_000, -86_000_000, 100.0)
    return MissionItem(index, 3, command, int(index == 0), 1, 0.0, 0.0, 0.0, 0.0, *at, 0)


@contextmanager
def simulated(vehicle, port):
    """Fly a vehicle in a thread of its own: MAVSDK has its own clock."""
    simulator, loops = Simulator(f"udpout:127.0.0.1:{port}", [vehicle]), []

    async def main():
        loops.append((asyncio.get_running_loop(), asyncio.current_task()))
        await simulator.run()

    def fly():
        with pytest.raises(asyncio.CancelledError):
            run(main(), SPEED)

    thread = threading.Thread(target=fly)
    thread.start()
    try:
        yield
    finally:
        loop, task = loops[0]
        loop.call_soon_threadsafe(task.cancel)
        thread.join()


def wait_for(what, seconds=10.0):
    end = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < end, "not in time"
        time.sleep(0.05)


def test_mavsdk_flies_our_vehicle():
    vehicle = Vehicle(Kind.PLANE, (37.0, -8.6, 20.0))
    mavsdk = Mavsdk(Configuration.create_manual(255, 190, always_send_heartbeats=True))
    mavsdk.add_any_connection(f"udpin://127.0.0.1:{PORT}")
    with simulated(vehicle, PORT):
        system = mavsdk.first_autopilot(10.0)
        assert system.get_system_id() == 1
        wait_for(lambda: vehicle.ready)
        telemetry, raw = Telemetry(system), MissionRaw(system)
        items = [item(0, 16), item(1, 22), item(2, 16), item(3, 16)]
        raw.upload_mission(items)
        assert [item.x for item in vehicle.store.items[MissionType.MISSION]] == [item.x for item in items]
        assert [item.x for item in raw.download_mission()][1:] == [item.x for item in items][1:]
        Action(system).arm()
        wait_for(telemetry.armed)
        raw.start_mission()
        wait_for(lambda: vehicle.flies)
        telemetry.set_rate_position(5.0)
        wait_for(lambda: telemetry.position().relative_altitude_m > 50)
        assert telemetry.position().latitude_deg == pytest.approx(vehicle.body.latitude, abs=0.01)
    mavsdk.destroy()
