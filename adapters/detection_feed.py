"""The detections plugin: GeoJSON features that a vision system posts over HTTP or puts into a folder.

`POST /detections` takes a FeatureCollection; `DELETE /detections/NAME` withdraws one. A detection can't take the name
of a vehicle, or have a kind that may not be detected.
"""

from __future__ import annotations

import asyncio
from collections import OrderedDict
from collections.abc import Collection
from contextlib import AsyncExitStack
from dataclasses import replace
from pathlib import Path
from typing import Final
from urllib.parse import unquote

from adapters.listening_plugin import Feed, in_slices
from adapters.naming import NamingService
from adapters.plugin import Aged, Gone, World
from adapters.rate_limit import Troubles
from adapters.web import MAX_BODY, Listen, serve
from physical import PhysicalError, PhysicalProperty, legible, open_file, reading_geojson
from physical.file_account import Counting

EVERY: Final = 1.0
MAX_FILES: Final = 1_000
"""The most files of a folder that are read: the newest."""

MAX_KNOWN: Final = 10_000
"""The most detections that can be withdrawn: the newest."""

PATH: Final = "/detections"


class Detections(Feed):
    """A plugin for detected entities.

    Arguments:
        name: Its name in reports.
        listen: The address for posts; None for no posts.
        folder: The folder of files `*.geojson`; each is read again when it changes.
        kinds: Kinds that may be detected; all if None.
        naming: The naming service, with the reserved names.
        time_to_live: Seconds for which a detection is valid.
    """

    def __init__(
        self,
        name: str,
        *,
        listen: Listen | None = None,
        folder: Path | None = None,
        kinds: Collection[str] | None = None,
        naming: NamingService | None = None,
        time_to_live: float = 600.0,
    ) -> None:
        super().__init__(name, "was detected")
        self._listen = listen
        self._folder = folder
        self._kinds = None if kinds is None else frozenset(kinds)
        self._naming = naming or NamingService()
        self._time_to_live = time_to_live
        self._seen: dict[Path, int] = {}
        self._troubles = Troubles(name)
        self._unread: set[str] = set()
        self._world: World | None = None
        self._taking = asyncio.Lock()
        self._known: OrderedDict[str, None] = OrderedDict()
        self.port: int | None = None
        """Its port, once it listens."""

    async def run(self, world: World) -> None:
        """Take detections until cancelled."""
        self._world = world
        async with AsyncExitStack() as stack:
            if self._listen is not None:
                self.port = await stack.enter_async_context(serve(self._answer, self._listen))
            while True:
                await self._look()
                self._troubles.report(world)
                await asyncio.sleep(EVERY)

    # --- posts ------------------------------------------------------------------------------------

    async def _answer(self, method: str, path: str, body: bytes) -> tuple[int, str]:
        if method == "POST" and path == PATH:
            return await self._posted(body)
        if method == "DELETE" and path.startswith(f"{PATH}/"):
            return self._withdrawn(unquote(path.removeprefix(f"{PATH}/")))
        return 404, f"POST {PATH}, or DELETE {PATH}/NAME"

    async def _posted(self, body: bytes) -> tuple[int, str]:
        try:
            count = await self._take(body)
        except PhysicalError as problem:
            self._troubles.note("detection refused", str(problem))
            return 400, legible(str(problem))
        return 200, f"{count} taken"

    def _withdrawn(self, entity: str) -> tuple[int, str]:
        assert self._world is not None
        if self._known.pop(entity, entity) is not None:
            return 404, f"{entity!r:.60} was not detected"
        self._world.publish(Gone(entity, self._world.now(), self._name))
        return 200, "withdrawn"

    async def _take(self, body: bytes) -> int:
        """Publish all features of a collection, or none; one collection at a time, without blocking the event loop."""
        assert self._world is not None
        async with self._taking:
            counting = Counting()
            found = [feature async for feature in in_slices(reading_geojson(body, counting))]
            self._tell_unread(counting)
            for feature in found:
                self._check(feature)
            async for feature in in_slices(found):
                stamped = replace(feature, time=self._world.now(), source=self._name)
                self._world.publish(Aged(stamped, self._time_to_live))
                self._known[feature.entity] = None
                self._known.move_to_end(feature.entity)
                if len(self._known) > MAX_KNOWN:
                    self._known.popitem(last=False)
        return len(found)

    def _tell_unread(self, counting: Counting) -> None:
        """Report the ignored parts of features, each kind once: a vision system repeats them every second."""
        for kind, count in sorted(counting.asides.items()):
            if kind not in self._unread:
                self._unread.add(kind)
                self._troubles.note(kind, "it is reported only once", count)

    def _check(self, feature: PhysicalProperty) -> None:
        if self._kinds is not None and feature.kind not in self._kinds:
            expected = ", ".join(sorted(self._kinds))
            raise PhysicalError(
                "kind", f"{feature.kind} is not a kind that may be detected", f"kinds are {expected}"
            )
        self._naming.name(f"name:{feature.entity}", feature.kind)

    # --- a folder ---------------------------------------------------------------------------------

    async def _look(self) -> None:
        if self._folder is None:
            return
        files = {path: _changed(path) for path in self._folder.glob("*.geojson")}
        newest = sorted(files, key=lambda path: (files[path], path.name))[-MAX_FILES:]
        for path in newest:
            if self._seen.get(path) != files[path]:
                await self._read(path)
        self._seen = {path: files[path] for path in newest}

    async def _read(self, path: Path) -> None:
        try:
            with open_file(path) as file:
                body = file.read(MAX_BODY + 1)
            await self._take(body)
        except (OSError, PhysicalError) as problem:
            self._troubles.note("detection unreadable", f"{path.name}: {problem}")


def _changed(path: Path) -> int:
    try:
        return path.stat().st_mtime_ns
    except OSError:  # deleted after the listing
        return 0
