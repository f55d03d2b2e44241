"""Bytes from and to UDP, TCP and serial lines by asyncio; who reads sees chunks and where they came from.

A connection that breaks is made again until the port is closed. What can't be sent at once is dropped beyond a bound:
everything here is said again anyway.
"""

from __future__ import annotations

import asyncio
import socket
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from typing import Any, Final, Protocol

from adapters.addresses import Address
from physical import PhysicalError

CHUNK: Final = 65_536
AGAIN: Final = 1.0
"""Seconds before a broken connection is tried again."""

MAX_UNSENT: Final = 262_144
"""Bytes that may wait in a connection."""

BURST: Final = 1_048_576
"""Bytes that a socket is asked to hold while something else is served; systems give less."""

MAX_PEERS: Final = 64
"""Connections accepted by one port."""

Remote = tuple[str, int]
Receive = Callable[[Remote, bytes], None]


class Port(Protocol):
    """Something that can send to whom it has heard."""

    def send(self, data: bytes, remote: Remote | None = None) -> None:
        """Send to a remote; to the one that we connect to if None."""
        ...

    @property
    def local(self) -> Remote:
        """Where it listens, once it is open."""
        ...


@asynccontextmanager
async def open_port(address: Address, receive: Receive) -> AsyncIterator[Port]:
    """Open a port, and hand every chunk that arrives to `receive`, until the context is left.

    Raises OSError where it can't listen there.
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


class _Datagrams(asyncio.DatagramProtocol):
    """One UDP socket."""

    def __init__(self, receive: Receive, peer: Remote | None) -> None:
        self._receive = receive
        self._peer = peer
        self._transport: Any = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._transport = transport
        link = transport.get_extra_info("socket")
        link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BURST)

    def datagram_received(self, data: bytes, addr: tuple[Any, ...]) -> None:
        self._receive((addr[0], addr[1]), data)

    def error_received(self, exc: Exception) -> None:
        """Pass over that nobody listens there: it may yet."""

    def send(self, data: bytes, remote: Remote | None = None) -> None:
        to = self._peer or remote
        if to is not None and self._transport.get_write_buffer_size() < MAX_UNSENT:
            self._transport.sendto(data, None if self._peer else to)

    @property
    def local(self) -> Remote:
        name = self._transport.get_extra_info("sockname")
        return name[0], name[1]


@asynccontextmanager
async def _udp(address: Address, receive: Receive) -> AsyncIterator[Port]:
    where = (address.host, address.port)
    out = address.scheme == "udpout"
    transport, protocol = await asyncio.get_running_loop().create_datagram_endpoint(
        lambda: _Datagrams(receive, where if out else None),
        local_addr=None if out else where,
        remote_addr=where if out else None,
    )
    try:
        yield protocol
    finally:
        transport.close()


# --- TCP and serial lines ---------------------------------------------------------------------------


class _Streams:
    """The connections of a port, by remote."""

    def __init__(self, receive: Receive) -> None:
        self._receive = receive
        self._writers: dict[Remote, asyncio.StreamWriter] = {}
        self.local: Remote = ("", 0)

    async def carry(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, remote: Remote) -> None:
        """Read a connection to its end."""
        if len(self._writers) >= MAX_PEERS:
            writer.close()
            return
        self._writers[remote] = writer
        try:
            while data := await reader.read(CHUNK):
                self._receive(remote, data)
        except OSError:
            pass  # it broke: the same as its end
        finally:
            self._writers.pop(remote, None)
            writer.close()

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

    server = await asyncio.start_server(accept, address.host, address.port)
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
        hint = "install the extra: pip install 'bigactors[live]'"
        raise PhysicalError("live-extra", "serial lines need pyserial-asyncio-fast", hint) from missing
    opened: tuple[asyncio.StreamReader, asyncio.StreamWriter] = await open_serial_connection(
        url=address.path, baudrate=address.baud
    )
    return opened
