"""What a plane needs for its landing stays on board, and it is not called back while it lands, over a slow link."""

import pytest
from test_on_board import LANDING, WAY, mission, theirs
from worlds import AREA, flight, until

from adapters.plugin import Arrived, Follow, GoTo, Hold, Refused, Return, TakenOver
from adapters.simulated import Disturbance, run

SLOW = Disturbance(delay=(0.3, 0.8))


KEPT = [item.command for item in LANDING]


def kept(f):
    return [item.command for item in mission(f)[-4:]] == KEPT


def received(f):
    """Return the number of items of an upload that have come so far."""
    return len(f.vehicle.store.receiving.items) if f.vehicle.store.receiving else 0


@pytest.mark.parametrize("held", [False, True])
def test_a_plane_that_lands_as_it_returns_is_not_called_back_while_its_mission_is_read(held):
    async def main():
        async with flight(disturbance=SLOW, parameters={"RTL_AUTOLAND": 2.0}) as f:
            theirs(f, more=LANDING)
            await until(f.plugin.is_known, 120)
            await f.plugin.command(GoTo("r1", "uav0", AREA))
            assert isinstance(await f.ended("r1"), Arrived)
            assert kept(f)
            if held:
                await f.plugin.command(Hold("r2", "uav0"))
                await f.ended("r2")
            modes = []
            note = lambda: modes.append(f.vehicle.mode) if f.vehicle.mode not in modes[-1:] else None  # noqa: E731
            await f.plugin.command(Return("r3", "uav0"))
            await until(lambda: note() or not f.vehicle.armed, 1200)
            assert modes.count(f.vehicle.kind.profile.auto) == 1
            assert f.world.of(TakenOver) == []

    run(main())


def test_an_upload_that_is_broken_off_loses_nothing_of_the_landing_sequence():
    async def main():
        async with flight(disturbance=SLOW, parameters={"RTL_AUTOLAND": 2.0}) as f:
            theirs(f, more=LANDING)
            await until(f.plugin.is_known, 120)
            await f.plugin.command(GoTo("r1", "uav0", AREA))
            assert isinstance(await f.ended("r1"), Arrived)
            for number in range(3):
                await f.plugin.command(Follow(f"go{number}", "uav0", WAY[number % 2 :]))
                await until(lambda: received(f) >= 5, 120, 0.05)
                await f.plugin.command(Hold(f"hold{number}", "uav0"))
                await until(lambda: f.vehicle.store.torn is not None, 120)
                x, y, z = f.vehicle.store.home
                f.vehicle.store.home = (x + 20, y, z)  # as arming sets it anew
                assert [item.command for item in f.vehicle.store.mission[-4:]] != KEPT
                await f.ended(f"hold{number}")
            await f.plugin.command(Follow("r2", "uav0", WAY))
            assert isinstance(await f.ended("r2"), Arrived)
            assert kept(f)

    run(main())


def test_a_landing_sequence_without_a_landing_is_refused():
    async def main():
        async with flight(parameters={"RTL_AUTOLAND": 2.0}) as f:
            theirs(f, more=LANDING[:2])
            await until(f.plugin.is_known, 60)
            with pytest.raises(Refused, match="a start and no landing"):
                await f.plugin.command(GoTo("r1", "uav0", AREA))

    run(main())
