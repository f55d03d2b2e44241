"""The static places plugin: a GeoJSON file, a waypoint file or a plan, read again when it changes."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Final

from adapters.listening_plugin import Feed
from adapters.plugin import Gone, World
from adapters.rate_limit import Troubles
from physical import PhysicalError, PhysicalProperty, open_file
from physical.place_files import read_place_file

EVERY: Final = 1.0
"""Seconds between two checks of the file."""

MAX_BYTES: Final = 10_000_000


class StaticPlaces(Feed):
    """A plugin for the places of a file: GeoJSON, or by its ending `.waypoints` or `.plan` (waypoint0, waypoint1, ...).

    A file that becomes unreadable is reported, and its last places stay. Ignored parts of a file are reported by kind.
    """

    def __init__(self, name: str, path: Path) -> None:
        super().__init__(name, "is a place")
        self._path = path
        self._seen: tuple[int, int, int] | None = None
        self._known: dict[str, PhysicalProperty] = {}
        self._troubles = Troubles(name)

    async def run(self, world: World) -> None:
        """Publish the places, and then their changes.

        Raises PhysicalError if the file can't be read at the start.
        """
        self._look(world)
        while True:
            await asyncio.sleep(EVERY)
            try:
                self._look(world)
            except PhysicalError as problem:
                self._troubles.note("places unreadable", str(problem))
            self._troubles.report(world)

    def _look(self, world: World) -> None:
        stamp = _stamp(self._path)
        if stamp == self._seen:
            return
        self._seen = stamp
        found = read_place_file(self._path.suffix, _read(self._path))
        for row in found.missing():
            self._troubles.note(f"{self._path.name}: {row}")
        places = {place.entity: place for place in found.properties}
        for name in sorted(self._known.keys() - places.keys()):
            world.publish(Gone(name, world.now(), self._name))
        for name, place in places.items():
            if self._known.get(name) != place:
                world.publish(place)
        self._known = places


def _stamp(path: Path) -> tuple[int, int, int]:
    try:
        found = path.stat()
    except OSError as problem:
        raise _unreadable(path, problem) from None
    return found.st_mtime_ns, found.st_size, found.st_ino


def _read(path: Path) -> bytes:
    try:
        with open_file(path) as file:
            return file.read(MAX_BYTES + 1)  # beyond the limit: for the reader to refuse
    except OSError as problem:
        raise _unreadable(path, problem) from None


def _unreadable(path: Path, problem: OSError) -> PhysicalError:
    message = f"cannot read the places: {problem.strerror or problem}"
    return PhysicalError(
        "places", message, "give the path of a GeoJSON file, a waypoint file or a plan", str(path)
    )
