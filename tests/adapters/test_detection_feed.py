"""Detections: posted, withdrawn, read from a folder; what clients get wrong, and floods of them."""

import asyncio
import json
from contextlib import asynccontextmanager

import aiohttp.web
import pytest
from worlds import World, running, simulated, until

from adapters import web
from adapters.detection_feed import Detections
from adapters.naming import NamingService
from adapters.plugin import Gone
from adapters.web import Listen, serve
from physical import box, write_geojson
from physical.physical_property import PhysicalProperty

PLACE = PhysicalProperty("searchArea0", "Location", box((37.04, -8.59), (36.94, -8.79)))
SPILL = PhysicalProperty("oilSpill0", "OilSpill", box((37.0, -8.7), (36.99, -8.71)))
DOCUMENT = json.loads(write_geojson([SPILL]))
POST = b"POST /detections HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"


@asynccontextmanager
async def detecting(token=None, headers=None, **options):
    """Run a plugin that detections are posted to; yield its world, it, and what asks it."""
    world, plugin = World(), Detections("camera", listen=Listen(0, token=token), **options)

    async def ask(method="POST", entity="", **more):
        url = f"http://127.0.0.1:{plugin.port}/detections{entity and '/' + entity}"
        async with session.request(method, url, **more) as answer:
            return answer.status, await answer.text()

    async with running(plugin.run(world)), aiohttp.ClientSession(headers=headers) as session:
        await until(lambda: plugin.port)
        yield world, plugin, ask


@simulated
async def test_detections_are_posted_and_withdrawn_by_who_named_them():
    naming = NamingService()
    naming.name("name:drifter0")  # a location service has it
    async with detecting(kinds=["OilSpill"], naming=naming) as (world, _, ask):
        assert await ask(json=DOCUMENT) == (200, "1 taken\n")
        (known,) = world.published
        assert (known.property, known.property.source) == (SPILL, "camera")
        assert (await ask("DELETE", "oilSpill0"))[0] == 200
        assert isinstance(world.published[-1], Gone)
        for other in ("uav0", "drifter0"):
            assert (await ask("DELETE", other))[0] == 404
        assert len(world.published) == 2


@pytest.mark.parametrize(
    ("body", "kind", "status"),
    [
        (b"{", "application/json", 400),
        (write_geojson([PLACE]).encode(), "application/json", 400),  # of a kind that nobody expects
        (write_geojson([SPILL]).encode(), "text/plain", 415),  # as a web page could
        (b"[" * 500_000, "application/json", 400),
        (b" " * 1_040_000, "application/json", 413),
    ],
)
@simulated
async def test_what_is_no_detection_is_refused(body, kind, status):
    async with detecting(kinds=["OilSpill"]) as (world, _, ask):
        assert (await ask(data=body, headers={"Content-Type": kind}))[0] == status
        assert world.published == []


async def told(port, *parts):
    """Send a request in parts, and return the status of the answer; none where none comes within a moment."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    for part in parts:
        writer.write(part)
        await asyncio.sleep(0.1)
    try:
        return int((await asyncio.wait_for(reader.readline(), 0.3)).split()[1])
    except TimeoutError:
        return None
    finally:
        writer.close()
        await asyncio.sleep(0.1)


@simulated
async def test_what_a_client_gets_wrong_is_told_it_and_not_logged(caplog):
    wrong = [
        ([b"POST /detections HTTP/1.1\r\nContent-Length: 0\r\n\r\n"], 400),
        ([POST + b"Content-Length: -5\r\n\r\n"], 400),
        ([POST + b"Content-Length: 99999999999999\r\n\r\n[", b"["], 413),
        ([POST + b"Content-Length: 1000\r\n\r\n["], None),  # and leaves
        ([POST + b"Content-Encoding: gzip\r\nContent-Length: 2\r\n\r\n[]"], 400),
        ([POST + b"Transfer-Encoding: chunked\r\n\r\nzz\r\n[]"], 400),
    ]
    async with detecting() as (world, plugin, _):
        for parts, status in wrong:
            assert await told(plugin.port, *parts) == status
    assert world.published == []
    assert [record.getMessage() for record in caplog.records if record.levelname == "ERROR"] == []


@simulated
async def test_a_bug_that_a_request_meets_is_logged_with_its_traceback(caplog):
    async def bug(_method, _path, _body):
        raise ZeroDivisionError

    async with serve(bug, Listen(0)) as port:
        assert await told(port, POST + b"Content-Length: 2\r\n\r\n[]") == 500
    assert [record.exc_info[0] for record in caplog.records if record.exc_info] == [ZeroDivisionError]


@simulated
async def test_a_detection_cannot_take_the_name_of_a_vehicle_and_a_token_is_asked_for():
    naming = NamingService({"mavlink:1": "oilSpill0"})
    async with detecting("secret", naming=naming) as (world, _, ask):
        assert (await ask(json=DOCUMENT))[0] == 401
        status, answer = await ask(json=DOCUMENT, headers={"Authorization": "Bearer secret"})
        assert status == 400
        assert "oilSpill0" in answer
        assert world.published == []


HOSTS = {
    200: ("127.0.0.1", "localhost:8080", "LOCALHOST", "[::1]:8080"),
    421: ("evil.example", "127.0.0.1.evil.example:8080", "192.0.2.7", ""),
}


@pytest.mark.parametrize(("status", "host"), [(status, host) for status in HOSTS for host in HOSTS[status]])
@simulated
async def test_a_page_whose_name_was_made_to_stand_for_this_machine_can_do_nothing(host, status):
    async with detecting(headers={"Host": host}) as (world, _, ask):
        assert (await ask(json=DOCUMENT))[0] == status
        assert (await ask("DELETE", "oilSpill0"))[0] == status
        assert len(world.published) == (2 if status == 200 else 0)


@simulated
async def test_detections_are_read_from_a_folder_when_a_file_is_new_or_changed(tmp_path):
    world = World()
    async with running(Detections("camera", folder=tmp_path).run(world)):
        await asyncio.sleep(0.05)
        (tmp_path / "one.geojson").write_text(write_geojson([SPILL]))
        (tmp_path / "bad.geojson").write_text("{")
        await asyncio.sleep(3)
        assert {each.property.entity for each in world.published} == {"oilSpill0"}
        assert len(world.published) == 1
        assert world.troubles() == {"detection unreadable"}


# --- floods -------------------------------------------------------------------------------------------


@simulated
async def test_half_requests_take_neither_all_connections_nor_much_time(monkeypatch, caplog):
    """Who sends half a request makes room for others, and is cut off in time."""
    monkeypatch.setattr(web, "IN_TIME", 1.0)
    async with detecting() as (_, plugin, ask):
        halves = []
        for _ in range(3 * web.MOST_CONNECTIONS):
            reader, writer = await asyncio.open_connection("127.0.0.1", plugin.port)
            writer.write(POST + b"Content-Le")
            halves.append((reader, writer))
        assert (await ask(json=DOCUMENT))[0] == 200
        await asyncio.sleep(1.5)
        assert all([await _has_ended(reader) for reader, _ in halves])
        for _, writer in halves:
            writer.close()
    assert caplog.records == []


async def _has_ended(reader):
    try:
        return not await asyncio.wait_for(reader.read(), 0.5)
    except ConnectionResetError:
        return True


@simulated
async def test_each_request_has_a_connection_of_its_own():
    async with detecting() as (_, plugin, _):
        reader, writer = await asyncio.open_connection("127.0.0.1", plugin.port)
        writer.write(POST + b"Content-Length: 2\r\n\r\n[]" + POST + b"Content-Length: 2\r\n\r\n[]")
        assert (await asyncio.wait_for(reader.read(), 5.0)).count(b"HTTP/1.1") == 1
        writer.close()
