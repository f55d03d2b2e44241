"""QGroundControl plans (`.plan`): JSON with a mission, a fence and rally points; the mission is read and written.

Its items become those of waypoint files, so that both are read as places in one way. Surveys and other complex items
hold the simple items that they stand for; those are taken.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

from physical.altitude import Band
from physical.errors import PhysicalError
from physical.shape import Geometry, point
from physical.untrusted_text import read_json
from physical.waypoints import MAX_CHARACTERS, MAX_ITEMS, AltitudeFrame, Command, MissionItem

FILE_TYPE: Final = "Plan"
MAX_DEPTH: Final = 8
"""Complex items within complex items."""

_ARDUPILOT, _PLANE = 3, 1


def read_plan(text: str) -> tuple[MissionItem, ...]:
    """Return the items of a plan's mission, in order; item 0 is the planned home position.

    Raises:
        PhysicalError: With the item of the first mistake.
    """
    mission = _member(_document(text), "mission")
    home = _home(mission.get("plannedHomePosition"))
    items = [home]
    for index, raw in enumerate(_simple(mission.get("items"), MAX_DEPTH), 1):
        if index > MAX_ITEMS:
            raise PhysicalError("too-large", f"the plan has over {MAX_ITEMS:,} items")
        items.append(_item(raw, index))
    return tuple(items)


def write_plan(points: Sequence[Geometry], altitude: float, home: Geometry | None = None) -> str:
    """Return a plan that visits points at an altitude in metres above home; home is the first unless given."""
    stops = [home or points[0], *points] if points else []
    if not stops or not all(stop.is_point for stop in stops):
        raise PhysicalError("plan", "a plan visits points", "take the waypoints of polygons")
    height = Band(altitude, altitude).low  # a finite number
    mission = {
        "version": 2,
        "firmwareType": _ARDUPILOT,
        "vehicleType": _PLANE,
        "cruiseSpeed": 15,
        "hoverSpeed": 5,
        "plannedHomePosition": [*stops[0].vertices[0], 0],
        "items": [_written(index, stop, height) for index, stop in enumerate(stops[1:], 1)],
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


def _written(index: int, at: Geometry, height: float) -> Mapping[str, object]:
    return {
        "type": "SimpleItem",
        "doJumpId": index,
        "command": int(Command.WAYPOINT),
        "frame": int(AltitudeFrame.HOME),
        "autoContinue": True,
        "params": [0, 0, 0, None, *at.vertices[0], height],
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


def _simple(items: object, depth: int) -> Iterator[Mapping[str, Any]]:
    """Yield the simple items, those that complex ones stand for too."""
    if not isinstance(items, list) or depth == 0:
        raise _fail("the mission has no list of items", "save it anew")
    for item in items:
        if not isinstance(item, dict):
            raise _fail(f"{item!r:.60} is no item", "save the plan anew")
        if item.get("type") == "SimpleItem":
            yield item
            continue
        inner = next((value["Items"] for value in (item, *item.values()) if _is_complex(value)), None)
        if inner is None:
            raise _fail(f"an item of type {item.get('type')!r:.60} is not known", "plan it by waypoints")
        yield from _simple(inner, depth - 1)


def _is_complex(value: object) -> bool:
    return isinstance(value, dict) and isinstance(value.get("Items"), list)


def _home(home: object) -> MissionItem:
    if not isinstance(home, list) or len(home) != 3:
        raise _fail("the plan has no planned home position", 'write "plannedHomePosition": [lat, lon, alt]')
    latitude, longitude, altitude = (_number(value, "home") for value in home)
    at = _point(latitude, longitude, "home")
    return MissionItem(0, AltitudeFrame.SEA_LEVEL, Command.WAYPOINT, (0.0, 0.0, 0.0, 0.0), at, altitude)


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
    p1, p2, p3, p4, latitude, longitude, altitude = (_number(value, where) for value in parameters)
    goes = command in set(Command) and (latitude, longitude) != (0.0, 0.0)
    at = _point(latitude, longitude, where) if goes else None
    return MissionItem(index, frame, command, (p1, p2, p3, p4), at, _altitude(altitude, where))


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
