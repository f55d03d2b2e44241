"""Positions and heights: what counts as one, what is said where there is none, and above what heights are."""

import asyncio
from dataclasses import replace

import pytest
from scale import long_ones
from worlds import AREA, HOME, flown, until

from adapters.live.loop import NotHeard
from adapters.mavlink.constants import Cmd, MavFrame, MissionType
from adapters.mavlink.message import say
from adapters.mavlink.telemetry import Telemetry, absorb
from adapters.mavlink.vehicle_faults import FaultState, look
from adapters.plugin import Arrived, Follow, GoTo, Status, TakenOver, Trouble
from adapters.simulated import Kind, Vehicle, protocol
from adapters.simulated.reporting import Reporter
from physical import Band, box, point

NO_FIX, FIX = 1, 3
GOOD, CONSTANT, PREDICTED = 831, 165, 933
NEAR = box((37.003, -8.601), (37.002, -8.603))


def told(*messages):
    known = Telemetry()
    for second, (name, fields) in enumerate(messages):
        known = absorb(known, replace(say(name, **fields), system=1, component=1), float(second))
    return known


def receiver(name, fix):
    fields = ("time_usec", "lat", "lon", "alt", "eph", "epv", "vel", "cog", "satellites_visible")
    more = {"dgps_numch": 0, "dgps_age": 0} if name == "GPS2_RAW" else {}
    return name, {"fix_type": fix, **dict.fromkeys(fields, 0), **more}


def filters(flags):
    kinds = ("velocity", "pos_horiz", "pos_vert", "compass", "terrain_alt")
    return "EKF_STATUS_REPORT", {"flags": flags, **{f"{kind}_variance": 0.0 for kind in kinds}}


@pytest.mark.parametrize(
    ("messages", "lacks"),
    [
        ((), "it has no position: it reports no GPS"),
        ((receiver("GPS_RAW_INT", NO_FIX),), "it has no position: GPS fix 1"),
        ((receiver("GPS_RAW_INT", FIX),), ""),
        ((receiver("GPS_RAW_INT", NO_FIX), receiver("GPS2_RAW", FIX)), ""),
        ((receiver("GPS_RAW_INT", NO_FIX), filters(GOOD)), ""),
        (
            (receiver("GPS_RAW_INT", FIX), receiver("GPS2_RAW", 0), filters(CONSTANT)),
            "it has no position: GPS fix 3, GPS 2 fix 0, its own estimate is not good",
        ),
    ],
)
def test_a_position_counts_by_the_vehicles_own_estimate_or_else_by_the_fix_of_any_receiver(messages, lacks):
    assert told(*messages).lacks(3.0) == lacks


@pytest.mark.parametrize(
    ("base_mode", "flags", "placed"),
    [
        (1, PREDICTED, True),  # disarmed
        (129, PREDICTED, False),
        (129, GOOD, True),
        (1, CONSTANT, False),
        (1, PREDICTED | 1024, False),  # not initialised
    ],
)
def test_a_position_that_a_filter_predicts_counts_until_the_vehicle_is_armed(base_mode, flags, placed):
    beat = {"type": 2, "autopilot": 3, "base_mode": base_mode, "custom_mode": 0, "system_status": 3}
    known = told(receiver("GPS_RAW_INT", FIX), ("HEARTBEAT", beat), filters(flags))
    assert known.is_placed(3.0) == placed


def test_what_a_receiver_does_not_tell_any_more_does_not_count():
    known = told(receiver("GPS_RAW_INT", FIX))
    assert known.lacks(10.0) == ""
    assert known.lacks(11.0) == "it has no position: GPS fix no longer reported"


@flown(Kind.PLANE, second=True)
async def test_a_plane_whose_first_receiver_fails_arrives_by_its_second(f):
    await f.accepts(GoTo("r1", "uav0", AREA))
    f.vehicle.fixed = False
    assert isinstance(await f.ended("r1"), Arrived)
    assert f.world.of(Trouble, what="no position") == []


@pytest.mark.parametrize("kind", [Kind.PLANE, Kind.PX4_PLANE])
@flown(by="kind")
async def test_a_vehicle_that_loses_its_position_in_flight_is_said_to_have_none_and_why(f):
    await f.accepts(GoTo("r1", "uav0", AREA))
    f.vehicle.fixed = False
    await asyncio.sleep(42)
    (lost,) = f.world.of(Trouble, what="no position")
    why = "it has no position: GPS fix 1, its own estimate is not good"
    assert lost.detail == f"{why}; its position is unknown"
    last = f.world.published[-1]  # it says (0, 0) now, and what was published last ages
    assert f.world.now() - last.property.time > 20
    assert all(published.property.geometry.vertices[0][0] > 36 for published in f.world.published)
    assert last.time_to_live == 30.0
    f.vehicle.fixed = True
    await until(lambda: f.world.of(Trouble, what="position again"), 10)


def test_a_run_that_does_not_begin_says_whether_a_vehicle_is_silent_or_has_no_position():
    said = {"uav0": Status("uav0", 1.0, lacks="it has no position: GPS fix 1")}
    error = NotHeard(["uav0", "uav1"], said)
    assert str(error) == "nothing was heard of uav1; uav0 is heard, and it has no position: GPS fix 1"
    assert not error.heard
    assert NotHeard(["uav0"], said).heard


# --- heights ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", [Kind.BOAT, Kind.COPTER])
@flown(by="kind")
async def test_what_moves_on_the_water_has_no_height(f):
    await until(lambda: any(each.mode and not each.lacks for each in f.world.of(Status)), 20)
    last = f.world.of(Status)[-1]
    assert last.surface == (f.vehicle.kind is Kind.BOAT)
    assert (last.height is None) == last.surface


@flown(Kind.PLANE)
async def test_a_target_at_the_same_point_and_another_height_is_not_ours(f):
    await f.completes(GoTo("r1", "uav0", AREA))
    assert f.vehicle.target.height == 100.0
    f.vehicle.target = replace(f.vehicle.target, height=400.0)
    (taken,) = await until(lambda: f.world.of(TakenOver), 20)
    assert taken.reason.endswith("to go there at another height: its target is 420 m above sea level")


@pytest.mark.parametrize(
    ("kind", "band"),
    [
        (Kind.PLANE, Band(100.0, 140.0)),
        *long_ones((Kind.COPTER, None), (Kind.PX4_COPTER, Band(100.0, 140.0))),
    ],
)
@flown(by="kind")
async def test_a_home_that_is_moved_is_said_and_the_next_leg_is_flown_above_the_home_before(f, kind, band):
    await f.completes(GoTo("r1", "uav0", NEAR if kind is not Kind.PLANE else AREA, band))
    latitude, longitude, altitude = f.vehicle.home
    before = altitude + f.vehicle.target.height
    f.vehicle.set_home(latitude, longitude, altitude + 300.0)
    (moved,) = await until(lambda: f.world.of(Trouble, what="home moved"), 20)
    assert moved.detail.startswith(
        "its home was moved by 0 m and +300 m in height, by itself or by a command"
    )
    await f.completes(GoTo("r2", "uav0", point(37.004, -8.6), band))
    assert f.vehicle.home[2] + f.vehicle.target.height == pytest.approx(before, abs=0.2)
    assert f.world.of(TakenOver) == []


@flown(Kind.PLANE)
async def test_a_path_in_a_band_is_uploaded_above_sea_level(f):
    await f.accepts(Follow("r1", "uav0", (point(37.004, -8.604), AREA), Band(150.0, 190.0)))
    flown = f.vehicle.store.items[MissionType.MISSION][1:]
    assert {(item.frame, item.z) for item in flown} == {(MavFrame.SEA_LEVEL, 170.0)}
    assert isinstance(await f.ended("r1"), Arrived)
    assert f.vehicle.home[2] + f.vehicle.body.height == pytest.approx(170.0, abs=3.0)


def test_a_simulated_vehicle_stays_where_it_is_when_its_home_is_moved_by_command():
    vehicle, reporter = Vehicle(Kind.COPTER, HOME), Reporter()
    moves = {"frame": 0, "command": int(Cmd.DO_SET_HOME), "current": 0, "autocontinue": 0, "z": 50.0}
    numbers = dict.fromkeys(("param1", "param2", "param3", "param4"), 0.0)
    there = {"x": 371_000_000, "y": -86_000_000, "target_system": 1, "target_component": 1}
    told = replace(say("COMMAND_INT", **moves, **numbers, **there), system=255, component=190)
    (answer,) = protocol.hear(vehicle, reporter, told, 1.0)
    assert (answer["command"], answer["result"]) == (179, 0)
    assert vehicle.home == (37.1, -8.6, 50.0)
    assert vehicle.home[2] + vehicle.body.height == HOME[2]
    assert not vehicle.flies


def test_a_home_that_arming_sets_anew_was_not_moved():
    known = Telemetry(armed=True, base=(37.0, -8.6, 20.0), home=(37.00001, -8.6), ground=21.5, position=None)
    condition, reports = look(FaultState(), "uav0", known, 1.0, lost=False)
    assert (condition, reports) == (FaultState(), ())
