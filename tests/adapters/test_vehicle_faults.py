"""What an operator is told of a vehicle at once, and in whose name."""

import asyncio
from dataclasses import replace

from worlds import AREA, flight, flown, simulated, until

from adapters.mavlink import Craft
from adapters.mavlink.telemetry import Telemetry
from adapters.mavlink.vehicle_faults import FaultState, look
from adapters.plugin import GoTo, Hold, TakenOver, Trouble
from adapters.simulated import Kind
from physical import circle


@flown(Kind.PLANE, fault="Compass not calibrated")
async def test_why_a_vehicle_cannot_be_armed_is_said_at_once_and_each_reason_once(f):
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    (first,) = await until(lambda: f.world.of(Trouble, what="not ready"), 30)
    assert first.detail == "it cannot be armed: 'PreArm: Compass not calibrated'"
    await asyncio.sleep(70)
    f.vehicle.fault = "Throttle below failsafe"
    await until(lambda: len(f.world.of(Trouble, what="not ready")) > 1, 60)
    said = [each.detail for each in f.world.of(Trouble, what="not ready")]
    assert said == [first.detail, "it cannot be armed: 'PreArm: Throttle below failsafe'"]


def test_a_reason_of_before_a_flight_is_said_again_after_it():
    down = Telemetry(armed=False, words=((0.0, "PreArm: x"),))
    said, reports = look(FaultState(), "uav0", down, 1.0, lost=False)
    assert [each.what for each in reports] == ["not ready"]
    flown, reports = look(said, "uav0", replace(down, armed=True), 2.0, lost=False)
    assert reports == ()
    again = replace(down, words=((100.0, "PreArm: x"),))
    assert [each.what for each in look(flown, "uav0", again, 101.0, lost=False)[1]] == ["not ready"]


@simulated
async def test_a_vehicle_that_leaves_its_fence_says_so_where_it_is_taken_over():
    fence = circle((37.0, -8.6), 3000)
    async with flight(Kind.PLANE, craft=Craft("uav0", fence=fence)) as f:
        await f.plugin.command(GoTo("r1", "uav0", AREA))
        await f.ended("r1")
        f.vehicle.body = replace(f.vehicle.body, latitude=37.05)
        (taken,) = await until(lambda: f.world.of(TakenOver), 30)
        assert taken.reason == (
            "it said 'Polygon fence breached'; it is in RTL, by itself or by a command from elsewhere"
        )


@flown(Kind.COPTER, enforce=False)
async def test_a_vehicle_that_obeys_another_station_refuses_all_and_says_by_which_parameter(f):
    await until(lambda: f.plugin.pilot("uav0").known.authority, 60)
    f.vehicle.parameters["SYSID_MYGCS"] = 252.0
    (told,) = await until(lambda: f.world.of(Trouble, what="unknown authority"), 30)
    assert "obeys system 252 (SYSID_MYGCS)" in told.detail
    await until(lambda: f.world.property("uav0").channels == ())
    why = "it obeys system 252, not gcs0: its SYSID_MYGCS is 252, and gcs0 has 255"
    assert (await f.rejects(Hold("r1", "uav0"))).reason == why
    await f.refuses(GoTo("r2", "uav0", AREA), why)
