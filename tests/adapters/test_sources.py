"""Unsigned links: a vehicle is believed from where it was heard first, until an operator says that it has moved."""

import asyncio
import socket
from contextlib import asynccontextmanager

import pytest
from packets import beat
from worlds import AREA, EPOCH, flight, flown, running, simulated, until

from adapters.mavlink.codec import Encoder
from adapters.mavlink.mavlink_plugin import MAX_REMOTES
from adapters.mavlink.message import say
from adapters.mavlink.signing import Signing, new_key, save
from adapters.plugin import Arrived, GoTo, LinkLost, LinkRestored, Rebind, Trouble
from adapters.simulated import Simulator
from physical import contains

LIES = (
    beat(mode=129, custom=15, status=4),
    say(
        "PARAM_VALUE", param_id=b"SYSID_MYGCS", param_value=254.0, param_type=4, param_count=1, param_index=0
    ),
)


@asynccontextmanager
async def another_radio(f):
    """Let the vehicle of a flight speak from another port."""
    again = Simulator(f"udpout:127.0.0.1:{f.plugin.local[1]}", [], epoch=EPOCH)
    async with running(again.run()):
        await until(lambda: again.local)
        again._vehicles, f.simulator._vehicles = f.simulator._vehicles, {}
        yield again


def details(f, what):
    return [report.detail for report in f.world.of(Trouble) if report.what == what]


@flown()
async def test_what_another_address_says_for_a_vehicle_is_reported_once_and_changes_nothing(f):
    await until(lambda: f.world.property("uav0"))
    before, encoder = f.plugin.pilot("uav0").known.authority, Encoder(1, 1)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.bind(("127.0.0.1", 0))
        link.setblocking(False)
        for _ in range(20):
            for lie in LIES:
                link.sendto(encoder.pack(lie), f.plugin.local)
            await asyncio.sleep(0.5)
            with pytest.raises(BlockingIOError):
                link.recv(2_000)
        there = f"127.0.0.1:{link.getsockname()[1]}"
    assert f.plugin.pilot("uav0").known.authority == before == 255
    assert f.world.property("uav0").channels == ("control:gcs0",)
    (detail,) = details(f, "second source of uav0")
    assert detail.endswith(
        f"if it has moved, run this once it is silent: bigactors give-back uav0 --at {there}"
    )


@flown()
async def test_a_vehicle_whose_radio_comes_back_at_another_port_is_believed_there_when_an_operator_says_so(f):
    await f.plugin.command(GoTo("r1", "uav0", AREA))
    await until(lambda: f.vehicle.body.height > 30)
    async with another_radio(f) as again:
        there = f"127.0.0.1:{again.local[1]}"
        await f.plugin.command(Rebind("o1", "uav0", there))  # it is heard where it was
        assert not f.world.of(LinkRestored)
        await until(lambda: f.world.of(LinkLost))
        await asyncio.sleep(20)
        assert not f.world.of(LinkRestored)  # silent, and nobody has said that it moved
        await f.plugin.command(Rebind("o2", "uav0", there))
        await until(lambda: f.world.of(LinkRestored), 10)
        assert isinstance(await f.ended("r1"), Arrived)
        assert contains(AREA, f.world.property("uav0").geometry)
    assert len(details(f, "source kept")) == 1
    assert "it can move when it is silent" in details(f, "source kept")[0]


@simulated
async def test_what_is_signed_is_believed_from_any_address(tmp_path):
    key = new_key("roaming")
    save(Signing(key), tmp_path / "key.json")
    async with flight(key_file=tmp_path / "key.json", signing=Signing(key)) as f:
        await until(lambda: f.world.property("uav0"))
        async with another_radio(f) as again:
            await asyncio.sleep(20)
            assert not f.world.of(LinkLost)
            assert f.plugin._routes[1] == again.local
            await f.plugin.command(Rebind("o1", "uav0", "127.0.0.1:1"))
            assert f.plugin._routes[1] == again.local


@flown()
async def test_a_flood_from_many_addresses_takes_no_vehicles_parser_and_is_bounded(f):
    await until(lambda: f.world.property("uav0"))
    source = f.plugin._routes[1]
    parser, encoder = f.plugin._decoders[source], Encoder(1, 1)
    for port in range(1, 3 * MAX_REMOTES):
        f.plugin._receive(("192.0.2.1", port), encoder.pack(LIES[0]))
    assert f.plugin._decoders[source] is parser
    assert len(f.plugin._decoders) == MAX_REMOTES
    assert len(f.plugin._elsewhere[1]) == MAX_REMOTES
    await asyncio.sleep(5)
    assert sum(report.count for report in f.world.of(Trouble, what="second source of uav0")) == MAX_REMOTES
