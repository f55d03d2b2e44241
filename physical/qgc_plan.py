"""QGroundControl plans (`.plan`): JSON with a mission, a fence and rally points; only the mission is read and written.

Its items become those of waypoint files, so that both are read as places in one way. Surveys and corridor scans contain
simple items, which are read. A landing pattern is read as the items of its flight. Other complex items, fences and
rally points are counted.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final, TypeGuard

from physical.altitude import Band
from physical.errors import PhysicalError
from physical.file_account import Read
from physical.shape import Geometry, point
from physical.untrusted_text import legible, read_json
from physical.waypoints import (
    MAX_CHARACTERS,
    MAX_ITEMS,
    AltitudeFrame,
    MAVCommand,
    MissionItem,
    MissionStop,
    goes_to,
    read_mission,
    stops_of,
)

FILE_TYPE: Final = "Plan"
MAX_DEPTH: Final = 8
"""The depth limit of complex items within complex items."""

_ARDUPILOT, _PLANE = 3, 1


def read_plan(text: str) -> tuple[MissionItem, ...]:
    """Return the items of a plan's mission, in order; item 0 is the planned home position.

    Raises:
        PhysicalError: With the item of the first mistake.
    """
    return _items(_document(text), Counter())


def read_plan_places(text: str) -> Read:
    """Return the places of a plan's mission, with the account of the items, the fence and the rally points.

    Raises:
        PhysicalError: With the item of the first mistake.
    """
    document, lost = _document(text), Counter[str]()
    items = _items(document, lost)
    lost.update(_fence(document.get("geoFence")))
    if points := len(_listed(document.get("rallyPoints"), "points")):
        lost["rally point"] += points
    return read_mission(items, lost)


def _items(document: Mapping[str, Any], lost: Counter[str]) -> tuple[MissionItem, ...]:
    """Return the items of the mission; unread complex items are counted in `lost`."""
    mission = _member(document, "mission")
    items = [_home(mission.get("plannedHomePosition"))]
    for index, raw in enumerate(_simple(mission.get("items"), MAX_DEPTH, lost), 1):
        if index > MAX_ITEMS:
            raise PhysicalError("too-large", f"the plan has over {MAX_ITEMS:,} items")
        items.append(_item(raw, index))
    return tuple(items)


def write_plan(
    points: Sequence[Geometry],
    altitude: float,
    home: Geometry | None = None,
    home_altitude: float = 0.0,
    bands: Sequence[Band | None] = (),
) -> str:
    """Return a plan that visits points at an altitude in metres above home; home is the first point by default.

    A point with a band of altitudes above sea level is visited within that band instead.
    """
    start, *stops = stops_of(points, altitude, home, home_altitude, bands)
    mission = {
        "version": 2,
        "firmwareType": _ARDUPILOT,
        "vehicleType": _PLANE,
        "cruiseSpeed": 15,
        "hoverSpeed": 5,
        "plannedHomePosition": [*start.point.vertices[0], start.altitude],
        "items": [_written(index, stop) for index, stop in enumerate(stops, 1)],
    }
    plan = {
        "fileType": FILE_TYPE,
        "version": 1,
        "groundStation": "QGroundControl",
        "mission": mission,
        "geoFence": {"version": 2, "circles": [], "polygons": []},
        "rallyPoints": {"version": 2, "points": []},
    }
    return json.dumps(plan, indent=1) + "\n"


def _written(index: int, stop: MissionStop) -> Mapping[str, object]:
    return {
        "type": "SimpleItem",
        "doJumpId": index,
        "command": int(MAVCommand.WAYPOINT),
        "frame": int(stop.frame),
        "autoContinue": True,
        "params": [0, 0, 0, None, *stop.point.vertices[0], stop.altitude],
    }


def _fail(message: str, hint: str = "", where: str = "") -> PhysicalError:
    return PhysicalError("plan", message, hint, where)


def _document(text: str) -> Mapping[str, Any]:
    document = read_json(text, MAX_CHARACTERS)
    if not isinstance(document, dict) or document.get("fileType") != FILE_TYPE:
        raise _fail(f'the document has no "fileType": "{FILE_TYPE}"', "save it as a plan")
    return document


def _member(document: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    member = document.get(name)
    if not isinstance(member, dict):
        raise _fail(f"the plan has no {name}", "save it anew")
    return member


# --- items ----------------------------------------------------------------------------------------


def _simple(items: object, depth: int, lost: Counter[str]) -> Iterator[Mapping[str, Any]]:
    """Yield the simple items, also those inside complex ones; unread complex items are counted in `lost`."""
    if not isinstance(items, list) or depth == 0:
        raise _fail("the mission has no list of items", "save it anew")
    for item in items:
        if not isinstance(item, dict):
            raise _fail(f"{item!r:.60} is no item", "save the plan anew")
        if item.get("type") == "SimpleItem":
            yield item
            continue
        inner = next((value["Items"] for value in (item, *item.values()) if _is_complex(value)), None)
        if inner is not None:
            yield from _simple(inner, depth - 1, lost)
            continue
        if item.get("type") != "ComplexItem":
            raise _fail(f"an item of type {item.get('type')!r:.60} is not known", "plan it by waypoints")
        landing = _landing(item)
        if not landing:
            lost[f"complex item {legible(str(item.get('complexItemType', 'without a type')), 60)}"] += 1
        yield from landing


def _is_complex(value: object) -> bool:
    return isinstance(value, dict) and isinstance(value.get("Items"), list)


def _landing(item: Mapping[str, Any]) -> tuple[Mapping[str, Any], ...]:
    """Return the flown items of a landing pattern: its start, the approach, the landing; none of other items."""
    land = _LANDINGS.get(str(item.get("complexItemType")))
    names = ("landingApproachCoordinate", "loiterCoordinate")
    approach = next((item[name] for name in names if name in item), None)
    touchdown = item.get("landCoordinate")
    if land is None or not _is_coordinate(approach) or not _is_coordinate(touchdown):
        return ()
    relative = item.get("altitudesAreRelative", item.get("loiterAltitudeRelative", True))
    frame = AltitudeFrame.HOME if relative else AltitudeFrame.SEA_LEVEL
    towards = MAVCommand.LOITER_TO_ALT if item.get("useLoiterToAlt", True) else MAVCommand.WAYPOINT
    begun = {"command": _LAND_START, "frame": _NO_FRAME, "params": [0] * 7}
    legs = ((towards, approach), (land, touchdown))
    return (
        begun,
        *({"command": int(to), "frame": int(frame), "params": [0, 0, 0, None, *at]} for to, at in legs),
    )


_LANDINGS: Final = {"fwLandingPattern": MAVCommand.LAND, "vtolLandingPattern": MAVCommand.VTOL_LAND}
_LAND_START: Final = 189
_NO_FRAME: Final = 2


def _is_coordinate(value: object) -> TypeGuard[list[Any]]:
    return isinstance(value, list) and len(value) == 3


def _home(home: object) -> MissionItem:
    if not _is_coordinate(home):
        raise _fail("the plan has no planned home position", 'write "plannedHomePosition": [lat, lon, alt]')
    return _made(0, AltitudeFrame.SEA_LEVEL, MAVCommand.WAYPOINT, [0, 0, 0, 0, *home], "home")


def _item(raw: Mapping[str, Any], index: int) -> MissionItem:
    where = f"item {index}"
    parameters = raw.get("params")
    command, frame = raw.get("command"), raw.get("frame")
    if (
        not isinstance(parameters, list)
        or len(parameters) != 7
        or type(command) is not int
        or type(frame) is not int
    ):
        raise _fail("the item has not a command, a frame and seven params", "save the plan anew", where)
    return _made(index, frame, command, parameters, where)


def _made(index: int, frame: int, command: int, parameters: Sequence[object], where: str) -> MissionItem:
    """Return an item; null means *the vehicle's own*: no position, and an unknown altitude."""
    p1, p2, p3, p4, latitude, longitude, height = (_number(value, where) for value in parameters)
    said = parameters[4] is not None and parameters[5] is not None
    goes = said and goes_to(index, frame, command, latitude, longitude)
    at = _point(latitude, longitude, where) if goes else None
    altitude = None if parameters[6] is None else _altitude(height, where)
    return MissionItem(index, frame, command, (p1, p2, p3, p4), at, altitude)


# --- fences ---------------------------------------------------------------------------------------


def _fence(fence: object) -> Iterator[str]:
    """Yield the kind of each part of a fence."""
    for circle in _listed(fence, "circles"):
        yield f"fence circle ({_side(circle)})"
    for polygon in _listed(fence, "polygons"):
        yield f"fence polygon ({_side(polygon)})"
    if _listed(fence, "polygon"):  # the first version had one
        yield f"fence polygon ({_side(None)})"
    if _listed(fence, "breachReturn"):
        yield "fence return point"


def _listed(member: object, name: str) -> list[object]:
    value = member.get(name) if isinstance(member, dict) else None
    return value if isinstance(value, list) else []


def _side(part: object) -> str:
    outside = isinstance(part, dict) and part.get("inclusion") is False
    return "to stay out" if outside else "to stay in"


def _number(value: object, where: str) -> float:
    """Return a number; null, which means *the vehicle's own*, is 0 as in waypoint files."""
    if value is None:
        return 0.0
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= 1e9:
        raise _fail(f"{value!r:.60} is no number", "", where)
    return float(value)


def _point(latitude: float, longitude: float, where: str) -> Geometry:
    try:
        return point(latitude, longitude)
    except PhysicalError as problem:
        raise PhysicalError(problem.code, problem.message, problem.hint, where) from None


def _altitude(value: float, where: str) -> float:
    try:
        return Band(value, value).low
    except PhysicalError as problem:
        raise PhysicalError(problem.code, problem.message, problem.hint, where) from None
