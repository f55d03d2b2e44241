"""A console that is served to tests, and clients of it: browsers, and others that behave badly."""

import asyncio
import json
import socket
from contextlib import asynccontextmanager
from pathlib import Path

import aiohttp
from jsonschema import Draft202012Validator

from adapters.console.access import Access
from adapters.console.browser_requests import PROTOCOL
from adapters.console.browser_session import Console
from adapters.console.console_server import Site, serving
from adapters.console.history import History
from bigactors.commands.console.recorded_history import rules_of

DOCS = Path(__file__).parents[1] / "docs" / "reference"
SCHEMA = json.loads((DOCS / "console.schema.json").read_text(encoding="utf-8"))
ACCESS = Access("looks-on", "may-act")
BEARER = {"Authorization": "Bearer looks-on"}
HELLO = {"type": "hello", "protocol": PROTOCOL, "token": "may-act", "name": "Ana"}


def checked(side):
    """Return what holds frames of one side to the documented schema."""
    return Draft202012Validator({**SCHEMA, "oneOf": [{"$ref": f"#/$defs/{side}"}]})


OF_SERVER, OF_CLIENT = checked("server"), checked("client")


class Client:
    """A browser's side: applies the frames, and keeps what else it hears."""

    def __init__(self, socket):
        self.socket, self.state, self.heard, self.frames = socket, {}, [], 0

    async def frame(self):
        """Take one frame; return its type."""
        frame = json.loads((await asyncio.wait_for(self.socket.receive(), 60)).data)
        OF_SERVER.validate(frame)
        if frame["type"] == "snapshot":
            self.state = {name: dict(section) for name, section in frame["state"].items()}
            assert frame["n"] == 1
        elif frame["type"] == "changes":
            for name, values in frame["set"].items():
                self.state.setdefault(name, {}).update(values)
            for name, keys in frame["gone"].items():
                for key in keys:
                    del self.state[name][key]
            assert frame["n"] == self.frames + 1
        else:
            self.heard.append(frame)
        self.frames = frame.get("n", self.frames)
        return frame["type"]

    async def until(self, true):
        """Take frames until something is so of what is shown."""
        async with asyncio.timeout(60):
            while not (self.state and true(self.state)):
                await self.frame()

    async def say(self, **message):
        await self.socket.send_json(message)

    async def act(self, **action):
        """Ask for an action; return why it is refused."""
        await self.say(type="act", id="1", action=action)
        return (await self.answer())["refusal"]

    async def answer(self):
        async with asyncio.timeout(60):
            before = len(self.heard)
            while len(self.heard) == before:
                await self.frame()
        return self.heard[-1]


@asynccontextmanager
async def console(path, **more):
    history = History(path, rules_of, live=more.get("live", False))
    history.read_on(5.0)
    async with serving(Console(history, ACCESS, "1", **more), Site(0)) as port:
        yield f"http://127.0.0.1:{port}"


@asynccontextmanager
async def client(address, *, hello=HELLO, **more):
    async with aiohttp.ClientSession() as session, session.ws_connect(f"{address}/ws", **more) as found:
        await found.send_json(hello)
        yield Client(found)


def play(state):
    return state["clock"]["playing"]


def opened(address):
    """Return a connection of which the test says every byte."""
    found = socket.create_connection(("127.0.0.1", int(address.rpartition(":")[2])))
    found.settimeout(10)
    return found


def raw(address):
    """Return a connection that has said hello by hand, and answers nothing from then on."""
    found = opened(address)
    found.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1024)
    key = "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13"
    head = f"Host: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n{key}"
    found.sendall(f"GET /ws HTTP/1.1\r\n{head}\r\n\r\n".encode() + masked(json.dumps(HELLO).encode()))
    return found


def masked(said):
    return bytes([0x81, 0x80 | len(said)]) + bytes(4) + said


def read_all(connection):
    got = b""
    while more := connection.recv(65_536):
        got += more
    return got
