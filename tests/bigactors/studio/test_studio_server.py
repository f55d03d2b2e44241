"""The studio's server: whom it hears, what it refuses in words, and that one check runs at a time."""

import asyncio
import json
import os
from contextlib import asynccontextmanager, suppress
from pathlib import Path

import aiohttp
import pytest

from adapters.console.access import Access
from adapters.console.console_server import Site, listening
from bigactors.studio.page_requests import MOST_BYTES, MOST_TEXT, PROTOCOL
from bigactors.studio.studio_server import StudioService

ACCESS = Access("looks-on", "may-act")
HELLO = {"type": "hello", "protocol": PROTOCOL, "token": "may-act"}
SMALL = """\
mission small
signature { kind Place contains UAV kind UAV driven }
world {
  a: Place = circle (37, -8) radius 500 m
  u: UAV = point (37, -8)
}
BigActor pilot hosted_at u with_behavior { display("here") }
"""
DRIFTS = ", ".join(f"circle (36.{n}, -8) radius 9 m" for n in range(1, 6))
HUGE = SMALL.replace(
    "  u:", "".join(f"  d{n}: UAV = circle (36.1, -8) radius 9 m\n" for n in range(20)) + "  u:"
) + ("environment {\n" + "".join(f"  d{n} drifts among {DRIFTS}\n" for n in range(20)) + "}\n")


@asynccontextmanager
async def page(file, hello=HELLO):
    """Open a page of a file's studio: what sends a frame, and what returns the next one of a type."""
    site = Site(0)
    async with (
        listening(StudioService(ACCESS, site, file), site) as port,
        aiohttp.ClientSession() as session,
        session.ws_connect(f"http://127.0.0.1:{port}/ws", max_msg_size=0) as socket,
    ):
        await socket.send_json(hello)

        async def heard(kind):
            while True:
                message = await asyncio.wait_for(socket.receive(), 60)
                if message.type is not aiohttp.WSMsgType.TEXT:
                    return socket.close_code
                frame = json.loads(message.data)
                if frame["type"] == kind:
                    return frame

        yield socket, heard


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "small.mission"
    path.write_text(SMALL, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"token": "guessed"}, 4401),
        ({"protocol": "bigactors.console/1"}, 4400),
        ({"token": "looks-on"}, 4403),
    ],
)
async def test_only_who_has_the_token_of_the_studio_is_heard(file, change, code):
    async with page(file, HELLO | change) as (_, heard):
        assert await heard("open") == code


@pytest.mark.parametrize(
    "frame",
    [
        {"type": "run", "command": "ls"},
        {"type": "text", "text": "x" * (MOST_TEXT + 1), "number": 1},
        {
            "type": "world",
            "id": 1,
            "text": SMALL,
            "edit": {"edit": "reshape", "name": "a", "points": [[91, 0]]},
        },
        {"type": "explore", "id": 1, "request": "run"},
    ],
)
async def test_a_frame_that_is_no_request_is_answered_in_words(file, frame):
    async with page(file) as (socket, heard):
        await socket.send_json(frame)
        said = await heard("error")
        assert said["message"].startswith("this page sent what the studio cannot read: ")


async def test_a_file_that_is_no_text_is_refused_in_words_and_left_as_it_is(file):
    file.write_bytes(b"mission \xff")
    async with page(file) as (_, heard):
        said = await heard("error")
        assert said["message"] == f"{file}: this is no text in UTF-8\n  hint: save it as UTF-8"
    assert file.read_bytes() == b"mission \xff"


async def test_a_frame_beyond_the_limit_ends_the_connection(file):
    async with page(file) as (socket, heard):
        with suppress(ConnectionError):  # it is cut while the frame is on its way
            await socket.send_str("x" * (MOST_BYTES + 1))
        assert not isinstance(await heard("error"), dict)
        assert socket.closed


async def test_a_change_of_the_text_ends_the_check_of_the_text_before(file):
    async with page(file) as (socket, heard):
        await socket.send_json({"type": "text", "text": HUGE, "number": 1})
        for _ in range(600):
            if running := checks():
                break
            await asyncio.sleep(0.1)
        await socket.send_json({"type": "text", "text": SMALL, "number": 2})
        found = await heard("verdicts")
        assert (found["number"], found["report"]["exit_code"]) == (2, 0)
        assert not running & checks()


async def test_the_exploration_is_of_the_newest_text_and_says_why_it_is_not(file):
    async with page(file) as (socket, heard):
        await socket.send_json({"type": "explore", "id": 1, "request": {"ask": "run", "run": ""}})
        assert (await heard("explored"))["refused"] == "there is no text yet"
        await socket.send_json({"type": "text", "text": SMALL, "number": 1})
        await socket.send_json({"type": "explore", "id": 2, "request": {"ask": "run", "run": ""}})
        assert list((await heard("explored"))["answer"]["view"]["places"]) == ["a"]
        await socket.send_json({"type": "text", "text": f"{SMALL}wrold {{}}", "number": 2})
        await socket.send_json({"type": "explore", "id": 3, "request": {"ask": "run", "run": ""}})
        assert (await heard("explored"))["refused"].startswith("the text has mistakes")


async def test_a_flight_of_a_mission_that_does_not_hold_is_refused_with_the_remedy(file):
    file.write_text(f'{SMALL}check {{ invariant "gone": not u in a }}', encoding="utf-8")
    async with page(file) as (socket, heard):
        await socket.send_json({"type": "fly", "id": 1})
        said = (await heard("flying"))["refused"]
        assert said.startswith("the flight does not begin:\n")
        assert "gone: not true here: not u in a\n  hint: write the line control timed into the text" in said


async def test_a_flight_of_a_text_with_a_mistake_is_refused_with_the_mistake(file):
    file.write_text(f"{SMALL}wrold {{}}", encoding="utf-8")
    async with page(file) as (socket, heard):
        await socket.send_json({"type": "fly", "id": 1})
        assert "did you mean 'world'" in (await heard("flying"))["refused"]


def checks():
    """Return the processes of this machine that check a text, as children of this one."""
    found = set()
    for each in Path("/proc").glob("[0-9]*"):
        try:
            line, status = (each / "cmdline").read_bytes(), (each / "stat").read_text(encoding="utf-8")
        except OSError:
            continue
        parent = int(status.rpartition(")")[2].split()[1])
        if b"bigactors.lsp.worker" in line and parent == os.getpid():
            found.add(each.name)
    return found
