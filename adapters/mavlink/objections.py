"""Reasons why a vehicle cannot carry out a command, known before any message is sent; and remarks on its items."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from itertools import chain, pairwise, product
from types import MappingProxyType
from typing import Final

from adapters.mavlink.constants import Cmd, MissionType
from adapters.mavlink.item_merging import RETURNS_BY_LANDING, OnBoard, is_cut, jumps_out, landing, merged
from adapters.mavlink.items import Items, route
from adapters.mavlink.items import fence as polygon_items
from adapters.mavlink.loiter_circle import cramped, goal, home_circle, room, stay
from adapters.mavlink.next_step import height_of
from adapters.mavlink.onboard_fences import (
    barred,
    beyond,
    crossed,
    keeps_no_polygon,
    own_fences,
    widened,
    zones_beside,
)
from adapters.mavlink.profiles import Profile, TakeOff
from adapters.mavlink.refuges import beyond_fence, missing_items, rally_points
from adapters.mavlink.telemetry import Telemetry
from adapters.mavlink.vehicle_identities import Craft, Stations
from adapters.mavlink.zones import zones
from adapters.plugin import Command, Follow, GoTo, HandOver
from physical import Geometry, circle, contains, point, waypoint
from physical.wordings import counted

NEEDS_MORE: Final[dict[float, str]] = {1: "a take-off", 2: "a landing", 3: "a take-off and a landing"}
"""PX4's demands of each mission (MIS_TKO_LAND_REQ, navigator/mission_params.yaml); every path meets 4 and 5."""

NOTHING_READ: Final[OnBoard] = MappingProxyType({})

MAX_PATH = 500
"""Points of a path: fewer than the items that every autopilot holds."""


def objection(
    command: Command,
    craft: Craft,
    stations: Stations,
    known: Telemetry,
    on_board: OnBoard = NOTHING_READ,
    *,
    again: bool = False,
) -> str | None:
    """Return the objection in the operator's words; None if none is known.

    `again`: the command was taken on before the items on board were known, so only objections to those items are new.
    """
    first = () if again else _objections(command, craft, stations, known)
    return next(chain(first, _of_on_board(command, craft, known, on_board)), None)


def _objections(command: Command, craft: Craft, stations: Stations, known: Telemetry) -> Iterator[str]:
    foreign = not_ours(stations, known)
    if foreign:
        yield foreign
    if isinstance(command, HandOver):
        yield from _of_hand_over(command, stations, known)
    if isinstance(command, Follow):
        yield from _of_landing(known)
        yield from _of_length(command)
    yield from _of_place(command, craft, known)


def _of_length(command: Follow) -> Iterator[str]:
    if not 0 < len(command.path) <= MAX_PATH:
        yield f"a path has 1 to {MAX_PATH} points, this one {len(command.path)}"


def _of_on_board(command: Command, craft: Craft, known: Telemetry, on_board: OnBoard) -> Iterator[str]:
    """Yield objections from the items on board."""
    if not isinstance(command, GoTo | Follow) or known.profile is None:
        return
    yield from _of_zones(command, craft, known.profile, known, on_board)
    yield from _of_legs(command, craft, known, on_board)
    yield from _of_items(command, known.profile, known, on_board)


def unfit(
    command: GoTo | Follow, craft: Craft, known: Telemetry, on_board: OnBoard = NOTHING_READ
) -> str | None:
    """Return the reason why no station can send a vehicle to a place: it is too small, or outside a fence."""
    zones = () if known.profile is None else _of_zones(command, craft, known.profile, known, on_board)
    return next(chain(_of_place(command, craft, known), zones), None)


def impassable(
    place: Geometry, craft: Craft, known: Telemetry, name: str, on_board: OnBoard = NOTHING_READ
) -> str | None:
    """Return the reason why a place can't be passed; the vehicle needs no room for a circle there."""
    if craft.fence is not None and not contains(craft.fence, waypoint(place)):
        return f"{name} lies outside the fence"
    own = own_fences(known, given=craft.fence is not None)
    zones = zones_beside(craft.fence, known, on_board)
    reasons = chain(
        beyond(own, known, waypoint(place), 0.0, None, name),
        (barred(zone, waypoint(place), 0.0, name) for zone in zones),
    )
    return next(filter(None, reasons), None)


def remarks(
    craft: Craft, known: Telemetry, on_board: OnBoard = NOTHING_READ, unread: Collection[MissionType] = ()
) -> Iterator[str]:
    """Yield messages to the operator about a vehicle before take-off."""
    own = own_fences(known, given=craft.fence is not None)
    if str(own):
        yield f"{craft.entity} keeps {own}, too: fences of its own are on"
    yield from (f"{craft.entity} {remark}" for remark in remarks_on_board(craft, known, on_board, unread))
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
    """Return an objection if the vehicle certainly obeys a station that is not ours."""
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
    """Object to a path if the vehicle requires a take-off or a landing in each mission: a path has neither."""
    rule = "" if known.profile is None else known.profile.dialect.landing_rule
    demanded = known.parameters.get(rule, 0)
    if demanded in NEEDS_MORE:
        what = NEEDS_MORE[demanded]
        yield f"it takes no path without {what}: its {rule} is {demanded:g}; set it to 0"


def _of_fence(command: Command, craft: Craft, known: Telemetry) -> Iterator[str]:
    """Object to points outside the fence, and to a circle around the last that leaves it."""
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


def _path(command: GoTo | Follow) -> tuple[Geometry, ...]:
    return (command.place,) if isinstance(command, GoTo) else command.path


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


def _of_zones(
    command: GoTo | Follow, craft: Craft, profile: Profile, known: Telemetry, on_board: OnBoard
) -> Iterator[str]:
    """Object to points that a zone on board forbids, to zones that can't be kept, and to rally points."""
    if craft.fence is not None:
        yield from widened(craft.fence, known, on_board)
        yield from beyond_fence(craft.fence, known, on_board)
    around = room(craft, profile, known) if profile.drift > 1.0 else 0.0
    *passed, last = _points(command, craft, known)
    stops = [*((at, 0.0, "a point of its way") for at in passed), (last, around, command.name or "the place")]
    for zone in zones_beside(craft.fence, known, on_board):
        yield from filter(None, (barred(zone, *stop) for stop in stops))


def _of_legs(command: GoTo | Follow, craft: Craft, known: Telemetry, on_board: OnBoard) -> Iterator[str]:
    """Object to straight legs through exclusion zones, from the vehicle's position on."""
    points = [*_points(command, craft, known)]
    if known.position is not None:
        points = [point(known.position.latitude, known.position.longitude), *points]
    name = command.name or "the place"
    for zone, (start, end) in product(zones_beside(craft.fence, known, on_board), pairwise(points)):
        yield from filter(
            None, [crossed(zone, start, end, name if end is points[-1] else "a point of its way")]
        )


def _of_items(command: GoTo | Follow, profile: Profile, known: Telemetry, on_board: OnBoard) -> Iterator[str]:
    """Object to required items that are missing before arming, and to a landing sequence that can't be kept."""
    found = on_board.get(MissionType.MISSION)
    if found is None:
        return
    if is_cut(found, known):
        yield (
            "the landing sequence on board has a start and no landing, as after an upload that was broken off: load it "
            "again with a ground station"
        )
    outside = jumps_out(found, known)
    if outside is not None:
        yield (
            f"the landing sequence on board jumps to item {outside}, outside of it, so it can't be kept behind a "
            "mission: change it with a ground station"
        )
    if known.flying:
        return
    takes = isinstance(command, Follow) or profile.takeoff is TakeOff.MISSION
    path = tuple(map(waypoint, _path(command)))
    by_item = profile.takeoff in (TakeOff.MISSION, TakeOff.COMMAND)
    ours = route(path, 0.0, takeoff=by_item, home=profile.dialect.home_is_item)
    mission = merged(ours, found, MissionType.MISSION, known) if takes else found
    yield from missing_items(mission, known, on_board)


def holds_circle(place: Geometry, radius: float) -> bool:
    """Return whether a circle around a place's waypoint fits in it; for a point it always does."""
    if place.is_point:
        return True
    return contains(place, _around(waypoint(place), radius))


def _around(at: Geometry, radius: float) -> Geometry:
    ((latitude, longitude),) = at.vertices
    return circle((latitude, longitude), radius)


_OURS = (Cmd.WAYPOINT, Cmd.LOITER_UNLIMITED, Cmd.TAKEOFF)


def remarks_on_board(
    craft: Craft, known: Telemetry, on_board: OnBoard, unread: Collection[MissionType]
) -> Iterator[str]:
    """Yield remarks on the items on board a vehicle; `unread` kinds could not be read."""
    missing = [kind.name.lower() for kind in unread if kind not in on_board]
    if missing:
        yield f"does not report its contents on board: {', '.join(missing)}"
    yield from _of_mission(on_board.get(MissionType.MISSION, ()), known)
    yield from _of_kept_zones(craft, known, on_board)
    rally = rally_points(on_board)
    if rally:
        yield f"has rally points on board, {len(rally)}: it returns to the nearest, not to its home"


def _of_mission(found: Items, known: Telemetry) -> Iterator[str]:
    kept = landing(found, known)
    first = known.profile is not None and known.profile.dialect.home_is_item
    rest = found[int(first) : len(found) - len(kept)]
    if any(item.command not in _OURS for item in rest):
        items = counted(len(found) - int(first), "item")
        yield f"has a mission of {items} on board, which the flights of this mission replace"
    if kept:
        items = counted(len(kept), "item")
        yield f"keeps its landing sequence: each upload ends with the last {items} of the mission on board"
    if known.parameters.get("RTL_AUTOLAND") in RETURNS_BY_LANDING and not kept:
        yield "has no landing sequence on board, which its RTL_AUTOLAND needs: when it returns, it circles"


def _of_kept_zones(craft: Craft, known: Telemetry, on_board: OnBoard) -> Iterator[str]:
    found = zones(on_board.get(MissionType.FENCE, ()))
    kept = zones_beside(craft.fence, known, on_board)
    for zone in kept:
        yield f"keeps {zone}, too: it is on board"
    if craft.fence is None:
        return
    own = {zone.key for zone in zones(polygon_items(craft.fence))}
    for zone in found:
        if zone not in kept and zone.key not in own:
            yield f"loses {zone}, which is on board: the fence of the mission replaces it"
