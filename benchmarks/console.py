"""Measure what a console costs the run beside it, and what it shows of it.

The run is that of `wire`: a hundred vehicles and a thousand vessels over sockets, recorded. Flights take turns: without
a console, with one and a client that applies every frame, and with another client besides that takes no frame. What the
client came to is compared with a fresh fold of the recording. `python -m benchmarks.console`.
"""

import argparse
import asyncio
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import Any

import aiohttp

from adapters.console.history import History
from adapters.console.requests import PROTOCOL
from benchmarks.machine import resident
from benchmarks.wire import flown, measured
from bigactors.console import rules_of
from bigactors.terminal import say

WAYS = ("without", "with", "stalled")
"""Without a console, with one and a client, and with a client besides that takes no frame."""

SETTLING = 10.0
"""Seconds in which a console reads what was recorded before it, and clients connect."""

STALLED = 20.0
"""Seconds for which a client takes no frame before it connects anew: it is given up after thirty."""

PARTING = 60.0

OWN = {"bigraph": ("svg", "drawn"), "clock": ("now", "live", "playing", "speed")}
"""What is not of the recording: the picture, which is drawn when there is time, and where somebody looks."""


# --- the client -------------------------------------------------------------------------------------------------


@dataclass
class Client:
    """A browser's side, which applies every frame.

    Attributes:
        state: All sections.
        sizes: Of the frames after the snapshot, in bytes.
        delays: Seconds from the newest moment that a frame shows to its arrival.
        first: When the snapshot arrived.
    """

    state: dict[str, dict[str, Any]] = field(default_factory=dict)
    sizes: list[int] = field(default_factory=list)
    delays: list[float] = field(default_factory=list)
    first: float = 0.0

    def take(self, text: str) -> None:
        """Apply a frame: they are counted, and what goes was there."""
        frame = json.loads(text)
        if frame["type"] == "snapshot":
            assert frame["n"] == 1
            self.state, self.first = frame["state"], time.monotonic()
        elif frame["type"] == "changes":
            self.sizes.append(len(text.encode()))
            assert frame["n"] == len(self.sizes) + 1
            self._apply(frame["set"], frame["gone"])
            self.delays.append(time.time() - self.state["clock"]["head"])

    def _apply(self, changed: dict[str, dict[str, Any]], gone: dict[str, list[str]]) -> None:
        for name, values in changed.items():
            self.state.setdefault(name, {}).update(values)
        for name, keys in gone.items():
            for key in keys:
                del self.state[name][key]

    @property
    def ended(self) -> bool:
        """Whether the run has ended."""
        return bool(self.state.get("clock", {}).get("ended"))


async def attend(link: str) -> None:
    """Apply frames until the run has ended; print the figures and the state."""
    client = Client()
    async with aiohttp.ClientSession() as session, _connected(session, link) as socket:
        await _greet(socket, link)
        while not client.ended:
            client.take((await socket.receive()).data)
    delays = sorted(client.delays)
    found = {
        "frames": len(client.sizes),
        "frames a second": len(client.sizes) / (time.monotonic() - client.first),
        "KB a frame": median(client.sizes) / 1000,
        "median ms to the client": median(delays) * 1000,
        "99th p. ms to the client": delays[int(len(delays) * 0.99)] * 1000,
        "entities": len(client.state["entities"]),
    }
    sys.stdout.write(json.dumps({"figures": found, "state": client.state}))


async def stall(link: str) -> None:
    """Take no frame after the greeting, over and over, until killed."""
    async with aiohttp.ClientSession() as session:
        while True:
            async with _connected(session, link) as socket:
                await _greet(socket, link)
                await asyncio.sleep(STALLED)


def _connected(session: aiohttp.ClientSession, link: str) -> Any:
    return session.ws_connect(link.partition("#")[0] + "ws", max_msg_size=2**26)


async def _greet(socket: aiohttp.ClientWebSocketResponse, link: str) -> None:
    token = link.partition("#token=")[2]
    await socket.send_json({"type": "hello", "protocol": PROTOCOL, "token": token, "name": "bench"})


# --- the run ----------------------------------------------------------------------------------------------------


class Beside:
    """A console beside a run, with its clients: all of them other processes."""

    def __init__(self, recording: Path, stack: ExitStack, *, stalled: bool) -> None:
        """Begin them."""
        words = ["console", str(recording), "--follow", "--beside", "kept", "--listen", "127.0.0.1:0"]
        self._console = _other(stack, "bigactors", *words, stdin=subprocess.PIPE, start_new_session=True)
        assert self._console.stdout is not None
        said = next(line for line in self._console.stdout if "to watch:" in line)
        link = said.rpartition(" ")[2].strip()
        self._client = _other(stack, "benchmarks.console", "--attend", link)
        if stalled:
            _other(stack, "benchmarks.console", "--stall", link)

    @property
    def processor(self) -> float:
        """The seconds of processor time that the console has taken."""
        said = Path(f"/proc/{self._console.pid}/stat").read_text(encoding="utf-8").rpartition(") ")[2].split()
        return (int(said[11]) + int(said[12])) / os.sysconf("SC_CLK_TCK")

    @property
    def memory(self) -> float:
        """The most memory that it has taken, in MB."""
        return resident(process=str(self._console.pid))

    def parting(self) -> dict[str, Any]:
        """Return what the client says when the run has ended."""
        out, _ = self._client.communicate(timeout=PARTING)
        assert not self._client.returncode, "the client could not apply a frame"
        found: dict[str, Any] = json.loads(out)
        return found


def _other(stack: ExitStack, module: str, *words: str, **more: Any) -> subprocess.Popen[str]:
    line = [sys.executable, "-m", module, *words]
    process = stack.enter_context(subprocess.Popen(line, stdout=subprocess.PIPE, text=True, **more))
    stack.callback(process.kill)
    return process


async def measure(way: str, vehicles: int, vessels: int, seconds: float) -> dict[str, float]:
    """Fly for some seconds, with a console or without; return the figures."""
    with _folder() as folder, ExitStack() as stack:
        recording = folder / "run.mcap"
        async with flown(vehicles, vessels, recording) as (run, watch):
            starting = asyncio.to_thread(Beside, recording, stack, stalled=way == "stalled")
            beginning = None if way == "without" else asyncio.ensure_future(starting)
            if beginning is None:
                starting.close()
            await run.go(seconds=SETTLING)
            beside = None if beginning is None else await beginning
            before = 0.0 if beside is None else beside.processor
            found = await measured(run, watch, seconds)
            if beside is None:
                return found
            found["console's processor"] = (beside.processor - before) / seconds
            found["console's memory MB"] = beside.memory
        told = await asyncio.to_thread(beside.parting)
        _check(told["state"], recording)
        return found | told["figures"]


@contextmanager
def _folder() -> Iterator[Path]:
    with tempfile.TemporaryDirectory() as folder:
        yield Path(folder)


def _check(state: dict[str, Any], recording: Path) -> None:
    """Compare what a client came to with a fresh fold of the recording."""
    history = History(recording, rules_of)
    while history.read_on(1.0):
        pass
    fresh = json.loads(json.dumps(history.newest().sections, default=dict))
    for name in fresh.keys() | state.keys():
        own = OWN.get(name, ())
        here, there = (
            {key: value for key, value in each[name].items() if key not in own} for each in (state, fresh)
        )
        differing = [key for key in here.keys() | there.keys() if here.get(key) != there.get(key)]
        assert here == there, f"{name}: {differing[:5]}"


def main() -> None:
    """Print the figures, or be a client."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vehicles", type=int, default=100)
    parser.add_argument("--vessels", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--ways", nargs="+", choices=WAYS, default=WAYS)
    parser.add_argument("--attend", help=argparse.SUPPRESS)
    parser.add_argument("--stall", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.attend or options.stall:
        asyncio.run(attend(options.attend) if options.attend else stall(options.stall))
        return
    found: dict[str, list[dict[str, float]]] = {way: [] for way in options.ways}
    for turn in range(options.turns):
        for way in options.ways:
            found[way].append(asyncio.run(measure(way, options.vehicles, options.vessels, options.seconds)))
            figures = ", ".join(f"{name} {value:.1f}" for name, value in found[way][-1].items())
            say(f"{turn + 1} {way}: {figures}")
            sys.stdout.flush()
    say(f"{options.vehicles} vehicles, {options.vessels} vessels, {os.cpu_count()} cores; least and median:")
    for way, turns in found.items():
        say(way)
        for name in turns[0]:
            values = [turn[name] for turn in turns]
            say(f"  {name:<26} {min(values):10.2f} {median(values):10.2f}")


if __name__ == "__main__":
    main()
