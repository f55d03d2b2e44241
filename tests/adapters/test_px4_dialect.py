"""What PX4 is told differently, and what of it is refused, with our simulated vehicle."""

import asyncio

import pytest
from worlds import AREA, Flight, flight, flown, simulated, until

from adapters.mavlink import Craft, Stations
from adapters.mavlink.constants import Cmd, Frame, MissionType
from adapters.mavlink.items import Item, same
from adapters.mavlink.profiles import PX4_COPTER, PX4_DIALECT, mode_number
from adapters.plugin import Accepted, Arrived, Follow, GoTo, HandOver, Hold, Refused, Rejected, TakenOver
from adapters.simulated import Kind
from physical import box, contains, distance, point

FENCE = box((37.05, -8.55), (36.95, -8.65))
FAR = box((37.04, -8.60), (37.03, -8.61))
PATH = (point(37.002, -8.602), point(37.004, -8.604))


def here(f: Flight):
    return point(f.vehicle.body.latitude, f.vehicle.body.longitude)


def test_modes_are_numbered_as_px4_numbers_them():
    assert PX4_COPTER.mode_name(50_593_792) == "AUTO.LOITER"  # as PX4's own program has sent it
    assert PX4_DIALECT.mode_parameters(mode_number(4, 5)) == (4, 5)


def test_frames_for_integers_are_the_same_frames():
    ours, theirs = (Item(Cmd.WAYPOINT, 1, 2, 3.0, frame) for frame in (Frame.HOME, Frame.HOME_INT))
    assert same((ours,), (theirs,), MissionType.MISSION)
    assert not same((ours,), (Item(Cmd.WAYPOINT, 1, 2, 3.0, Frame.SEA_LEVEL_INT),), MissionType.MISSION)


@flown(Kind.PX4_COPTER, craft=Craft("uav0", fence=FENCE))
async def test_a_copter_holds_on_its_way_although_its_mode_stays_the_same(f):
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    await until(lambda: f.world.of(Accepted, request="r1"))
    assert f.vehicle.mode == PX4_COPTER.guided == PX4_COPTER.hold
    assert f.vehicle.fence is not None
    await asyncio.sleep(20.0)
    await f.plugin.command(Hold("r2", "uav0"))
    assert isinstance(await f.ended("r2"), Arrived)
    await asyncio.sleep(10.0)
    assert f.vehicle.body.speed < 1.0
    assert not contains(AREA, here(f))
    assert f.world.of(TakenOver) == []


@pytest.mark.parametrize("kind", [Kind.PX4_COPTER, Kind.PX4_PLANE])
@flown(by="kind")
async def test_a_path_has_no_home_and_no_take_off_among_its_items(f):
    await f.plugin.command(Follow("r1", "uav0", PATH))
    assert isinstance(await f.ended("r1"), Arrived)
    items = f.vehicle.store.items[MissionType.MISSION]
    assert [item.command for item in items] == [Cmd.WAYPOINT, Cmd.LOITER_UNLIMITED]
    assert f.vehicle.current == 1


@flown(Kind.PX4_COPTER)
async def test_a_fence_that_stops_it_is_a_take_over_although_its_mode_stays_the_same(f):
    await f.plugin.command(GoTo("r1", "uav0", FAR))
    await until(lambda: f.world.of(Accepted, request="r1"))
    await asyncio.sleep(30.0)
    f.vehicle.stay()  # as at a fence with GF_ACTION 2
    await until(lambda: f.world.of(TakenOver))
    assert "it would have to be told to go there" in f.world.of(TakenOver)[0].reason
    assert distance(here(f), point(37.0, -8.6)) < 400


@pytest.mark.parametrize(
    ("parameters", "command", "reason"),
    [
        ({}, HandOver("r1", "uav0", "control:gcs0", "control:gcs1"), "PX4 obeys every station on its link"),
        ({"GF_ACTION": 1.0}, GoTo("r1", "uav0", AREA), "its GF_ACTION is 1; set it to 2"),
        (
            {"GF_MAX_HOR_DIST": 200.0},
            GoTo("r1", "uav0", AREA),
            "set GF_MAX_HOR_DIST to more, or to 0 for none",
        ),
        ({"MIS_TKO_LAND_REQ": 2.0}, Follow("r1", "uav0", PATH), "no path without a landing"),
    ],
)
@simulated
async def test_what_px4_cannot_do_is_refused_by_name_before_take_off(parameters, command, reason):
    stations = Stations({"gcs0": 255, "gcs1": 254}, ("gcs0", "gcs1"))
    craft = Craft("uav0", fence=FENCE)
    async with flight(Kind.PX4_COPTER, craft=craft, stations=stations, parameters=parameters) as f:
        await until(f.plugin.is_known)
        with pytest.raises(Refused, match=reason):
            await f.plugin.command(command)
        assert not f.vehicle.armed
        assert f.world.of(Rejected) == []
