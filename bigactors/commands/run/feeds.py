"""Feed and camera plugins from the command line's options."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from adapters.addresses import LOOPBACK, parse_address
from adapters.ais import AisFeed
from adapters.camera.camera_plugin import Camera, CameraFeed
from adapters.camera.libraries import opencv
from adapters.camera.poses import PoseLog
from adapters.camera.sea_projection import Lens
from adapters.camera.slick import find_slicks
from adapters.camera.sources import source_of
from adapters.detection_feed import Detections
from adapters.location_feed import LocationService
from adapters.naming import NamingService
from adapters.plugin import Plugin
from adapters.ros import RosFeed
from adapters.static_places import StaticPlaces
from adapters.web import Listen
from bigactors.arguments.values import LIVING
from bigactors.files import read_bytes
from bigactors.installed_plugins import FEEDS as INSTALLED
from bigactors.installed_plugins import find_detector, make_feed, require_known
from bigactors.mistakes import Mistake, near_or_known
from bigactors.worlds import area_within
from physical import Geometry
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


LONGEST_TOKEN = 1_000


@dataclass(frozen=True, slots=True)
class Hearing:
    """The settings of feeds.

    Attributes:
        naming: The naming service.
        kinds: The kinds that each feed may report; an absent feed may report all.
        area: The area outside of which AIS positions are ignored.
        token: The token that posts of detections must carry.
        living: The time to live of each feed's positions, in seconds.
    """

    naming: NamingService
    kinds: dict[str, frozenset[str]]
    area: Geometry | None
    token: str | None
    living: dict[str, float]


def feeds_of(options: Namespace, mission: ElaboratedMission, naming: NamingService) -> tuple[Plugin, ...]:
    """Return the plugins of the given feeds; raises Mistake, PhysicalError."""
    hearing = Hearing(
        naming,
        {"detections": _expected(mission)} | _told(options, mission),
        None if options.within is None else area_within(options.within),
        None if options.token is None else _token(options.token),
        LIVING | dict(options.time_to_live),
    )
    return tuple(_feed(kind, address, n, hearing) for n, (kind, address) in enumerate(options.feed, 1))


def _told(options: Namespace, mission: ElaboratedMission) -> dict[str, frozenset[str]]:
    """Return the kinds given by option; those of detections must be kinds of the mission."""
    told = dict(options.kinds)
    known = mission.setting.signature.kinds
    for kind in sorted(told.get("detections", frozenset()) - known.keys()):
        hint = near_or_known(kind, known, "kinds")
        raise Mistake(f"the mission has no kind '{kind:.60}' that could be detected", hint)
    return told


def _expected(mission: ElaboratedMission) -> frozenset[str]:
    """Return the detectable kinds: the mission's kinds that are not driven."""
    kinds = mission.setting.signature.kinds.values()
    return frozenset(kind.name for kind in kinds if not kind.driven)


def _token(path: str) -> str:
    token = read_bytes(path, LONGEST_TOKEN).decode("ascii", "replace").strip()
    if not token or len(token) > LONGEST_TOKEN or not token.isascii() or not token.isprintable():
        raise Mistake(
            f"the token is not one line of at most {LONGEST_TOKEN:,} letters and digits",
            f"make one: openssl rand -hex 32 > {path}",
            path,
        )
    return token


def _ais(name: str, address: str, hearing: Hearing) -> Plugin:
    kinds, living = hearing.kinds.get("ais"), hearing.living["ais"]
    return AisFeed(name, address, hearing.naming, area=hearing.area, kinds=kinds, time_to_live=living)


def _places(name: str, address: str, _hearing: Hearing) -> Plugin:
    return StaticPlaces(name, Path(address.removeprefix("file:")))


def _detections(name: str, address: str, hearing: Hearing) -> Plugin:
    scheme, _, rest = address.partition(":")
    if scheme == "folder" and rest:
        return _detector(name, hearing, folder=Path(rest))
    at = parse_address(address.replace("http:", "tcpin:", 1))
    if at.host != LOOPBACK and hearing.token is None:
        hint = "give the token that posts must carry: --token FILE"
        raise Mistake(f"anyone who reaches {at.host} could post detections", hint, address)
    return _detector(name, hearing, listen=Listen(at.port, at.host, hearing.token))


def _detector(
    name: str, hearing: Hearing, *, listen: Listen | None = None, folder: Path | None = None
) -> Plugin:
    return Detections(
        name,
        listen=listen,
        folder=folder,
        kinds=hearing.kinds["detections"],
        naming=hearing.naming,
        time_to_live=hearing.living["detections"],
    )


def _locations(name: str, address: str, hearing: Hearing) -> Plugin:
    return LocationService(name, address, naming=hearing.naming, time_to_live=hearing.living["locations"])


def _ros(name: str, address: str, hearing: Hearing) -> Plugin:
    return RosFeed(name, address, naming=hearing.naming, time_to_live=hearing.living["ros"])


FEEDS: dict[str, Callable[[str, str, Hearing], Plugin]] = {
    "ais": _ais,
    "detections": _detections,
    "locations": _locations,
    "places": _places,
    "ros": _ros,
}
"""The function that makes each kind of feed from a name, an address and the settings."""


def _feed(kind: str, address: str, number: int, hearing: Hearing) -> Plugin:
    name, make = f"{kind}{number}", FEEDS.get(kind)
    if make is not None:
        return make(name, address, hearing)
    require_known(kind, INSTALLED, FEEDS, f"there is no feed '{kind:.40}'")
    return make_feed(kind, name, address)
