"""Simulated vehicles flown by the autopilot plugin over real sockets: what it says happened did happen."""

from worlds import AREA, flight

from adapters.plugin import Accepted, Arrived, GoTo
from adapters.simulated import run
from physical import contains


def test_a_plane_takes_off_goes_to_a_place_and_is_published_inside_it():
    async def main():
        async with flight() as f:
            await f.plugin.command(GoTo("r1", "uav0", AREA))
            end = await f.ended("r1")
            assert isinstance(end, Arrived), end
            assert len(f.world.of(Accepted, request="r1")) == 1
            assert contains(AREA, f.world.property("uav0").geometry)
            assert f.world.property("uav0").channels == ("control:gcs0",)
            assert f.vehicle.flies

    run(main())
