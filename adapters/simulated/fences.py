"""The fences of a simulated vehicle: what it does at them, and when it switches them by itself."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from adapters.mavlink.constants import Fence, FenceAction
from adapters.mavlink.merging import UNION
from adapters.simulated.body import Body, metres_to, moved
from physical import contains, point

if TYPE_CHECKING:
    from adapters.simulated.vehicle import Vehicle

WARNING: Final = 4
NOTICE: Final = 5

STOPS_BEFORE: Final = 4.0
"""Metres before its circle fence at which what drives stops, in silence."""

REPORT_ONLY: Final = 0.0
"""ArduPilot's FENCE_ACTION with which it only says that it is outside."""

AFTER_TAKEOFF: Final = (1.0, 2.0)
ON_ARMING: Final = 3.0
"""FENCE_AUTOENABLE: when ArduPilot switches its fences on by itself. With the first it switches them off before."""

HIGH: Final = 10.0
"""Metres above home at which a take-off counts as done."""


def switch_by_itself(vehicle: Vehicle) -> None:
    """Switch the fences as FENCE_AUTOENABLE says: off again before a take-off, on after it, or on arming."""
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


def keep(vehicle: Vehicle) -> None:
    """Return, or stop, as soon as it is outside a fence; what drives has stopped before its circle."""
    here = vehicle.body
    outside = not holds(vehicle, here.latitude, here.longitude, here.height)
    if outside and vehicle.fence_action is FenceAction.HOLD:
        if not vehicle.breached:
            vehicle.words.append((WARNING, "Geofence violation: holding"))
            vehicle.stay()
    elif outside:
        if not vehicle.breached and vehicle.fence_action is None:
            vehicle.words.append((NOTICE, "Polygon fence breached"))
        if vehicle.parameters.get("FENCE_ACTION") != REPORT_ONLY:
            vehicle.mode = vehicle.kind.profile.home
    vehicle.breached = outside


def holds(vehicle: Vehicle, latitude: float, longitude: float, height: float) -> bool:
    """Tell whether somewhere is inside all fences that are on."""
    inside = _in_zones(vehicle, latitude, longitude)
    if Fence.CIRCLE in vehicle.fences:
        away = metres_to(Body(*vehicle.home[:2]), latitude, longitude)[0]
        inside = inside and away <= vehicle.parameters["FENCE_RADIUS"]
    if Fence.ALT_MAX in vehicle.fences:
        inside = inside and height <= vehicle.parameters["FENCE_ALT_MAX"]
    return inside


def in_force(vehicle: Vehicle) -> bool:
    """Tell whether the zones on board are kept: ArduPilot switches them, PX4 has an action for them."""
    acts = vehicle.fence_action is not None and vehicle.fence_action > FenceAction.WARN
    return acts or Fence.POLYGON in vehicle.fences


def _in_zones(vehicle: Vehicle, latitude: float, longitude: float) -> bool:
    """Tell whether somewhere is in the zones to stay in, of PX4 one, and out of the others."""
    if not in_force(vehicle):
        return True
    at = point(latitude, longitude)
    within = [zone.shape is not None and contains(zone.shape, at) for zone in vehicle.zones if zone.within]
    outside = [zone.shape is not None and contains(zone.shape, at) for zone in vehicle.zones if zone.outside]
    one = vehicle.kind.profile.dialect.unites or int(vehicle.parameters.get("FENCE_OPTIONS", 0)) & UNION
    return (any(within) if one and within else all(within)) and not any(outside)


def before_the_circle(vehicle: Vehicle, course: float) -> float:
    """Return the metres that it may drive on a course before it stops at its circle fence."""
    ahead = moved(replace(vehicle.body, course=course, speed=1.0), vehicle.kind.limits, course, 1.0, 0.0, 1.0)
    home = Body(*vehicle.home[:2])
    here, there = (metres_to(home, at.latitude, at.longitude)[0] for at in (vehicle.body, ahead))
    return math.inf if there < here else vehicle.parameters["FENCE_RADIUS"] - STOPS_BEFORE - here
