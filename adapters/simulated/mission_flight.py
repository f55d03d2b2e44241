"""Missions of a simulated vehicle: flight, landing sequence, and the point of return."""

from __future__ import annotations

from typing import Final

from adapters.mavlink.constants import Cmd, MissionType
from adapters.mavlink.items import Items, OnboardItem
from adapters.mavlink.refuges import missing_items
from adapters.mavlink.telemetry import Telemetry
from adapters.simulated.body import Target, metres_to
from adapters.simulated.vehicle_state import INFO, WARNING, State

NAMES: Final[dict[int, str]] = {
    Cmd.TAKEOFF: "Takeoff",
    Cmd.WAYPOINT: "WP",
    Cmd.LOITER_UNLIMITED: "LoitUnlim",
    Cmd.LAND: "Land",
}
"""ArduPilot's names for the items of a mission that it begins."""

_FLOWN: Final = frozenset(NAMES)
"""The items with a destination; all others are over as soon as they are begun."""

IMMEDIATELY: Final = 2.0
AT_HOME: Final = 1.0
"""RTL_AUTOLAND for going straight to the landing sequence, or first to the point of return."""


def follow(vehicle: State, seconds: float) -> None:
    """Fly the mission for a while."""
    items = vehicle.store.mission
    first = int(vehicle.kind.profile.dialect.home_is_item)
    if len(items) <= first:
        return
    vehicle.current = max(first, min(vehicle.current, len(items) - 1))
    item = items[vehicle.current]
    if vehicle.told != vehicle.current:
        vehicle.told = vehicle.current
        vehicle.words.append((INFO, f"Mission: {vehicle.current} {NAMES.get(item.command, item.command)}"))
    _fly(vehicle, item, seconds)
    if _done(vehicle, item) and vehicle.current < len(items) - 1:
        _next(vehicle, item)


def _fly(vehicle: State, item: OnboardItem, seconds: float) -> None:
    if item.command == Cmd.TAKEOFF:
        vehicle.take_off(_height(vehicle, item), seconds)
    elif item.command in _FLOWN:
        stays = item.command == Cmd.LOITER_UNLIMITED
        circle = vehicle.circle if stays and vehicle.kind.limits.must_move else 0.0
        vehicle.go(Target(item.x / 1e7, item.y / 1e7, _height(vehicle, item), circle), seconds)
        low = (
            vehicle.body.height <= _height(vehicle, item) + 1.0
            and _away(vehicle, item) <= vehicle.kind.radius
        )
        if item.command == Cmd.LAND and low:
            vehicle.arm(armed=False)


def _done(vehicle: State, item: OnboardItem) -> bool:
    if item.command == Cmd.TAKEOFF:
        return vehicle.body.height >= _height(vehicle, item) - 1.0
    if item.command not in _FLOWN:
        return True
    asked = item.parameters[1] if vehicle.kind.limits.must_move else 0.0
    return item.command == Cmd.WAYPOINT and _away(vehicle, item) <= (asked or vehicle.kind.radius)


def _next(vehicle: State, item: OnboardItem) -> None:
    vehicle.reached.append(vehicle.current)
    if item.command == Cmd.WAYPOINT:
        words = f"Reached waypoint #{vehicle.current} dist {_away(vehicle, item):.0f}m"
        vehicle.words.append((INFO, words))
    jumps = item.command == Cmd.DO_JUMP
    vehicle.current = round(item.parameters[0]) if jumps else vehicle.current + 1


def _height(vehicle: State, item: OnboardItem) -> float:
    """Return an item's height above home."""
    return vehicle.height_in(item.z, item.frame)


def _away(vehicle: State, item: OnboardItem) -> float:
    return metres_to(vehicle.body, item.x / 1e7, item.y / 1e7)[0]


def refuge(vehicle: State) -> tuple[float, float]:
    """Return the point of return: the nearest rally point, or home if it counts or no rally point is near enough."""
    rally = [(item.x / 1e7, item.y / 1e7) for item in vehicle.store.items.get(MissionType.RALLY, ())]
    home, limit = vehicle.home[:2], 1000.0 * vehicle.parameters.get("RALLY_LIMIT_KM", 0.0)
    near = [at for at in rally if not limit or metres_to(vehicle.body, *at)[0] <= limit]
    both = vehicle.kind.profile.dialect.unites or vehicle.parameters.get("RALLY_INCL_HOME")
    return min([*near, *([home] if both or not near else [])], key=lambda at: metres_to(vehicle.body, *at)[0])


def may_land(vehicle: State) -> bool:
    """Return whether it is time to look for a landing sequence."""
    asked = vehicle.parameters.get("RTL_AUTOLAND")
    if asked != AT_HOME or vehicle.refuge is None:
        return asked == IMMEDIATELY
    return metres_to(vehicle.body, *vehicle.refuge)[0] <= 1.5 * vehicle.home_circle


def land(vehicle: State) -> bool:
    """Begin the landing sequence of the mission on board; return whether it has one."""
    start = _landing(vehicle.store.mission)
    if start is None:
        vehicle.words.append((WARNING, "Unable to start landing sequence"))
        return False
    vehicle.mode, vehicle.current = vehicle.kind.profile.auto, start
    return True


def _landing(items: Items) -> int | None:
    return next((at for at, item in enumerate(items) if item.command == Cmd.DO_LAND_START), None)


def missing(vehicle: State) -> str:
    """Return the required item that is missing on board before arming, or an empty text."""
    if not vehicle.parameters.get("ARMING_MIS_ITEMS"):
        return ""
    known = Telemetry(parameters=vehicle.parameters)
    return next(missing_items(vehicle.store.mission, known, vehicle.store.items), "")
