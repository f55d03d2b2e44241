"""Camera plugins from the command line's options."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterable, Mapping

from adapters.camera.camera_plugin import Camera, CameraFeed
from adapters.camera.libraries import opencv
from adapters.camera.poses import PoseLog
from adapters.camera.sea_projection import Lens
from adapters.camera.slick import find_slicks
from adapters.camera.sources import source_of
from adapters.naming import NamingService
from adapters.plugin import Plugin
from bigactors.installed_plugins import find_detector
from bigactors.mistakes import Mistake
from specs.elaboration import ElaboratedMission


def poses_for(cameras: Iterable[Namespace], vehicles: Iterable[str]) -> dict[str, PoseLog]:
    """Return a pose log for each vehicle that carries a camera; raises Mistake if a carrier is not given."""
    given = set(vehicles)
    carriers = [camera.vehicle for camera in cameras]
    for name in carriers:
        if name not in given:
            raise Mistake(
                f"'{name:.60}' carries a camera, but its address is not given",
                f"give it with --vehicle {name:.60}=...",
            )
    return {name: PoseLog() for name in carriers}


def cameras_of(
    options: Namespace,
    mission: ElaboratedMission,
    poses: Mapping[str, PoseLog],
    naming: NamingService,
    time_to_live: float,
) -> tuple[Plugin, ...]:
    """Return the plugins of cameras; raises Mistake, PhysicalError."""
    if options.camera:
        opencv()  # refuse a missing OpenCV before anything flies
    return tuple(
        CameraFeed(
            f"camera{number} on {each.vehicle}",
            Camera(
                each.vehicle,
                Lens(each.fov, each.pitch, each.yaw, each.roll, each.level),
                each.every,
                each.delay,
                _kind(each.kind, mission),
                each.name,
                find_detector(each.detector) if each.detector else find_slicks,
            ),
            source_of(each.source),
            poses[each.vehicle],
            naming,
            time_to_live,
        )
        for number, each in enumerate(options.camera, 1)
    )


def _kind(kind: str, mission: ElaboratedMission) -> str:
    known = mission.setting.signature.kinds
    if kind not in known or known[kind].driven:
        others = ", ".join(each for each in known if not known[each].driven)
        hint = f"give the kind to look for: kind=KIND, one of {others}"
        raise Mistake(f"'{kind:.60}' is no kind of the mission that a camera could find", hint)
    return kind
