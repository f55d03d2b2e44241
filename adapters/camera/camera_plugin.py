"""The camera plugin: finds regions in the frames of a camera in flight, tracks them, and publishes them.

A thread decodes, searches and merges the frames, one after the other: the run never waits for it. A region is published
once its whole border was in view, under a name that it keeps, and withdrawn once most frames contradict it.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Final, TypeVar

from adapters.camera.frames import frame_of
from adapters.camera.poses import PoseLog
from adapters.camera.region_detection import Looked, look
from adapters.camera.sea_projection import Lens, Pose
from adapters.camera.slick import Detector, find_slicks
from adapters.camera.sources import Shot, Source
from adapters.camera.votes import Region, share
from adapters.listening_plugin import Feed
from adapters.naming import NameClash, NamingService
from adapters.plugin import Aged, Gone, World
from adapters.rate_limit import Troubles
from physical import Geometry, PhysicalError, PhysicalProperty

DOWN: Final = Lens()

LOOKS: Final = 0.2
"""Seconds between two checks for new frames."""

PATIENCE: Final = 2.0
"""Seconds for which a frame waits for its pose."""

MOST_WAITING: Final = 20
"""The most frames that wait for their pose or the search: the newest."""

SURE: Final = 0.3
"""The least confidence of a published region; below it a published one is withdrawn."""

SAME: Final = 0.9
"""The least overlap (intersection over union) of two outlines at which the first one stays published."""

SETTLES: Final = 20.0
"""Seconds between two outlines of one region: each is a step of the run."""

RELATED: Final = 0.1
"""The least overlap at which a new outline continues a known region."""

AGAIN: Final = 0.25
"""The fraction of its time to live after which a visible region is published again."""

Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Camera:
    """A camera and its detector.

    Attributes:
        vehicle: The vehicle that carries it.
        lens: Its field of view and its angles.
        every: Seconds between two searched frames.
        delay: Seconds from the exposure of a frame to its arrival.
        kind: The kind of its findings.
        called: The prefix of their names, before a number.
        detector: The detector that finds them in a frame.
    """

    vehicle: str
    lens: Lens = DOWN
    every: float = 1.0
    delay: float = 0.0
    kind: str = "OilSpill"
    called: str = "oilSpill"
    detector: Detector = find_slicks


@dataclass(frozen=True, slots=True)
class PublishedRegion:
    """One region: its last published outline, its entity, the time of that, and whether it was then withdrawn."""

    geometry: Geometry
    entity: str
    time: float
    withdrawn: bool = False


class CameraFeed(Feed):
    """A plugin for one camera.

    Arguments:
        name: Its name in reports.
        camera: The camera.
        source: The source of its frames.
        poses: The poses of its vehicle.
        naming: The naming service, with the reserved names.
        time_to_live: Seconds for which a sighting is valid.
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
        self._known: dict[str, PublishedRegion] = {}
        self._newest = float("-inf")
        self._troubles = Troubles(name)
        self.in_thread = True
        """Whether a thread does the search; False in simulated time, which would go on meanwhile."""

    async def run(self, world: World) -> None:
        """Search frames until cancelled."""
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
        """Queue new frames, except those that come too soon after the last one."""
        for shot in self._source.taken(now):
            at = shot.time - self._camera.delay
            if at - self._newest < self._camera.every:
                continue
            if len(self._waiting) == MOST_WAITING:
                self._leave_out("more than the detector can process")
            self._newest = at
            self._waiting.append(Shot(at, shot.name, shot.pixels))

    def _ready(self, now: float) -> tuple[Shot, Pose] | None:
        """Return the next frame with a known pose; frames whose pose never comes are left out."""
        while self._waiting:
            shot = self._waiting[0]
            if shot.time > self._poses.until and now - shot.time < PATIENCE:
                return None
            self._waiting.popleft()
            pose = self._poses.at(shot.time)
            if pose is not None:
                return shot, pose
            self._leave_out(f"the position and attitude of {self._camera.vehicle} are not known")
        return None

    async def _look(self, world: World, shot: Shot, pose: Pose) -> None:
        work = partial(looked_at, self._looked, shot, pose, self._camera)
        try:
            self._looked, found = await self._worked(work)
        except PhysicalError as problem:
            self._leave_out(problem.message)
        except Exception as problem:  # a detector is the user's own code
            self._leave_out(f"{shot.name}: {type(problem).__name__}: {problem}"[:200])
        else:
            self._publish(world, found)

    async def _worked(self, work: Callable[[], Result]) -> Result:
        return await asyncio.to_thread(work) if self.in_thread else work()

    def _leave_out(self, why: str) -> None:
        self._troubles.note("frame left out", why)

    # --- regions ----------------------------------------------------------------------------------

    def _publish(self, world: World, found: tuple[Region, ...]) -> None:
        """Publish the complete regions of sufficient confidence: again only if they change, or their time runs out."""
        now = world.now()
        for region in found:
            if not region.whole:
                continue
            name = self._name_of(region.geometry)
            before = self._known.get(name)
            if region.confidence < SURE:
                self._withdraw(world, name, now)
                continue
            geometry = region.geometry
            if before is not None and now - before.time < SETTLES:
                continue
            if before is not None and share(before.geometry, geometry) >= SAME:
                if not before.withdrawn and now - before.time < AGAIN * self._time_to_live:
                    continue
                geometry = before.geometry
            try:
                entity = self._naming.name(f"name:{name}", self._camera.kind)
            except NameClash as problem:
                self._troubles.note("detection refused", str(problem))
                continue
            self._known[name] = PublishedRegion(geometry, entity, now)
            seen_at = PhysicalProperty(entity, self._camera.kind, geometry, time=now, source=self.name)
            world.publish(Aged(seen_at, self._time_to_live))

    def _withdraw(self, world: World, name: str, now: float) -> None:
        """Take back a published region: the frames since have made it doubtful."""
        before = self._known.get(name)
        if before is not None and not before.withdrawn:
            self._known[name] = replace(before, time=now, withdrawn=True)
            world.publish(Gone(before.entity, now, self.name))

    def _name_of(self, geometry: Geometry) -> str:
        """Return the name of the known region that this one continues, else a new name."""
        shares = {name: share(known.geometry, geometry) for name, known in self._known.items()}
        nearest = max(shares, key=shares.__getitem__, default="")
        called = self._camera.called
        return nearest if shares.get(nearest, 0.0) >= RELATED else f"{called}{len(self._known)}"


def looked_at(before: Looked, shot: Shot, pose: Pose, camera: Camera) -> tuple[Looked, tuple[Region, ...]]:
    """Return the state and the regions after one more frame; raises the errors of decoding and detectors."""
    after = look(before, frame_of(shot.pixels(), pose, camera.lens, shot.name), camera.detector)
    return after, after.regions
