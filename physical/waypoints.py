"""Waypoint files: `QGC WPL 110`, plain text of tab-separated columns (paper, Example 1).

A line is: index, current, frame, command, four parameters, latitude, longitude, altitude, autocontinue; the
numbers are those of MAVLink. Item 0 is the home position.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Final

from physical.altitude import Band
from physical.errors import PhysicalError
from physical.mobility_commands import MobilityCommand, Waypoint
from physical.physical_property import PhysicalProperty
from physical.shape import Geometry, point

HEADER: Final = "QGC WPL 110"
MAX_CHARACTERS: Final = 1_000_000
MAX_ITEMS: Final = 10_000
COLUMNS: Final = 12


class AltitudeFrame(IntEnum):
    """What altitudes are above (MAV_FRAME); in a file, the `INT` frames are written like the others."""

    SEA_LEVEL = 0
    HOME = 3
    SEA_LEVEL_INT = 5
    HOME_INT = 6
    TERRAIN = 10
    TERRAIN_INT = 11


class Command(IntEnum):
    """The commands that go to a position (MAV_CMD)."""

    WAYPOINT = 16
    LOITER_UNLIMITED = 17
    LOITER_TURNS = 18
    LOITER_TIME = 19
    LAND = 21
    TAKEOFF = 22
    SPLINE_WAYPOINT = 82


@dataclass(frozen=True, slots=True)
class MissionItem:
    """One line of a waypoint file.

    Attributes:
        index: Its number; 0 is home.
        frame: What the altitude is above (MAV_FRAME).
        command: What to do (MAV_CMD).
        parameters: The command's four parameters.
        point: Where, if the command goes somewhere.
        altitude: Metres in its frame.
    """

    index: int
    frame: int
    command: int
    parameters: tuple[float, float, float, float]
    point: Geometry | None
    altitude: float


def read_waypoints(text: str) -> tuple[MissionItem, ...]:
    """Return the items of a waypoint file, in order.

    Raises:
        PhysicalError: With the line of the first mistake.
    """
    if len(text) > MAX_CHARACTERS:
        raise PhysicalError("too-large", f"the waypoint file is over {MAX_CHARACTERS:,} characters")
    lines = [(number, line.split()) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    if not lines or lines[0][1] != HEADER.split():
        raise PhysicalError(
            "waypoint-file", f"the file does not begin with {HEADER!r}", "save it as a waypoint file"
        )
    if len(lines) > MAX_ITEMS + 1:
        raise PhysicalError("too-large", f"the waypoint file has over {MAX_ITEMS:,} items")
    items = tuple(_item(columns, f"line {number}") for number, columns in lines[1:])
    for expected, (item, (number, _)) in enumerate(zip(items, lines[1:], strict=True)):
        if item.index != expected:
            raise PhysicalError(
                "waypoint-file",
                f"item {item.index} where item {expected} was expected",
                "number the items from 0",
                f"line {number}",
            )
    return items


def waypoint_places(items: Sequence[MissionItem], prefix: str = "waypoint") -> tuple[PhysicalProperty, ...]:
    """Return the positions that a mission goes to as places named by their index; home is `<prefix>0`.

    Altitudes above home are made altitudes above sea level; those above terrain are not known.
    """
    home = items[0].altitude if items else 0.0
    return tuple(
        PhysicalProperty(f"{prefix}{item.index}", "Waypoint", item.point, _band(item, home), source=HEADER)
        for item in items
        if item.point is not None
    )


def write_waypoints(points: Sequence[Geometry], altitude: float, home: Geometry | None = None) -> str:
    """Return a waypoint file that visits points at an altitude in metres above home.

    Home, the first point unless given, is written as item 0 at altitude 0.
    """
    stops = [home or points[0], *points] if points else []
    if not stops or not all(stop.is_point for stop in stops):
        raise PhysicalError(
            "waypoint-file", "a waypoint file visits points", "take the waypoints of polygons"
        )
    Band(altitude, altitude)  # a finite number
    lines = [HEADER, _line(0, AltitudeFrame.SEA_LEVEL, stops[0], 0.0)]
    lines += [_line(i, AltitudeFrame.HOME, stop, altitude) for i, stop in enumerate(stops[1:], 1)]
    return "".join(f"{line}\n" for line in lines)


def visited(commands: Iterable[MobilityCommand], entity: str) -> tuple[Geometry, ...]:
    """Return the points that a trace's mobility commands send an entity to, in order."""
    return tuple(
        command.point for command in commands if isinstance(command, Waypoint) and command.entity == entity
    )


def _line(index: int, frame: AltitudeFrame, at: Geometry, altitude: float) -> str:
    ((latitude, longitude),) = at.vertices
    numbers = [0.0, 0.0, 0.0, 0.0, latitude, longitude, altitude]
    columns = [
        index,
        int(index == 0),
        int(frame),
        int(Command.WAYPOINT),
        *(f"{value:.7f}" for value in numbers),
        1,
    ]
    return "\t".join(map(str, columns))


def _item(columns: Sequence[str], where: str) -> MissionItem:
    if len(columns) != COLUMNS:
        message = f"{len(columns)} columns where {COLUMNS} were expected"
        raise PhysicalError("waypoint-file", message, "separate the columns by tabs", where)
    try:
        index, _, frame, command = (int(column) for column in columns[:4])
        p1, p2, p3, p4, latitude, longitude, altitude = (float(column) for column in columns[4:11])
    except ValueError:
        raise PhysicalError("waypoint-file", "a column is not a number", "", where) from None
    try:
        goes = index == 0 or (command in set(Command) and (latitude, longitude) != (0.0, 0.0))
        at = point(latitude, longitude) if goes else None
        altitude = Band(altitude, altitude).low
    except PhysicalError as problem:
        raise PhysicalError(problem.code, problem.message, problem.hint, where) from None
    return MissionItem(index, frame, command, (p1, p2, p3, p4), at, altitude)


def _band(item: MissionItem, home: float) -> Band | None:
    if item.frame in (AltitudeFrame.SEA_LEVEL, AltitudeFrame.SEA_LEVEL_INT):
        return Band(item.altitude, item.altitude)
    if item.frame in (AltitudeFrame.HOME, AltitudeFrame.HOME_INT):
        return Band(home + item.altitude, home + item.altitude)
    return None
