"""Bytes from and to UDP, TCP and serial lines by asyncio; readers get chunks with their source addresses.

A broken connection is reopened until the port is closed. Beyond a bound, unsent data is dropped: all protocols here
repeat their messages.
"""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from typing import Any, Final, Protocol

from adapters.addresses import Address
from physical import PhysicalError
from physical.wordings import install_extra

CHUNK: Final = 65_536
AGAIN: Final = 1.0
"""Seconds before a broken connection is tried again."""

MAX_UNSENT: Final = 262_144
"""Bytes that may wait in a connection."""

BURST: Final = 1_048_576
"""The requested size of a socket's buffer in bytes; systems give less."""

MAX_AT_ONCE: Final = 8
"""Datagrams read at once, up to `CHUNK` bytes: about a millisecond's work, then the loop serves others."""

MAX_PEERS: Final = 64
"""The most connections of one port; beyond it the one that was silent for longest is closed."""

BACKLOG: Final = 16
"""Connections accepted at once."""

Remote = tuple[str, int]
Receive = Callable[[Remote, bytes], None]


class Port(Protocol):
    """A port that can send to the remotes that it has heard."""

    def send(self, data: bytes, remote: Remote | None = None) -> None:
        """Send to a remote; if None, to the one that we connect to."""

    @property
    def local(self) -> Remote:
        """Its local address, once it is open."""


@asynccontextmanager
async def open_port(address: Address, receive: Receive) -> AsyncIterator[Port]:
    """Open a port, and pass every received chunk to `receive`, until the context is left.

    Raises OSError if it can't listen there.
    """
    match address.scheme:
        case "udp" | "udpout":
            opened = _udp(address, receive)
        case "tcpin":
            opened = _listening(address, receive)
        case "tcp" | "serial":
            opened = _connecting(address, receive)
        case _:
            raise PhysicalError(
                "address", f"{address} is nothing to listen to", "name a socket or a serial line"
            )
    async with opened as port:
        yield port


# --- UDP --------------------------------------------------------------------------------------------


class _Datagrams:
    """One UDP socket. It reads all waiting datagrams at once: asyncio's own reads one in each pass of the loop."""

    def __init__(self, link: socket.socket, receive: Receive, *, connected: bool) -> None:
        self._link = link
        self._receive = receive
        self._connected = connected

    def read(self) -> None:
        """Pass on the waiting datagrams, up to a bound, so that the loop can serve others."""
        read = 0
        for _ in range(MAX_AT_ONCE):
            if read >= CHUNK:
                return
            try:
                data, sender = self._link.recvfrom(CHUNK)
            except BlockingIOError:
                return
            except OSError:
                continue  # no listener at the remote yet
            read += len(data)
            self._receive((sender[0], sender[1]), data)

    def send(self, data: bytes, remote: Remote | None = None) -> None:
        with suppress(OSError):  # data that can't be sent now is dropped
            if self._connected:
                self._link.send(data)
            elif remote is not None:
                self._link.sendto(data, remote)

    @property
    def local(self) -> Remote:
        name = self._link.getsockname()
        return name[0], name[1]


@asynccontextmanager
async def _udp(address: Address, receive: Receive) -> AsyncIterator[Port]:
    loop, out = asyncio.get_running_loop(), address.scheme == "udpout"
    family, where = await _resolved(address)
    with socket.socket(family, socket.SOCK_DGRAM) as link:
        link.setblocking(False)
        link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BURST)
        if out:
            link.connect(where)
        else:
            link.bind(where)
        port = _Datagrams(link, receive, connected=out)
        loop.add_reader(link, port.read)
        try:
            yield port
        finally:
            loop.remove_reader(link)


async def _resolved(address: Address) -> tuple[int, Any]:
    kind = socket.SOCK_DGRAM
    with suppress(socket.gaierror):  # a numeric address needs no look-up
        family, *_, where = socket.getaddrinfo(
            address.host, address.port, type=kind, flags=socket.AI_NUMERICHOST
        )[0]
        return family, where
    found = await asyncio.get_running_loop().getaddrinfo(address.host, address.port, type=kind)
    return found[0][0], found[0][4]


# --- TCP and serial lines ---------------------------------------------------------------------------


class _Streams:
    """The connections of a port, by remote."""

    def __init__(self, receive: Receive) -> None:
        self._receive = receive
        self._writers: dict[Remote, asyncio.StreamWriter] = {}
        self._heard: dict[Remote, float] = {}
        self.local: Remote = ("", 0)

    async def carry(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, remote: Remote) -> None:
        """Read a connection to its end; if there are too many, the one that was silent for longest is closed."""
        if len(self._writers) >= MAX_PEERS:
            self._drop(min(self._heard, key=self._heard.__getitem__))
        self._writers[remote], self._heard[remote] = writer, time.monotonic()
        try:
            while data := await reader.read(CHUNK):
                self._heard[remote] = time.monotonic()
                self._receive(remote, data)
        except OSError:
            pass  # it broke: the same as its end
        finally:
            if self._writers.get(remote) is writer:
                self._drop(remote)
            writer.close()

    def _drop(self, remote: Remote) -> None:
        del self._heard[remote]
        self._writers.pop(remote).transport.abort()

    def send(self, data: bytes, remote: Remote | None = None) -> None:
        writer = self._writers.get(remote) if remote else next(iter(self._writers.values()), None)
        if writer is not None and writer.transport.get_write_buffer_size() < MAX_UNSENT:
            writer.write(data)

    def close(self) -> None:
        for writer in list(self._writers.values()):
            writer.close()


@asynccontextmanager
async def _listening(address: Address, receive: Receive) -> AsyncIterator[Port]:
    streams = _Streams(receive)

    async def accept(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        peer = writer.get_extra_info("peername")
        await streams.carry(reader, writer, (peer[0], peer[1]))

    server = await asyncio.start_server(accept, address.host, address.port, backlog=BACKLOG)
    name = server.sockets[0].getsockname()
    streams.local = (name[0], name[1])
    try:
        yield streams
    finally:
        server.close()
        streams.close()
        await server.wait_closed()


@asynccontextmanager
async def _connecting(address: Address, receive: Receive) -> AsyncIterator[Port]:
    streams = _Streams(receive)
    task = asyncio.create_task(_keep_connected(address, streams))
    try:
        yield streams
    finally:
        task.cancel()
        with suppress(asyncio.CancelledError):
            await task


async def _keep_connected(address: Address, streams: _Streams) -> None:
    remote = (address.path or address.host, address.port)
    while True:
        with suppress(OSError):
            reader, writer = await _connect(address)
            await streams.carry(reader, writer, remote)
        await asyncio.sleep(AGAIN)


async def _connect(address: Address) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    if address.scheme == "tcp":
        return await asyncio.open_connection(address.host, address.port)
    try:
        from serial_asyncio_fast import open_serial_connection  # noqa: PLC0415 - an extra: few have serial lines
    except ImportError as missing:
        hint = install_extra("live")
        raise PhysicalError("live-extra", "serial lines need pyserial-asyncio-fast", hint) from missing
    opened: tuple[asyncio.StreamReader, asyncio.StreamWriter] = await open_serial_connection(
        url=address.path, baudrate=address.baud
    )
    return opened
