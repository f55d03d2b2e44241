"""Another station changes missions, fences and targets of ArduPilot's own plane: the scenes of `test_on_board.py`."""

import asyncio
from contextlib import asynccontextmanager

import pytest
from sitl import SPEED, Station, linked, needs_simulators, tell
from worlds import AREA, HOME, until

from adapters.mavlink import Craft
from adapters.mavlink.command import long, reposition, set_parameter
from adapters.mavlink.constants import Cmd, MavFrame, MissionType
from adapters.mavlink.items import OnboardItem, route, same
from adapters.plugin import (
    Accepted,
    Arrived,
    Follow,
    GiveBack,
    GoTo,
    Hold,
    Refused,
    Rejected,
    Return,
    Status,
    TakenOver,
    Trouble,
)
from adapters.simulated import run
from physical import box, circle, distance, point

pytestmark = needs_simulators

WIDE = box((37.05, -8.55), (36.95, -8.65))
FENCED = Craft("uav0", system=1, fence=WIDE)
PLAIN = Craft("uav0", system=1)
GATES = (circle((37.012, -8.6), 200), circle((37.012, -8.615), 200))
WAY = (*GATES, box((37.035, -8.61), (37.025, -8.625)))
AWAY = (point(36.98, -8.6), point(36.96, -8.6), point(36.94, -8.6))
ALL_FENCES = (("FENCE_TYPE", 7), ("FENCE_RADIUS", 9_000), ("FENCE_ALT_MAX", 500))


def e7(latitude, longitude):
    return round(latitude * 1e7), round(longitude * 1e7)


def theirs(more=()):
    return (*route(AWAY, 100.0, takeoff=True, home=True), *more)


def on_board(kind=MissionType.MISSION):
    with Station(250) as station:
        return station.download(kind)


def load(items, kind=MissionType.MISSION):
    with Station(250) as station:
        station.upload(kind, items)


def inside(world, place):
    return distance(world.property("uav0").geometry, place) == 0


@asynccontextmanager
async def flying(tmp_path, command, craft=PLAIN, parameters=(), before=None):
    """Start a plane, let another station change it, and fly a command until it is accepted."""
    async with linked("plane", tmp_path, craft, parameters) as (world, plugin):
        if before is not None:
            before()
            await asyncio.sleep(70.0)  # until it was read again
            await until(plugin.is_known)
        await plugin.command(command)
        await until(lambda: world.of(Accepted, request=command.request) or world.of(Rejected), 400)
        assert world.of(Rejected) == []
        yield world, plugin


async def ended(world, request, seconds=1_200):
    ends = lambda: [*world.of(Arrived, request=request), *world.of(Rejected, request=request)]  # noqa: E731
    return (await until(ends, seconds))[0]


def test_a_mission_that_is_loaded_while_it_is_held_is_replaced_before_the_real_plane_flies_on(tmp_path):
    async def main():
        async with flying(tmp_path, Follow("r1", "uav0", WAY)) as (world, plugin):
            ours = on_board()
            await plugin.command(Hold("r2", "uav0"))
            await ended(world, "r2")
            load(theirs())
            await plugin.command(GiveBack("r3", "uav0"))
            await plugin.command(Follow("r4", "uav0", WAY))
            await until(lambda: world.of(Accepted, request="r4"), 400)
            assert same(ours, on_board(), MissionType.MISSION)
            passed = set()
            note = lambda: passed.update(n for n, gate in enumerate(GATES) if inside(world, gate))  # noqa: E731
            await until(lambda: note() or world.of(Arrived, request="r4"), 1_200)
            assert passed == {0, 1}

    run(main(), SPEED)


def test_a_mission_that_is_loaded_while_ours_is_flown_is_a_take_over_of_the_real_plane(tmp_path):
    async def main():
        async with flying(tmp_path, Follow("r1", "uav0", WAY)) as (world, _):
            load(theirs())
            await until(lambda: world.of(TakenOver), 120)
            await asyncio.sleep(300)
            assert world.of(Arrived) == []

    run(main(), SPEED)


@pytest.mark.parametrize("back", [1, 2])
def test_a_number_that_somebody_sets_passes_no_gate_of_the_real_plane(back, tmp_path):
    async def main():
        async with flying(tmp_path, Follow("r1", "uav0", WAY)) as (world, _):
            assert not inside(world, GATES[0])
            tell(253, long(Cmd.SET_MISSION_CURRENT, 1, len(on_board()) - back))
            (taken,) = await until(lambda: world.of(TakenOver), 60)
            assert "of its mission, not to item" in taken.reason
            await asyncio.sleep(400)
            assert world.of(Arrived) == []

    run(main(), SPEED)


def test_a_fence_that_somebody_clears_is_noticed_and_is_on_the_real_plane_again_after_a_give_back(tmp_path):
    async def main():
        async with flying(tmp_path, GoTo("r1", "uav0", WAY[-1]), FENCED, ALL_FENCES) as (world, plugin):
            load((), MissionType.FENCE)
            (taken,) = await until(lambda: world.of(TakenOver), 120)
            assert taken.reason.startswith("the fence on board is not the one sent")
            await plugin.command(GiveBack("r2", "uav0"))
            await plugin.command(GoTo("r3", "uav0", WAY[-1]))
            await until(lambda: world.of(Accepted, request="r3"), 400)
            assert len(on_board(MissionType.FENCE)) == 4

    run(main(), SPEED)


def test_a_zone_to_stay_out_of_stays_on_the_real_plane_and_is_not_flown_across(tmp_path):
    zone = OnboardItem(
        Cmd.FENCE_CIRCLE_EXCLUSION, *e7(37.015, -8.6), 0.0, MavFrame.SEA_LEVEL, (300.0, 0.0, 0.0, 0.0)
    )

    async def main():
        before = lambda: load((zone,), MissionType.FENCE)  # noqa: E731
        round_it = (circle((37.015, -8.585), 200), circle((37.03, -8.6), 250))
        async with flying(tmp_path, Follow("r1", "uav0", round_it), FENCED, before=before) as (world, plugin):
            kept = on_board(MissionType.FENCE)
            assert [(each.command, each.parameters[0]) for each in kept[-1:]] == [
                (Cmd.FENCE_CIRCLE_EXCLUSION, 300.0)
            ]
            assert isinstance(await ended(world, "r1"), Arrived)
            with pytest.raises(Refused, match="crosses a circle of 300 m"):
                await plugin.command(GoTo("r2", "uav0", circle((37.0, -8.6), 250), name="the field"))

    run(main(), SPEED)


def test_a_landing_sequence_stays_on_the_real_plane_and_brings_it_down(tmp_path):
    landing = (
        OnboardItem(Cmd.DO_LAND_START, 0, 0, 0.0, MavFrame.SEA_LEVEL),
        OnboardItem(Cmd.WAYPOINT, *e7(36.985, -8.615), 60.0),
        OnboardItem(Cmd.WAYPOINT, *e7(36.993, -8.607), 30.0),
        OnboardItem(Cmd.LAND, *e7(37.0, -8.6), 0.0),
    )

    async def main():
        given = {"parameters": [("RTL_AUTOLAND", 2)], "before": lambda: load(theirs(landing))}
        async with flying(tmp_path, Follow("r1", "uav0", WAY), **given) as (world, plugin):
            assert [item.command for item in on_board()[-4:]] == [item.command for item in landing]
            assert isinstance(await ended(world, "r1"), Arrived)
            await plugin.command(Return("r2", "uav0"))
            assert isinstance(await ended(world, "r2"), Arrived)
            await until(lambda: not plugin.pilot("uav0").known.armed, 600)
            assert distance(world.property("uav0").geometry, point(*HOME[:2])) < 200

    run(main(), SPEED)


def test_a_return_of_the_real_plane_is_done_at_its_rally_point(tmp_path):
    rally = OnboardItem(Cmd.RALLY_POINT, *e7(37.01, -8.635), 80.0)

    async def main():
        before = lambda: load((rally,), MissionType.RALLY)  # noqa: E731
        async with flying(tmp_path, GoTo("r1", "uav0", AREA), FENCED, before=before) as (world, plugin):
            assert isinstance(await ended(world, "r1"), Arrived)
            await asyncio.sleep(60.0)
            await plugin.command(Return("r2", "uav0"))
            assert isinstance(await ended(world, "r2"), Arrived)
            assert distance(world.property("uav0").geometry, point(37.01, -8.635)) < 200

    run(main(), SPEED)


SECOND = (("SIM_GPS2_ENABLE", 1), ("GPS2_TYPE", 1), ("EK3_SRC1_POSZ", 1))


def test_the_real_plane_arrives_by_its_second_receiver(tmp_path):
    async def main():
        async with flying(tmp_path, GoTo("r1", "uav0", AREA), parameters=SECOND) as (world, _):
            tell(250, set_parameter(1, "SIM_GPS1_ENABLE", 0))
            assert isinstance(await ended(world, "r1"), Arrived)

    run(main(), SPEED)


def test_a_real_plane_without_position_says_so_and_comes_back(tmp_path):
    async def main():
        async with flying(tmp_path, GoTo("r1", "uav0", WAY[-1])) as (world, _):
            tell(250, set_parameter(1, "SIM_GPS1_ENABLE", 0))
            (lost,) = await until(
                lambda: [each for each in world.of(Trouble) if "position" in f"{each.what} {each.detail}"],
                120,
            )
            assert "GPS" in lost.detail
            tell(250, set_parameter(1, "SIM_GPS1_ENABLE", 1))

    run(main(), SPEED)


def test_a_target_of_somebody_at_the_same_point_and_another_height_takes_the_real_plane_over(tmp_path):
    async def main():
        async with flying(tmp_path, GoTo("r1", "uav0", WAY[-1])) as (world, plugin):
            await until(lambda: plugin.pilot("uav0").known.target)
            x, y = e7(*plugin.pilot("uav0").known.target)
            tell(253, reposition(1, x, y, (400.0, MavFrame.HOME), 0.0, enters=True))
            (taken,) = await until(lambda: world.of(TakenOver), 60)
            assert "at another height" in taken.reason

    run(main(), SPEED)


def test_while_the_real_plane_obeys_another_station_an_order_is_refused_and_later_sent_again(tmp_path):
    async def main():
        async with flying(tmp_path, GoTo("r1", "uav0", WAY[-1])) as (world, plugin):
            tell(250, set_parameter(1, "SYSID_MYGCS", 252))
            await until(lambda: world.of(Status)[-1].authority == ("system 252",), 120)
            await plugin.command(Hold("r2", "uav0"))
            no = await ended(world, "r2", 120)
            assert isinstance(no, Rejected)
            assert no.reason.startswith("it obeys system 252, not gcs0")
            tell(250, set_parameter(1, "SYSID_MYGCS", 255))
            await until(lambda: world.of(Status)[-1].authority == ("gcs0",), 120)
            await plugin.command(Hold("r3", "uav0"))
            assert isinstance(await ended(world, "r3", 120), Arrived)

    run(main(), SPEED)


def test_a_take_off_that_the_real_plane_asks_for_is_in_its_mission(tmp_path):
    async def main():
        async with flying(tmp_path, GoTo("r1", "uav0", AREA), parameters=[("ARMING_MIS_ITEMS", 8)]) as (
            world,
            _,
        ):
            assert isinstance(await ended(world, "r1"), Arrived)

    run(main(), SPEED)


def test_a_fence_of_more_corners_than_the_real_plane_holds_is_refused_in_its_words(tmp_path):
    async def main():
        craft = Craft("uav0", system=1, fence=circle((37.0, -8.6), 5_000, 250))
        async with linked("plane", tmp_path, craft) as (world, plugin):
            await plugin.command(GoTo("r1", "uav0", AREA))
            end = await ended(world, "r1", 200)
            assert end.reason.startswith("the vehicle refuses the fence: NO_SPACE")
            assert "items are supported" in end.reason

    run(main(), SPEED)


@pytest.mark.parametrize(
    ("parameter", "why"),
    [(("FENCE_ACTION", 0), "it only reports"), (("FENCE_AUTOENABLE", 1), "switches its fences off")],
)
def test_a_fence_that_the_real_plane_would_not_keep_is_refused(parameter, why, tmp_path):
    async def main():
        async with linked("plane", tmp_path, FENCED, [parameter]) as (_, plugin):
            with pytest.raises(Refused, match=why):
                await plugin.command(GoTo("r1", "uav0", AREA))

    run(main(), SPEED)
