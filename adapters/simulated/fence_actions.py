"""The fences of a simulated vehicle: its actions at them, and its automatic switching."""

from __future__ import annotations

from typing import Final

from adapters.mavlink.constants import Fence, FenceAction
from adapters.mavlink.item_merging import UNION
from adapters.simulated.body import Body, metres_to
from adapters.simulated.vehicle_state import NOTICE, WARNING, State
from physical import contains, point

REPORT_ONLY: Final = 0.0
"""ArduPilot's FENCE_ACTION for a report alone."""

AFTER_TAKEOFF: Final = (1.0, 2.0)
ON_ARMING: Final = 3.0
"""FENCE_AUTOENABLE: ArduPilot's automatic switching of its fences. With 1 they are off before a take-off."""

HIGH: Final = 10.0
"""Metres above home at which a take-off counts as done."""


def switch_by_itself(vehicle: State) -> None:
    """Switch the fences according to FENCE_AUTOENABLE: off before a take-off, on after it, or on arming."""
    auto = vehicle.parameters.get("FENCE_AUTOENABLE", 0.0)
    if not auto or vehicle.parameters.get("FENCE_ENABLE"):
        return
    if not vehicle.armed:
        vehicle.fences = Fence(0) if auto == AFTER_TAKEOFF[0] else vehicle.fences
        return
    due = auto == ON_ARMING or (auto in AFTER_TAKEOFF and vehicle.body.height > HIGH)
    before = vehicle.fences & vehicle.configured
    if due:
        vehicle.switch_fences(~Fence.ALT_MIN, on=True)
    if before != vehicle.fences & vehicle.configured:
        vehicle.words.append((NOTICE, "Polygon fence auto-enabled"))


def keep(vehicle: State) -> None:
    """Return, or stop, as soon as it is outside a fence; a ground vehicle has stopped before its circle."""
    here = vehicle.body
    outside = not holds(vehicle, here.latitude, here.longitude, here.height)
    if outside and vehicle.fence_action is FenceAction.HOLD:
        if not vehicle.breached:
            vehicle.words.append((WARNING, "Geofence violation: holding"))
            vehicle.stay()
    elif outside:
        if not vehicle.breached and vehicle.fence_action is None:
            vehicle.words.append((NOTICE, f"{_breached(vehicle)} fence breached"))
        if vehicle.parameters.get("FENCE_ACTION") != REPORT_ONLY:
            vehicle.mode = vehicle.kind.profile.home
    vehicle.breached = outside


def _breached(vehicle: State) -> str:
    """Name the breached fence, as ArduPilot does."""
    here = vehicle.body
    if not _in_zones(vehicle, here.latitude, here.longitude):
        return "Polygon"
    higher = Fence.ALT_MAX in vehicle.fences and here.height > vehicle.parameters["FENCE_ALT_MAX"]
    return "Max Alt" if higher else "Circle"


def holds(vehicle: State, latitude: float, longitude: float, height: float) -> bool:
    """Return whether a position is inside all fences that are on."""
    inside = _in_zones(vehicle, latitude, longitude)
    if Fence.CIRCLE in vehicle.fences:
        away = metres_to(Body(*vehicle.home[:2]), latitude, longitude)[0]
        inside = inside and away <= vehicle.parameters["FENCE_RADIUS"]
    if Fence.ALT_MAX in vehicle.fences:
        inside = inside and height <= vehicle.parameters["FENCE_ALT_MAX"]
    return inside


def _in_zones(vehicle: State, latitude: float, longitude: float) -> bool:
    """Return whether a position is in the inclusion zones (for PX4 in one), and in no exclusion zone."""
    if not vehicle.keeps_zones:
        return True
    at = point(latitude, longitude)
    within = [zone.shape is not None and contains(zone.shape, at) for zone in vehicle.zones if zone.within]
    outside = [zone.shape is not None and contains(zone.shape, at) for zone in vehicle.zones if zone.outside]
    one = vehicle.kind.profile.dialect.unites or int(vehicle.parameters.get("FENCE_OPTIONS", 0)) & UNION
    return (any(within) if one and within else all(within)) and not any(outside)
