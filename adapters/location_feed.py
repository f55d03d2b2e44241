"""The location plugin: positions by HTTP and JSON from a location service.

It polls the service for a document like this, in which altitude (metres above sea level), speed (m/s), course (degrees
true), time (seconds since 1970) and channels are optional:

    {"entities": [{"name": "drifter0", "kind": "Drifter", "latitude": 37.0, "longitude": -8.7,
                   "altitude": 0, "speed": 0.4, "course": 120, "time": 1600000000, "channels": ["sat"]}]}
"""

from __future__ import annotations

import asyncio
from typing import Annotated, Any, Final

from msgspec import Meta, Struct

from adapters.listening_plugin import Feed, in_slices
from adapters.naming import NamingService
from adapters.plugin import Aged, World
from adapters.rate_limit import Troubles
from adapters.typed_json import Word, check_printable, read_typed, typed
from adapters.web import MAX_BODY, fetching
from physical import Band, PhysicalError, PhysicalProperty, Velocity, point

MAX_ENTITIES: Final = 10_000
LARGEST: Final = 1e12
"""The largest number: a thousand times a time in seconds."""

FUTURE: Final = 1.0
"""Seconds by which the service's clock may be ahead of ours."""


Number = Annotated[float, Meta(ge=-LARGEST, le=LARGEST)]


class _Entity(Struct, frozen=True):
    name: Word
    kind: Word
    latitude: Number
    longitude: Number
    altitude: Number | None = None
    speed: Number | None = None
    course: Number | None = None
    time: Number | None = None
    channels: tuple[Word, ...] = ()


class _Answer(Struct, frozen=True):
    entities: Annotated[list[Any], Meta(max_length=MAX_ENTITIES)]


class LocationService(Feed):
    """A plugin that polls a location service.

    Arguments:
        name: Its name in reports.
        url: The service's URL.
        every: Seconds between two requests.
        naming: The naming service.
        time_to_live: Seconds for which a position is valid.
    """

    def __init__(
        self,
        name: str,
        url: str,
        *,
        every: float = 1.0,
        naming: NamingService | None = None,
        time_to_live: float = 60.0,
    ) -> None:
        super().__init__(name, "is located")
        self._url = url
        self._every = every
        self._naming = naming or NamingService()
        self._time_to_live = time_to_live
        self._troubles = Troubles(name)

    async def run(self, world: World) -> None:
        """Poll until cancelled."""
        async with fetching() as fetch:
            while True:
                try:
                    await self._take(world, await fetch(self._url))
                except OSError as problem:
                    self._troubles.note("no answer", f"{self._url}: {problem}")
                except PhysicalError as problem:
                    self._troubles.note("answer unreadable", str(problem))
                self._troubles.report(world)
                await asyncio.sleep(self._every)

    async def _take(self, world: World, body: bytes) -> None:
        async for index, entry in in_slices(enumerate(read_typed(body, MAX_BODY, _Answer).entities)):
            try:
                known = _property(entry, world.now(), self._name)
                self._naming.name(f"name:{known.entity}", known.kind)
            except PhysicalError as problem:
                self._troubles.note("entity refused", f"entity {index}: {problem.message}")
                continue
            self._publish(world, known)

    def _publish(self, world: World, known: PhysicalProperty) -> None:
        assert known.time is not None
        if known.time < world.now() - self._time_to_live:
            self._troubles.note(
                "time stamp too old", f"{known.entity}, {world.now() - known.time:.0f} s behind"
            )
            return
        world.publish(Aged(known, self._time_to_live))


def _property(entry: object, now: float, source: str) -> PhysicalProperty:
    said = typed(entry, _Entity)
    check_printable(said)
    if said.time is not None and said.time > now + FUTURE:
        raise PhysicalError(
            "time", f"its time is {said.time - now:.0f} s in the future", "set the service's clock"
        )
    return PhysicalProperty(
        said.name,
        said.kind,
        point(said.latitude, said.longitude),
        None if said.altitude is None else Band(said.altitude, said.altitude),
        said.channels,
        time=now if said.time is None else min(said.time, now),
        source=source,
        velocity=None
        if said.speed is None or said.course is None
        else Velocity(said.speed, said.course % 360),
    )
