"""The simulated flight of a studio: one at a time, in a process that ends with the studio."""

from __future__ import annotations

import asyncio
import contextlib
import sys
from asyncio.subprocess import PIPE, STDOUT, Process
from collections.abc import AsyncIterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from bigactors.commands.run.console_beside import STARTING
from bigactors.mistakes import Mistake

LINK: Final = "console, to act:"
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
        line = (sys.executable, "-P", "-m", module, str(file), self._folder.name)
        self._process = await asyncio.create_subprocess_exec(*line, stdout=PIPE, stderr=STDOUT)
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
