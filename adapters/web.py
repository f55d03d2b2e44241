"""HTTP, by aiohttp: the only file that imports it, and only when called."""

from __future__ import annotations

import asyncio
import logging
import re
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from dataclasses import dataclass
from functools import cache
from ipaddress import IPv4Address, IPv6Address, ip_address
from typing import Any, Final

from adapters.addresses import LOOPBACK
from physical import PhysicalError, legible
from physical.wordings import install_extra

MAX_BODY: Final = 1_000_000
"""Bytes of a request or answer."""

TIMEOUT: Final = 10.0

MOST_CONNECTIONS: Final = 64
"""The most connections of all clients; the one with the oldest unfinished request makes room for another."""

BACKLOG: Final = 16
"""Connections accepted at once, before excess ones are closed: each takes a descriptor."""

IN_TIME: Final = 15.0
"""Seconds for a whole request to arrive. Each has a connection of its own."""

JSON: Final = ("application/json", "application/geo+json")

Handler = Callable[[str, str, bytes], Awaitable[tuple[int, str]]]
"""From method, path and body to status and text."""


@dataclass(frozen=True, slots=True)
class Listen:
    """A listening address: port 0 is any free one; the default host is this machine only.

    With a token, requests need it (`Authorization: Bearer ...`).
    """

    port: int
    host: str = LOOPBACK
    token: str | None = None


@asynccontextmanager
async def serve(handler: Handler, where: Listen) -> AsyncIterator[int]:
    """Serve HTTP until the context is left; yield the port.

    Only JSON is accepted, and only requests to this machine's address, so that no web page in a browser here can post
    (DNS rebinding). The number of connections and the time for a request are bounded. Raises OSError if it can't listen
    there.
    """
    web = library().web
    door: Door | None = None

    async def answer(request: Any) -> Any:
        refused = _refusal(request, where)
        body = None if refused else await _read(request)
        assert door is not None
        door.has_come(request.transport)
        if body is None:
            status, text = refused or (400, "the body does not match its headers")
        else:
            status, text = await handler(request.method, request.path, body)
        response = web.Response(status=status, text=text + "\n")
        response.force_close()
        return response

    application = web.Application(client_max_size=MAX_BODY)
    application.router.add_route("*", "/{path:.*}", answer)
    runner = web.AppRunner(application, access_log=None, logger=quiet_log())
    await runner.setup()
    async with AsyncExitStack() as stack:
        stack.push_async_callback(runner.cleanup)
        door = Door(runner.server, MOST_CONNECTIONS, IN_TIME)
        loop = asyncio.get_running_loop()
        server = await loop.create_server(
            door.opened, where.host, where.port, backlog=BACKLOG, reuse_address=True
        )
        stack.callback(server.close)
        yield server.sockets[0].getsockname()[1]


class Door:
    """Limits the number of connections, and the time of each for its request.

    Arguments:
        http: aiohttp's server.
        most: The most connections at once.
        seconds: The time in which a request must arrive; None for no bound.
    """

    def __init__(self, http: Any, most: int, seconds: float | None = None) -> None:
        self._http = http
        self._most = most
        self._seconds = seconds
        self._coming: dict[asyncio.Transport, asyncio.TimerHandle] = {}

    def opened(self) -> asyncio.Protocol:
        """Return the protocol of a connection that is about to be made."""
        return _Entering(self)

    def enter(self, transport: asyncio.Transport) -> None:
        """Pass a connection to the HTTP server, or close it if there are too many."""
        if len(self._http.connections) >= self._most and not self._makes_room():
            transport.abort()
            return
        if self._seconds is not None:
            loop = asyncio.get_running_loop()
            self._coming[transport] = loop.call_later(self._seconds, self._too_late, transport)
        handler = self._http()
        transport.set_protocol(handler)
        handler.connection_made(transport)

    def has_come(self, transport: asyncio.Transport | None) -> None:
        """Record that the request of a connection has arrived, or will never arrive."""
        timer = None if transport is None else self._coming.pop(transport, None)
        if timer is not None:
            timer.cancel()

    def _makes_room(self) -> bool:
        """Close the connection with the oldest unfinished request; return whether there was one."""
        for transport in [each for each in self._coming if each.is_closing()]:
            self.has_come(transport)
        oldest = next(iter(self._coming), None)
        self.has_come(oldest)
        if oldest is not None:
            oldest.abort()
        return oldest is not None

    def _too_late(self, transport: asyncio.Transport) -> None:
        self._coming.pop(transport, None)
        transport.abort()


class _Entering(asyncio.Protocol):
    def __init__(self, door: Door) -> None:
        self._door = door

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self._door.enter(transport)


def _refusal(request: Any, where: Listen) -> tuple[int, str] | None:
    if not is_meant(request.headers.get("Host", ""), where.host):
        return (
            421,
            f"address it as localhost, or by its number: {legible(request.host, 60)} is not known here",
        )
    token = where.token
    if token is not None and request.headers.get("Authorization") != f"Bearer {token}":
        return 401, "send the token: Authorization: Bearer TOKEN"
    if request.method == "POST" and request.content_type not in JSON:
        return 415, f"send {' or '.join(JSON)}"
    if (request.content_length or 0) > MAX_BODY:
        return 413, f"send at most {MAX_BODY:,} bytes"
    return None


async def _read(request: Any) -> bytes | None:
    """Return a request's body, None if it is invalid or the client has disconnected."""
    with suppress(ConnectionError, *_spoilt()):
        return await request.read()  # type: ignore[no-any-return]
    return None


def is_meant(header: str, listening: str) -> bool:
    """Return whether a request's Host is an address that is listened on; a rebound DNS name is not.

    >>> is_meant("127.0.0.1:8080", "127.0.0.1"), is_meant("[::1]", "::1"), is_meant("evil.example:8080", "127.0.0.1")
    (True, True, False)
    """
    host = header if header.endswith("]") else re.sub(r":[0-9]*$", "", header)
    host = host.removeprefix("[").removesuffix("]").lower()
    if host in ("localhost", listening.lower()):
        return True
    said, own = _number(host), _number(listening)
    if said is None or own is None:
        return False
    return own.is_unspecified or (own.is_loopback and said.is_loopback)


def _number(host: str) -> IPv4Address | IPv6Address | None:
    with suppress(ValueError):
        return ip_address(host)
    return None


@asynccontextmanager
async def fetching() -> AsyncIterator[Callable[[str], Awaitable[bytes]]]:
    """Yield a function that fetches a URL.

    It raises OSError if there is no answer, or if it is too long or not 200.
    """
    aiohttp = library()
    async with aiohttp.ClientSession(timeout=aiohttp.ClientTimeout(total=TIMEOUT)) as session:

        async def fetch(url: str) -> bytes:
            try:
                async with session.get(url) as answer:
                    return await _body(answer)
            except (aiohttp.ClientError, TimeoutError) as problem:
                raise OSError(str(problem) or type(problem).__name__) from problem

        yield fetch


async def _body(answer: Any) -> bytes:
    if answer.status != 200:
        raise OSError(f"HTTP status {answer.status}")
    body = bytearray()
    async for chunk in answer.content.iter_chunked(65_536):
        body += chunk
        if len(body) > MAX_BODY:
            raise OSError(f"the answer is over {MAX_BODY:,} bytes")
    return bytes(body)


@cache
def quiet_log() -> logging.Logger:
    """Return aiohttp's logger without clients' mistakes, which they get as answers."""

    def is_ours(record: logging.LogRecord) -> bool:
        return not (record.exc_info and isinstance(record.exc_info[1], _spoilt()))

    log = logging.getLogger(__name__)
    log.addFilter(is_ours)
    return log


def _spoilt() -> tuple[type[Exception], ...]:
    """Return the exceptions that aiohttp raises for an unreadable request."""
    aiohttp = library()
    return aiohttp.http_exceptions.HttpProcessingError, aiohttp.web.RequestPayloadError


@cache
def library() -> Any:
    """Return aiohttp; raises PhysicalError if it is not installed."""
    try:
        import aiohttp  # noqa: PLC0415 - an extra
        import aiohttp.web  # noqa: PLC0415 - an extra
    except ImportError as missing:
        hint = install_extra("live")
        raise PhysicalError("live-extra", "HTTP needs aiohttp, which is not installed", hint) from missing
    return aiohttp
