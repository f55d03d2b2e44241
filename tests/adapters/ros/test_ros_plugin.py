"""Positions of ROS 2, written by `rosbags` and put on Zenoh as rmw_zenoh does."""

import asyncio
import random
import socket
from contextlib import suppress

import pytest
from rosbags.rosbag2 import StoragePlugin
from routers import STORE, fix, for_real, header, router, tokens, write_bag
from worlds import World, running, simulated, until

from adapters.naming import NamingService
from adapters.ros import RosFeed
from adapters.ros.position_messages import FIX, POSE, STAMPED, hash_of, read_position
from adapters.ros.ros_plugin import _recorded
from adapters.ros.wire import Topic, key_of
from physical import PhysicalError, point

PUBLISHED = {FIX: "RIHS01_62223ab3fe210a15976021da7afddc9e200dc9ec75231c1b6a557fc598a65404"}
"""Hashes as several public programs that talk with ROS 2 have them."""


def naming():
    return NamingService(own={"mavlink:1": "uav0"}, kinds={"drifter0": "Drifter", "uav0": "UAV"})


def pose(latitude=37.0, longitude=-8.7, seconds=None):
    types = STORE.types
    at = types["geographic_msgs/msg/GeoPoint"](latitude=latitude, longitude=longitude, altitude=0.0)
    turned = types["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=0.0, w=1.0)
    said = types[POSE](position=at, orientation=turned)
    if seconds is None:
        return bytes(STORE.serialize_cdr(said, POSE))
    return bytes(STORE.serialize_cdr(types[STAMPED](header=header(seconds), pose=said), STAMPED))


def test_a_type_has_the_hash_that_ros_has_published():
    assert {name: hash_of(name) for name in PUBLISHED} == PUBLISHED


@pytest.mark.parametrize(("name", "raw"), [(FIX, fix(seconds=5)), (STAMPED, pose(seconds=5)), (POSE, pose())])
def test_a_position_is_read_with_its_time(name, raw):
    position = read_position(name, raw)
    assert position.geometry == point(37.0, -8.7)
    assert position.time == (0.0 if name == POSE else 5.0)


@pytest.mark.parametrize(
    ("raw", "code"),
    [
        (b"", "message unreadable"),
        (fix()[:60], "message unreadable"),
        (b"\x00\x01\x00\x00" + b"\xff" * 90, "message unreadable"),
        (bytes(5_000), "message too long"),
        (fix(status=-1), "no fix"),
    ],
)
def test_what_is_no_position_is_refused(raw, code):
    with pytest.raises(PhysicalError) as refusal:
        read_position(FIX, raw)
    assert refusal.value.code == code


@pytest.mark.parametrize("place", [(91.0, 0.0), (float("nan"), 0.0), (0.0, float("inf"))])
def test_what_is_nowhere_is_refused(place):
    with pytest.raises(PhysicalError):
        read_position(FIX, fix(*place))


@pytest.mark.parametrize("address", ["udp:7447", "tcp:127.0.0.1:7447?domain=233", "tcp:127.0.0.1:7447?x=1"])
def test_an_address_that_cannot_be_heard_is_refused(address):
    with pytest.raises(PhysicalError, match="Zenoh router"):
        RosFeed("ros", address)


# --- bags -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("storage", list(StoragePlugin), ids=lambda each: each.name)
@simulated
async def test_a_bag_is_replayed_at_its_pace_and_what_is_wrong_in_it_is_counted(tmp_path, storage):
    messages = [
        (1000, "/drifter0/fix", FIX, fix(37.0, seconds=1000)),
        (1001, "/drifter0/fix", FIX, fix(status=-1, seconds=1001)),
        (1002, "/uav0/fix", FIX, fix(seconds=1002)),
        (1003, "/stranger/fix", FIX, fix(seconds=1003)),
        (1004, "/drifter0/fix", FIX, fix(seconds=100)),
        (1010, "/drifter0/pose", STAMPED, pose(37.1, seconds=1010)),
    ]
    bag = write_bag(tmp_path / "bag", messages, storage)
    world = World()
    plugin = RosFeed("ros", f"file:{bag}", naming=naming())
    async with running(plugin.run(world)):
        await until(plugin.played.is_set)
    said = [each.property for each in world.published]
    assert [(each.entity, each.kind, each.geometry) for each in said] == [
        ("drifter0", "Drifter", point(37.0, -8.7)),
        ("drifter0", "Drifter", point(37.1, -8.7)),
    ]
    assert said[1].time - said[0].time == pytest.approx(10, abs=0.5)
    assert {(each.what, each.count) for each in world.reports} == {
        ("no fix", 1),
        ("name-clash", 1),
        ("unknown entity", 1),
        ("time stamp too old", 1),
    }


async def test_what_is_no_bag_is_refused(tmp_path):
    (tmp_path / "metadata.yaml").write_text("{")
    for path in (tmp_path, tmp_path / "metadata.yaml"):
        with pytest.raises(PhysicalError) as refusal:
            await RosFeed("ros", f"file:{path}").run(World())
        assert refusal.value.code == "bag"
    with pytest.raises(OSError, match="none"):
        await RosFeed("ros", f"file:{tmp_path / 'none'}").run(World())


@pytest.mark.parametrize("storage", list(StoragePlugin), ids=lambda each: each.name)
def test_a_damaged_bag_is_a_mistake_of_the_user(tmp_path, storage):
    bag = write_bag(tmp_path / "bag", [(1000, "/drifter0/fix", FIX, fix())] * 20, storage)
    damage = random.Random(16)
    failed = 0
    for file in bag.iterdir():
        whole = file.read_bytes()
        for _ in range(10):
            torn = bytearray(whole)
            for _ in range(8):
                torn[damage.randrange(len(torn))] = damage.randrange(256)
            file.write_bytes(torn)
            with suppress(PhysicalError, OSError):
                failed += 1
                assert len(list(_recorded(str(bag)))) <= 20
                failed -= 1
        file.write_bytes(whole)
    assert failed > 0
    assert len(list(_recorded(str(bag)))) == 20


# --- a router ---------------------------------------------------------------------------------------


async def test_a_ros_node_is_heard_in_its_domain_and_sees_ours():
    world = World()
    with router() as (port, node):
        plugin = RosFeed("ros", f"tcp:127.0.0.1:{port}?domain=7", naming=naming())
        async with running(plugin.run(world)):
            await asyncio.wait_for(plugin.listening.wait(), 60)
            await for_real(lambda: tokens(node, 7))  # it is told last: the subscriptions are there, too
            assert [each.split("/", 3)[3] for each in tokens(node, 7)] == ["0/0/NN/%/%/bigactors"]
            right = Topic("/drifter0/fix", FIX, hash_of(FIX))
            node.put(key_of(7, Topic("/drifter0/fix", FIX, "RIHS01_0")), fix(36.0))
            node.put(key_of(8, right), fix(36.5))
            node.put(key_of(7, right), b"junk")
            node.put(key_of(7, right), fix(37.0))
            await for_real(lambda: world.published and len(world.reports) == 2)
    assert [each.property.geometry for each in world.published] == [point(37.0, -8.7)]
    assert {each.what for each in world.reports} == {"another type", "message unreadable"}
    assert "RIHS01_0," in next(each.detail for each in world.reports if each.what == "another type")


async def test_a_router_that_does_not_answer_is_said(monkeypatch):
    monkeypatch.setattr("adapters.ros.ros_node.PATIENCE", 100)
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        address = f"tcp:127.0.0.1:{taken.getsockname()[1]}"
        with pytest.raises(PhysicalError, match="no Zenoh router answers"):
            await RosFeed("ros", address).run(World())
