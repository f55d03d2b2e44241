"""The location plugin: positions by HTTP and JSON from a location service.

It polls the service for a document like this, in which altitude (metres above sea level), speed (m/s), course (degrees
true), time (seconds since 1970) and channels are optional:

    {"entities": [{"name": "drifter0", "kind": "Drifter", "latitude": 37.0, "longitude": -8.7,
                   "altitude": 0, "speed": 0.4, "course": 120, "time": 1600000000, "channels": ["sat"]}]}
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any, Final

from adapters.feed import Feed
from adapters.issue_counter import Troubles
from adapters.naming import NamingService
from adapters.plugin import Aged, World
from adapters.slices import in_slices
from adapters.web import MAX_BODY, fetching
from physical import Band, PhysicalError, PhysicalProperty, Velocity, is_word, point, read_json

MAX_ENTITIES: Final = 10_000
LARGEST: Final = 1e12
"""The largest number: a thousand times a time in seconds."""

FUTURE: Final = 1.0
"""Seconds by which the service's clock may be ahead of ours."""


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
        async for index, entry in in_slices(enumerate(_entries(body))):
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


def _entries(body: bytes) -> list[Any]:
    document = read_json(body, MAX_BODY)
    entries = document.get("entities") if isinstance(document, dict) else None
    if not isinstance(entries, list) or len(entries) > MAX_ENTITIES:
        raise PhysicalError(
            "location",
            f"the answer has no list of at most {MAX_ENTITIES:,} entities",
            'answer {"entities": [...]}',
        )
    return entries


def _property(entry: Any, now: float, source: str) -> PhysicalProperty:
    if not isinstance(entry, dict):
        raise PhysicalError("location", f"{entry!r:.60} is no entity", 'write {"name": ..., "kind": ...}')
    altitude, speed, course = (_optional(entry, name) for name in ("altitude", "speed", "course"))
    time = _optional(entry, "time")
    if time is not None and time > now + FUTURE:
        raise PhysicalError(
            "time", f"its time is {time - now:.0f} s in the future", "set the service's clock"
        )
    return PhysicalProperty(
        _word(entry, "name"),
        _word(entry, "kind"),
        point(_number(entry, "latitude"), _number(entry, "longitude")),
        None if altitude is None else Band(altitude, altitude),
        _channels(entry),
        time=now if time is None else min(time, now),
        source=source,
        velocity=None if speed is None or course is None else Velocity(speed, course % 360),
    )


def _number(entry: Mapping[str, Any], name: str) -> float:
    value = entry.get(name)
    if (
        isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= LARGEST
    ):  # excludes NaN
        raise PhysicalError(name, f"the {name} {value!r:.60} is no number", "write degrees, metres or m/s")
    return float(value)


def _optional(entry: Mapping[str, Any], name: str) -> float | None:
    return None if entry.get(name) is None else _number(entry, name)


def _word(entry: Mapping[str, Any], name: str) -> str:
    value = entry.get(name)
    if not is_word(value):
        raise PhysicalError(name, f"the {name} {value!r:.60} is no word", "write 1 to 200 characters")
    return value


def _channels(entry: Mapping[str, Any]) -> tuple[str, ...]:
    channels = entry.get("channels", [])
    if not isinstance(channels, list):
        raise PhysicalError("channels", f"the channels {channels!r:.60} are no list", 'write ["wifi", ...]')
    return tuple(_word({"channel": channel}, "channel") for channel in channels)
