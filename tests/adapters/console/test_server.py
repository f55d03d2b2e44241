"""A console's server, asked by real clients over loopback: whom it lets in, what it serves, and how much of it."""

import asyncio
import select
import socket
from contextlib import ExitStack

import aiohttp
import pytest
from clients import BEARER, HELLO, PROTOCOL, client, console, masked, play, raw, read_all

from adapters.console import server as servers
from adapters.console.server import MOST_LOOKERS

# --- who is let in


@pytest.mark.parametrize(
    ("hello", "code"),
    [
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
    ],
)
async def test_nobody_is_shown_anything_without_a_token_and_the_protocol(recording, hello, code):
    async with console(recording) as address, client(address, hello=hello) as looker:
        message = await looker.socket.receive()
        assert message.type is aiohttp.WSMsgType.CLOSE
        assert message.data == code


async def test_who_says_nothing_is_let_go(recording, monkeypatch):
    monkeypatch.setattr("adapters.console.server.PATIENCE", 0.2)
    async with (
        console(recording) as address,
        aiohttp.ClientSession() as session,
        session.ws_connect(f"{address}/ws") as silent,
    ):
        assert (await silent.receive(10)).data == 4401


@pytest.mark.parametrize(
    "headers", [{"Host": "evil.example"}, {"Origin": "http://evil.example"}, {"Origin": "null"}]
)
@pytest.mark.parametrize("path", ["/", "/ws", "/land", "/parts/app.js"])
async def test_pages_of_others_and_other_names_of_this_machine_are_refused(recording, headers, path):
    async with (
        console(recording) as address,
        aiohttp.ClientSession(headers=headers) as session,
        session.get(f"{address}{path}") as answer,
    ):
        assert answer.status in (403, 421)
        assert answer.headers["X-Content-Type-Options"] == "nosniff"


async def test_its_own_page_is_let_in(recording):
    async with console(recording) as address, client(address, origin=address) as looker:
        assert await looker.frame() == "welcome"


@pytest.mark.parametrize("path", ["/land?south=36&west=-9&north=38&east=-8", "/tiles"])
async def test_coast_and_tiles_need_the_token(recording, path):
    async with console(recording) as address, aiohttp.ClientSession() as session:
        for headers in ({}, {"Authorization": "Bearer guessed"}, {"Authorization": "may-act"}):
            async with session.get(f"{address}{path}", headers=headers) as answer:
                assert answer.status == 401


async def test_the_coast_is_geojson_and_a_window_that_is_none_is_refused(recording):
    async with console(recording) as address, aiohttp.ClientSession(headers=BEARER) as session:
        async with session.get(f"{address}/land?south=36.9&west=-8.8&north=37.2&east=-8.5") as answer:
            found = await answer.json(content_type="application/geo+json")
        polygons = found["features"][0]["geometry"]["coordinates"]
        assert all(
            -8.8 <= x <= -8.5 and 36.9 <= y <= 37.2
            for polygon in polygons
            for ring in polygon
            for x, y in ring
        )
        for wrong in (
            "",
            "?south=nan&west=0&north=1&east=1",
            "?south=2&west=0&north=1&east=1",
            "?south=0&west=0&north=1&east=1e9",
        ):
            async with session.get(f"{address}/land{wrong}") as answer:
                assert answer.status == 400


@pytest.mark.parametrize(
    ("asked", "status", "place", "part"),
    [
        ("bytes=7-9", 206, "bytes 7-9/207", b"\x00\x01\x02"),
        ("bytes=205-300", 206, "bytes 205-206/207", b"\xc6\xc7"),
        ("bytes=207-300", 416, "bytes */207", b""),
        ("bytes=0-99999999", 416, None, None),
        ("bytes=9-7", 416, None, None),
        ("all", 416, None, None),
        (None, 416, None, None),
    ],
)
async def test_of_tiles_a_part_is_answered(recording, tmp_path, asked, status, place, part):
    (tmp_path / "map.pmtiles").write_bytes(b"PMTiles" + bytes(range(200)))
    async with (
        console(recording, tiles=tmp_path / "map.pmtiles") as address,
        aiohttp.ClientSession(headers=BEARER) as session,
        session.get(f"{address}/tiles", headers={"Range": asked} if asked else {}) as answer,
    ):
        assert (answer.status, answer.headers.get("Content-Range")) == (status, place)
        assert part is None or await answer.read() == part


async def test_the_page_and_its_parts_are_served_without_trouble(recording, caplog):
    async with console(recording) as address, aiohttp.ClientSession() as session:
        for path in ("/", "/parts/app.js", "/parts/style.css"):
            async with session.get(f"{address}{path}") as answer:
                assert (answer.status, bool(await answer.read())) == (200, True)
    assert caplog.text == ""


async def test_only_files_of_the_page_are_served(recording):
    async with console(recording) as address:
        port = int(address.rpartition(":")[2])
        for path in (
            "../server.py",
            "..%2fserver.py",
            "/etc/passwd",
            "%2e%2e/server.py",
            "package.json",
            "node_modules/htm/package.json",
        ):
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.write(
                f"GET /parts/{path} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n".encode()
            )
            answered = await reader.read()
            assert answered.startswith(b"HTTP/1.1 404"), path
            writer.close()


async def test_the_page_may_load_nothing_from_elsewhere(recording):
    async with console(recording) as address, aiohttp.ClientSession() as session:
        async with session.get(address) as answer:
            assert answer.status == 200
            assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
            assert "http:" not in await answer.text()
        async with session.get(f"{address}/parts/app.js") as answer:
            assert answer.content_type == "text/javascript"


async def test_so_many_may_look_and_no_more(recording):
    async with console(recording) as address, aiohttp.ClientSession() as session:
        sockets = [await session.ws_connect(f"{address}/ws") for _ in range(MOST_LOOKERS)]
        with pytest.raises(aiohttp.WSServerHandshakeError, match="503"):
            await session.ws_connect(f"{address}/ws")
        await sockets[0].close()
        async with asyncio.timeout(10):
            while True:
                try:
                    await session.ws_connect(f"{address}/ws")
                except aiohttp.WSServerHandshakeError:
                    await asyncio.sleep(0.05)
                else:
                    return


async def test_who_answers_no_ping_is_let_go(recording, monkeypatch):
    monkeypatch.setattr("adapters.console.server.HEARTBEAT", 0.4)
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


def opened(address):
    found = socket.create_connection(("127.0.0.1", int(address.rpartition(":")[2])))
    found.settimeout(10)
    return found


def is_closed(connection):
    """Wait until the other side has closed a connection, or cut it; tell whether nothing came before."""
    try:
        return connection.recv(1) == b""
    except ConnectionError:
        return True


@pytest.mark.parametrize("begins", [b"", b"GET / HT", b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: "])
async def test_a_connection_that_asks_for_nothing_as_a_whole_is_closed(recording, monkeypatch, begins):
    monkeypatch.setattr(servers, "IDLE", 0.3)
    async with console(recording) as address:
        with opened(address) as idle:
            idle.sendall(begins)
            assert await asyncio.to_thread(is_closed, idle)


async def say_on(slow):
    """Say more and more of a header that never ends."""
    async with asyncio.timeout(20):
        while True:
            slow.sendall(b"x")
            await asyncio.sleep(0.02)


async def test_a_connection_that_asks_letter_by_letter_is_closed(recording, monkeypatch):
    monkeypatch.setattr(servers, "IDLE", 0.3)
    async with console(recording) as address:
        with opened(address) as slow:
            slow.sendall(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: ")
            with pytest.raises(ConnectionError):
                await say_on(slow)


async def test_a_connection_that_goes_idle_after_an_answer_is_closed(recording, monkeypatch):
    monkeypatch.setattr(servers, "IDLE", 0.3)
    async with console(recording) as address:
        with opened(address) as idle:
            idle.sendall(b"GET /land HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
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
        async with asyncio.timeout(10), aiohttp.ClientSession() as session:
            while True:
                try:
                    async with session.get(address) as answer:
                        assert answer.status == 200
                        return
                except aiohttp.ClientConnectionError:
                    await asyncio.sleep(0.02)
