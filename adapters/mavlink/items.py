"""Mission items: their messages, and the comparison of uploaded and stored items."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final

from adapters.mavlink.constants import Cmd, MavFrame, MissionType
from adapters.mavlink.message import MavlinkMessage, say
from physical import Geometry

TAKEOFF_PITCH: Final = 15.0
HEIGHT_TOLERANCE: Final = 0.02
"""Metres: the autopilot keeps centimetres."""


@dataclass(frozen=True, slots=True)
class OnboardItem:
    """One item: x and y are latitude and longitude in 1e-7 degree, z metres in the frame."""

    command: int
    x: int
    y: int
    z: float = 0.0
    frame: int = MavFrame.HOME
    parameters: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)


Items = tuple[OnboardItem, ...]

_SAME_FRAME: Final[dict[int, int]] = {
    MavFrame.SEA_LEVEL_INT: MavFrame.SEA_LEVEL,
    MavFrame.HOME_INT: MavFrame.HOME,
}
"""The frames for integer coordinates that PX4 reads back (mavlink/mavlink_mission.cpp)."""


def e7(at: Geometry) -> tuple[int, int]:
    """Return the latitude and longitude of a point in 1e-7 degree."""
    ((latitude, longitude),) = at.vertices
    return round(latitude * 1e7), round(longitude * 1e7)


@lru_cache(maxsize=256)
def route(
    path: tuple[Geometry, ...],
    height: float,
    *,
    takeoff: bool,
    home: bool = True,
    above: float | None = None,
    near: tuple[float, ...] = (),
) -> Items:
    """Return the mission that visits points at a height above home and stays at the last.

    If `home` is an item, it is item 0, which the vehicle overwrites. With `above`, the altitude of the mission's home,
    heights are above that home, even if the vehicle's home moves. `near`: acceptance radii of all points but the last.
    """
    z, frame = (height, MavFrame.HOME) if above is None else (round(height + above, 2), MavFrame.SEA_LEVEL)
    radii = near or (0.0,) * (len(path) - 1)
    ways = [
        OnboardItem(Cmd.WAYPOINT, *e7(at), z, frame, (0.0, radius, 0.0, 0.0))
        for at, radius in zip(path[:-1], radii, strict=True)
    ]
    stay = OnboardItem(Cmd.LOITER_UNLIMITED, *e7(path[-1]), z, frame)
    first = (
        [OnboardItem(Cmd.TAKEOFF, *e7(path[0]), z, frame, parameters=(TAKEOFF_PITCH, 0.0, 0.0, 0.0))]
        if takeoff
        else []
    )
    zeroth = [OnboardItem(Cmd.WAYPOINT, *e7(path[0]), 0.0, MavFrame.SEA_LEVEL)] if home else []
    return (*zeroth, *first, *ways, stay)


@lru_cache(maxsize=256)
def fence(polygon: Geometry) -> Items:
    """Return the fence that keeps a vehicle within a polygon."""
    count = float(len(polygon.vertices))
    return tuple(
        OnboardItem(
            Cmd.FENCE_VERTEX_INCLUSION,
            round(latitude * 1e7),
            round(longitude * 1e7),
            0.0,
            MavFrame.SEA_LEVEL,
            (count, 0.0, 0.0, 0.0),
        )
        for latitude, longitude in polygon.vertices
    )


def same(ours: Items, theirs: Items, kind: MissionType) -> bool:
    """Return whether the items on board are the wanted ones: all of a fence, all but home of a mission."""
    first = int(kind is MissionType.MISSION and bool(ours) and is_home(ours[0]))
    return len(ours) == len(theirs) and all(map(alike, ours[first:], theirs[first:]))


def is_home(item: OnboardItem) -> bool:
    """Return whether a first item is that for home: no flown item is at sea level."""
    return (item.command, item.z, item.frame) == (Cmd.WAYPOINT, 0.0, MavFrame.SEA_LEVEL)


def alike(a: OnboardItem, b: OnboardItem) -> bool:
    """Return whether an item on board is the wanted one."""
    here, there = ((each.command, _SAME_FRAME.get(each.frame, each.frame), each.x, each.y) for each in (a, b))
    counts = a.command == Cmd.DO_JUMP and a.parameters[0] != b.parameters[0]
    return here == there and abs(a.z - b.z) <= HEIGHT_TOLERANCE and not counts


def item_message(item: OnboardItem, index: int, kind: int, system: int, component: int = 1) -> MavlinkMessage:
    """Return the message that carries an item."""
    return say(
        "MISSION_ITEM_INT",
        target_system=system,
        target_component=component,
        seq=index,
        frame=int(item.frame),
        command=int(item.command),
        current=0,
        autocontinue=1,
        param1=item.parameters[0],
        param2=item.parameters[1],
        param3=item.parameters[2],
        param4=item.parameters[3],
        x=item.x,
        y=item.y,
        z=item.z,
        mission_type=int(kind),
    )


def item_of(said: Mapping[str, Any]) -> OnboardItem:
    """Read an item from the fields of its message."""
    parameters = (said["param1"], said["param2"], said["param3"], said["param4"])
    return OnboardItem(said["command"], said["x"], said["y"], said["z"], said["frame"], parameters)
