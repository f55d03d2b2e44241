"""What PX4 is told differently, and what of it is refused, with our simulated vehicle."""

import asyncio

import pytest
from worlds import AREA, Flight, flown, until

from adapters.mavlink import Craft
from adapters.mavlink.constants import Cmd, MavFrame, MissionType
from adapters.mavlink.items import OnboardItem, same
from adapters.mavlink.profiles import PX4_COPTER, PX4_DIALECT, mode_number
from adapters.plugin import Follow, GoTo, Hold, TakenOver
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
    ours, theirs = (
        OnboardItem(Cmd.WAYPOINT, 1, 2, 3.0, frame) for frame in (MavFrame.HOME, MavFrame.HOME_INT)
    )
    assert same((ours,), (theirs,), MissionType.MISSION)
    assert not same(
        (ours,), (OnboardItem(Cmd.WAYPOINT, 1, 2, 3.0, MavFrame.SEA_LEVEL_INT),), MissionType.MISSION
    )


@flown(Kind.PX4_COPTER, craft=Craft("uav0", fence=FENCE))
async def test_a_copter_holds_on_its_way_although_its_mode_stays_the_same(f):
    await f.accepts(GoTo("r1", "uav0", AREA))
    assert f.vehicle.mode == PX4_COPTER.guided == PX4_COPTER.hold
    assert f.vehicle.fence is not None
    await asyncio.sleep(20.0)
    await f.completes(Hold("r2", "uav0"))
    await asyncio.sleep(10.0)
    assert f.vehicle.body.speed < 1.0
    assert not contains(AREA, here(f))
    assert f.world.of(TakenOver) == []


@pytest.mark.parametrize("kind", [Kind.PX4_COPTER, Kind.PX4_PLANE])
@flown(by="kind")
async def test_a_path_has_no_home_and_no_take_off_among_its_items(f):
    await f.completes(Follow("r1", "uav0", PATH))
    items = f.vehicle.store.items[MissionType.MISSION]
    assert [item.command for item in items] == [Cmd.WAYPOINT, Cmd.LOITER_UNLIMITED]
    assert f.vehicle.current == 1


@flown(Kind.PX4_COPTER)
async def test_a_fence_that_stops_it_is_a_take_over_although_its_mode_stays_the_same(f):
    await f.accepts(GoTo("r1", "uav0", FAR))
    await asyncio.sleep(30.0)
    f.vehicle.stay()  # as at a fence with GF_ACTION 2
    await until(lambda: f.world.of(TakenOver))
    assert "it would need the command to go there" in f.world.of(TakenOver)[0].reason
    assert distance(here(f), point(37.0, -8.6)) < 400
