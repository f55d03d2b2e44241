"""Mutated packets and sentences: no crash, and no more memory than before. `make fuzz` tries a million of each."""

import asyncio
import math
import os
import resource
import socket
from random import Random

import pytest
from mutations import SENTENCES, frames, mutated, with_right_checksum
from worlds import AREA, World, running, simulated, until

from adapters.ais import AisFeed
from adapters.mavlink import Autopilot, Craft
from adapters.mavlink.codec import Decoder, Garbage
from adapters.mavlink.constants import Cmd, MavFrame, Result
from adapters.mavlink.message import say
from adapters.plugin import Aged, GoTo
from adapters.simulated import Kind, Vehicle, protocol
from adapters.simulated.reporting import Reporter

MANY = int(os.environ.get("BIGACTORS_FUZZ_PACKETS", "0"))
LONG = (pytest.mark.fuzz, pytest.mark.skipif(not MANY, reason="a long run: `make fuzz`"))
AT_ONCE = 20
GROWTH = 64 * 1024
"""Kibibytes by which memory may grow over a run of any length."""


def amount(function):
    """Run with a few, and under `make fuzz` with many."""
    return pytest.mark.parametrize("number", [1_500, pytest.param(MANY, marks=LONG)])(function)


def memory():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


async def thrown(where, number, make):
    """Send packets over a real socket, and see what they cost in memory after the first tenth."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        before = None
        for index in range(number):
            link.sendto(make()[:2_000], where)
            if index % AT_ONCE == 0:
                await asyncio.sleep(0.001)
            if index == number // 10:
                before = memory()
    assert memory() - before < GROWTH


@amount
@pytest.mark.parametrize("change", [mutated, with_right_checksum])
@simulated
async def test_the_autopilot_plugin_takes_mutated_packets(number, change):
    random, (said, _) = Random(number), frames()
    world, plugin = World(), Autopilot("autopilot", "udp:0", [Craft("uav0", system=1)])
    async with running(plugin.run(world)):
        await until(lambda: plugin.local)
        await plugin.command(GoTo("r1", "uav0", AREA))

        def make():
            world.published[:-100] = []
            world.reports[:-100] = []
            raw = random.choice(said)
            return change(raw, random) if random.random() < 0.9 else raw

        await thrown(plugin.local, number, make)
        for published in world.published:
            assert isinstance(published, Aged)
            assert published.property.time <= world.now()
        assert plugin.pilot("uav0").known.heard is not None


@amount
@pytest.mark.parametrize("change", [mutated, with_right_checksum])
def test_the_simulated_vehicle_takes_mutated_packets(number, change):
    random, (_, asked) = Random(number), frames()
    vehicle, reporter, decoder = Vehicle(Kind.PLANE, (37.0, -8.6, 20.0), enforce=False), Reporter(), Decoder()
    for index in range(number):
        now = index / 100
        raw = random.choice(asked)
        for message in decoder.feed(change(raw, random) if random.random() < 0.9 else raw):
            if not isinstance(message, Garbage):
                protocol.hear(vehicle, reporter, message, now)
        if index % 10 == 0:
            vehicle.move(now)
            vehicle.store.tick(now)
            reporter.due(vehicle)
        assert decoder.held < 1_000


def test_flags_that_are_no_number_move_no_vehicle():
    vehicle = Vehicle(Kind.COPTER, (37.0, -8.6, 20.0), enforce=False, armed=True)
    where = {
        "x": 370_000_000,
        "y": -86_000_000,
        "z": 20.0,
        "frame": int(MavFrame.HOME_INT),
        "param3": 10.0,
    }
    command = say("COMMAND_INT", command=int(Cmd.REPOSITION), param2=math.nan, **where)
    [answer] = protocol.hear(vehicle, Reporter(), command, 1.0)
    assert (answer.name, answer["result"], vehicle.target) == ("COMMAND_ACK", Result.DENIED, None)


@amount
@simulated
async def test_the_ais_plugin_takes_mutated_sentences(number):
    random = Random(number)
    world, feed = World(), AisFeed("ais", "udp:0")
    async with running(feed.run(world)):
        await until(lambda: feed.local)

        def make():
            world.published[:-100] = []
            world.reports[:-100] = []
            raw = random.choice(SENTENCES)
            return mutated(raw, random) if random.random() < 0.9 else raw

        await thrown(feed.local, number, make)
        assert world.published
        for published in world.published:
            assert published.property.time <= world.now()
