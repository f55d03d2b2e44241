"""Fences that vehicles have of their own, and circles that they fly as they are configured to: as ArduPilot's do."""

import asyncio
from math import hypot

import pytest
from scale import long_ones
from worlds import AREA, flight, flown, simulated, until

from adapters.mavlink import Craft, Stations
from adapters.mavlink.constants import Fence
from adapters.plugin import Follow, GoTo, HandOver, Rejected, Return, Trouble
from adapters.simulated import Kind
from adapters.simulated.body import Body, metres_to
from physical import box, circle, point

WIDE = box((37.05, -8.55), (36.95, -8.65))
FAR = circle((37.0037, -8.6), 30)
"""400 m from home: beyond the circle of 300 m that rovers and copters have by default."""


def fenced(kind, **vehicle):
    return flight(kind, craft=Craft("uav0", fence=WIDE), **vehicle)


async def known(f):
    await until(f.plugin.is_known, 60)


# --- fences -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", [Kind.ROVER, Kind.COPTER])
@simulated
async def test_only_the_polygon_that_it_is_given_is_switched_on(kind):
    async with fenced(kind) as f:
        await f.completes(GoTo("r1", "uav0", FAR))
        assert f.vehicle.fences == Fence.POLYGON


@simulated
async def test_a_fence_that_is_on_already_does_not_hide_that_the_polygon_is_not():
    async with fenced(Kind.COPTER, parameters={"FENCE_RADIUS": 3_000.0}) as f:
        f.vehicle.fences = Fence.CIRCLE  # so it says that it keeps within a fence
        await f.completes(GoTo("r1", "uav0", FAR))
        assert f.vehicle.fences == Fence.POLYGON | Fence.CIRCLE


@pytest.mark.parametrize("kind", [Kind.ROVER, Kind.COPTER])
@pytest.mark.parametrize(
    "how", [{"parameters": {"FENCE_ENABLE": 1.0}}, {"version": (4, 5, 7)}], ids=["on", "all at once"]
)
@simulated
async def test_what_its_own_circle_does_not_hold_is_refused_with_the_figures(kind, how):
    async with fenced(kind, **how) as f:
        await known(f)
        why = (
            "its circle fence of 300 m around home does not hold the mole, which takes 411 m.*FENCE_TYPE to 4"
        )
        assert f.plugin.bar("uav0", FAR, "the mole") is not None
        await f.refuses(GoTo("r1", "uav0", FAR, name="the mole"), why)
        assert not f.vehicle.armed
        (remark,) = f.plugin.remarks()
        assert remark.startswith("uav0 keeps within 300 m around home (FENCE_RADIUS)")
        await f.completes(GoTo("r2", "uav0", circle((37.001, -8.6), 50)))


CENTRE, TWO = (37.01, -8.61), Stations({"gcs0": 255, "gcs1": 254}, ("gcs0", "gcs1"))
THERE, TO_FAR = GoTo("r1", "uav0", AREA), GoTo("r1", "uav0", FAR)
ALONG = Follow("r1", "uav0", (point(37.002, -8.602), point(37.004, -8.604)))
HANDED = HandOver("r1", "uav0", "control:gcs0", "control:gcs1")
LOW = {"FENCE_ENABLE": 1.0, "FENCE_ALT_MAX": 25.0, "FENCE_RADIUS": 3_000.0}
ARMING = "ARMING_MIS_ITEMS is 41, so it is not armed without a landing and a rally point on board"
REFUSED = [
    (Kind.COPTER, LOW, TO_FAR, "altitude fence of 25 m does not hold a flight at 30 m"),
    (Kind.COPTER, {"FENCE_TYPE": 3.0}, TO_FAR, "it keeps within no polygon: its FENCE_TYPE is 3; add 4"),
    (Kind.PLANE, {"FENCE_ACTION": 0.0}, THERE, "its FENCE_ACTION is 0; it only reports; set it to 1"),
    (
        Kind.PLANE,
        {"FENCE_AUTOENABLE": 1.0},
        THERE,
        "FENCE_AUTOENABLE is 1; before take-off it switches its fences off",
    ),
    (Kind.PLANE, {"ARMING_MIS_ITEMS": 41.0}, THERE, ARMING),
    (Kind.PLANE, {}, GoTo("r1", "uav0", circle(CENTRE, 85)), "a circle of 104 m: it circles at 80 m"),
    (
        Kind.PLANE,
        {"WP_LOITER_RAD": -120.0},
        GoTo("r1", "uav0", circle(CENTRE, 150)),
        "a circle of 156 m: it circles at 120 m",
    ),
    (Kind.PX4_COPTER, {}, HANDED, "PX4 obeys every station on its link"),
    (Kind.PX4_COPTER, {"GF_ACTION": 1.0}, THERE, "its GF_ACTION is 1; set it to 2"),
    (Kind.PX4_COPTER, {"GF_MAX_HOR_DIST": 200.0}, THERE, "set GF_MAX_HOR_DIST to more, or to 0 for none"),
    (Kind.PX4_COPTER, {"MIS_TKO_LAND_REQ": 2.0}, ALONG, "no path without a landing"),
]


@pytest.mark.parametrize(("kind", "parameters", "command", "why"), REFUSED)
@flown(craft=Craft("uav0", fence=WIDE), stations=TWO, by="kind parameters")
async def test_what_a_vehicle_would_not_do_as_it_is_configured_is_refused_by_name_before_take_off(
    f, command, why
):
    await known(f)
    await f.refuses(command, why)
    assert not f.vehicle.armed
    assert f.world.of(Rejected) == []


@flown(Kind.COPTER)
async def test_an_answer_that_is_no_last_no_is_said_at_once_and_again_when_it_is_given_up(f):
    await known(f)
    f.vehicle.fences = Fence.CIRCLE  # by a switch on its transmitter: nothing shows which are on
    await f.plugin.command(GoTo("r1", "uav0", FAR))
    (trouble,) = await until(lambda: f.world.of(Trouble, what="refused for now"))
    assert (
        trouble.detail == "it was commanded to go there, and answers FAILED; the command is repeated for 45 s"
    )
    end = await f.ended("r1")
    assert isinstance(end, Rejected)
    assert end.reason == "it was commanded to go there, and did not obey in 45 s, but answered FAILED"
    assert f.world.of(Trouble, what="refused for now") == [trouble]


@flown()
async def test_a_vehicle_that_does_not_tell_what_it_may_do_is_flown_all_the_same(f):
    del f.vehicle.parameters["FENCE_AUTOENABLE"], f.vehicle.parameters["RTL_RADIUS"]
    await until(f.plugin.is_known, 60)
    await f.accepts(GoTo("r1", "uav0", circle((37.01, -8.61), 150)))


# --- circles ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("radius", "metres"), [*long_ones((80.0, 105)), (90.0, 118), *long_ones((-80.0, 105))]
)
@simulated
async def test_a_plane_stays_in_the_place_where_it_has_arrived_in_wind_too(radius, metres):
    async with flight(parameters={"WP_LOITER_RAD": radius}, wind=(5.0, 6.2)) as f:
        assert hypot(*f.vehicle.wind) == pytest.approx(8, abs=0.1)
        await known(f)
        await f.completes(GoTo("r1", "uav0", circle(CENTRE, metres)))
        found = []
        for _ in range(80):
            await asyncio.sleep(1)
            found.append(metres_to(Body(*CENTRE), f.vehicle.body.latitude, f.vehicle.body.longitude)[0])
        assert 1.2 * abs(radius) < max(found) < metres  # it would have left a place as large as its circle


@flown(parameters={"RTL_RADIUS": -300.0})
async def test_a_plane_that_circles_its_home_far_out_has_returned(f):
    await known(f)
    await f.completes(GoTo("r1", "uav0", circle(CENTRE, 150)))
    await f.completes(Return("r2", "uav0"))


@simulated
async def test_a_return_that_leaves_the_fence_is_remarked():
    near = box((37.03, -8.599), (37.0, -8.64))
    async with flight(craft=Craft("uav0", fence=near)) as f:
        await known(f)
        assert list(f.plugin.remarks()) == [
            "uav0 circles its home at 80 m when it returns, which leaves the fence"
        ]
