"""Faults and foes on the link: the flight ends well or is reported, and nothing is made up."""

import asyncio
import socket
from dataclasses import replace

import pytest
from packets import beat, fixed, position
from scale import long_ones, seeds
from worlds import AREA, EPOCH, World, flown, running, simulated, until

from adapters.mavlink import Autopilot, Craft, Stations
from adapters.mavlink.codec import Encoder
from adapters.mavlink.message import say
from adapters.mavlink.signing import Signing
from adapters.plugin import Arrived, GoTo, HandOver, LinkLost, LinkRestored, Rejected, Trouble
from adapters.simulated import Disturbance, Kind, Simulator, Vehicle
from physical import box, contains, point

BAD = Disturbance(loss=0.3, duplication=0.1, delay=(0.0, 1.0))
SYSTEM = 5  # the byte of a frame that has its sender
TWO = Stations({"gcs0": 255, "gcs1": 254}, ("gcs0", "gcs1"))


async def send(f, encoder, *messages):
    """Send to the plugin from the address from which it hears the system already, else from one of its own."""
    known = f.plugin._routes.get(encoder.pack(messages[0])[SYSTEM], ("127.0.0.1", 0))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.bind(known)
        for message in messages:
            link.sendto(encoder.pack(message), f.plugin.local)
            await asyncio.sleep(0.05)


def here(vehicle):
    return point(vehicle.body.latitude, vehicle.body.longitude)


@pytest.mark.parametrize("kind", [Kind.PLANE, *long_ones(Kind.COPTER)])
@seeds(3, 1)
@flown(disturbance=BAD, craft=Craft("uav0", fence=box((37.05, -8.55), (36.95, -8.65))), by="kind seed")
async def test_it_arrives_though_a_third_is_lost_and_the_rest_comes_late_twice_and_in_disorder(f):
    await f.completes(GoTo("r1", "uav0", AREA))
    assert contains(AREA, here(f.vehicle))
    assert f.vehicle.fence is not None


@seeds(8, 3)
@flown(disturbance=BAD, stations=TWO, by="seed")
async def test_a_hand_over_works_on_the_same_bad_link_though_answers_are_lost(f):
    """A vehicle that obeys the next station already doesn't answer the one before."""
    await f.completes(HandOver("r1", "uav0", "control:gcs0", "control:gcs1"))
    assert f.vehicle.parameters["SYSID_MYGCS"] == 254


@flown(disturbance=Disturbance(blackouts=((60.0, 70.0),)), craft=Craft("uav0", channels=("wifi",)))
async def test_a_blackout_is_reported_and_takes_the_channels_and_the_flight_goes_on(f):
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    lost = (await until(lambda: f.world.of(LinkLost)))[0]
    assert lost.since == pytest.approx(EPOCH + 60, abs=0.5)
    assert f.world.property("uav0").channels == ()
    assert isinstance(await f.ended("r1"), Arrived)
    assert len(f.world.of(LinkRestored, rebooted=False)) == 1
    assert f.world.property("uav0").channels == ("control:gcs0", "wifi")


@flown()
async def test_a_watchdog_reboot_in_flight_is_reported_and_the_flight_goes_on(f):
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    await until(lambda: f.vehicle.body.height > 60)
    f.simulator.reboot(1, armed=True)
    await until(lambda: f.world.of(LinkRestored, rebooted=True))
    assert isinstance(await f.ended("r1"), Arrived)
    assert contains(AREA, here(f.vehicle))


@flown()
async def test_a_vehicle_that_comes_back_disarmed_is_not_armed_again(f):
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    await until(lambda: f.vehicle.body.height > 60)
    f.simulator.reboot(1)
    end = await f.ended("r1")
    assert isinstance(end, Rejected)
    assert "disarmed" in end.reason
    await asyncio.sleep(60)
    assert not f.vehicle.armed


@flown(craft=Craft("uav0", system=7))
async def test_what_a_vehicle_tells_another_station_is_not_taken_for_an_answer(f):
    for target, heard in ((253, False), (255, True)):
        request = say("MISSION_REQUEST", target_system=target, target_component=190, seq=0, mission_type=0)
        await send(f, Encoder(7, 1), request)
        assert (f.plugin.pilot("uav0").known.heard is not None) == heard


@flown(craft=Craft("uav0", system=7))
async def test_positions_at_zero_are_refused_even_from_a_receiver_that_claims_a_fix(f):
    encoder = Encoder(7, 1)
    await send(f, encoder, fixed())
    for time, latitude in enumerate((0.00029, 200.0, 37.0), 1):
        assert f.plugin.pilot("uav0").known.position is None
        await send(f, encoder, position((latitude, 0.000008), time))
    assert f.plugin.pilot("uav0").known.position.latitude == 37.0


@pytest.mark.parametrize("clock", [0, 1, 2**32 - 1])
@flown()
async def test_a_vehicle_clock_in_the_past_or_the_future_does_not_reach_the_world(f, clock):
    await until(lambda: f.world.property("uav0"))
    f.simulator._broadcast(f.vehicle, [say("SYSTEM_TIME", time_unix_usec=2**60, time_boot_ms=clock)])
    await asyncio.sleep(20)
    assert 0 <= f.world.now() - f.world.property("uav0").time < 1.0


@flown()
async def test_a_vehicle_that_is_in_no_mission_is_reported(f):
    await until(lambda: f.world.property("uav0"))
    other = replace(f.vehicle, system=9)
    encoder = Encoder(other.system, 1)
    for _ in range(5):
        await send(f, encoder, beat(1, 3))
        await asyncio.sleep(1)
    (trouble,) = f.world.of(Trouble, what="unknown vehicle")  # once, not with each heartbeat
    assert trouble.count == 1


@pytest.mark.parametrize(
    ("sort", "reason"),
    [((2, 13), "no vehicle with ArduPilot or PX4"), ((20, 12), "PX4, of which only planes and copters")],
)
@flown(craft=Craft("uav0", system=7))
async def test_what_no_profile_fits_is_rejected_with_the_reason(f, sort, reason):
    encoder = Encoder(7, 1)
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    await send(f, encoder, *[beat(*sort, 1)] * 100)
    assert reason in f.world.of(Rejected, request="r1")[0].reason


def fleet(count):
    """Vehicles and crafts for one link."""
    vehicles = [
        Vehicle(Kind.PLANE, (37.0, -8.6 + number * 0.002, 20.0), number + 1) for number in range(count)
    ]
    return vehicles, [Craft(f"uav{number}", system=number + 1) for number in range(count)]


@pytest.mark.long
@pytest.mark.parametrize(("count", "disturbance"), [(4, BAD), (10, Disturbance())])
@simulated
async def test_many_planes_on_one_link_all_arrive(count, disturbance):
    vehicles, crafts = fleet(count)
    world, plugin = World(), Autopilot("autopilot", "udp:127.0.0.1:0", crafts)
    async with running(plugin.run(world)):
        await until(lambda: plugin.local)
        simulator = Simulator(f"udpout:127.0.0.1:{plugin.local[1]}", vehicles, disturbance, epoch=EPOCH)
        async with running(simulator.run()):
            for craft in crafts:
                await plugin.command(GoTo(craft.entity, craft.entity, AREA))
            await until(lambda: len(world.of(Arrived)) == count)
    assert {report.entity for report in world.of(Arrived)} == {craft.entity for craft in crafts}
    assert all(contains(AREA, world.property(craft.entity).geometry) for craft in crafts)
    assert world.of(Rejected) == []


@flown()
async def test_a_vehicle_that_obeys_someone_else_and_does_not_answer_us_is_rejected_with_the_likely_cause(f):
    f.vehicle.parameters["SYSID_MYGCS"] = 200
    end = await f.rejects(GoTo("r1", "uav0", AREA), 200)
    assert "it may obey another" in end.reason
    assert not f.vehicle.armed


@flown(signing=Signing(b"k" * 32))
async def test_a_vehicle_that_asks_for_signed_packets_is_said_to(f):
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    (trouble,) = await until(lambda: f.world.of(Trouble, what="no answer"))
    assert trouble.detail == "it asks for signed packets: give its key, --key FILE"
    end = await f.ended("r1", 200)
    assert isinstance(end, Rejected)
    assert "it asks for signed packets" in end.reason


@pytest.mark.parametrize(("version", "name"), [((4, 6, 3), "SYSID_MYGCS"), ((4, 7, 0), "MAV_GCS_SYSID")])
@flown(stations=TWO, by="version")
async def test_whom_a_vehicle_obeys_is_read_and_set_by_the_name_that_its_version_has(f, name):
    await until(lambda: f.world.property("uav0"))
    assert f.world.property("uav0").channels == ("control:gcs0",)
    await f.completes(HandOver("r1", "uav0", "control:gcs0", "control:gcs1"))
    assert f.vehicle.parameters[name] == 254
    assert {"SYSID_MYGCS", "MAV_GCS_SYSID"} & f.vehicle.parameters.keys() == {name}
    await until(lambda: f.world.property("uav0").channels == ("control:gcs1",))
    await f.accepts(GoTo("r2", "uav0", AREA))  # now said by gcs1: nobody else is obeyed
