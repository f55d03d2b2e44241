"""What every plugin keeps to, whatever it stands for."""

import asyncio
import importlib
import inspect
import json
import pkgutil
import socket
from contextlib import asynccontextmanager
from pathlib import Path

import aiohttp.web
import pytest
from worlds import EPOCH, HOME, World, running, until

import adapters
from adapters.ais import AisFeed
from adapters.detections import Detections
from adapters.location import LocationService
from adapters.mavlink import Autopilot, Craft
from adapters.plugin import Aged, Gone, GoTo, HandOver, Plugin, Refused
from adapters.simulated import Kind, Simulator, Vehicle, run
from adapters.static_places import StaticPlaces
from adapters.stations.shared_plugin import Shared
from adapters.stations.sharing import Sharing
from adapters.web import Listen
from bigactors import feeds
from bigactors.arguments.links import LIVING
from physical import PhysicalProperty, box, write_geojson

VESSEL = rb"!AIVDM,1,1,,B,35VwAv0300QcEQ`EGcpN40jD0PUQ,0*61"
SPILL = PhysicalProperty("oilSpill0", "OilSpill", box((37.0, -8.7), (36.99, -8.71)))
JUNK = (b"", b"\x00" * 300, b"\xfd\xff\x01" * 100, b"!AIVDM,9,9,,,,9*00", bytes(range(256)) * 8)


def throw(where, *packets):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        for packet in packets:
            link.sendto(packet, where)


@asynccontextmanager
async def autopilot(_tmp_path):
    plugin = Autopilot("autopilot", "udp:0", [Craft("uav0")])

    @asynccontextmanager
    async def fed():
        vehicle = Vehicle(Kind.PLANE, HOME)
        simulator = Simulator(f"udpout:127.0.0.1:{plugin.local[1]}", [vehicle], epoch=EPOCH)
        async with running(simulator.run()):
            yield

    yield plugin, fed, lambda: throw(plugin.local, *JUNK)


@asynccontextmanager
async def ais(_tmp_path):
    plugin = AisFeed("ais", "udp:0")

    @asynccontextmanager
    async def fed():
        throw(plugin.local, VESSEL)
        yield

    yield plugin, fed, lambda: throw(plugin.local, *JUNK)


@asynccontextmanager
async def places(tmp_path):
    path = tmp_path / "places.geojson"
    path.write_text(write_geojson([SPILL]))

    @asynccontextmanager
    async def fed():
        path.write_text(write_geojson([SPILL, SPILL.at(box((37.1, -8.7), (37.09, -8.71)))][1:]))
        yield

    yield StaticPlaces("places", path), fed, lambda: path.write_bytes(JUNK[-1])


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

    yield plugin, fed, lambda: (tmp_path / "junk.geojson").write_bytes(JUNK[-1])


@asynccontextmanager
async def location(_tmp_path):
    said = [b'{"entities": [{"name": "drifter0", "kind": "Drifter", "latitude": 37.0, "longitude": -8.7}]}']

    async def answer(_request):
        return aiohttp.web.Response(body=said[0])

    application = aiohttp.web.Application()
    application.router.add_get("/", answer)
    runner = aiohttp.web.AppRunner(application, access_log=None)
    await runner.setup()
    await aiohttp.web.TCPSite(runner, "127.0.0.1", 0).start()

    @asynccontextmanager
    async def fed():
        yield

    def spoil():
        said[0] = JUNK[-1]

    yield LocationService("cloud", f"http://127.0.0.1:{runner.addresses[0][1]}/"), fed, spoil
    await runner.cleanup()


DOCS = Path(__file__).parents[2] / "docs" / "reference"
PLUGINS = {
    Autopilot: autopilot,
    AisFeed: ais,
    StaticPlaces: places,
    Detections: detections,
    LocationService: location,
}
ELSEWHERE = {Plugin, Shared, Sharing}
"""The interface, and what stands between several stations."""


def is_plugin(each):
    return inspect.isclass(each) and all(hasattr(each, name) for name in ("run", "command", "owns"))


def test_every_plugin_is_held_to_the_contract_and_can_be_given():
    names = {each.name for each in pkgutil.walk_packages(adapters.__path__, "adapters.")}
    modules = [importlib.import_module(name) for name in names if not name.endswith("__main__")]
    ours = {each for module in modules for each in vars(module).values() if is_plugin(each)} - ELSEWHERE
    assert PLUGINS.keys() == ours
    assert {each for each in vars(feeds).values() if is_plugin(each)} - ELSEWHERE == ours - {Autopilot}
    plugins, options = ((DOCS / name).read_text(encoding="utf-8") for name in ("plugins.md", "cli.md"))
    assert [each for each in ours if f"{each.__name__}(" not in plugins] == []
    assert [name for name in feeds.FEEDS if name not in options] == []
    assert LIVING.keys() - {"vehicles"} == feeds.FEEDS.keys() - {"places"}


@pytest.fixture(params=PLUGINS.values(), ids=lambda make: make.__name__)
def make(request, tmp_path):
    return lambda: request.param(tmp_path)


async def opened(plugin):
    """Wait until a plugin has opened what it opens."""
    await until(lambda: getattr(plugin, "local", True) and getattr(plugin, "port", True))


def said(published):
    return published.property if isinstance(published, Aged) else published


def test_it_is_a_plugin_with_a_name(make):
    async def main():
        async with make() as (plugin, _, _):
            assert isinstance(plugin, Plugin)
            assert plugin.name
            assert plugin.name.isprintable()

    run(main())


def test_it_publishes_properties_that_are_stamped_and_never_in_the_future(make):
    async def main():
        async with make() as (plugin, fed, _):
            world = World()
            async with running(plugin.run(world)):
                await opened(plugin)
                async with fed():
                    await until(lambda: world.published)
                    await asyncio.sleep(5)
            for published in world.published:
                assert isinstance(published, PhysicalProperty | Aged | Gone)
                if isinstance(published, Aged):
                    assert EPOCH <= published.property.time <= world.now()
                    assert published.property.source
                    assert published.time_to_live > 0

    run(main())


def test_it_refuses_commands_for_what_it_does_not_own(make):
    async def main():
        async with make() as (plugin, _, _):
            world = World()
            async with running(plugin.run(world)):
                await opened(plugin)
                assert not plugin.owns("nobody0")
                for command in (
                    GoTo("r1", "nobody0", SPILL.geometry),
                    HandOver("r2", "nobody0", "control:a", "control:b"),
                ):
                    with pytest.raises(Refused) as refusal:
                        await plugin.command(command)
                    assert "nobody0" in refusal.value.reason
                assert world.reports == []

    run(main())


def test_junk_does_not_end_it_and_is_reported_with_its_name(make):
    async def main():
        async with make() as (plugin, fed, spoil):
            world = World()
            async with running(plugin.run(world)):
                await opened(plugin)
                await asyncio.sleep(0.5)
                spoil()
                await asyncio.sleep(3)
                troubles = [report for report in world.reports if hasattr(report, "what")]
                assert troubles
                assert {report.source for report in troubles} == {plugin.name}
                assert all(report.what and report.count > 0 for report in troubles)
                if plugin.name != "cloud":
                    async with fed():
                        await until(lambda: world.published)

    run(main())


def test_it_ends_when_cancelled_and_can_run_again(make):
    async def main():
        async with make() as (plugin, fed, _):
            for _ in range(2):
                world = World()
                task = asyncio.ensure_future(plugin.run(world))
                await asyncio.sleep(0.5)
                await opened(plugin)
                async with fed():
                    await asyncio.sleep(15)
                task.cancel()
                with pytest.raises(asyncio.CancelledError):
                    await task
                count = len(world.published)
                await asyncio.sleep(5)
                assert len(world.published) == count
            others = [other for other in asyncio.all_tasks() if other is not asyncio.current_task()]
            assert all("aiohttp" in repr(other) or "web" in repr(other) for other in others)

    run(main())


@pytest.mark.parametrize("make_one", [autopilot, ais, detections])
def test_it_listens_on_this_machine_only_unless_told_otherwise(make_one, tmp_path):
    async def main():
        async with make_one(tmp_path) as (plugin, _, _), running(plugin.run(World())):
            await opened(plugin)
            port = plugin.port if make_one is detections else plugin.local[1]
            kind = socket.SOCK_STREAM if make_one is detections else socket.SOCK_DGRAM
            with socket.socket(socket.AF_INET, kind) as other:  # what listens everywhere would be in its way
                other.bind(("127.0.0.2", port))

    run(main())


@pytest.mark.parametrize("make_one", ["autopilot", "ais", "detections"])
def test_a_port_that_is_taken_is_an_error_that_says_so(make_one):
    async def main():
        kind = socket.SOCK_STREAM if make_one == "detections" else socket.SOCK_DGRAM
        with socket.socket(socket.AF_INET, kind) as other:
            other.bind(("127.0.0.1", 0))
            if make_one == "detections":
                other.listen()
            port = other.getsockname()[1]
            plugin = {
                "autopilot": lambda: Autopilot("autopilot", f"udp:{port}", [Craft("uav0")]),
                "ais": lambda: AisFeed("ais", f"udp:{port}"),
                "detections": lambda: Detections("camera", listen=Listen(port)),
            }[make_one]()
            with pytest.raises(OSError, match=r"in use|address"):
                await plugin.run(World())

    run(main())
