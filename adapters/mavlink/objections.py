"""Reasons why a vehicle cannot carry out a command, known before anything is sent."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from adapters.mavlink.fencing import beyond, keeps_no_polygon, own_fences
from adapters.mavlink.fleet import Craft, Stations
from adapters.mavlink.loiter_radius import cramped, goal, home_circle, room, stay
from adapters.mavlink.next_step import height_of
from adapters.mavlink.profiles import Profile
from adapters.mavlink.telemetry import Telemetry
from adapters.plugin import Command, Follow, GoTo, HandOver
from physical import Geometry, circle, contains, point, waypoint

NEEDS_MORE: Final[dict[float, str]] = {1: "a take-off", 2: "a landing", 3: "a take-off and a landing"}
"""What PX4 demands of each mission (MIS_TKO_LAND_REQ, navigator/mission_params.yaml); 4 and 5 are met by a path."""

MAX_PATH = 500
"""Points of a path: fewer than the items that every autopilot holds."""


def objection(command: Command, craft: Craft, stations: Stations, known: Telemetry) -> str | None:
    """Return the objection in the operator's words; None if none is known."""
    return next(_objections(command, craft, stations, known), None)


def _objections(command: Command, craft: Craft, stations: Stations, known: Telemetry) -> Iterator[str]:
    foreign = not_ours(stations, known)
    if foreign:
        yield foreign
    if isinstance(command, HandOver):
        yield from _of_hand_over(command, stations, known)
    if isinstance(command, Follow):
        yield from _of_landing(known)
    if isinstance(command, Follow) and not 0 < len(command.path) <= MAX_PATH:
        yield f"a path has 1 to {MAX_PATH} points, this one {len(command.path)}"
        return
    yield from _of_place(command, craft, known)


def unfit(command: GoTo | Follow, craft: Craft, known: Telemetry) -> str | None:
    """Return why no station can send a vehicle to a place: it is too small, or outside a fence."""
    return next(_of_place(command, craft, known), None)


def impassable(place: Geometry, craft: Craft, known: Telemetry, name: str) -> str | None:
    """Return why a place can't be passed; the vehicle needs no room for a circle there."""
    if craft.fence is not None and not contains(craft.fence, waypoint(place)):
        return f"{name} lies outside the fence"
    own = own_fences(known, given=craft.fence is not None)
    return next(beyond(own, known, waypoint(place), 0.0, None, name), None)


def remarks(craft: Craft, known: Telemetry) -> Iterator[str]:
    """Yield messages to the operator about a vehicle before take-off."""
    own = own_fences(known, given=craft.fence is not None)
    if str(own):
        yield f"{craft.entity} keeps {own}, too: fences of its own are on"
    profile, home = known.profile, known.home
    if profile is None or home is None or craft.fence is None or profile.drift == 1.0:
        return
    radius = home_circle(craft, profile, known)
    if not contains(craft.fence, _around(point(*home), radius * profile.drift)):
        yield f"{craft.entity} circles its home at {radius:g} m when it returns, which leaves the fence"


def _of_place(command: Command, craft: Craft, known: Telemetry) -> Iterator[str]:
    yield from _of_fence(command, craft, known)
    if isinstance(command, GoTo | Follow) and known.profile is not None:
        yield from _of_size(command, craft, known.profile, known)
        yield from _of_own_fences(command, craft, known.profile, known)


def not_ours(stations: Stations, known: Telemetry) -> str | None:
    """Return the station that a vehicle obeys, if it is certainly not ours."""
    authority = stations.obeyed(known.authority, known.profile)
    name = stations.name_of(authority)
    if authority is None or name in stations.own:
        return None
    ours = " or ".join(stations.own)
    if known.authority_parameter is None:
        return f"it obeys {name or f'system {authority}'}, not {ours}"
    ids = " or ".join(str(stations.ids[each]) for each in stations.own)
    told = f"its {known.authority_parameter} is {authority}, and {ours} has {ids}"
    return f"it obeys {name or f'system {authority}'}, not {ours}: {told}"


def _of_hand_over(command: HandOver, stations: Stations, known: Telemetry) -> Iterator[str]:
    if known.profile is not None and not known.profile.dialect.authority:
        name = known.profile.dialect.name
        yield f"{name} obeys every station on its link: control of it can't be handed over"
    if stations.station_of(command.join) is None:
        yield f"{command.join} is no control channel of a known station"
    leaves = stations.station_of(command.leave)
    if leaves is None or (known.authority is not None and stations.name_of(known.authority) != leaves):
        yield f"it is not on {command.leave}"


def _of_landing(known: Telemetry) -> Iterator[str]:
    """Object to a path where the vehicle takes only missions with a take-off or a landing: a path has neither."""
    rule = "" if known.profile is None else known.profile.dialect.landing_rule
    demanded = known.parameters.get(rule, 0)
    if demanded in NEEDS_MORE:
        what = NEEDS_MORE[demanded]
        yield f"it takes no path without {what}: its {rule} is {demanded:g}; set it to 0"


def _of_fence(command: Command, craft: Craft, known: Telemetry) -> Iterator[str]:
    """Object to points outside of the fence, and to a circle around the last that leaves it."""
    if craft.fence is None or not isinstance(command, GoTo | Follow):
        return
    why = keeps_no_polygon(known)
    if why:
        yield why
    points = _points(command, craft, known)
    radius = 0.0 if known.profile is None else room(craft, known.profile, known)
    outside = [at for at in points if not contains(craft.fence, at)]
    if outside:
        yield f"{outside[0]!r} lies outside the fence"
    elif radius and not contains(craft.fence, _around(points[-1], radius)):
        yield f"a circle of {radius:g} m around {points[-1]!r} leaves the fence"


def _points(command: GoTo | Follow, craft: Craft, known: Telemetry) -> tuple[Geometry, ...]:
    """Return the waypoints of a command, as far as the kind of vehicle is known."""
    around = 0.0 if known.profile is None else room(craft, known.profile, known)
    passed = () if isinstance(command, GoTo) else command.path[:-1]
    return (*map(waypoint, passed), stay(command, around) or waypoint(goal(command)))


def _of_size(command: GoTo | Follow, craft: Craft, profile: Profile, known: Telemetry) -> Iterator[str]:
    reason = cramped(command, craft, profile, known)
    if reason is not None:
        yield reason


def _of_own_fences(command: GoTo | Follow, craft: Craft, profile: Profile, known: Telemetry) -> Iterator[str]:
    """Object to points outside the vehicle's own active fences."""
    own = own_fences(known, given=craft.fence is not None)
    around = room(craft, profile, known) if profile.drift > 1.0 else 0.0
    height = None
    if known.position is not None:
        height = height_of(command.altitude, profile, known, known.position, craft.height_of(profile))
    name = command.name or "the place"
    *passed, last = _points(command, craft, known)
    for at in passed:
        yield from beyond(own, known, at, 0.0, None, "a point of its way")
    yield from beyond(own, known, last, around, height, name)


def _around(at: Geometry, radius: float) -> Geometry:
    ((latitude, longitude),) = at.vertices
    return circle((latitude, longitude), radius)
