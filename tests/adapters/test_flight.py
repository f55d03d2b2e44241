"""Simulated vehicles flown by the autopilot plugin over real sockets: what it says happened did happen."""

import asyncio

import pytest
from scale import crossed, long_ones
from worlds import AREA, EPOCH, FIELD, HOME, TINY, World, flight, flown, running, simulated, until

from adapters.mavlink import Autopilot, Craft, Stations
from adapters.mavlink.constants import MissionType
from adapters.mavlink.mavlink_plugin import AT_ONCE
from adapters.mavlink.task import PATIENCE
from adapters.plugin import Accepted, Arrived, Follow, GoTo, HandOver, Hold, Rejected, Return
from adapters.simulated import Disturbance, Kind, Simulator, Vehicle, run
from physical import Band, box, circle, contains, distance, point, waypoint

TWO = Stations({"gcs0": 255, "gcs1": 254}, ("gcs0", "gcs1"))
PATH = (point(37.004, -8.604), point(37.008, -8.610), point(37.012, -8.602))


SHORT = (point(37.001, -8.601), point(37.002, -8.602), point(37.001, -8.603))
"""For what is slower: a test takes its time from the length of its flight."""


def here(vehicle):
    return point(vehicle.body.latitude, vehicle.body.longitude)


@pytest.mark.parametrize("kind", Kind)
@simulated
async def test_every_kind_goes_to_a_place_and_is_published_inside_it(kind):
    place = AREA if kind.limits.must_move else circle((37.0025, -8.602), 60)  # too small for a plane
    async with flight(kind) as f:
        await f.completes(GoTo("r1", "uav0", place))
        assert len(f.world.of(Accepted, request="r1")) == 1
        known = f.world.property("uav0")
        assert contains(place, known.geometry)
        assert known.channels == ("control:gcs0",)
        assert (known.source, known.kind) == ("mavlink", "UAV")
        assert f.vehicle.armed


@pytest.mark.parametrize(
    ("kind", "path"), [(Kind.PLANE, PATH), *long_ones((Kind.COPTER, SHORT), (Kind.ROVER, SHORT))]
)
@flown(by="kind")
async def test_every_kind_follows_a_path_to_its_end(f, kind, path):
    await f.completes(Follow("r1", "uav0", path), 900)
    assert distance(here(f.vehicle), path[-1]) <= kind.profile.reach + 5
    assert f.vehicle.mode == kind.profile.auto
    await f.completes(Follow("r2", "uav0", path[::-1]), 900)  # in the air: it takes off no second time
    assert distance(here(f.vehicle), path[0]) <= kind.profile.reach + 5


@pytest.mark.parametrize("loss", [0.0, 0.3])
@simulated
async def test_a_path_that_moves_on_is_followed_from_where_the_vehicle_is_on_it(loss):
    async with flight(disturbance=Disturbance(loss=loss), seed=3) as f:
        await f.plugin.command(Follow("r1", "uav0", PATH))
        await until(lambda: f.vehicle.current == 3)
        at = set()
        further = box((37.025, -8.59), (37.015, -8.605))
        await f.plugin.command(Follow("r1", "uav0", (*PATH[:2], further)))
        await until(lambda: at.add(f.vehicle.current) or f.world.of(Arrived, request="r1"), 900)
        assert contains(further, here(f.vehicle))
        assert at == {3, 4}  # what was passed is not passed again
        assert len(f.world.of(Arrived, request="r1")) == 1


LONG, CLOSE = (tuple(point(37.001 + apart * n, -8.601) for n in range(20)) for apart in (0.0005, 0.0001))
WORST = Disturbance(loss=0.3, duplication=0.1, delay=(0.0, 1.0))


@flown(Kind.COPTER, WORST, seed=1)
async def test_a_long_path_is_uploaded_though_that_takes_longer_than_another_step_may(f):
    await f.plugin.command(Follow("r1", "uav0", LONG))
    told = f.world.now()
    assert isinstance(await f.ended("r1", 1200), Arrived)
    (accepted,) = f.world.of(Accepted, request="r1")
    assert accepted.time - told > PATIENCE
    assert len(f.vehicle.store.items[MissionType.MISSION]) == 22


@flown(Kind.COPTER)
async def test_a_path_that_moves_on_after_its_end_is_followed_to_its_new_end(f):
    await f.completes(Follow("r1", "uav0", SHORT))
    at = set()
    await f.plugin.command(Follow("r1", "uav0", (*SHORT[:2], point(37.002, -8.604))))
    await until(lambda: at.add(f.vehicle.current) or len(f.world.of(Arrived, request="r1")) == 2)
    assert distance(here(f.vehicle), point(37.002, -8.604)) <= 10
    assert at == {4}


@flown()
async def test_a_place_that_moves_on_is_followed_under_the_same_request(f):
    await f.accepts(GoTo("r1", "uav0", AREA))
    further = box((37.025, -8.63), (37.015, -8.645))
    await f.completes(GoTo("r1", "uav0", further))
    assert contains(further, f.world.property("uav0").geometry)
    assert (f.vehicle.target.latitude, f.vehicle.target.longitude) == waypoint(further).vertices[0]


@flown()
async def test_courses_are_published_and_a_plane_circles_in_its_place_at_an_altitude_above_sea_level(f):
    await f.plugin.command(GoTo("r1", "uav0", AREA, Band(140, 160)))
    await until(lambda: f.vehicle.body.height > 90)
    await asyncio.sleep(20)
    velocity = f.world.property("uav0").velocity
    assert velocity.speed == pytest.approx(22.2, abs=0.5)
    assert 270 < velocity.course < 360
    assert isinstance(await f.ended("r1"), Arrived)
    await asyncio.sleep(60)
    assert f.world.property("uav0").altitude.low == pytest.approx(150, abs=2)
    assert f.vehicle.body.height == pytest.approx(130, abs=2)
    for _ in range(40):
        await asyncio.sleep(1)
        assert 75 < distance(here(f.vehicle), waypoint(AREA)) < 95


@flown()
async def test_hold_and_return(f):
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    await until(lambda: f.vehicle.flies)
    await f.completes(Hold("r2", "uav0"))
    assert f.vehicle.kind.profile.mode_name(f.vehicle.mode) == "LOITER"
    await f.completes(Return("r3", "uav0"))
    assert distance(here(f.vehicle), point(*HOME[:2])) < 200
    assert not f.world.of(Arrived, request="r1")


@simulated
async def test_after_a_hand_over_to_someone_else_nothing_more_is_commanded():
    stations = Stations({"gcs0": 255, "gcs1": 254}, ("gcs0",))
    async with flight(stations=stations) as f:
        await until(lambda: f.world.property("uav0"))
        await f.completes(HandOver("r1", "uav0", "control:gcs0", "control:gcs1"))
        await f.refuses(GoTo("r2", "uav0", AREA), "it obeys gcs1, not gcs0")


@flown()
async def test_a_place_too_small_for_the_circle_is_refused_before_take_off_unless_it_is_only_passed(f):
    await until(lambda: f.world.property("uav0"))
    why = r"the nest is too small: .* needs a circle of 104 m: it circles at 80 m"
    for kind, where in ((GoTo, TINY), (Follow, (PATH[0], TINY))):
        await f.refuses(kind("r1", "uav0", where, name="the nest"), why)
    assert not f.vehicle.armed
    await f.plugin.command(Follow("r2", "uav0", (TINY, AREA)))


@flown()
async def test_the_same_place_is_refused_when_the_kind_becomes_known_later(f):
    end = await f.rejects(GoTo("r1", "uav0", TINY))
    assert "too small" in end.reason
    assert not f.vehicle.armed


@simulated
async def test_the_fence_is_on_board_and_kept_before_the_vehicle_is_armed():
    fence = box((37.05, -8.55), (36.95, -8.65))
    async with flight(craft=Craft("uav0", fence=fence)) as f:
        await f.refuses(GoTo("r0", "uav0", circle((38, -8.6), 900)), "outside the fence")
        await f.plugin.command(GoTo("r1", "uav0", AREA))
        await until(lambda: f.vehicle.armed)
        assert f.vehicle.fence is not None
        assert len(f.vehicle.store.items[MissionType.FENCE]) == 4


@flown(fixed=False)
async def test_nothing_is_published_before_there_is_a_fix_though_positions_come(f):
    await asyncio.sleep(60)
    assert f.world.published == []
    f.vehicle.fixed = True
    await until(lambda: f.world.property("uav0"))
    assert contains(FIELD, f.world.property("uav0").geometry)


@flown(speedup=10.0)
async def test_a_vehicle_whose_clock_runs_ten_times_faster_is_stamped_by_ours(f):
    await until(lambda: f.world.property("uav0"))
    await asyncio.sleep(20)
    assert 0 <= f.world.now() - f.world.property("uav0").time < 1.0


@simulated
async def test_a_flight_over_tcp_is_the_same():
    world, plugin = World(), Autopilot("autopilot", "tcpin:127.0.0.1:0", [Craft("uav0")])
    async with running(plugin.run(world)):
        await until(lambda: plugin.local)
        vehicle = Vehicle(Kind.PLANE, HOME)
        simulator = Simulator(f"tcp:127.0.0.1:{plugin.local[1]}", [vehicle], epoch=EPOCH)
        async with running(simulator.run()):
            await plugin.command(GoTo("r1", "uav0", AREA))
            await until(lambda: world.of(Arrived))
    assert contains(AREA, world.property("uav0").geometry)


def test_the_same_seed_gives_the_same_flight():
    async def main():
        async with flight(disturbance=WORST, seed=7) as f:
            await f.accepts(GoTo("r1", "uav0", AREA))
            return f.world.reports, f.world.published

    assert run(main()) == run(main())


@crossed([0.6, 1.5, 3.0, 5.0], {"enforced": True, "not enforced": False})
@simulated
async def test_a_hand_over_amid_an_upload_lets_the_new_authority_begin_it_anew(name, variation):
    slow, after = Disturbance(delay=(0.15, 0.2)), name
    async with flight(Kind.COPTER, slow, stations=TWO, enforce=variation) as f:
        await until(lambda: f.world.property("uav0"))
        await until(lambda: f.vehicle.ready)
        await f.plugin.command(Follow("r1", "uav0", CLOSE))
        await asyncio.sleep(after)
        await f.completes(HandOver("r2", "uav0", "control:gcs0", "control:gcs1"))
        assert isinstance(await f.ended("r1"), Arrived), f.world.of(Rejected)
        assert f.world.property("uav0").channels == ("control:gcs1",)


@simulated
async def test_an_upload_ends_where_the_vehicle_was_handed_to_a_station_that_is_not_ours():
    slow = Disturbance(delay=(0.15, 0.2))
    stations = Stations({"gcs0": 255, "gcs1": 254}, ("gcs0",))
    async with flight(Kind.COPTER, slow, stations=stations) as f:
        await until(lambda: f.world.property("uav0"))
        await until(lambda: f.vehicle.ready)
        await f.plugin.command(Follow("r1", "uav0", CLOSE))
        await asyncio.sleep(1.5)
        await f.plugin.command(HandOver("r2", "uav0", "control:gcs0", "control:gcs1"))
        end = await f.ended("r1", 20)
        assert isinstance(end, Rejected)
        assert end.reason == "it obeys gcs1, not gcs0: its SYSID_MYGCS is 254, and gcs0 has 255"


@simulated
async def test_the_pilots_of_a_fleet_look_at_the_clock_in_groups_so_that_the_loop_serves_others_between():
    names = [f"uav{number}" for number in range(100)]
    plugin = Autopilot(
        "fleet", "udp:127.0.0.1:0", [Craft(name, "UAV", at) for at, name in enumerate(names, 1)]
    )
    looks, at_once = dict.fromkeys(names, 0), 0
    async with running(plugin.run(World())):
        known = {name: plugin.pilot(name) for name in names}
        for _ in range(1_000):
            await asyncio.sleep(0.001)
            looked = [name for name in names if plugin.pilot(name) is not known[name]]
            at_once = max(at_once, len(looked))
            for name in looked:
                looks[name], known[name] = looks[name] + 1, plugin.pilot(name)
    assert at_once == AT_ONCE
    assert set(looks.values()) <= {4, 5}
