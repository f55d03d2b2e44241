"""Robots of ROS 2 that are driven over a real Zenoh router.

The robot here is written with Zenoh and `rosbags` alone: what it subscribes to, reads and answers is not ours.
"""

import asyncio
import time
from contextlib import asynccontextmanager, nullcontext

import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from routers import router, session, tokens
from worlds import World, running, simulated, until

from adapters.assigned import Assigned
from adapters.plugin import (
    Accepted,
    Arrived,
    Follow,
    GiveBack,
    GoTo,
    HandOver,
    Hold,
    LinkLost,
    LinkRestored,
    Refused,
    Rejected,
    Return,
    Trouble,
)
from adapters.ros import RosVehicles
from adapters.simulated import run
from bigactors.testing import Connection, PluginContract
from physical import PhysicalError, box, circle, distance, point

STORE = get_typestore(Stores.ROS2_KILTED)
for _name, _fields in (
    ("GeoPoint", "float64 latitude\nfloat64 longitude\nfloat64 altitude"),
    ("GeoPose", "geographic_msgs/GeoPoint position\ngeometry_msgs/Quaternion orientation"),
    ("GeoPoseStamped", "std_msgs/Header header\ngeographic_msgs/GeoPose pose"),
    ("GeoPath", "std_msgs/Header header\ngeographic_msgs/GeoPoseStamped[] poses"),
):
    STORE.register(get_types_from_msg(_fields, f"geographic_msgs/msg/{_name}"))
HASHED, HUMBLE = "", "TypeHashNotSupported"
TRIGGER = (
    "std_srvs::srv::dds_::Trigger_/RIHS01_eeff2cd6fa5ad9d27cdf4dec64818317839b62f212a91e6b5304b634b2062c5f"
)
PLACE = circle((37.02, -8.6), 300)
MID = circle((37.01, -8.61), 300)
REAL = 0.005
"""Seconds for which a step of the robot waits, whatever the clock: Zenoh's threads deliver in them."""


class Robot:
    """A robot at 37.0, -8.6: it says where it is once a second, and goes 20 m a second to its newest goal."""

    def __init__(self, node, hashed=HASHED, listens=True):
        self.node, self.hashed = node, hashed
        self.at, self.goals, self.told, self.held, self.silent = (37.0, -8.6), [], [], 0, False
        self.home, self.height, self.heights = self.at, 151.5, []
        self.kept = []
        if listens:
            self.hear("/bigactors/uav0/goal", "GeoPoseStamped", lambda said: [said.pose])
            self.hear("/bigactors/uav0/path", "GeoPath", lambda said: [each.pose for each in said.poses])
        self.kept.append(node.declare_queryable(f"7/uav0/hold/{TRIGGER}", self.hold))

    def topic(self, package, name):
        return f"{package}::msg::dds_::{name}_/{self.hashed or STORE.hash_rihs01(f'{package}/msg/{name}')}"

    def hear(self, topic, name, read):
        def heard(sample):
            assert len(sample.attachment.to_bytes()) == 33
            said = STORE.deserialize_cdr(sample.payload.to_bytes(), f"geographic_msgs/msg/{name}")
            self.goals = [(pose.position.latitude, pose.position.longitude) for pose in read(said)]
            self.heights += [pose.position.altitude for pose in read(said)]
            self.told.append(name)

        kind = self.topic("geographic_msgs", name)
        self.kept.append(self.node.declare_subscriber(f"7{topic}/{kind}", heard))
        token = (
            f"@ros2_lv/7/b2/0/1{len(self.kept)}/MS/%/%/robot/{topic.replace('/', '%')}/{kind}/::,10:,:,:,,"
        )
        self.kept.append(self.node.liveliness().declare_token(token))

    def hold(self, query):
        assert query.payload.to_bytes() == b"\0\1\0\0\0"
        self.goals, self.held = [], self.held + 1
        query.reply(f"7/uav0/hold/{TRIGGER}", b"\0\1\0\0\1\0\0\0\1\0\0\0\0")

    def say(self, raw=None):
        stamp = STORE.types["builtin_interfaces/msg/Time"](sec=0, nanosec=0)
        header = STORE.types["std_msgs/msg/Header"](stamp=stamp, frame_id="gps")
        position = STORE.types["geographic_msgs/msg/GeoPoint"](*self.at, self.height)
        turned = STORE.types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0)
        pose = STORE.types["geographic_msgs/msg/GeoPose"](position, turned)
        kind = "geographic_msgs/msg/GeoPoseStamped"
        said = STORE.serialize_cdr(STORE.types[kind](header, pose), kind)
        self.node.put(f"7/uav0/fix/{self.topic('geographic_msgs', 'GeoPoseStamped')}", raw or bytes(said))

    async def live(self):
        while True:
            if self.goals:
                goal = self.goals[0]
                step = [max(-2e-4, min(2e-4, to - at)) for at, to in zip(self.at, goal, strict=True)]
                self.at = tuple(at + by for at, by in zip(self.at, step, strict=True))
                if self.at == goal and len(self.goals) > 1:
                    self.goals = self.goals[1:]
            if not self.silent:
                self.say()
            time.sleep(REAL)
            await asyncio.sleep(1)


@asynccontextmanager
async def robot(options="&hold=hold", **kind):
    with router() as (port, node):
        assigned = (Assigned("uav0", "UAV", ("wifi",), box((38.0, -9.0), (36.0, -8.0))),)
        plugin = RosVehicles("robots", f"tcp:127.0.0.1:{port}?domain=7{options}", assigned)
        simulated = Robot(node, **kind)
        async with running(simulated.live()):
            yield plugin, simulated


class TestRosVehicles(PluginContract):
    @asynccontextmanager
    async def connect(self, folder):  # noqa: ARG002 - as it is called
        async with robot() as (plugin, simulated):
            yield Connection(plugin, nullcontext, lambda: simulated.say(b"junk"), ("uav0", PLACE))


@asynccontextmanager
async def driven(*options, **kind):
    async with robot(*options, **kind) as (plugin, simulated):
        world = World()
        async with running(plugin.run(world)):
            await until(lambda: world.property("uav0"))
            yield plugin, simulated, world


def answers(world, request):
    return [type(each) for each in world.reports if getattr(each, "request", "") == request]


@pytest.mark.parametrize("hashed", [HASHED, HUMBLE], ids=["jazzy", "humble"])
@simulated
async def test_a_robot_goes_by_a_path_is_held_and_is_refused_what_ros_has_no_word_for(hashed):
    async with driven(hashed=hashed) as (plugin, simulated, world):
        assert world.property("uav0").channels == ("wifi",)
        await plugin.command(Follow("r1", "uav0", (MID, PLACE), name="north"))
        await until(lambda: answers(world, "r1")[-1:] == [Arrived])
        assert answers(world, "r1") == [Accepted, Arrived]
        assert set(simulated.told) == {"GeoPath"}
        await plugin.command(GoTo("r2", "uav0", MID))
        await until(lambda: answers(world, "r2"))
        await plugin.command(Hold("r3", "uav0"))
        await until(lambda: answers(world, "r3"))
        assert (answers(world, "r2"), answers(world, "r3")) == ([Accepted], [Accepted, Arrived])
        assert (simulated.held, simulated.told[-1]) == (1, "GeoPoseStamped")
        await plugin.command(GiveBack("r6", "uav0"))
        await plugin.command(Return("r4", "uav0"))  # without a service of its own: a goal where it was first
        await until(lambda: answers(world, "r4")[-1:] == [Arrived])
        assert distance(world.property("uav0").geometry, point(*simulated.home)) <= 10
        assert set(simulated.heights) == {simulated.height}
        outside, high = point(39.0, -8.6), (100.0, 120.0)
        for command, reason in (
            (HandOver("r5", "uav0", "control:a", "control:b"), "has no HandOver"),
            (GoTo("r7", "uav0", outside, name="far0"), "far0 is outside the fence of uav0"),
            (GoTo("r8", "uav0", PLACE, high), "cannot be sent to a height"),
        ):
            with pytest.raises(Refused, match=reason):
                await plugin.command(command)
        assert not any(answers(world, f"r{number}") for number in (5, 7, 8))


@simulated
async def test_a_goal_that_nobody_takes_is_told_and_then_rejected():
    async with driven("&return=home", listens=False) as (plugin, _, world):
        await plugin.command(GoTo("r1", "uav0", PLACE))
        await until(lambda: answers(world, "r1"))
        await plugin.command(Return("r2", "uav0"))
        await until(lambda: answers(world, "r2"))
    missing = "no node subscribes to /bigactors/uav0/goal as geographic_msgs/msg/GeoPoseStamped"
    assert [each.reason for each in world.of(Rejected)] == [missing, "/uav0/home: no such service answers"]
    assert {each.detail for each in world.of(Trouble)} == {missing}


@pytest.mark.long  # Zenoh waits before it connects again
def test_a_lost_router_is_told_at_once_and_reached_again():
    async def main():
        world = World()
        with router() as (port, node):
            plugin = RosVehicles("robots", f"tcp:127.0.0.1:{port}?domain=7", (Assigned("uav0", "UAV"),))
            simulated = Robot(node)
            life = [asyncio.ensure_future(each) for each in (plugin.run(world), simulated.live())]
            await until(lambda: world.property("uav0"))
            life[1].cancel()
        await until(lambda: world.of(LinkLost))
        assert "no router" in world.troubles()
        with session("router", listen=f"tcp/127.0.0.1:{port}") as node:
            life[1] = asyncio.ensure_future(Robot(node).live())
            await until(lambda: world.of(LinkRestored))
            assert [each.split("/", 3)[3] for each in tokens(node, 7) if "/NN/" in each] == [
                "0/0/NN/%/%/bigactors"
            ]
            await plugin.command(GoTo("r1", "uav0", PLACE))
            await until(lambda: answers(world, "r1") == [Accepted, Arrived])
            for each in life:
                each.cancel()
            await asyncio.gather(*life, return_exceptions=True)

    run(main(), speed=20)


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ("?goal=a b", "no name that ROS allows"),
        ("?stop=x", "no option"),
        ("?at=/fix", "/fix is given twice"),
        ("?domain=300", "no domain"),
    ],
)
def test_an_address_that_cannot_be_meant_is_refused(options, why):
    two = (Assigned("uav0", "UAV"), Assigned("uav1", "UAV"))
    with pytest.raises(PhysicalError, match=why):
        RosVehicles("robots", f"tcp:127.0.0.1:7447{options}", two)
