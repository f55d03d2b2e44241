"""Processes beside the studio: for one text, killed when it is out of date, and for one simulated flight."""

from __future__ import annotations

import asyncio
import contextlib
import json
import sys
from asyncio.subprocess import DEVNULL, PIPE, STDOUT, Process
from collections.abc import AsyncIterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

from bigactors.commands.run.console_beside import STARTING
from bigactors.mistakes import Mistake

MOST_ANSWER: Final = 64 << 20
"""The most bytes of one answer."""


class ChildProcess:
    """A Python module that runs in a process of its own; it ends when it is killed, or at the end of its input."""

    def __init__(self, process: Process) -> None:
        self._process = process

    @classmethod
    async def start(cls, *module: str) -> ChildProcess:
        """Start a module with its arguments; a module in the user's folder cannot take its place."""
        line = (sys.executable, "-P", "-m", *module)
        return cls(
            await asyncio.create_subprocess_exec(
                *line, stdin=PIPE, stdout=PIPE, stderr=DEVNULL, limit=MOST_ANSWER
            )
        )

    def kill(self) -> None:
        """End the process at once."""
        with contextlib.suppress(ProcessLookupError):
            self._process.kill()

    @property
    def has_ended(self) -> bool:
        """Whether the process has ended."""
        return self._process.returncode is not None

    async def end(self) -> None:
        """End the process, and wait until nothing of it is left."""
        self.kill()
        assert self._process.stdin is not None
        self._process.stdin.close()
        await self._process.wait()
        while await self._output.read(1 << 20):
            pass

    async def ask_once(self, question: Any) -> Any:
        """Return the value that the process prints after it has read a question; None if it fails."""
        try:
            out, _ = await self._process.communicate(json.dumps(question).encode())
        finally:
            self.kill()
        return json.loads(out) if self._process.returncode == 0 else None

    async def ask(self, question: Any) -> Any:
        """Return the answer to a question, each a line of JSON; None if the process has ended."""
        try:
            await self._write(json.dumps(question).encode() + b"\n")
            line = await self._output.readline()
        except (ConnectionError, ValueError):  # the latter for a line over the limit
            return None
        return json.loads(line) if line.endswith(b"\n") else None

    async def send_frame(self, message: Any) -> None:
        """Send a message with the header of the language server protocol; nothing if the process has ended."""
        data = json.dumps(message).encode()
        with contextlib.suppress(ConnectionError):
            await self._write(b"Content-Length: %d\r\n\r\n%b" % (len(data), data))

    async def frames(self) -> AsyncIterator[Any]:
        """Yield the messages of a language server until it ends."""
        with contextlib.suppress(asyncio.IncompleteReadError, ConnectionError):
            while True:
                header = await self._output.readuntil(b"\r\n\r\n")
                lines = dict(line.split(b": ", 1) for line in header.split(b"\r\n") if line)
                size = int(lines[b"Content-Length"])
                yield json.loads(await self._output.readexactly(size))

    async def _write(self, data: bytes) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(data)
        await self._process.stdin.drain()

    @property
    def _output(self) -> asyncio.StreamReader:
        assert self._process.stdout is not None
        return self._process.stdout


LINK: Final = "console, to act:"
RECORDING: Final = "run.mcap"
MOST_LINES: Final = 20
"""The lines of a flight that does not begin which are shown."""


class FlightProcess:
    """Starts the flight of a mission, and ends it."""

    def __init__(self) -> None:
        self._process: Process | None = None
        self._folder: TemporaryDirectory[str] | None = None
        self._rest: asyncio.Task[None] | None = None

    async def begin(self, file: Path) -> str:
        """Check and fly a mission's file, in the place of an earlier flight; return the console's link.

        Raises:
            Mistake: The mission does not hold, or cannot be flown so.
        """
        await self.end()
        self._folder = TemporaryDirectory(prefix="bigactors-")
        module = f"{__package__}.simulated_flight"
        line = (sys.executable, "-P", "-m", module, file.name, self._folder.name)
        there = file.resolve().parent
        self._process = await asyncio.create_subprocess_exec(
            *line, cwd=there, stdin=PIPE, stdout=PIPE, stderr=STDOUT
        )
        said: list[str] = []
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(STARTING):
                async for each in self._lines(self._process):
                    if each.startswith(LINK):
                        self._rest = asyncio.create_task(self._drain(self._process))
                        return each.removeprefix(LINK).strip()
                    said = [*said, each][-MOST_LINES:]
        await self.end()
        raise Mistake("the flight does not begin:\n" + "\n".join(said))

    async def recording(self) -> Path | None:
        """Wait until the flight has ended, and return its recording; None if another one took its place."""
        rest, folder = self._rest, self._folder
        if rest is None or folder is None:
            return None
        await asyncio.wait([rest])
        return None if rest.cancelled() else Path(folder.name) / RECORDING

    async def end(self) -> None:
        """End the flight, if there is one."""
        if self._rest is not None:
            self._rest.cancel()
        if self._process is not None:
            with contextlib.suppress(ProcessLookupError):
                self._process.kill()
            await self._process.wait()
        if self._folder is not None:
            self._folder.cleanup()
        self._process = self._folder = self._rest = None

    async def _lines(self, process: Process) -> AsyncIterator[str]:
        """Yield the printed lines."""
        assert process.stdout is not None
        async for line in process.stdout:
            yield line.decode(errors="replace").rstrip()

    async def _drain(self, process: Process) -> None:
        async for _ in self._lines(process):
            pass
