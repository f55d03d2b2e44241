"""The operator's Unix socket: messages to a running mission, one line of JSON each way."""

from __future__ import annotations

import asyncio
import errno
import json
import os
import stat
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import Final

from adapters.live.state import GivingBack, Said, Saying
from physical import PhysicalError, is_text, read_json

MOST_BYTES: Final = 16_384
PATIENCE: Final = 5.0

Listener = Callable[[Said], Awaitable[str]]
"""Takes a message, and returns why it was refused, or an empty text."""


class NobodyListens(Exception):
    """No mission runs there, or it does not answer; the message says which."""


@asynccontextmanager
async def listening(path: Path, listener: Listener) -> AsyncIterator[None]:
    """Listen at a path that only its user may open; raises OSError if that is impossible.

    The socket of a killed run is replaced; that of a live run is not.
    """
    if await _is_taken(path):
        raise FileExistsError(errno.EEXIST, "another run listens there", str(path))
    if path.exists() and stat.S_ISSOCK(path.lstat().st_mode):
        path.unlink()

    async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        with suppress(OSError, ValueError, TimeoutError, asyncio.IncompleteReadError):
            async with asyncio.timeout(PATIENCE):
                line = await reader.readuntil()
            writer.write(json.dumps({"refusal": await _answer(line, listener)}).encode() + b"\n")
            await writer.drain()
        writer.close()

    mask = os.umask(0o177)
    try:
        server = await asyncio.start_unix_server(serve, path, limit=MOST_BYTES)
    finally:
        os.umask(mask)
    try:
        async with server:
            yield
    finally:
        path.unlink(missing_ok=True)


async def _is_taken(path: Path) -> bool:
    try:
        await _exchange(path, b"{}\n")
    except NobodyListens:
        return False
    return True


async def _answer(line: bytes, listener: Listener) -> str:
    with suppress(PhysicalError):
        match read_json(line, MOST_BYTES):
            case {"agent": str(agent), "message": str(message)} if is_text(agent) and is_text(message):
                return await listener(Saying(agent, message))
            case {"give_back": str(vehicle), "at": str(at)} if is_text(vehicle) and is_text(at):
                return await listener(GivingBack(vehicle, at))
    expected = "an object with 'agent' and 'message', or 'give_back' and 'at', in valid Unicode"
    return f"this is no saying: {expected}, was expected"


async def say(path: Path, agent: str, message: str) -> str:
    """Send a message to an agent of the run that listens at a path; return why it was refused, or an empty text.

    Raises:
        NobodyListens: No run does, or it does not answer.
    """
    return await _say(path, {"agent": agent, "message": message})


async def give_back(path: Path, vehicle: str, at: str = "") -> str:
    """Give a vehicle back to the run that listens at a path, or say at which HOST:PORT it is now; as `say`."""
    return await _say(path, {"give_back": vehicle, "at": at})


async def _say(path: Path, said: dict[str, str]) -> str:
    line = json.dumps(said).encode() + b"\n"
    if len(line) > MOST_BYTES:
        return f"a message of more than {MOST_BYTES:,} bytes"
    with suppress(PhysicalError):
        match read_json(await _exchange(path, line), MOST_BYTES):
            case {"refusal": str(refusal)}:
                return refusal
    raise NobodyListens(f"what listens at {path} is no run of bigactors")


async def _exchange(path: Path, line: bytes) -> bytes:
    try:
        reader, writer = await asyncio.open_unix_connection(path, limit=MOST_BYTES)
    except OSError as error:
        raise NobodyListens(f"no mission runs at {path}: {error.strerror or error}") from error
    try:
        writer.write(line)
        await writer.drain()
        async with asyncio.timeout(PATIENCE):
            return await reader.readuntil()
    except (TimeoutError, asyncio.IncompleteReadError, asyncio.LimitOverrunError, OSError) as error:
        raise NobodyListens(f"the run at {path} does not answer") from error
    finally:
        writer.close()
