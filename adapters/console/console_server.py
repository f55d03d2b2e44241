"""The console's server: its page over HTTP, and the views over a websocket (docs/reference/console.md).

It reads a recording and never touches the run. The number of connections and their idle time are bounded.
"""

from __future__ import annotations

import asyncio
import mimetypes
import struct
from abc import ABC, abstractmethod
from collections.abc import AsyncIterator, Mapping
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from dataclasses import dataclass
from os import SEEK_END
from pathlib import Path
from socket import SO_LINGER, SOL_SOCKET
from ssl import SSLContext
from typing import Any, Final

from adapters.addresses import LOOPBACK
from adapters.console.access import Access, Role, bearer
from adapters.console.browser_requests import MOST_BYTES, PROTOCOL, Hello, Unreadable, read_request
from adapters.console.browser_session import EVERY, STALLED, Console, Looker
from adapters.console.coast import coast, window_of
from adapters.console.facts import Facts
from adapters.console.flight_report import flight_report
from adapters.recording.mcap_files import RecordingError
from adapters.recording.recorded_tracks import WRITERS, recorded_tracks
from adapters.web import BACKLOG, Door, is_meant, library, quiet_log
from physical import is_word, open_file

PAGE: Final = Path(__file__).with_name("page")
INDEX: Final = "index.html"
NEEDED: Final = "parts/leaflet.js"
"""A part that npm fetches; without it the page stays empty."""

PATIENCE: Final = 5.0
"""Seconds within which a connection must send its hello."""

HEARTBEAT: Final = 20.0
SLICE: Final = 0.02
"""Seconds of reading the recording before other tasks get their turn."""

BREAKS_OFF: Final = "the recording breaks off here: its run was killed, or is not over yet"
MOST_LOOKERS: Final = 32
MOST_CONNECTIONS: Final = 256
"""For all browsers together; each opens several for the files of the page."""

MOST_TILE: Final = 1 << 24
"""The most bytes of map tiles in one answer."""

IDLE: Final = 15.0
"""Seconds within which a connection must send a complete request."""

AT_ONCE: Final = struct.pack("ii", 1, 0)
"""SO_LINGER for a connection that is cut off, so that its unsent data is dropped."""

LINGERING: Final = 1.0
"""Seconds after an answer for which unread request data is still received."""

EXPORTS: Final = {
    "track.gpx": "application/gpx+xml",
    "track.csv": "text/csv",
    "track.geojson": "application/geo+json",
    "report.html": "text/html",
}
"""The content type of each file that a console writes."""

POLICY: Final = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS: Final = {
    "Cache-Control": "no-cache",
    "Content-Security-Policy": POLICY,
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}


@dataclass(frozen=True, slots=True)
class Site:
    """The address of a console: port 0 for any free port; by default only this machine can reach it."""

    port: int
    host: str = LOOPBACK
    tls: SSLContext | None = None


def lacks_parts() -> bool:
    """Return whether the page is incomplete, as in a clone before npm has fetched its parts."""
    return not (PAGE / NEEDED).is_file()


@asynccontextmanager
async def serving(console: Console, site: Site) -> AsyncIterator[int]:
    """Serve a console until the context is left; yield the port; raises as `listening`."""
    service = Service(console, site)
    async with listening(service, site) as port:
        reading = asyncio.create_task(service.read_on())
        try:
            yield port
        finally:
            reading.cancel()


@asynccontextmanager
async def listening(service: PageService, site: Site) -> AsyncIterator[int]:
    """Serve a page until the context is left; yield the port.

    Raises:
        OSError: The address cannot be listened on.
        PhysicalError: aiohttp is not installed.
    """
    web = library().web

    @web.middleware  # type: ignore[untyped-decorator]  # aiohttp is imported when it is called
    async def guard(request: Any, handler: Any) -> Any:
        return await service.guard(request, handler)

    application = web.Application(middlewares=[guard])
    for path, answer in service.routes().items():
        application.router.add_get(path, answer)
    bounds = {"keepalive_timeout": IDLE, "lingering_time": LINGERING}
    runner = web.AppRunner(application, access_log=None, logger=quiet_log(), shutdown_timeout=1.0, **bounds)
    await runner.setup()
    async with AsyncExitStack() as stack:
        stack.push_async_callback(runner.cleanup)
        server = await _listening(runner.server, site)
        stack.callback(server.close)
        stack.push_async_callback(service.close)
        yield server.sockets[0].getsockname()[1]


async def _listening(http: Any, site: Site) -> asyncio.Server:
    """Listen for at most `MOST_CONNECTIONS` connections."""
    return await asyncio.get_running_loop().create_server(
        Door(http, MOST_CONNECTIONS).opened,
        site.host,
        site.port,
        ssl=site.tls,
        ssl_handshake_timeout=None if site.tls is None else PATIENCE,
        backlog=BACKLOG,
        reuse_address=True,
    )


class PageService(ABC):
    """Answers requests of browsers for a page and its files; a subclass talks with the page over a websocket.

    Arguments:
        access: The tokens.
        site: The address, which requests must name.
        parts: The folders of the page's files, by the beginnings of their addresses; the first has the index.
        most_bytes: The size of a message.
    """

    protocol: str = PROTOCOL

    def __init__(self, access: Access, site: Site, parts: Mapping[str, Path], most_bytes: int) -> None:
        self._access = access
        self._site = site
        self._parts = {beginning: _files(folder) for beginning, folder in parts.items()}
        self._most_bytes = most_bytes
        self._connections: set[Any] = set()

    def routes(self) -> dict[str, Any]:
        """Return what answers each path."""
        files = {f"/{beginning}/{{path:.*}}": self.part for beginning in self._parts}
        return {"/": self.index, **files, "/land": self.land, "/ws": self.socket}

    @abstractmethod
    async def talk(self, socket: Any, role: Role, name: str) -> None:
        """Talk with a page until either side ends it."""

    async def close(self) -> None:
        """Close the sockets of all browsers."""
        for socket in tuple(self._connections):
            with suppress(ConnectionError):
                await socket.close(code=1001, message=b"the program has ended")

    # --- files

    async def guard(self, request: Any, handler: Any) -> Any:
        """Refuse requests from elsewhere (DNS rebinding, other sites), and set the headers of all answers."""
        web = library().web
        if not is_meant(request.headers.get("Host", ""), self._site.host):
            answer = web.Response(
                status=421, text="address it as localhost, by its number, or as it listens\n"
            )
        elif not self._is_own(request.headers.get("Origin")):
            answer = web.Response(status=403, text="another site's page may not ask this\n")
        else:
            try:
                answer = await handler(request)
            except web.HTTPException as error:
                answer = web.Response(status=error.status, text=f"{error.reason}\n")
        if not answer.prepared:
            answer.headers.update(HEADERS)
            await self._send(request, answer)
        return answer

    async def _send(self, request: Any, answer: Any) -> None:
        """Send an answer; cut off a client that does not take it within `STALLED` seconds."""
        try:
            async with asyncio.timeout(STALLED):
                await answer.prepare(request)
                await answer.write_eof()
        except TimeoutError:
            if request.transport is not None:  # it may have left meanwhile
                line = request.transport.get_extra_info("socket")
                line.setsockopt(SOL_SOCKET, SO_LINGER, AT_ONCE)  # else the system keeps the unsent data
                request.transport.abort()
            raise ConnectionResetError from None

    def _is_own(self, origin: str | None) -> bool:
        """Return whether the request is from this console's page or from a program; both need the token."""
        if origin is None:
            return True
        scheme, _, host = origin.partition("://")
        return scheme == ("http" if self._site.tls is None else "https") and is_meant(host, self._site.host)

    async def index(self, _: Any) -> Any:
        """Answer with the page."""
        index = next(iter(self._parts.values()))[INDEX]
        return library().web.Response(body=_bytes_of(index), content_type="text/html", charset="utf-8")

    async def part(self, request: Any) -> Any:
        """Answer with a file of the page; only known files are served, so that no path leaves the folder."""
        web = library().web
        path = self._parts[request.path.split("/")[1]].get(request.match_info["path"])
        if path is None:
            raise web.HTTPNotFound
        kind = "text/javascript" if path.suffix == ".js" else mimetypes.guess_type(path.name)[0]
        return web.Response(body=_bytes_of(path), content_type=kind or "application/octet-stream")

    async def land(self, request: Any) -> Any:
        """Answer with the coast in a window."""
        web = library().web
        self._admit(request)
        window = window_of(request.query)
        if window is None:
            return web.Response(status=400, text="give south, west, north and east, in degrees\n")
        answer = web.Response(
            text=await asyncio.to_thread(coast, *window), content_type="application/geo+json"
        )
        answer.enable_compression()
        return answer

    def _admit(self, request: Any) -> None:
        if self._access.role(bearer(request.headers.get("Authorization", ""))) is None:
            raise library().web.HTTPUnauthorized

    # --- the websocket

    async def socket(self, request: Any) -> Any:
        """Serve one browser over a websocket."""
        web = library().web
        if len(self._connections) >= MOST_LOOKERS:
            raise web.HTTPServiceUnavailable
        socket = web.WebSocketResponse(
            heartbeat=HEARTBEAT, max_msg_size=self._most_bytes, compress=not _is_near(request.remote)
        )
        socket.headers.update(HEADERS)
        await socket.prepare(request)
        self._connections.add(socket)
        try:
            hello = await self._hello(socket)
            if hello is not None:
                await self.talk(socket, *hello)
        except (ConnectionError, TimeoutError):
            pass  # the browser is gone, or reads nothing
        finally:
            self._connections.discard(socket)
            with suppress(ConnectionError):
                await socket.close()
        return socket

    async def _hello(self, socket: Any) -> tuple[Role, str] | None:
        """Return the role and the name from a client's hello; None, with the socket closed, if it is not valid."""
        code, why = 4401, b"say hello with a token"
        with suppress(TimeoutError, Unreadable):
            async with asyncio.timeout(PATIENCE):
                message = await socket.receive()
            said = read_request(message.data) if isinstance(message.data, str) else None
            if isinstance(said, Hello):
                if said.protocol != self.protocol:
                    code, why = 4400, f"this is {self.protocol}".encode()
                elif (role := self._access.role(said.token)) is not None:
                    if said.name == "" or is_word(said.name):
                        return role, said.name
                    code, why = 4402, b"a name has 1 to 200 characters that can be printed"
        await socket.close(code=code, message=why)
        return None


class Service(PageService):
    """Answers requests of a console's browsers."""

    def __init__(self, console: Console, site: Site) -> None:
        super().__init__(console.access, site, {"parts": PAGE}, MOST_BYTES)
        self._console = console

    def routes(self) -> dict[str, Any]:
        """Return what answers each path."""
        return super().routes() | {"/tiles": self.tiles, "/export/{name}": self.export}

    async def read_on(self) -> None:
        """Read appended messages, until cancelled or the file proves to be no recording."""
        with suppress(RecordingError, OSError):  # waiting browsers get the history's trouble
            while True:
                more = self._console.history.read_on(SLICE)
                if not more and not self._console.live:
                    self._console.history.end(BREAKS_OFF)
                await asyncio.sleep(0 if more else EVERY)

    async def export(self, request: Any) -> Any:
        """Answer with the vehicles' tracks, or with the report of the flight."""
        web = library().web
        self._admit(request)
        name, facts = request.match_info["name"], self._console.history.facts
        if facts.run is None or name not in EXPORTS:
            raise web.HTTPNotFound
        text = await asyncio.to_thread(_exported, self._console.history.path, facts, Path(name).suffix)
        return web.Response(text=text, content_type=EXPORTS[name], charset="utf-8")

    async def tiles(self, request: Any) -> Any:
        """Answer with a byte range of the map's tiles; the whole file may be too large for one answer."""
        web = library().web
        self._admit(request)
        if self._console.tiles is None:
            raise web.HTTPNotFound
        try:
            asked = request.http_range
        except ValueError:
            asked = slice(None)
        start, stop = asked.start or 0, asked.stop
        if stop is None or not 0 <= start < stop <= start + MOST_TILE:
            return web.Response(status=416, text=f"ask for a range of at most {MOST_TILE:,} bytes\n")
        part, size = await asyncio.to_thread(_part_of, self._console.tiles, start, stop)
        if not part:
            return web.Response(status=416, headers={"Content-Range": f"bytes */{size}"})
        place = {"Content-Range": f"bytes {start}-{start + len(part) - 1}/{size}"}
        return web.Response(status=206, body=part, headers=place, content_type="application/octet-stream")

    async def talk(self, socket: Any, role: Role, name: str) -> None:
        """Show a browser the console, and do what it asks."""
        looker = Looker(self._console, socket, role, name)
        showing = asyncio.create_task(looker.show())
        hearing = asyncio.create_task(looker.hear())
        _, left = await asyncio.wait((showing, hearing), return_when=asyncio.FIRST_COMPLETED)
        for task in left:
            task.cancel()
        ended = await asyncio.gather(showing, hearing, return_exceptions=True)
        for each in ended:
            if isinstance(each, Exception) and not isinstance(each, ConnectionError | TimeoutError):
                raise each


def _exported(recording: Path, facts: Facts, suffix: str) -> str:
    assert facts.run is not None
    tracks = recorded_tracks(recording, facts.run.vehicles)
    return flight_report(facts, tracks) if suffix == ".html" else WRITERS[suffix](tracks)


def _bytes_of(path: Path) -> bytes:
    with open_file(path) as file:
        return file.read()


def _part_of(path: Path, start: int, stop: int) -> tuple[bytes, int]:
    """Return the bytes of a file between two positions, and its size."""
    with open_file(path) as file:
        size = file.seek(0, SEEK_END)
        file.seek(start)
        return file.read(stop - start), size


def _files(folder: Path) -> dict[str, Path]:
    """Return the files of the page by their request paths, without npm's own files."""
    found = (path for path in folder.rglob("*") if path.is_file() and "node_modules" not in path.parts)
    return {
        path.relative_to(folder).as_posix(): path for path in found if not path.name.startswith("package")
    }


def _is_near(remote: str | None) -> bool:
    return remote in (LOOPBACK, "::1")
