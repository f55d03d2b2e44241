"""Bytes by UDP: all that waits is read, nobody who is not there stops anything."""

import asyncio
import socket

import pytest

from adapters import transport
from adapters.addresses import Address, parse_address
from adapters.transport import MAX_AT_ONCE, open_port


@pytest.mark.timeout(60)
async def test_what_waits_at_a_socket_is_read_in_few_looks_of_the_loop():
    heard, looks = [], 0
    async with open_port(parse_address("udp:127.0.0.1:0"), lambda _, data: heard.append(data)) as port:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            for number in range(100):
                link.sendto(b"%d" % number, port.local)
        while len(heard) < 100:
            await asyncio.sleep(0)
            looks += 1
    assert heard == [b"%d" % number for number in range(100)]
    assert looks <= 100 // MAX_AT_ONCE + 3


@pytest.mark.timeout(60)
async def test_who_sends_where_nobody_listens_is_heard_once_somebody_does():
    heard = asyncio.Event()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as spot:
        spot.bind(("127.0.0.1", 0))
        free = spot.getsockname()[1]
    async with open_port(parse_address(f"udpout:127.0.0.1:{free}"), lambda *_: None) as sender:
        for _ in range(3):  # each may raise the refusal of the one before
            sender.send(b"lost")
            await asyncio.sleep(0.01)
        async with open_port(parse_address(f"udp:127.0.0.1:{free}"), lambda *_: heard.set()):
            while not heard.is_set():
                sender.send(b"heard")
                await asyncio.sleep(0.01)


async def test_a_name_is_looked_up_and_one_that_is_unknown_is_an_error():
    async with open_port(parse_address("udp:localhost:0"), lambda *_: None) as port:
        assert port.local[1]
    with pytest.raises(OSError, match=r"not known|resolution|Name"):
        async with open_port(parse_address("udp:nobody.invalid:0"), lambda *_: None):
            pass


async def test_of_too_many_connections_the_one_that_was_silent_for_longest_makes_room(monkeypatch):
    monkeypatch.setattr(transport, "MAX_PEERS", 3)
    heard, clients = [], []
    address = Address("tcpin", "127.0.0.1", 0)
    async with transport._listening(address, lambda _, data: heard.append(data)) as port:
        for number in range(5):
            clients.append(await asyncio.open_connection(*port.local))
            clients[0][1].write(b"%d" % number)  # the first one is never silent
            await asyncio.sleep(0.1)
        clients[-1][1].write(b"last")
        await asyncio.sleep(0.1)
        ended = [reader.at_eof() or reader.exception() is not None for reader, _ in clients]
        assert ended == [False, True, True, False, False]
        for _, writer in clients:
            writer.close()
    assert heard[-1] == b"last"
