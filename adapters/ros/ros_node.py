"""Our own node in a ROS 2 graph: a session with the Zenoh router, and its arrivals in the event loop."""

from __future__ import annotations

import asyncio
import json
import re
from collections.abc import AsyncIterator, Callable, Collection, Iterable
from contextlib import asynccontextmanager
from dataclasses import replace
from typing import Any, Final

from adapters.addresses import Address, parse_address
from adapters.plugin import World
from adapters.rate_limit import Troubles
from adapters.ros.position_messages import MOST_BYTES, RosPosition, hash_of, read_position
from adapters.ros.wire import UNHASHED, Topic, node_token, topic_of
from physical import PhysicalError
from physical.wordings import install_extra

FUTURE: Final = 1.0
"""Seconds by which a sender's clock may be ahead of ours."""

REPORT: Final = 0.5
MOST_WAITING: Final = 1_000
"""The most waiting messages; more are dropped, and counted."""

PATIENCE: Final = 3_000
"""Milliseconds in which the router must answer."""

LAST_DOMAIN: Final = 232
HINT: Final = "write tcp:HOST:PORT[?domain=N] of the Zenoh router, or file:BAG"


class RouterLink:
    """A plugin's messages through a router, and the router's reachability."""

    def __init__(self, address: Address, domain: int, troubles: Troubles) -> None:
        self._address = address
        self._domain = domain
        self._troubles = troubles
        self._waiting = 0
        self._dropped = 0
        self._session: Any = None
        self._was_reached = True

    @asynccontextmanager
    async def opened(self, keys: Iterable[str], take: Callable[[Topic, bytes], None]) -> AsyncIterator[Any]:
        """Open a session, and take the messages under some keys; raises PhysicalError if no router answers.

        It also takes the messages that a publisher keeps for late subscribers. Zenoh reconnects by itself.
        """
        import zenoh.ext  # noqa: PLC0415 - an extra

        session = await asyncio.to_thread(open_session, self._address)
        self._session, self._was_reached = session, True
        hear, past = self._hearing(take), zenoh.ext.HistoryConfig(detect_late_publishers=True)
        try:
            kept = [zenoh.ext.declare_advanced_subscriber(session, key, hear, history=past) for key in keys]
            kept.append(session.liveliness().declare_token(node_token(self._domain, str(session.zid()))))
            yield session
        finally:
            self._session = None
            await asyncio.to_thread(session.close)

    def is_reached(self) -> bool:
        """Return whether the router answers."""
        return self._session is not None and bool(self._session.info.routers_zid())

    def report(self, world: World) -> None:
        """Report dropped messages, the loss and return of the router, and all other troubles."""
        dropped, self._dropped = self._dropped, 0
        if dropped:
            self._troubles.note("too many messages", f"{dropped:,} were dropped")
        reached = self._session is None or self.is_reached()
        if reached != self._was_reached:
            self._was_reached = reached
            what = "the router is back" if reached else "no router"
            self._troubles.note(
                what, f"{self._address}" + ("" if reached else " does not answer, and is tried again")
            )
        self._troubles.report(world)

    def _hearing(self, take: Callable[[Topic, bytes], None]) -> Callable[[Any], None]:
        loop = asyncio.get_running_loop()

        def heard(sample: Any) -> None:  # in a thread of Zenoh
            if self._waiting >= MOST_WAITING or len(sample.payload) > MOST_BYTES:
                self._dropped += 1
                return
            self._waiting += 1
            try:
                loop.call_soon_threadsafe(
                    self._arrived, take, str(sample.key_expr), sample.payload.to_bytes()
                )
            except RuntimeError:  # the run has ended
                self._waiting -= 1

        return heard

    def _arrived(self, take: Callable[[Topic, bytes], None], key: str, raw: bytes) -> None:
        self._waiting -= 1
        if self._session is None:
            return
        try:
            take(topic_of(key), raw)
        except PhysicalError as problem:
            self._troubles.note(problem.code, f"{key:.100}: {problem.message}")


def read_at(topic: Topic, raw: bytes, now: float, oldest: float, shift: float = 0.0) -> RosPosition:
    """Read a position, with its effective time; raises PhysicalError.

    `shift` moves the times of a bag to today. Messages older than `oldest` seconds are rejected.
    """
    if topic.type_hash not in (UNHASHED, hash_of(topic.type_name)):
        raise PhysicalError(
            "another type",
            f"{topic.type_name} comes with {topic.type_hash:.80}, not {hash_of(topic.type_name)}",
        )
    position = read_position(topic.type_name, raw)
    time = position.time + shift if position.time else now
    if time > now + FUTURE:
        raise PhysicalError("time stamp in the future", f"{time - now:.0f} s ahead")
    if time < now - oldest:
        raise PhysicalError("time stamp too old", f"{now - time:.0f} s behind")
    return replace(position, time=min(time, now))


def read_address(text: str) -> tuple[Address, int]:
    """Read an address and its domain; raises PhysicalError."""
    where, domain, _ = read_options(text, (), HINT)
    return where, domain


def read_options(text: str, known: Collection[str], hint: str) -> tuple[Address, int, dict[str, str]]:
    """Read an address, its domain, and the options that follow it; raises PhysicalError."""
    where, _, rest = text.partition("?")
    address = parse_address(text if text.startswith("file:") else where)
    if address.scheme not in ("tcp", "file"):
        raise PhysicalError("address", f"{text!r:.100}: ROS is not reached that way", hint)
    if address.scheme == "file" or not rest:
        return address, 0, {}
    options: dict[str, str] = {}
    for each in rest.split("&"):
        word, _, value = each.partition("=")
        if word not in ("domain", *known) or not value or word in options:
            raise PhysicalError("address", f"{each!r:.60} is no option there, or is given twice", hint)
        options[word] = value
    number = options.pop("domain", "0")
    if not re.fullmatch(r"[0-9]{1,3}", number) or int(number) > LAST_DOMAIN:
        raise PhysicalError("address", f"{number!r:.60} is no domain from 0 to {LAST_DOMAIN}", hint)
    return address, int(number), options


def open_session(address: Address) -> Any:
    """Open a session with a router; raises PhysicalError if none answers."""
    try:
        import zenoh  # noqa: PLC0415 - an extra
    except ImportError as missing:
        raise PhysicalError(
            "ros-extra", "ROS needs Zenoh, which is not installed", install_extra("ros")
        ) from missing
    settings = {
        "mode": "client",
        "connect": {"endpoints": [str(address).replace(":", "/", 1)], "timeout_ms": PATIENCE},
        "scouting": {"multicast": {"enabled": False}},
        "timestamping": {"enabled": True},
    }
    try:
        return zenoh.open(zenoh.Config.from_json5(json.dumps(settings)))
    except zenoh.ZError as error:
        raise PhysicalError(
            "ros", f"no Zenoh router answers at {address}", "start one: ros2 run rmw_zenoh_cpp rmw_zenohd"
        ) from error
