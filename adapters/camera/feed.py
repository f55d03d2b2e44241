"""The camera plugin: what a camera in flight sees is found, followed from frame to frame, and published.

Each frame is decoded, searched and merged by a thread, one after the other: the run never waits for it. A region is
published once its whole border was in view, under a name that it keeps.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Final, TypeVar

from adapters.camera.frames import frame_of
from adapters.camera.poses import PoseLog
from adapters.camera.sightings import Looked, look
from adapters.camera.slick import Detector, find_slicks
from adapters.camera.sources import Shot, Source
from adapters.camera.view import Lens, Pose
from adapters.camera.votes import Region, share
from adapters.feed import Feed
from adapters.naming import NameClash, NamingService
from adapters.plugin import Aged, World
from adapters.troubles import Troubles
from physical import Geometry, PhysicalError, PhysicalProperty

DOWN: Final = Lens()

LOOKS: Final = 0.2
"""Seconds between two looks for frames."""

PATIENCE: Final = 2.0
"""Seconds for which a frame waits for the pose at its time."""

MOST_WAITING: Final = 20
"""Frames that wait for their pose, or to be looked at: the newest."""

SURE: Final = 0.3
"""The confidence from which a region is published."""

SAME: Final = 0.9
"""How much of two outlines is common (intersection over union) where the first goes on to be published."""

SETTLES: Final = 20.0
"""Seconds between two outlines of one region: each is a step of the run."""

RELATED: Final = 0.1
"""How much, where one is taken for the other, grown."""

AGAIN: Final = 0.25
"""The part of its time to live after which a region that is still seen is published again."""

Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Camera:
    """A camera, and what is looked for with it.

    Attributes:
        vehicle: What carries it.
        lens: Its field of view and its angles.
        every: Seconds between two frames that are looked at.
        delay: Seconds from when a frame is taken to when it comes.
        kind: The kind of what is found.
        called: What it is called, with a number.
        detector: What finds it in a frame.
    """

    vehicle: str
    lens: Lens = DOWN
    every: float = 1.0
    delay: float = 0.0
    kind: str = "OilSpill"
    called: str = "oilSpill"
    detector: Detector = find_slicks


@dataclass(frozen=True, slots=True)
class Sighting:
    """What is known of one region: its outline as it was published last, and when."""

    geometry: Geometry
    time: float


class CameraFeed(Feed):
    """A plugin for one camera.

    Arguments:
        name: Its name in reports.
        camera: The camera.
        source: Where its frames come from.
        poses: Where its vehicle is.
        naming: Whose names are taken already.
        time_to_live: Seconds for which what was seen counts.
    """

    def __init__(
        self,
        name: str,
        camera: Camera,
        source: Source,
        poses: PoseLog,
        naming: NamingService | None = None,
        time_to_live: float = 600.0,
    ) -> None:
        super().__init__(name, "was seen by a camera")
        self._camera = camera
        self._source = source
        self._poses = poses
        self._naming = naming or NamingService()
        self._time_to_live = time_to_live
        self._waiting: deque[Shot] = deque(maxlen=MOST_WAITING)
        self._looked = Looked()
        self._known: dict[str, Sighting] = {}
        self._newest = float("-inf")
        self._troubles = Troubles(name)
        self.in_thread = True
        """Whether a thread looks: not where time is simulated, and would go on meanwhile."""

    async def run(self, world: World) -> None:
        """Look at frames until cancelled."""
        self._source.begin()
        try:
            while True:
                self._take(world.now())
                while (shot := self._ready(world.now())) is not None:
                    await self._look(world, *shot)
                if trouble := self._source.trouble():
                    self._troubles.note("camera silent", trouble)
                self._troubles.report(world)
                await asyncio.sleep(LOOKS)
        finally:
            self._source.end()
            self._troubles.report(world, now=True)

    # --- frames -----------------------------------------------------------------------------------

    def _take(self, now: float) -> None:
        """Let new frames wait, but for those that come sooner than they are wanted."""
        for shot in self._source.taken(now):
            at = shot.time - self._camera.delay
            if at - self._newest < self._camera.every:
                continue
            if len(self._waiting) == MOST_WAITING:
                self._leave_out("more than could be looked at")
            self._newest = at
            self._waiting.append(Shot(at, shot.name, shot.pixels))

    def _ready(self, now: float) -> tuple[Shot, Pose] | None:
        """Return the next frame whose pose is known; those whose pose does not become known are left out."""
        while self._waiting:
            shot = self._waiting[0]
            if shot.time > self._poses.until and now - shot.time < PATIENCE:
                return None
            self._waiting.popleft()
            pose = self._poses.at(shot.time)
            if pose is not None:
                return shot, pose
            self._leave_out(f"where {self._camera.vehicle} was, and how it lay, is not known")
        return None

    async def _look(self, world: World, shot: Shot, pose: Pose) -> None:
        work = partial(looked_at, self._looked, shot, pose, self._camera)
        try:
            self._looked, found = await self._worked(work)
        except PhysicalError as problem:
            self._leave_out(problem.message)
        except Exception as problem:  # a detector is anybody's
            self._leave_out(f"{shot.name}: {type(problem).__name__}: {problem}"[:200])
        else:
            self._publish(world, found)

    async def _worked(self, work: Callable[[], Result]) -> Result:
        return await asyncio.to_thread(work) if self.in_thread else work()

    def _leave_out(self, why: str) -> None:
        self._troubles.note("frame left out", why)

    # --- what they show ---------------------------------------------------------------------------

    def _publish(self, world: World, found: tuple[Region, ...]) -> None:
        """Publish what is seen whole and surely: again only where it is another, or its time runs out."""
        now = world.now()
        for region in found:
            if not region.whole or region.confidence < SURE:
                continue
            name = self._name_of(region.geometry)
            before = self._known.get(name)
            geometry = region.geometry
            if before is not None and now - before.time < SETTLES:
                continue
            if before is not None and share(before.geometry, geometry) >= SAME:
                if now - before.time < AGAIN * self._time_to_live:
                    continue
                geometry = before.geometry
            try:
                entity = self._naming.name(f"name:{name}", self._camera.kind)
            except NameClash as problem:
                self._troubles.note("detection refused", str(problem))
                continue
            self._known[name] = Sighting(geometry, now)
            seen_at = PhysicalProperty(entity, self._camera.kind, geometry, time=now, source=self.name)
            world.publish(Aged(seen_at, self._time_to_live))

    def _name_of(self, geometry: Geometry) -> str:
        """Return the name of the sighting that a region is, else a new one."""
        shares = {name: share(known.geometry, geometry) for name, known in self._known.items()}
        nearest = max(shares, key=shares.__getitem__, default="")
        called = self._camera.called
        return nearest if shares.get(nearest, 0.0) >= RELATED else f"{called}{len(self._known)}"


def looked_at(before: Looked, shot: Shot, pose: Pose, camera: Camera) -> tuple[Looked, tuple[Region, ...]]:
    """Return what is known after one more frame, and what that shows; raises what decoding and detectors raise."""
    after = look(before, frame_of(shot.pixels(), pose, camera.lens, shot.name), camera.detector)
    return after, after.regions
