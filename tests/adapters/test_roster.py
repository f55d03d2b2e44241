"""Who is who on a link: by system id, by serial number, as the first heard."""

import asyncio
from dataclasses import replace

import packets
import pytest
from worlds import AREA, EPOCH, HOME, World, flown, running, simulated, until

from adapters.mavlink import Autopilot, Craft, Stations
from adapters.mavlink.message import say
from adapters.mavlink.pilot import Pilot
from adapters.mavlink.roster import Roster, find, serial_of
from adapters.plugin import GoTo
from adapters.simulated import Kind, Simulator, Vehicle

NOTHING = {
    **dict.fromkeys(["capabilities", "flight_sw_version", "middleware_sw_version", "os_sw_version"], 0),
    **dict.fromkeys(["board_version", "vendor_id", "product_id"], 0),
    **{f"{part}_custom_version": [0] * 8 for part in ("flight", "middleware", "os")},
}


def version(system=1, uid=0, uid2=b""):
    message = say("AUTOPILOT_VERSION", uid=uid, uid2=list(uid2.ljust(18, b"\0")), **NOTHING)
    return replace(message, system=system, component=1)


def beat(system=1):
    return replace(packets.beat(2, mode=1), system=system, component=1)


def pilots(*crafts):
    return [Pilot(craft, Stations(), 0 if craft.serial else craft.system or 0) for craft in crafts]


def test_a_serial_number_is_the_long_one_else_the_short_one_else_none():
    assert serial_of(version(uid2=bytes.fromhex("2F003B00AA"))) == "2F003B00AA"
    assert serial_of(version(uid=0x2F)) == "000000000000002F"
    assert serial_of(version()) == ""


def test_a_vehicle_known_by_its_serial_number_is_asked_for_it_once_a_second_and_not_believed_before():
    expected = pilots(Craft("uav0", serial="2F"))
    found = find(Roster(), expected, beat(), 0.0)
    assert (found.pilot, found.question["param1"]) == (None, 148.0)
    assert find(found.roster, expected, beat(), 0.5).question is None
    assert find(found.roster, expected, beat(), 1.0).question is not None
    told = find(found.roster, expected, version(uid2=b"\x2f"), 1.1)
    assert (told.pilot.craft.entity, told.pilot.system) == ("uav0", 1)


def test_another_serial_number_is_a_strangers_also_under_the_right_system_id():
    expected = pilots(Craft("uav0", system=1, serial="2F"))
    told = find(Roster(), expected, version(uid2=b"\x30"), 0.0)
    assert (told.pilot, told.stranger) == (None, True)
    assert find(told.roster, expected, beat(), 0.1).stranger
    assert find(Roster(), expected, version(system=2, uid2=b"\x2f"), 0.0).pilot is None  # not its system id


def test_who_has_no_number_is_the_first_that_is_none_of_the_others():
    expected = pilots(Craft("uav0", serial="2F"), Craft("uav1"))
    told = find(Roster(), expected, version(system=7, uid2=b"\x30"), 0.0)
    assert (told.pilot.craft.entity, told.pilot.system) == ("uav1", 7)


@simulated
async def test_vehicles_that_came_with_swapped_system_ids_are_told_apart_by_their_serial_numbers():
    world = World()
    crafts = [Craft("uav0", serial="AA01"), Craft("uav1", serial="AA02")]
    plugin = Autopilot("autopilot", "udp:127.0.0.1:0", crafts)
    homes = {2: HOME, 1: (37.02, -8.6, 20.0)}
    async with running(plugin.run(world)):
        await until(lambda: plugin.local)
        fleet = [
            Vehicle(Kind.COPTER, homes[system], system, serial=bytes([0xAA, 3 - system])) for system in (1, 2)
        ]
        async with running(Simulator(f"udpout:127.0.0.1:{plugin.local[1]}", fleet, epoch=EPOCH).run()):
            await until(lambda: world.property("uav0") and world.property("uav1"))
    assert world.property("uav0").geometry.vertices[0] == pytest.approx(HOME[:2], abs=1e-5)
    assert (plugin.pilot("uav0").system, plugin.pilot("uav1").system) == (2, 1)


@flown(craft=Craft("uav0", serial="2F"), serial=b"\x30")
async def test_a_vehicle_with_the_wrong_serial_number_is_reported_and_never_flown(f):
    await until(lambda: "unknown vehicle" in f.world.troubles())
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    await asyncio.sleep(60)
    assert not f.vehicle.armed
    assert f.world.published == []
    assert "system 1 with serial number 30" in f.world.reports[0].detail
