"""What is on board a vehicle: nothing of it is believed that was not read, and nothing is lost without a word.

Other stations write over links of their own, so nothing of it is heard here: the vehicle's memory just changes.
"""

import asyncio

import pytest
from scale import some_long
from worlds import AREA, flight, flown, simulated, until

from adapters.mavlink import Craft
from adapters.mavlink.constants import Cmd, Fence, MavFrame, MissionResult, MissionType
from adapters.mavlink.items import OnboardItem, fence, route, same
from adapters.mavlink.task import PATIENCE
from adapters.plugin import (
    Arrived,
    Follow,
    GiveBack,
    GoTo,
    Hold,
    Rejected,
    Return,
    Status,
    TakenOver,
    Trouble,
)
from adapters.simulated import Kind
from adapters.simulated.body import metres_to
from physical import box, circle, contains, point, polygon

WIDE = box((37.05, -8.55), (36.95, -8.65))
GATES = (circle((37.012, -8.6), 200), circle((37.012, -8.615), 200))
WAY = (*GATES, box((37.035, -8.61), (37.025, -8.625)))
AWAY = (point(36.98, -8.6), point(36.96, -8.6), point(36.94, -8.6))
"""Somebody's mission: as many items as ours, elsewhere."""

PLANES = [Kind.PLANE, Kind.PX4_PLANE]


def theirs(f, path=AWAY, more=()):
    """Let somebody else load a mission."""
    profile = f.vehicle.kind.profile
    items = route(path, 100.0, takeoff=not profile.dialect.typed, home=profile.dialect.home_is_item)
    f.vehicle.store.items[MissionType.MISSION] = (*items, *more)
    return items


def mission(f):
    return f.vehicle.store.items[MissionType.MISSION]


def e7(latitude, longitude):
    return round(latitude * 1e7), round(longitude * 1e7)


def no_fly(latitude, longitude, radius):
    more = 0.0, MavFrame.SEA_LEVEL, (radius, 0.0, 0.0, 0.0)
    return OnboardItem(Cmd.FENCE_CIRCLE_EXCLUSION, *e7(latitude, longitude), *more)


async def finds(f, kind, *items):
    """Let a vehicle have something on board, and wait until it is read."""
    f.vehicle.store.items[kind] = items
    await until(f.plugin.is_known, 60)


def remarked(f, text):
    return any(text in each for each in f.plugin.remarks())


def inside(f, place):
    return contains(place, point(f.vehicle.body.latitude, f.vehicle.body.longitude))


# --- other people's missions --------------------------------------------------------------------------


@pytest.mark.parametrize("kind", PLANES)
@flown(by="kind")
async def test_a_mission_that_somebody_loads_while_it_is_held_is_not_flown_when_it_is_given_back(f, kind):
    await f.accepts(Follow("r1", "uav0", WAY))
    ours = mission(f)
    await f.plugin.command(Hold("r2", "uav0"))
    await f.ended("r2")
    theirs(f)
    await f.plugin.command(GiveBack("r3", "uav0"))
    await f.plugin.command(Follow("r4", "uav0", WAY))
    flown = set()
    note = lambda: flown.add(mission(f)) if f.vehicle.mode == kind.profile.auto else None  # noqa: E731
    await until(lambda: note() or f.world.of(Arrived, request="r4"), 900)
    assert [same(ours, each, MissionType.MISSION) for each in flown] == [True]


@simulated
async def test_a_copter_that_has_landed_is_not_armed_for_a_mission_that_somebody_loaded_meanwhile():
    way = (circle((37.001, -8.601), 20), circle((37.002, -8.602), 20))
    async with flight(Kind.COPTER) as f:
        await f.plugin.command(Follow("r1", "uav0", way))
        await f.ended("r1")
        ours = mission(f)
        f.vehicle.arm(armed=False)
        await until(lambda: f.world.of(TakenOver))
        theirs(f, AWAY[:2])
        await f.plugin.command(GiveBack("r2", "uav0"))
        await f.plugin.command(Follow("r3", "uav0", way))
        await until(lambda: f.vehicle.armed)
        assert same(ours, mission(f), MissionType.MISSION)
        assert isinstance(await f.ended("r3"), Arrived)


@pytest.mark.parametrize("moment", ["begun", "auto"])
@flown()
async def test_a_mission_that_somebody_loads_at_the_last_moment_is_not_armed_for(f, moment):
    await f.plugin.command(Follow("r1", "uav0", WAY))
    auto = f.vehicle.kind.profile.auto
    await until(
        lambda: f.vehicle.mode == auto if moment == "auto" else f.plugin.pilot("uav0").moving.begun,
        every=0.02,
    )
    assert not f.vehicle.armed
    ours = mission(f)
    theirs(f)
    await until(lambda: f.vehicle.armed)
    assert same(ours, mission(f), MissionType.MISSION)


@pytest.mark.parametrize("kind", PLANES)
@pytest.mark.parametrize("path", [AWAY, (*AWAY, point(36.92, -8.6))], ids=["as long", "longer"])
@flown(by="kind")
async def test_a_mission_that_somebody_loads_while_ours_is_flown_is_a_take_over(f, path):
    await f.accepts(Follow("r1", "uav0", WAY))
    theirs(f, path)
    (report,) = await until(lambda: f.world.of(TakenOver), 30)
    assert report.reason.startswith("the mission on board is not the one sent")
    assert isinstance(await f.ended("r1"), Rejected)
    items = mission(f)
    await asyncio.sleep(60)
    assert mission(f) == items  # it is not fought


# --- places of a way ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "item"), [*zip(PLANES, (-1, -2), strict=True)], ids=["to the end", "to the second gate"]
)
@flown(by="kind")
async def test_the_number_of_an_item_that_somebody_sets_passes_no_place(f, item):
    await f.accepts(Follow("r1", "uav0", WAY))
    assert not inside(f, GATES[0])
    f.vehicle.current = len(mission(f)) + item
    (report,) = await until(lambda: f.world.of(TakenOver), 30)
    assert "of its mission, not to item" in report.reason
    await until(lambda: inside(f, WAY[-1]))
    await asyncio.sleep(20)
    assert f.world.of(Arrived) == []


@flown()
async def test_a_mission_that_is_set_back_is_a_take_over(f):
    await f.accepts(Follow("r1", "uav0", WAY))
    await until(lambda: f.vehicle.current == 3)
    await asyncio.sleep(5)
    f.vehicle.current = 2
    (report,) = await until(lambda: f.world.of(TakenOver), 30)
    assert "it would need the command to fly to item 3 of its mission, not to item 2" in report.reason


@flown()
async def test_a_place_that_the_vehicle_would_turn_before_is_entered_and_a_mission_that_is_read_is_flown_to_its_end(
    f,
):
    small = circle((37.012, -8.6), 20)
    await f.plugin.command(Follow("r1", "uav0", (small, WAY[-1])))
    await until(lambda: inside(f, small), every=0.1)
    assert isinstance(await f.ended("r1"), Arrived)
    assert mission(f)[2].parameters[1] == 12.5  # instead of WP_RADIUS, 50 m
    await asyncio.sleep(60)
    assert f.world.of(TakenOver) == []


# --- fences -------------------------------------------------------------------------------------------


@simulated
async def test_a_fence_that_somebody_clears_while_others_are_on_is_noticed_and_is_there_again_after_a_give_back():
    parameters = {"FENCE_TYPE": 7.0, "FENCE_RADIUS": 9_000.0, "FENCE_ALT_MAX": 500.0}
    async with flight(craft=Craft("uav0", fence=WIDE), parameters=parameters) as f:
        f.vehicle.switch_fences(~Fence.ALT_MIN, on=True)
        await f.accepts(GoTo("r1", "uav0", WAY[-1]))
        f.vehicle.store.items[MissionType.FENCE] = ()
        assert f.vehicle.fences & f.vehicle.configured  # it says that it keeps within a fence
        (report,) = await until(lambda: f.world.of(TakenOver), 60)
        assert report.reason.startswith("the fence on board is not the one sent")
        await f.plugin.command(GiveBack("r2", "uav0"))
        await f.accepts(GoTo("r3", "uav0", WAY[-1]))
        assert f.vehicle.fence is not None


@pytest.mark.parametrize("away", [6, 40])
@flown(craft=Craft("uav0", fence=WIDE), enforce=False)
async def test_a_fenced_vehicle_that_obeyed_somebody_else_for_a_while_goes_on_with_its_flight(f, away):
    await f.accepts(GoTo("r1", "uav0", circle((37.022, -8.61), 300)))
    ours, f.vehicle.parameters["SYSID_MYGCS"] = f.vehicle.parameters["SYSID_MYGCS"], 252.0
    await asyncio.sleep(away)
    assert f.world.of(Status)[-1].authority == ("system 252",)
    f.vehicle.parameters["SYSID_MYGCS"] = ours
    end = await f.ended("r1")
    assert isinstance(end, Arrived), end
    assert not f.world.of(TakenOver)


@pytest.mark.parametrize("kind", [Kind.PLANE, Kind.PX4_COPTER])
@simulated
async def test_a_zone_to_stay_out_of_stays_on_board_beside_the_fence(kind):
    zone = no_fly(37.02, -8.56, 300.0)
    async with flight(kind, craft=Craft("uav0", fence=WIDE)) as f:
        await finds(f, MissionType.FENCE, zone)
        assert remarked(f, "keeps a circle of 300 m")
        await f.accepts(GoTo("r1", "uav0", AREA))
        there = f.vehicle.store.items[MissionType.FENCE]
        assert len(there) == 5
        assert (there[-1].command, there[-1].parameters[0]) == (Cmd.FENCE_CIRCLE_EXCLUSION, 300.0)


@pytest.mark.parametrize("fenced", [True, False])
@simulated
async def test_a_flight_into_a_zone_to_stay_out_of_or_across_it_is_refused(fenced):
    craft = Craft("uav0", fence=WIDE if fenced else None)
    parameters = {} if fenced else {"FENCE_ENABLE": 1.0}
    async with flight(craft=craft, parameters=parameters) as f:
        await finds(f, MissionType.FENCE, no_fly(37.015, -8.6, 300.0))
        await f.refuses(
            GoTo("r1", "uav0", circle((37.0185, -8.6), 250), name="the bay"),
            r"the bay is not clear of a circle of 300 m .* on board",
        )
        beyond = circle((37.03, -8.6), 250)
        await f.refuses(
            GoTo("r2", "uav0", beyond, name="the bay"),
            "the straight way to the bay crosses a circle of 300 m",
        )
        round_it = circle((37.015, -8.59), 200)
        await f.plugin.command(Follow("r3", "uav0", (round_it, beyond), name="the bay"))


@simulated
async def test_another_zone_to_stay_in_is_kept_and_bounds_what_is_flown():
    other = polygon([(37.0125, -8.59), (36.98, -8.59), (36.98, -8.63), (37.0125, -8.63)])
    async with flight(craft=Craft("uav0", fence=WIDE)) as f:
        await finds(f, MissionType.FENCE, *fence(other))
        await f.refuses(
            GoTo("r1", "uav0", WAY[-1]), "is not inside a polygon of 4 corners to stay in, which is on board"
        )
        await f.accepts(GoTo("r2", "uav0", circle((37.006, -8.61), 200)))
        assert len(f.vehicle.store.items[MissionType.FENCE]) == 8


@pytest.mark.parametrize("wider", [True, False])
@flown(Kind.PX4_COPTER, craft=Craft("uav0", fence=WIDE))
async def test_where_one_of_several_zones_is_enough_a_wider_one_is_replaced_and_another_refused(f, wider):
    there = GoTo("r1", "uav0", box((37.003, -8.601), (37.002, -8.603)))
    zone = box((37.1, -8.5), (36.9, -8.7)) if wider else box((37.04, -8.5), (36.96, -8.6))
    await finds(f, MissionType.FENCE, *fence(zone))
    if wider:
        assert remarked(f, "loses a polygon of 4 corners to stay in")
        await f.accepts(there)
        assert len(f.vehicle.store.items[MissionType.FENCE]) == 4
    else:
        await f.refuses(there, "with both it could fly in either")


# --- landing sequences --------------------------------------------------------------------------------

LANDING = (
    OnboardItem(Cmd.DO_LAND_START, 0, 0, 0.0, MavFrame.SEA_LEVEL),
    OnboardItem(Cmd.WAYPOINT, *e7(36.99, -8.61), 60.0),
    OnboardItem(Cmd.WAYPOINT, *e7(36.995, -8.605), 30.0),
    OnboardItem(Cmd.LAND, *e7(37.0, -8.6), 0.0),
)


@flown(parameters={"RTL_AUTOLAND": 2.0})
async def test_a_landing_sequence_stays_on_board_behind_each_mission_and_brings_the_plane_down(f):
    theirs(f, more=LANDING)
    await until(f.plugin.is_known, 60)
    (kept,) = [each for each in f.plugin.remarks() if "landing sequence" in each]
    assert kept.startswith("uav0 keeps its landing sequence: each upload ends with the last 4 items")
    await f.accepts(GoTo("r1", "uav0", AREA))
    assert [item.command for item in mission(f)[-4:]] == [item.command for item in LANDING]
    await f.accepts(Follow("r2", "uav0", WAY))
    assert [item.command for item in mission(f)[-4:]] == [item.command for item in LANDING]
    await f.completes(Return("r3", "uav0"), 1200)
    await until(lambda: not f.vehicle.armed)
    assert f.world.of(TakenOver) == []


@pytest.mark.parametrize(
    ("parameters", "more", "remark"),
    [
        (
            {"RTL_AUTOLAND": 2.0},
            None,
            "uav0 has no landing sequence on board, which its RTL_AUTOLAND needs: when it returns, it circles",
        ),
        (
            {},
            (LANDING[3],),
            "uav0 has a mission of 5 items on board, which the flights of this mission replace",
        ),
    ],
)
@flown(by="parameters")
async def test_a_landing_sequence_that_is_not_there_and_a_mission_that_is_replaced_are_named_before(
    f, more, remark
):
    if more:
        theirs(f, more=more)
    await until(f.plugin.is_known, 60)
    assert list(f.plugin.remarks()) == [remark]


@pytest.mark.parametrize("aside", [False, True])
@flown(parameters={"RTL_AUTOLAND": 2.0})
async def test_the_jumps_of_a_landing_sequence_keep_their_aims_and_one_out_of_it_is_refused(f, aside):
    to = 2.0 if aside else len(theirs(f)) + 1.0
    jump = OnboardItem(Cmd.DO_JUMP, 0, 0, 0.0, MavFrame.SEA_LEVEL, (to, 1.0, 0.0, 0.0))
    theirs(f, more=(*LANDING[:3], jump, LANDING[3]))
    await until(f.plugin.is_known, 60)
    if aside:
        await f.refuses(GoTo("r1", "uav0", AREA), "jumps to item 2, outside of it")
        return
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    await until(lambda: f.vehicle.armed)
    (moved,) = [item.parameters[0] for item in mission(f) if item.command == Cmd.DO_JUMP]
    assert moved == 4.0  # behind home, take-off, circle and the marker


# --- rally points -------------------------------------------------------------------------------------


def rally(latitude, longitude):
    return OnboardItem(Cmd.RALLY_POINT, *e7(latitude, longitude), 60.0)


@pytest.mark.parametrize("kind", some_long(PLANES))
@flown(craft=Craft("uav0", fence=WIDE), by="kind")
async def test_a_return_is_done_at_the_rally_point_that_it_leads_to(f):
    await finds(f, MissionType.RALLY, rally(37.01, -8.635))
    assert remarked(f, "rally points on board, 1: it returns to the nearest")
    await f.accepts(GoTo("r1", "uav0", AREA))
    await f.ended("r1")
    await asyncio.sleep(60)  # until it circles, nearer to that than to its home
    await f.completes(Return("r2", "uav0"))
    assert metres_to(f.vehicle.body, 37.01, -8.635)[0] < 200


@simulated
async def test_a_rally_point_outside_the_fence_is_refused_and_a_return_to_it_is_said():
    outside = rally(37.07, -8.6)
    async with flight(craft=Craft("uav0", fence=WIDE)) as f:
        await finds(f, MissionType.RALLY, outside)
        why = "its rally point 1 lies 22.. m outside the fence, and it returns to the nearest: remove it"
        await f.refuses(GoTo("r1", "uav0", AREA), why)
        f.vehicle.store.items[MissionType.RALLY] = ()
        await asyncio.sleep(70)
        await f.accepts(GoTo("r2", "uav0", AREA))
        f.vehicle.store.items[MissionType.RALLY] = (outside,)
        await asyncio.sleep(70)
        await f.plugin.command(Return("r3", "uav0"))
        (trouble,) = f.world.of(Trouble, what="returns outside its fence")
        assert "rally point 1" in trouble.detail


@flown(craft=Craft("uav0", fence=WIDE))
async def test_a_rally_point_of_another_airfield_is_no_matter(f):
    await finds(f, MissionType.RALLY, rally(38.0, -8.6))
    await f.accepts(GoTo("r1", "uav0", AREA))


# --- refusals -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("result", [MissionResult.INVALID, MissionResult.INVALID_PARAM1])
@flown()
async def test_a_refused_upload_is_refused_here_at_once_and_by_name(f, result):
    f.vehicle.store.refuses[MissionType.MISSION] = result
    await until(f.plugin.is_known, 60)
    await asyncio.sleep(20)
    told = f.world.now()
    await f.plugin.command(Follow("r1", "uav0", WAY))
    end = await f.ended("r1")
    assert end.reason.startswith(f"the vehicle refuses the mission: {result.name}")
    assert end.time - told < 10


@simulated
async def test_a_fence_of_more_corners_than_the_vehicle_holds_is_refused_in_seconds_and_in_its_words():
    round_one = circle((37.0, -8.6), 5_000, 90)
    async with flight(craft=Craft("uav0", fence=round_one)) as f:
        await until(f.plugin.is_known, 60)
        await asyncio.sleep(20)
        told = f.world.now()
        await f.plugin.command(GoTo("r1", "uav0", AREA))
        end = await f.ended("r1")
        assert end.reason.startswith("the vehicle refuses the fence: NO_SPACE; its last words: ")
        assert "Only 84 items are supported" in end.reason
        assert end.time - told < 15
        (trouble,) = f.world.of(Trouble, what="refused for now")
        assert trouble.time - told < 5


@flown(craft=Craft("uav0", fence=WIDE))
async def test_a_fence_that_is_never_written_is_refused_with_the_vehicles_answer(f):
    f.vehicle.store.refuses[MissionType.FENCE] = MissionResult.ERROR
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    end = await f.ended("r1")
    assert "after 5 uploads, and the vehicle answers ERROR" in end.reason
    assert end.time - f.world.of(Trouble, what="refused for now")[0].time < PATIENCE


@pytest.mark.parametrize(
    "parameters", [{"ARMING_MIS_ITEMS": 8.0}, {"FENCE_AUTOENABLE": 3.0, "FENCE_ALT_MAX": 500.0}]
)
@flown(craft=Craft("uav0", fence=WIDE), by="parameters")
async def test_a_take_off_in_its_mission_and_fences_that_come_on_by_arming_are_given_to_who_asks_for_them(f):
    await f.accepts(GoTo("r1", "uav0", AREA))
