"""Faults and foes on the link: the flight ends well or is reported, and nothing is made up."""

import asyncio
import socket
from dataclasses import replace

import pytest
from worlds import AREA, EPOCH, World, flight, flown, running, simulated, until

from adapters.mavlink import Autopilot, Craft, Stations
from adapters.mavlink.codec import Encoder
from adapters.mavlink.command import long
from adapters.mavlink.constants import Cmd
from adapters.mavlink.message import say
from adapters.mavlink.signing import Signing
from adapters.plugin import (
    Accepted,
    Arrived,
    GoTo,
    HandOver,
    LinkLost,
    LinkRestored,
    Refused,
    Rejected,
    Trouble,
)
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


@pytest.mark.parametrize("kind", [Kind.PLANE, Kind.COPTER])
@pytest.mark.parametrize("seed", range(3))
@simulated
async def test_it_arrives_though_a_third_is_lost_and_the_rest_comes_late_twice_and_in_disorder(kind, seed):
    fence = box((37.05, -8.55), (36.95, -8.65))
    async with flight(kind, BAD, craft=Craft("uav0", fence=fence), seed=seed) as f:
        await f.plugin.command(GoTo("r1", "uav0", AREA))
        end = await f.ended("r1")
        assert isinstance(end, Arrived), end
        assert contains(AREA, here(f.vehicle))
        assert f.vehicle.fence is not None


@pytest.mark.parametrize("seed", range(8))
@flown(disturbance=BAD, stations=TWO, by="seed")
async def test_a_hand_over_works_on_the_same_bad_link_though_answers_are_lost(f):
    """A vehicle that obeys the next station already doesn't answer the one before."""
    await f.plugin.command(HandOver("r1", "uav0", "control:gcs0", "control:gcs1"))
    assert isinstance(await f.ended("r1"), Arrived)
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


@flown(disturbance=Disturbance(blackouts=((19.4, 31.0),)))
async def test_a_blackout_during_the_upload_delays_it_only(f):
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    assert isinstance(await f.ended("r1"), Arrived)


@flown(disturbance=Disturbance(blackouts=((60.0, 1e9),)))
async def test_a_vehicle_that_never_comes_back_is_lost_and_never_said_to_have_arrived(f):
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    await asyncio.sleep(600)
    assert f.world.of(LinkLost)
    assert not f.world.of(Arrived)
    assert contains(AREA, here(f.vehicle))  # it did arrive, but nobody could know


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


@flown()
async def test_someone_elses_change_of_mode_is_reported_and_not_fought(f):
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    await until(lambda: f.world.of(Accepted, request="r1"))
    f.vehicle.mode = 5  # a pilot takes over
    end = await f.ended("r1")
    assert isinstance(end, Rejected)
    assert "FBWA" in end.reason
    await asyncio.sleep(30)
    assert f.vehicle.mode == 5


@flown()
async def test_a_second_ground_station_is_reported_and_changes_nothing(f):
    encoder = Encoder(253, 190)
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    noise = (
        say("HEARTBEAT", type=6, autopilot=8, base_mode=0, custom_mode=0, system_status=4, mavlink_version=3),
        long(Cmd.DO_SET_MODE, 1, 1, 0),
        say("MISSION_COUNT", target_system=1, target_component=1, count=0, mission_type=0),
        say("MISSION_ACK", target_system=1, target_component=1, type=0, mission_type=0),
    )

    async def talk():
        while True:
            for message in noise:
                link.sendto(encoder.pack(message), f.plugin.local)
            await asyncio.sleep(0.5)

    talking = asyncio.ensure_future(talk())
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    assert isinstance(await f.ended("r1"), Arrived)
    assert "second ground station" in f.world.troubles()
    talking.cancel()
    link.close()


@flown(craft=Craft("uav0", system=7))
async def test_what_a_vehicle_tells_another_station_is_not_taken_for_an_answer(f):
    for target, heard in ((253, False), (255, True)):
        request = say("MISSION_REQUEST", target_system=target, target_component=190, seq=0, mission_type=0)
        await send(f, Encoder(7, 1), request)
        assert (f.plugin.pilot("uav0").known.heard is not None) == heard


@flown()
async def test_a_receiver_that_fails_in_flight_leaves_the_last_position_to_age(f):
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    await until(lambda: f.vehicle.body.height > 60)
    f.vehicle.fixed = False  # says (0, 0) from now on
    await asyncio.sleep(30)
    last = f.world.published[-1]
    assert f.world.now() - last.property.time > 20
    assert all(published.property.geometry.vertices[0][0] > 36 for published in f.world.published)
    assert last.time_to_live == 30.0


@flown(craft=Craft("uav0", system=7))
async def test_positions_at_zero_are_refused_even_from_a_receiver_that_claims_a_fix(f):
    encoder = Encoder(7, 1)
    fields = {"alt": 0, "relative_alt": 0, "vx": 0, "vy": 0, "vz": 0, "hdg": 0}
    rest = {"alt": 0, "eph": 0, "epv": 0, "vel": 0, "cog": 0, "satellites_visible": 9}
    await send(f, encoder, say("GPS_RAW_INT", time_usec=0, fix_type=3, lat=0, lon=0, **rest))
    for time, latitude in enumerate((2_900, 2_000_000_000, 370_000_000), 1):
        assert f.plugin.pilot("uav0").known.position is None
        await send(f, encoder, say("GLOBAL_POSITION_INT", time_boot_ms=time, lat=latitude, lon=80, **fields))
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
    beat = say(
        "HEARTBEAT", type=1, autopilot=3, base_mode=0, custom_mode=0, system_status=3, mavlink_version=3
    )
    for _ in range(5):
        await send(f, encoder, beat)
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
    beat = say(
        "HEARTBEAT",
        type=sort[0],
        autopilot=sort[1],
        base_mode=1,
        custom_mode=0,
        system_status=3,
        mavlink_version=3,
    )
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    await send(f, encoder, *[beat] * 100)
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
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    end = await f.ended("r1", 200)
    assert isinstance(end, Rejected)
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
    await f.plugin.command(HandOver("r1", "uav0", "control:gcs0", "control:gcs1"))
    assert isinstance(await f.ended("r1"), Arrived)
    assert f.vehicle.parameters[name] == 254
    assert {"SYSID_MYGCS", "MAV_GCS_SYSID"} & f.vehicle.parameters.keys() == {name}


@flown()
async def test_an_authority_that_changes_hands_is_published_and_reported_if_nobody_knows_it(f):
    f.vehicle.enforce = False
    await until(lambda: f.world.property("uav0"))
    f.vehicle.parameters["SYSID_MYGCS"] = 200
    await until(lambda: f.world.property("uav0").channels == ())
    assert "unknown authority" in f.world.troubles()
    with pytest.raises(Refused, match="it obeys system 200, not gcs0"):
        await f.plugin.command(GoTo("r1", "uav0", AREA))
