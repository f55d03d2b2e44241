"""The operator's Unix socket: messages to a running mission, one line of JSON each way."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator, Mapping, Sequence
from contextlib import asynccontextmanager, contextmanager, suppress
from pathlib import Path
from socket import socket
from types import MappingProxyType
from typing import Any, Final, NamedTuple

from adapters.live.batch import Acknowledging, GivingBack, Noting, Ordering, Said, Saying
from adapters.live.socket_file import Reserve, bound
from adapters.live.turn_result import Answer
from physical import PhysicalError, is_text, is_word, read_json
from semantics.live_policy import Fallback

MOST_BYTES: Final = 16_384
MOST_ANSWER: Final = 2**20
PATIENCE: Final = 5.0
MOST_SERVED: Final = 32
"""Simultaneous connections: each has one request, and ends within seconds."""

ASKED: Final = b'{"status": true}\n'
"""The line that requests the status of a run."""

ASKED_FATES: Final = b'{"fates": true}\n'
"""The line that requests the fates of operators' orders."""

HAS_STARTED: Final = "the run has started already"

EXPECTED: Final = (
    "an object with 'agent' and 'message', 'give_back', 'order' (hold or return) and 'vehicle', 'acknowledge', 'note', "
    "or 'start', and 'by', in valid Unicode"
)

Listener = Callable[[Said], Awaitable[Answer]]
"""Takes a message, and returns the answer to it."""

Fates = Mapping[str, tuple[str, str]]
"""The fate of the operator's order to each vehicle, also in words."""

Starter = Callable[[str], str]
"""Starts the run for an operator, and returns the reason if it does not start, else an empty text."""


class NobodyListens(Exception):
    """No mission runs there, or it does not answer, according to the message."""


@asynccontextmanager
async def listening(
    path: Path,
    listener: Listener,
    describe: Callable[[], str] = str,
    fates: Callable[[], Fates] = dict,
    start: Starter = lambda _by: HAS_STARTED,
) -> AsyncIterator[None]:
    """Listen at a path that only its user may open; raises OSError if that is impossible.

    `describe` returns the status of the run, `fates` the fates of orders; `start` starts a run that waits for an
    operator. The socket of a killed run is replaced; that of a live run is not, even if the run is stopped.
    """

    async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            with suppress(OSError, ValueError, TimeoutError, asyncio.IncompleteReadError):
                async with asyncio.timeout(PATIENCE):
                    line = await reader.readuntil()
                answer = await _answer(line, listener, describe, fates, start)
                writer.write(json.dumps(answer).encode() + b"\n")
                await writer.drain()
        finally:
            writer.close()
        with suppress(OSError):
            await writer.wait_closed()

    with bound(path) as server, _accepting(server, serve):
        yield


Serve = Callable[[asyncio.StreamReader, asyncio.StreamWriter], Awaitable[None]]


@contextmanager
def _accepting(server: socket, serve: Serve) -> Iterator[None]:
    """Serve connections, also in a process without free descriptors: some are kept in reserve."""
    loop, reserve, serving = asyncio.get_running_loop(), Reserve(), set[asyncio.Task[None]]()

    async def carry(connection: socket) -> None:
        reader = asyncio.StreamReader(limit=MOST_BYTES)
        protocol = asyncio.StreamReaderProtocol(reader)
        transport, _ = await loop.connect_accepted_socket(lambda: protocol, connection)
        await serve(reader, asyncio.StreamWriter(transport, protocol, reader, loop))

    def accept() -> None:
        connection = reserve.accepted(server)
        if connection is None:
            return
        if len(serving) >= MOST_SERVED:
            connection.close()
            return
        task = loop.create_task(carry(connection))
        serving.add(task)
        task.add_done_callback(serving.discard)
        task.add_done_callback(lambda _: reserve.fill())

    loop.add_reader(server, accept)
    try:
        yield
    finally:
        loop.remove_reader(server)
        for task in serving:
            task.cancel()
        reserve.close()


async def _answer(
    line: bytes, listener: Listener, describe: Callable[[], str], fates: Callable[[], Fates], start: Starter
) -> dict[str, object]:
    if line == ASKED:
        return {"refusal": "", "status": describe()}
    if line == ASKED_FATES:
        return {"refusal": "", "fates": dict(fates())}
    said = _said(line)
    if isinstance(said, str):
        return {"refusal": start(said)}
    if said is None:
        return {"refusal": f"this is no request: expected {EXPECTED}"}
    answer = await listener(said)
    more = {"left_out": dict(answer.left_out), "notes": [*answer.notes]}
    return {"refusal": answer.refusal, **{name: each for name, each in more.items() if each}}


def _said(line: bytes) -> Said | str | None:
    """Return the message in a line, or the operator who starts the run by it; None if there is none."""
    with suppress(PhysicalError):
        match read_json(line, MOST_BYTES):
            case {**said} if (by := said.get("by", "")) == "" or is_word(by):
                return _said_by(said, by)
    return None


def _said_by(said: Mapping[object, object], by: str) -> Said | str | None:
    match said:
        case {"start": True}:
            return by
        case {"agent": str(agent), "message": str(message)} if is_text(agent) and is_text(message):
            return Saying(agent, message, by)
        case {"give_back": str(vehicle)} if is_text(vehicle) and is_text(at := said.get("at", "")):
            return GivingBack(vehicle, at, by)
        case {"order": "hold" | "return" as order, "vehicle": None}:
            return Ordering(Fallback(order), None, by)
        case {"order": "hold" | "return" as order, "vehicle": str(vehicle)} if is_text(vehicle):
            return Ordering(Fallback(order), vehicle, by)
        case {"order": "hold" | "return" as order, "vehicle": [str(), *_] as several} if all(
            map(is_text, several)
        ):
            return Ordering(Fallback(order), tuple(dict.fromkeys(filter(is_text, several))), by)
        case {"acknowledge": int(number)} if not isinstance(number, bool):
            return Acknowledging(number, by)
        case {"note": str(text)} if is_text(text):
            return Noting(text, by)
    return None


async def say(path: Path, agent: str, message: str, by: str = "") -> str:
    """Send a message to an agent of the run that listens at a path; return the reason of a refusal, or an empty text.

    Raises:
        NobodyListens: No run listens there, or it does not answer.
    """
    return _refusal(await _say(path, {"agent": agent, "message": message, "by": by}))


class Outcome(NamedTuple):
    """The outcome of an operator's request.

    Attributes:
        refusal: The reason of a refusal; empty if it was accepted.
        left_out: For an order to all vehicles, those left out, with the reasons.
        notes: Other remarks to the operator.
    """

    refusal: str
    left_out: Mapping[str, str] = MappingProxyType({})
    notes: tuple[str, ...] = ()


async def order(path: Path, what: str, vehicle: str | Sequence[str] | None, by: str = "") -> Outcome:
    """Order a vehicle, several, or all, to `hold` or `return`; as `say`, and return the vehicles left out, too."""
    return _outcome(await _say(path, {"order": what, "vehicle": vehicle, "by": by}))


async def give_back(path: Path, vehicle: str, at: str = "", by: str = "") -> Outcome:
    """Give a vehicle back to the run that listens at a path, or pass on its new HOST:PORT; as `order`."""
    return _outcome(await _say(path, {"give_back": vehicle, "at": at, "by": by}))


async def acknowledge(path: Path, finding: int, by: str = "") -> str:
    """Acknowledge a finding by its number; as `say`."""
    return _refusal(await _say(path, {"acknowledge": finding, "by": by}))


async def note(path: Path, text: str, by: str = "") -> str:
    """Record an operator's note in the run that listens at a path; as `say`."""
    return _refusal(await _say(path, {"note": text, "by": by}))


async def start(path: Path, by: str = "") -> str:
    """Start the run that waits at a path; as `say`."""
    return _refusal(await _say(path, {"start": True, "by": by}))


async def status(path: Path) -> str:
    """Return the status of the run that listens at a path, in lines of text; raises NobodyListens."""
    match await _asked(path, ASKED):
        case {"status": str(text)}:
            return text
    raise NobodyListens(f"the run at {path} is of a version that reports no status")


async def fates(path: Path) -> Fates:
    """Return the fates of operators' orders in the run that listens at a path; raises NobodyListens."""
    match await _asked(path, ASKED_FATES):
        case {"fates": dict(found)}:
            pairs = (
                (name, each) for name, each in found.items() if isinstance(each, list) and len(each) == 2
            )
            return {name: (str(fate), str(words)) for name, (fate, words) in pairs}
    raise NobodyListens(f"the run at {path} is of a version that reports no progress of orders")


def _outcome(answer: dict[str, Any]) -> Outcome:
    left_out, notes = answer.get("left_out"), answer.get("notes")
    why = {name: str(each) for name, each in left_out.items()} if isinstance(left_out, dict) else {}
    return Outcome(_refusal(answer), why, tuple(map(str, notes)) if isinstance(notes, list) else ())


def _refusal(answer: dict[str, Any]) -> str:
    refusal: str = answer["refusal"]
    return refusal


async def _say(path: Path, said: dict[str, Any]) -> dict[str, Any]:
    line = json.dumps(said).encode() + b"\n"
    if len(line) > MOST_BYTES:
        return {"refusal": f"a message of more than {MOST_BYTES:,} bytes"}
    return await _asked(path, line)


async def _asked(path: Path, line: bytes) -> dict[str, Any]:
    """Return a run's answer to a line; it has at least the reason of a refusal."""
    with suppress(PhysicalError):
        answer: Any = read_json(await _exchange(path, line), MOST_ANSWER)
        if isinstance(answer, dict) and isinstance(answer.get("refusal"), str):
            return answer
    raise NobodyListens(f"the listener at {path} is no run of bigactors")


async def _exchange(path: Path, line: bytes) -> bytes:
    try:
        reader, writer = await asyncio.open_unix_connection(path, limit=MOST_ANSWER)
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
