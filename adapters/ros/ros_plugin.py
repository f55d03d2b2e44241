"""The ROS plugin: positions of a ROS 2 graph, by the Zenoh router of `rmw_zenoh`, or of a bag.

It subscribes to every topic with a type of positions: `/drifter0/fix` is about the mission's entity `drifter0`.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from adapters.listening_plugin import Feed
from adapters.naming import NamingService
from adapters.plugin import Aged, World
from adapters.rate_limit import Troubles
from adapters.ros.position_messages import TYPES, hash_of, typestore
from adapters.ros.ros_node import REPORT, RouterLink, read_address, read_at
from adapters.ros.wire import NODE, Topic, all_of
from physical import PhysicalError, PhysicalProperty


class RosFeed(Feed):
    """A plugin that receives positions from ROS 2.

    Arguments:
        name: Its name in reports.
        address: The Zenoh router's, `tcp:HOST:PORT[?domain=N]`, or `file:BAG`.
        naming: The naming service; it knows the kinds of the mission's entities.
        time_to_live: Seconds for which a position is valid.
    """

    def __init__(
        self, name: str, address: str, *, naming: NamingService | None = None, time_to_live: float = 60.0
    ) -> None:
        super().__init__(name, "is heard over ROS")
        self._address, self._domain = read_address(address)
        self._naming = naming or NamingService()
        self._time_to_live = time_to_live
        self._troubles = Troubles(name)
        self._link = RouterLink(self._address, self._domain, self._troubles)
        self.played = asyncio.Event()
        """Set when a bag has been played to its end."""
        self.listening = asyncio.Event()
        """Set when the router has answered."""

    async def run(self, world: World) -> None:
        """Receive until cancelled."""
        typestore()  # report a missing extra at once
        try:
            if self._address.scheme == "file":
                await asyncio.gather(self._play(world), self._reporting(world))
            await self._listen(world)
        finally:
            self._troubles.report(world, now=True)

    async def _reporting(self, world: World) -> None:
        while True:
            await asyncio.sleep(REPORT)
            self._link.report(world)

    async def _listen(self, world: World) -> None:
        def take(topic: Topic, raw: bytes) -> None:
            if not topic.name.startswith(f"/{NODE}/"):  # a run's own publications
                self._take(world, topic, raw)

        async with self._link.opened((all_of(self._domain, each) for each in TYPES), take):
            self.listening.set()
            await self._reporting(world)

    # --- bags -------------------------------------------------------------------------------------

    async def _play(self, world: World) -> None:
        """Replay a bag in real time."""
        start = None
        for topic, stamp, raw in _recorded(self._address.path):
            start = world.now() - stamp if start is None else start
            await asyncio.sleep(max(0.0, stamp + start - world.now()))
            self._take(world, topic, raw, start)
        if start is None:
            self._troubles.note("no positions", f"the bag has none of {', '.join(TYPES)}")
        self.played.set()

    # --- messages of both -------------------------------------------------------------------------

    def _take(self, world: World, topic: Topic, raw: bytes, shift: float = 0.0) -> None:
        """Publish the position in a message; `shift` moves the times of a bag to today."""
        try:
            world.publish(Aged(self._property(topic, raw, shift, world.now()), self._time_to_live))
        except PhysicalError as problem:
            self._troubles.note(problem.code, f"{topic.name:.100}: {problem.message}")

    def _property(self, topic: Topic, raw: bytes, shift: float, now: float) -> PhysicalProperty:
        position = read_at(topic, raw, now, self._time_to_live, shift)
        entity = self._naming.name(f"name:{topic.name.split('/')[1]}")
        kind = self._naming.kind_of(entity, "")
        if not kind:
            raise PhysicalError("unknown entity", f"the mission has no {entity!r:.60}")
        return PhysicalProperty(entity, kind, position.geometry, time=position.time, source=self._name)


def _recorded(path: str) -> Iterator[tuple[Topic, float, bytes]]:
    """Yield a bag's messages with positions, with their times; raises PhysicalError, OSError."""
    from rosbags.highlevel import AnyReader  # noqa: PLC0415 - an extra

    try:
        with AnyReader([Path(path)], default_typestore=typestore()[0]) as reader:
            known = [each for each in reader.connections if each.msgtype in TYPES]
            for each, stamp, raw in reader.messages(connections=known) if known else ():
                yield _topic(each), stamp / 1e9, bytes(raw)
    except OSError:
        raise
    except Exception as problem:  # a damaged bag makes its readers (YAML, SQLite, MCAP) raise anything
        reason = str(problem) or type(problem).__name__
        raise PhysicalError("bag", f"{path:.200}: {reason:.200}", "give the folder of a rosbag2") from problem


def _topic(connection: Any) -> Topic:
    """Return a connection's topic; bags of older ROS have no hashes of types."""
    known = connection.digest.startswith("RIHS")
    return Topic(
        connection.topic, connection.msgtype, connection.digest if known else hash_of(connection.msgtype)
    )
