"""A stall of our own is nobody's silence: real ones, by a process that does not look, at ten times the clock's pace."""

import asyncio
import time

from worlds import AREA, flown, until

from adapters.plugin import Aged, GoTo, LinkLost, Rejected
from adapters.stations.authority import LASTING, Authority
from adapters.stations.entries import Said
from physical import PhysicalProperty, point


@flown(speed=10)
async def test_a_vehicle_is_not_lost_because_we_did_not_listen(f):
    await until(lambda: f.world.property("uav0"))
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    for _ in range(5):
        await asyncio.sleep(2)
        time.sleep(0.8)  # eight seconds of the loop's
    await asyncio.sleep(2)
    assert f.world.of(LinkLost) == f.world.of(Rejected) == []
    said = f.world.property("uav0")
    assert 0 <= f.world.now() - said.time < 3.0  # published in the world's time, not in ours


@flown(speed=10)
async def test_a_vehicle_that_falls_silent_while_we_do_not_listen_is_lost_once_we_have_listened(f):
    await until(lambda: f.world.property("uav0"))
    f.vehicle.system = 77  # another's: ours says nothing any more
    time.sleep(0.8)
    back = f.world.now()
    (lost,) = await until(lambda: f.world.of(LinkLost), 20)
    assert 2 <= lost.time - back <= 8
    assert 5 <= lost.time - lost.since <= 7  # only what was listened to is called silence


def test_a_doubt_of_whom_a_vehicle_obeys_does_not_grow_while_nobody_listens():
    def on(channel, at):
        return Aged(PhysicalProperty("uav0", "UAV", point(37, -8), channels=(channel,), time=at), 60.0)

    mine, theirs = on("control:gcs0", 0.0), Said(on("control:gcs1", 0.0), 1.0, owned=False)
    for missed, channels in ((LASTING + 1, ("control:gcs1",)), (0.0, ("control:gcs0",))):
        authority = Authority("gcs2")
        authority.channels("uav0", theirs.published, theirs, 1.0)
        assert authority.channels("uav0", mine, theirs, 2.0)[0] == ("control:gcs1",)
        assert authority.channels("uav0", mine, theirs, 4.0 + LASTING, missed)[0] == channels
