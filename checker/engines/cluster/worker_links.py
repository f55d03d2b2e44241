"""Links of a worker to all others: sockets, within a machine and between machines.

In an exchange, each worker sends something to every other and receives from every other; there is no leader. If a
worker is lost, the exchange fails for all. A process that ends is noticed at once, a machine after some time
(`SILENCE`).
"""

import hmac
import os
import pickle
import socket
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Any, Protocol

from checker.engines.cluster.crew import LostError
from checker.engines.cluster.transfer import WORKERS_AT_MOST

PATIENCE = 60.0
"""Seconds within which all workers must be connected."""

SILENCE = {"TCP_KEEPIDLE": 10, "TCP_KEEPINTVL": 5, "TCP_KEEPCNT": 4, "TCP_USER_TIMEOUT": 30_000}
"""When an unresponsive machine counts as lost, by Linux's socket options: seconds, the last in milliseconds."""

PROOF = 32
"""The bytes of a challenge, and of its answer."""

Address = tuple[str, int]


class Links(Protocol):
    """The interface for exchanges with the other workers."""

    def exchange(self, given: Sequence[Any]) -> list[Any]:
        """Send one item to each worker, in order, and return the items received from each.

        Raises:
            LostError: Some worker is gone, or has closed its links.
        """


class Sockets:
    """Links to workers on any machine; data is pickled, so each peer must first prove its membership.

    Attributes:
        address: The address at which others connect.
    """

    def __init__(self, host: str) -> None:
        family = socket.getaddrinfo(host, None)[0][0]
        self._server = socket.create_server((host, 0), family=family, backlog=WORKERS_AT_MOST)
        self._server.settimeout(PATIENCE)
        self.address: Address = self._server.getsockname()[:2]
        self._me = 0
        self._peers: dict[int, socket.socket] = {}
        self._sending = ThreadPoolExecutor(1, "sending")

    def meet(self, me: int, addresses: Sequence[Address], secret: bytes) -> None:
        """Connect with all others, which do the same, as worker number `me`.

        Raises:
            LostError: Some worker can't be reached.
        """
        self._me = me
        try:
            for peer, address in enumerate(addresses[:me]):
                link = self._peers[peer] = socket.create_connection(address, PATIENCE)
                link.sendall(_number(me))
                _prove(link, secret, me, peer)
            while len(self._peers) < len(addresses) - 1:
                self._admit(self._server.accept()[0], secret)
        except OSError as error:
            self.close()
            raise LostError(f"worker {me} could not meet the others: {error}") from error
        self._server.close()

    def _admit(self, link: socket.socket, secret: bytes) -> None:
        """Admit a caller that proves its membership; ignore any other."""
        link.settimeout(PATIENCE)
        try:
            peer = int.from_bytes(_received(link, len(_number(0))), "big")
            _prove(link, secret, self._me, peer)
        except OSError:
            link.close()
        else:
            self._peers[peer] = link

    def exchange(self, given: Sequence[Any]) -> list[Any]:
        """Send one item to each worker, in order, and return the items received from each."""
        found = list(given)
        # Another thread sends while this one receives, so no two workers wait for each other.
        sent = self._sending.submit(self._send, given)
        try:
            for peer in _in_turn(self._me, -1, len(given)):
                link = self._peers[peer]
                size = int.from_bytes(_received(link, len(_number(0))), "big")
                found[peer] = pickle.loads(_received(link, size))
            sent.result()
        except (OSError, KeyError) as error:
            self.close()
            raise LostError(f"worker {self._me} has lost others: {error}") from error
        return found

    def _send(self, given: Sequence[Any]) -> None:
        for peer in _in_turn(self._me, 1, len(given)):
            told = pickle.dumps(given[peer], pickle.HIGHEST_PROTOCOL)
            self._peers[peer].sendall(_number(len(told)))
            self._peers[peer].sendall(told)

    def close(self) -> None:
        """Close all links, which wakes the threads at the other ends."""
        self._server.close()
        for link in self._peers.values():
            with suppress(OSError):  # the other end may have closed first
                link.shutdown(socket.SHUT_RDWR)  # wakes threads that wait here, too
            link.close()
        self._peers = {}


def _in_turn(me: int, step: int, size: int) -> list[int]:
    """Return the others in cyclic order, so that in each step every worker has one sender and one receiver."""
    return [(me + step * distance) % size for distance in range(1, size)]


def _number(number: int) -> bytes:
    return number.to_bytes(8, "big")


def _received(link: socket.socket, size: int) -> bytearray:
    told = bytearray(size)
    left = memoryview(told)
    while left:
        count = link.recv_into(left)
        if not count:
            raise ConnectionError("it has gone")
        left = left[count:]
    return told


def _prove(link: socket.socket, secret: bytes, me: int, peer: int) -> None:
    """Authenticate both ends of a link by the secret and their numbers; afterwards remove its time limit.

    Raises:
        OSError: The other end fails.
    """
    challenge = os.urandom(PROOF)
    link.sendall(challenge)
    link.sendall(_proof(secret, me, bytes(_received(link, PROOF))))
    if not hmac.compare_digest(_received(link, PROOF), _proof(secret, peer, challenge)):
        raise ConnectionError("it does not belong to this crew")
    link.settimeout(None)
    link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    link.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for name, value in SILENCE.items():
        if hasattr(socket, name):
            link.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)


def _proof(secret: bytes, prover: int, challenge: bytes) -> bytes:
    return hmac.digest(secret, _number(prover) + challenge, "sha256")
