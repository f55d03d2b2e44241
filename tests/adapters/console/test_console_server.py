"""A console's server, asked by real clients over loopback: whom it lets in, what it serves, and how much of it."""

import asyncio
import csv
import json
import select
import socket
from contextlib import ExitStack, asynccontextmanager
from io import StringIO
from xml.etree import ElementTree

import aiohttp
import pytest
from console_clients import BEARER, HELLO, PROTOCOL, client, console, masked, opened, play, raw, read_all

from adapters.console import console_server as servers
from adapters.console.console_server import MOST_LOOKERS


@asynccontextmanager
async def visited(recording, headers=None, **more):
    """Serve a recording; yield a session of requests, and the address."""
    async with console(recording, **more) as address, aiohttp.ClientSession(headers=headers) as session:
        yield session, address


# --- who is let in


async def test_nobody_is_shown_anything_without_a_token_and_the_protocol(recording):
    async with console(recording) as address:
        for hello, code in [
            (HELLO | {"token": "guessed"}, 4401),
            (HELLO | {"token": ""}, 4401),
            ({"type": "hello", "protocol": PROTOCOL}, 4401),
            ({"type": "live"}, 4401),
            ([], 4401),
            (HELLO | {"protocol": "bigactors.console/2"}, 4400),
            (HELLO | {"name": "A" * 201}, 4402),
            (HELLO | {"name": "Ana\n"}, 4402),
            (HELLO | {"name": 7}, 4402),
            (HELLO | {"name": "A" * 201, "token": "guessed"}, 4401),
        ]:
            async with client(address, hello=hello) as looker:
                message = await looker.socket.receive()
                assert (message.type, message.data) == (aiohttp.WSMsgType.CLOSE, code), hello


async def test_who_says_nothing_is_let_go(recording, monkeypatch):
    monkeypatch.setattr(servers, "PATIENCE", 0.2)
    async with visited(recording) as (session, address), session.ws_connect(f"{address}/ws") as silent:
        assert (await silent.receive(10)).data == 4401


async def test_pages_of_others_and_other_names_of_this_machine_are_refused_and_its_own_is_let_in(recording):
    refused = [{"Host": "evil.example"}, {"Origin": "http://evil.example"}, {"Origin": "null"}]
    async with visited(recording) as (session, address):
        for path in ("/", "/ws", "/land", "/parts/app.js"):
            for headers in refused:
                async with session.get(f"{address}{path}", headers=headers) as answer:
                    assert answer.status in (403, 421), (path, headers)
                    assert answer.headers["X-Content-Type-Options"] == "nosniff"
        async with client(address, origin=address) as looker:
            assert await looker.frame() == "welcome"


async def test_coast_and_tiles_need_the_token(recording):
    async with visited(recording) as (session, address):
        for path in (
            "/land?south=36&west=-9&north=38&east=-8",
            "/tiles",
            "/export/track.gpx",
            "/export/report.html",
        ):
            for headers in ({}, {"Authorization": "Bearer guessed"}, {"Authorization": "may-act"}):
                async with session.get(f"{address}{path}", headers=headers) as answer:
                    assert answer.status == 401, (path, headers)


async def test_the_coast_is_geojson_and_a_window_that_is_none_is_refused(recording):
    async with visited(recording, headers=BEARER) as (session, address):
        async with session.get(f"{address}/land?south=36.9&west=-8.8&north=37.2&east=-8.5") as answer:
            found = await answer.json(content_type="application/geo+json")
        polygons = found["features"][0]["geometry"]["coordinates"]
        points = [at for polygon in polygons for ring in polygon for at in ring]
        assert points
        assert all(-8.8 <= x <= -8.5 and 36.9 <= y <= 37.2 for x, y in points)
        for window in ("nan 0 1 1", "2 0 1 1", "0 0 1 1e9", ""):
            sides = zip(("south", "west", "north", "east"), window.split(), strict=False)
            async with session.get(f"{address}/land", params=dict(sides)) as answer:
                assert answer.status == 400, window


async def test_the_flown_track_is_the_same_in_each_format_and_the_report_names_who_did_what(recording):
    files = {}
    async with visited(recording, headers=BEARER) as (session, address):
        for name in ("track.gpx", "track.csv", "track.geojson", "report.html"):
            async with session.get(f"{address}/export/{name}") as answer:
                files[name] = await answer.text()
        for name in ("track.html", "report.gpx", "run.mcap", "..%2Ftrack.gpx"):
            async with session.get(f"{address}/export/{name}") as answer:
                assert answer.status == 404, name
    points = ElementTree.fromstring(files["track.gpx"]).iter("{http://www.topografix.com/GPX/1/1}trkpt")
    of_gpx = [(float(each.get("lon")), float(each.get("lat"))) for each in points]
    rows = list(csv.DictReader(StringIO(files["track.csv"])))
    (feature,) = json.loads(files["track.geojson"])["features"]
    of_csv = [(float(each["longitude"]), float(each["latitude"])) for each in rows]
    assert of_gpx == of_csv == [tuple(each[:2]) for each in feature["geometry"]["coordinates"]]
    assert [each["time"] for each in rows] == feature["properties"]["coordTimes"]
    assert ({each["name"] for each in rows}, len(rows)) == ({"uav0"}, 43)
    report = files["report.html"]
    for told in (
        "Flight of tour.mission",
        "lost link",
        "its pilot has taken over",
        "say &quot;handover&quot;",
        "uav0",
        "UAV",
    ):
        assert told in report, told
    assert "1970-01-01 00:16:40 UTC to 1970-01-01 00:17:42 UTC" in report


async def test_of_tiles_a_part_is_answered(recording, tmp_path):
    (tmp_path / "map.pmtiles").write_bytes(b"PMTiles" + bytes(range(200)))
    async with visited(recording, headers=BEARER, tiles=tmp_path / "map.pmtiles") as (session, address):
        for asked, status, place, part in [
            ("bytes=7-9", 206, "bytes 7-9/207", b"\x00\x01\x02"),
            ("bytes=205-300", 206, "bytes 205-206/207", b"\xc6\xc7"),
            ("bytes=207-300", 416, "bytes */207", b""),
            ("bytes=0-99999999", 416, None, None),
            ("bytes=9-7", 416, None, None),
            ("all", 416, None, None),
            (None, 416, None, None),
        ]:
            headers = {"Range": asked} if asked else {}
            async with session.get(f"{address}/tiles", headers=headers) as answer:
                assert (answer.status, answer.headers.get("Content-Range")) == (status, place), asked
                assert part is None or await answer.read() == part


async def test_the_page_and_its_parts_are_served_without_trouble_and_load_nothing_from_elsewhere(
    recording, caplog
):
    async with visited(recording) as (session, address):
        for path, kind in (("/", "html"), ("/parts/app.js", "javascript"), ("/parts/style.css", "css")):
            async with session.get(f"{address}{path}") as answer:
                assert (answer.status, answer.content_type) == (200, f"text/{kind}")
                text = await answer.text()
                assert text
            if kind == "html":
                assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
                assert "http:" not in text
    assert caplog.text == ""


async def test_only_files_of_the_page_are_served(recording):
    outside = ("../server.py", "..%2fserver.py", "/etc/passwd", "%2e%2e/server.py")
    async with console(recording) as address:
        for path in (*outside, "package.json", "node_modules/htm/package.json"):
            with opened(address) as found:
                head = "Host: 127.0.0.1\r\nConnection: close"
                found.sendall(f"GET /parts/{path} HTTP/1.1\r\n{head}\r\n\r\n".encode())
                answered = await asyncio.to_thread(read_all, found)
                assert answered.startswith(b"HTTP/1.1 404"), path


async def served_again(look, refused, within=10):
    """Wait until a place is free: look again and again until one is not refused any more."""
    async with asyncio.timeout(within):
        while True:
            try:
                return await look()
            except refused:
                await asyncio.sleep(0.02)


async def test_so_many_may_look_and_no_more_until_one_has_gone(recording):
    async with visited(recording) as (session, address):
        sockets = [await session.ws_connect(f"{address}/ws") for _ in range(MOST_LOOKERS)]
        with pytest.raises(aiohttp.WSServerHandshakeError, match="503"):
            await session.ws_connect(f"{address}/ws")
        await sockets[0].close()
        await served_again(lambda: session.ws_connect(f"{address}/ws"), aiohttp.WSServerHandshakeError)


async def test_who_answers_no_ping_is_let_go(recording, monkeypatch):
    monkeypatch.setattr(servers, "HEARTBEAT", 0.4)
    async with console(recording) as address:
        with raw(address) as silent:
            assert b'"snapshot"' in await asyncio.to_thread(read_all, silent)


@pytest.mark.parametrize(
    "frame",
    [b"\x83\x80" + bytes(4), b"\xf1\x80" + bytes(4), b"\x81\xff" + b"\x7f" * 8 + bytes(4),
     masked(b"\xff\xfe")],
    ids=["unknown opcode", "reserved bits", "an exabyte", "no UTF-8"],
)  # fmt: skip
async def test_what_is_no_websocket_frame_ends_that_connection_only(recording, frame):
    async with console(recording) as address, client(address) as other:
        with raw(address) as bad:
            bad.sendall(frame)
            await asyncio.to_thread(read_all, bad)
        await other.until(bool)
        await other.say(type="pause")
        await other.until(lambda state: not play(state))


# --- connections that ask for nothing, or take nothing


def is_closed(connection):
    """Wait until the other side has closed a connection, or cut it; tell whether nothing came before."""
    try:
        return connection.recv(1) == b""
    except ConnectionError:
        return True


async def test_a_connection_that_asks_for_nothing_as_a_whole_is_closed(recording, monkeypatch):
    monkeypatch.setattr(servers, "IDLE", 0.3)
    async with console(recording) as address:
        for begins in (b"", b"GET / HT", b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: "):
            with opened(address) as idle:
                idle.sendall(begins)
                assert await asyncio.to_thread(is_closed, idle), begins


async def say_on(slow):
    """Say more and more of a header that never ends."""
    async with asyncio.timeout(20):
        while True:
            slow.sendall(b"x")
            await asyncio.sleep(0.02)


async def test_a_connection_that_asks_letter_by_letter_or_goes_idle_after_an_answer_is_closed(
    recording, monkeypatch
):
    monkeypatch.setattr(servers, "IDLE", 0.3)
    async with console(recording) as address:
        with opened(address) as slow, opened(address) as idle:
            idle.sendall(b"GET /land HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
            slow.sendall(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: ")
            with pytest.raises(ConnectionError):
                await say_on(slow)
            assert (await asyncio.to_thread(read_all, idle)).startswith(b"HTTP/1.1 401")


async def test_who_takes_no_answer_is_cut_off_and_others_are_served(recording, tmp_path, monkeypatch):
    monkeypatch.setattr(servers, "STALLED", 0.3)
    (tmp_path / "map.pmtiles").write_bytes(bytes(20_000_000))
    async with console(recording, tiles=tmp_path / "map.pmtiles") as address, client(address) as looker:
        with opened(address) as stalled:
            stalled.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1024)
            token = f"Authorization: {BEARER['Authorization']}"
            part = "Range: bytes=0-16000000"
            stalled.sendall(f"GET /tiles HTTP/1.1\r\nHost: 127.0.0.1\r\n{part}\r\n{token}\r\n\r\n".encode())
            cut_off = select.poll()
            cut_off.register(stalled, 0)
            assert await asyncio.to_thread(cut_off.poll, 10_000)
        await looker.until(bool)


async def test_connections_that_are_too_many_are_closed_at_once_until_others_end(recording, monkeypatch):
    monkeypatch.setattr(servers, "MOST_CONNECTIONS", 8)
    async with console(recording) as address:
        with ExitStack() as stack:
            for _ in range(8):
                stack.enter_context(opened(address))
            ninth = stack.enter_context(opened(address))
            assert await asyncio.to_thread(is_closed, ninth)
        async with aiohttp.ClientSession() as session:
            answer = await served_again(lambda: session.get(address), aiohttp.ClientConnectionError)
            assert answer.status == 200
            answer.close()
