"""What every plugin keeps to, whatever it stands for."""

import importlib
import inspect
import json
import pkgutil
import socket
from contextlib import asynccontextmanager
from pathlib import Path

import aiohttp.web
import pytest
from rosbags.rosbag2 import StoragePlugin
from routers import fix, write_bag
from worlds import AREA, EPOCH, HOME, World, answering, running, simulated

import adapters
from adapters.ais import AisFeed
from adapters.camera.camera_plugin import Camera, CameraFeed
from adapters.camera.libraries import opencv
from adapters.camera.poses import PoseLog
from adapters.camera.sea_projection import Lens, Pose
from adapters.camera.sources import Folder
from adapters.detection_feed import Detections
from adapters.location_feed import LocationService
from adapters.mavlink import Autopilot, Craft
from adapters.naming import NamingService
from adapters.plugin import Plugin
from adapters.ros import RosFeed, RosVehicles
from adapters.ros.position_messages import FIX
from adapters.simulated import Kind, Simulator, Vehicle
from adapters.simulated.camera import render
from adapters.simulated.missing_sensor import MissingSensor
from adapters.simulated.simulated_link import SimulatedLink
from adapters.static_places import StaticPlaces
from adapters.stations.shared_plugin import Shared
from adapters.stations.station_plugin import Sharing
from adapters.web import Listen
from bigactors.arguments.values import LIVING
from bigactors.commands.run import feeds
from bigactors.testing import Connection, PluginContract, opened
from physical import PhysicalProperty, box, circle, write_geojson

VESSEL = rb"!AIVDM,1,1,,B,35VwAv0300QcEQ`EGcpN40jD0PUQ,0*61"
SPILL = PhysicalProperty("oilSpill0", "OilSpill", box((37.0, -8.7), (36.99, -8.71)))
HEARD = b'{"entities": [{"name": "drifter0", "kind": "Drifter", "latitude": 37.0, "longitude": -8.7}]}'
JUNK = (b"", b"\x00" * 300, b"\xfd\xff\x01" * 100, b"!AIVDM,9,9,,,,9*00", bytes(range(256)) * 8)


def throw(where, *packets):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        for packet in packets:
            link.sendto(packet, where)


@asynccontextmanager
async def autopilot(_tmp_path, kind=Kind.PLANE):
    plugin = Autopilot("autopilot", "udp:0", [Craft("uav0")])

    @asynccontextmanager
    async def fed():
        vehicle = Vehicle(kind, HOME)
        simulator = Simulator(f"udpout:127.0.0.1:{plugin.local[1]}", [vehicle], epoch=EPOCH)
        async with running(simulator.run()):
            yield

    yield Connection(plugin, fed, lambda: throw(plugin.local, *JUNK), ("uav0", AREA))


def px4(tmp_path):
    return autopilot(tmp_path, Kind.PX4_COPTER)


@asynccontextmanager
async def ais(_tmp_path):
    plugin = AisFeed("ais", "udp:0")

    @asynccontextmanager
    async def fed():
        throw(plugin.local, VESSEL)
        yield

    yield Connection(plugin, fed, lambda: throw(plugin.local, *JUNK))


@asynccontextmanager
async def places(tmp_path):
    path = tmp_path / "places.geojson"
    path.write_text(write_geojson([SPILL]))

    @asynccontextmanager
    async def fed():
        path.write_text(write_geojson([SPILL, SPILL.at(box((37.1, -8.7), (37.09, -8.71)))][1:]))
        yield

    yield Connection(StaticPlaces("places", path), fed, lambda: path.write_bytes(JUNK[-1]))


@asynccontextmanager
async def detections(tmp_path):
    plugin = Detections("camera", listen=Listen(0), folder=tmp_path)

    @asynccontextmanager
    async def fed():
        async with aiohttp.ClientSession() as session:
            url = f"http://127.0.0.1:{plugin.port}/detections"
            async with session.post(url, json=json.loads(write_geojson([SPILL]))) as answer:
                assert answer.status == 200
        yield

    yield Connection(plugin, fed, lambda: (tmp_path / "junk.geojson").write_bytes(JUNK[-1]))


class Hovering(PoseLog):
    """A vehicle that is always at one place."""

    until = float("inf")

    def at(self, time):
        return Pose(time, 37.0, -8.7, 300.0)


@asynccontextmanager
async def camera(tmp_path):
    lens = Lens(80)
    plugin = CameraFeed("camera", Camera("uav0", lens), Folder(tmp_path), Hovering())
    plugin.in_thread = False  # time is simulated

    def put(data):
        (tmp_path / "part").write_bytes(data)
        (tmp_path / "part").rename(tmp_path / "taken.png")

    @asynccontextmanager
    async def fed():
        image = render(Pose(0, 37.0, -8.7, 300.0), lens, (240, 180), [circle((37.0, -8.7), 100.0)])
        put(opencv().imencode(".png", image)[1].tobytes())
        yield

    yield Connection(plugin, fed, lambda: put(JUNK[-1]))


@asynccontextmanager
async def location(_tmp_path):
    said = [HEARD]

    async def answer(_request):
        return aiohttp.web.Response(body=said[0])

    @asynccontextmanager
    async def fed():
        said[0] = HEARD
        yield

    def spoil():
        said[0] = JUNK[-1]

    async with answering(answer) as url:
        yield Connection(LocationService("cloud", url), fed, spoil)


@asynccontextmanager
async def idle():
    yield


@asynccontextmanager
async def ros(tmp_path):
    said = (*JUNK, fix())
    messages = [(second, "/drifter0/fix", FIX, each) for second, each in enumerate(said)]
    bag = write_bag(tmp_path / "bag", messages, StoragePlugin.SQLITE3)
    naming = NamingService(kinds={"drifter0": "Drifter"})
    yield Connection(RosFeed("ros", f"file:{bag}", naming=naming), idle)


DOCS = Path(__file__).parents[2] / "docs" / "reference"
PLUGINS = {
    Autopilot: autopilot,
    AisFeed: ais,
    StaticPlaces: places,
    Detections: detections,
    LocationService: location,
    RosFeed: ros,
    CameraFeed: camera,
}
ELSEWHERE = {Plugin, Shared, Sharing, SimulatedLink, MissingSensor}
"""The interface, what stands between several stations, and what stands for the world in rehearsals."""

APART = {RosVehicles}
"""Held to the contract in `tests/adapters/ros/test_ros_vehicle.py`, with a router."""


def is_plugin(each):
    return inspect.isclass(each) and all(hasattr(each, name) for name in ("run", "command", "owns"))


def test_every_plugin_is_held_to_the_contract_and_can_be_given():
    names = {each.name for each in pkgutil.walk_packages(adapters.__path__, "adapters.")}
    modules = [importlib.import_module(name) for name in names if not name.endswith("__main__")]
    ours = {each for module in modules for each in vars(module).values() if is_plugin(each)} - ELSEWHERE
    assert PLUGINS.keys() | APART == ours
    given = {each for each in vars(feeds).values() if is_plugin(each)} - ELSEWHERE
    assert given == ours - {Autopilot, RosVehicles}
    plugins, options = ((DOCS / name).read_text(encoding="utf-8") for name in ("plugins.md", "cli.md"))
    assert [each for each in ours if f"{each.__name__}(" not in plugins] == []
    assert [name for name in feeds.FEEDS if name not in options] == []
    assert LIVING.keys() - {"vehicles"} == feeds.FEEDS.keys() - {"places"}


def held(connect):
    return type("Held", (PluginContract,), {"connect": staticmethod(connect)})


TestAutopilot, TestPx4 = held(autopilot), held(px4)
TestAis, TestRos, TestLocation = held(ais), held(ros), held(location)
TestPlaces, TestDetections, TestCamera = held(places), held(detections), held(camera)


@pytest.mark.parametrize("make_one", [autopilot, ais, detections])
@simulated
async def test_it_listens_on_this_machine_only_unless_told_otherwise(make_one, tmp_path):
    async with make_one(tmp_path) as connection, running((plugin := connection.plugin).run(World())):
        await opened(plugin)
        port = plugin.port if make_one is detections else plugin.local[1]
        kind = socket.SOCK_STREAM if make_one is detections else socket.SOCK_DGRAM
        with socket.socket(socket.AF_INET, kind) as other:  # what listens everywhere would be in its way
            other.bind(("127.0.0.2", port))


@pytest.mark.parametrize(
    ("kind", "make"),
    [
        (socket.SOCK_DGRAM, lambda port: Autopilot("autopilot", f"udp:{port}", [Craft("uav0")])),
        (socket.SOCK_DGRAM, lambda port: AisFeed("ais", f"udp:{port}")),
        (socket.SOCK_STREAM, lambda port: Detections("camera", listen=Listen(port))),
    ],
)
@simulated
async def test_a_port_that_is_taken_is_an_error_that_says_so(kind, make):
    with socket.socket(socket.AF_INET, kind) as other:
        other.bind(("127.0.0.1", 0))
        if kind is socket.SOCK_STREAM:
            other.listen()
        with pytest.raises(OSError, match=r"in use|address"):
            await make(other.getsockname()[1]).run(World())
