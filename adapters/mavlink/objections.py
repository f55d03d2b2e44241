"""Why a vehicle can't do what it is told: what is known before anything is sent."""

from __future__ import annotations

from collections.abc import Iterator

from adapters.mavlink.fleet import Craft, Stations
from adapters.mavlink.profiles import Profile
from adapters.mavlink.telemetry import Telemetry
from adapters.plugin import Command, Follow, GoTo, HandOver
from physical import Geometry, circle, contains, waypoint

MAX_PATH = 500
"""Points of a path: fewer than the items that every autopilot holds."""


def objection(command: Command, craft: Craft, stations: Stations, known: Telemetry) -> str | None:
    """Return why not, in the operator's words; None if nothing is against it as far as is known."""
    return next(_objections(command, craft, stations, known), None)


def _objections(command: Command, craft: Craft, stations: Stations, known: Telemetry) -> Iterator[str]:
    yield from _of_authority(stations, known)
    if isinstance(command, HandOver):
        yield from _of_hand_over(command, stations, known)
    if isinstance(command, Follow) and not 0 < len(command.path) <= MAX_PATH:
        yield f"a path has 1 to {MAX_PATH} points, this one {len(command.path)}"
        return
    yield from _of_place(command, craft, known.profile)


def unfit(command: GoTo | Follow, craft: Craft, profile: Profile | None) -> str | None:
    """Return why a place is none for a vehicle, whoever commands it: it is too small, or outside the fence."""
    return next(_of_place(command, craft, profile), None)


def impassable(place: Geometry, craft: Craft, name: str) -> str | None:
    """Return why a place can't be passed: a circle needs no room there."""
    if craft.fence is None or contains(craft.fence, waypoint(place)):
        return None
    return f"{name} lies outside the fence"


def _of_place(command: Command, craft: Craft, profile: Profile | None) -> Iterator[str]:
    yield from _of_fence(command, craft, profile)
    if isinstance(command, GoTo | Follow) and profile is not None:
        yield from _of_size(command, craft, profile)


def _of_authority(stations: Stations, known: Telemetry) -> Iterator[str]:
    name = stations.name_of(known.authority)
    if known.authority is not None and name not in stations.own:
        yield f"it obeys {name or f'system {known.authority}'}, not {' or '.join(stations.own)}"


def _of_hand_over(command: HandOver, stations: Stations, known: Telemetry) -> Iterator[str]:
    if stations.station_of(command.join) is None:
        yield f"{command.join} is no control channel of a known station"
    leaves = stations.station_of(command.leave)
    if leaves is None or (known.authority is not None and stations.name_of(known.authority) != leaves):
        yield f"it is not on {command.leave}"


def _of_fence(command: Command, craft: Craft, profile: Profile | None) -> Iterator[str]:
    """Object to points outside of the fence, and to a circle around the last that leaves it."""
    if craft.fence is None or not isinstance(command, GoTo | Follow):
        return
    points = tuple(map(waypoint, _path(command)))
    radius = 0.0 if profile is None else craft.circle_of(profile)
    outside = [at for at in points if not contains(craft.fence, at)]
    if outside:
        yield f"{outside[0]!r} lies outside the fence"
    elif radius and not contains(craft.fence, _around(points[-1], radius)):
        yield f"a circle of {radius:g} m around {points[-1]!r} leaves the fence"


def _path(command: GoTo | Follow) -> tuple[Geometry, ...]:
    return (command.place,) if isinstance(command, GoTo) else command.path


def _of_size(command: GoTo | Follow, craft: Craft, profile: Profile) -> Iterator[str]:
    radius = craft.circle_of(profile)
    if not holds_circle(_path(command)[-1], radius):
        name = command.name or "the place"
        yield f"{name} is too small: the {profile.kind} needs a circle of {radius:g} m around its centre to stay"


def holds_circle(place: Geometry, radius: float) -> bool:
    """Whether a circle around the waypoint of a place fits in it; at a point it is the best that can be done."""
    if place.is_point:
        return True
    return contains(place, _around(waypoint(place), radius))


def _around(at: Geometry, radius: float) -> Geometry:
    ((latitude, longitude),) = at.vertices
    return circle((latitude, longitude), radius)
