"""Waypoint files: `QGC WPL 110`, plain text of tab-separated columns (paper, Example 1).

A line is: index, current, frame, command, four parameters, latitude, longitude, altitude, autocontinue; the numbers are
those of MAVLink. Item 0 is the home position, if it is a position above sea level.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from types import MappingProxyType
from typing import Final, NamedTuple

from physical.altitude import Band
from physical.command_names import POSITIONS, command_name
from physical.errors import PhysicalError
from physical.file_account import Counting, Read
from physical.mobility_commands import MobilityCommand, Waypoint
from physical.physical_property import PhysicalProperty
from physical.shape import Geometry, point

HEADER: Final = "QGC WPL 110"
MAX_CHARACTERS: Final = 1_000_000
MAX_ITEMS: Final = 10_000
COLUMNS: Final = 12
EMPTY: Final[Mapping[str, int]] = MappingProxyType({})


class AltitudeFrame(IntEnum):
    """The reference of an altitude (MAV_FRAME); in a file, the `INT` frames are written like the others."""

    SEA_LEVEL = 0
    HOME = 3
    SEA_LEVEL_INT = 5
    HOME_INT = 6
    TERRAIN = 10
    TERRAIN_INT = 11


class MAVCommand(IntEnum):
    """The commands that go to a position (MAV_CMD)."""

    WAYPOINT = 16
    LOITER_UNLIMITED = 17
    LOITER_TURNS = 18
    LOITER_TIME = 19
    LAND = 21
    TAKEOFF = 22
    LOITER_TO_ALT = 31
    DO_ORBIT = 34
    DO_FIGURE_EIGHT = 35
    ARC_WAYPOINT = 36
    SPLINE_WAYPOINT = 82
    VTOL_TAKEOFF = 84
    VTOL_LAND = 85
    PAYLOAD_PLACE = 94
    DO_REPOSITION = 192


_USERS: Final = range(31000, 31005)
"""User-defined waypoints (MAV_CMD_WAYPOINT_USER_1 to 5)."""

_GOING: Final = frozenset({*map(int, MAVCommand), *_USERS})
_ABOVE_SEA: Final = frozenset({AltitudeFrame.SEA_LEVEL, AltitudeFrame.SEA_LEVEL_INT})
_ABOVE_HOME: Final = frozenset({AltitudeFrame.HOME, AltitudeFrame.HOME_INT})
_GLOBAL: Final = frozenset(map(int, AltitudeFrame))
_HOMES: Final = (MAVCommand.WAYPOINT, 0)
"""The commands of a home item: a waypoint, or no command."""


@dataclass(frozen=True, slots=True)
class MissionItem:
    """One line of a waypoint file.

    Attributes:
        index: Its number; 0 is home.
        frame: The reference of the altitude (MAV_FRAME).
        command: The command (MAV_CMD).
        parameters: The command's four parameters.
        point: The position, if the command goes to one.
        altitude: Metres in its frame, if the file has one.
    """

    index: int
    frame: int
    command: int
    parameters: tuple[float, float, float, float]
    point: Geometry | None
    altitude: float | None

    @property
    def is_home(self) -> bool:
        """Whether this is the vehicle's start: item 0, if it is a position above sea level."""
        return (
            self.index == 0 and self.command in _HOMES and self.frame in _ABOVE_SEA and self.point is not None
        )


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


def goes_to(index: int, frame: int, command: int, latitude: float, longitude: float) -> bool:
    """Whether a mission item is home or a position that the vehicle goes to.

    Latitude 0 and longitude 0 mean *the present position*, or no position. In frames that are not global the numbers
    are metres.
    """
    there = frame in _GLOBAL and (latitude, longitude) != (0.0, 0.0)
    return there and (command in _GOING or (index == 0 and command in _HOMES and frame in _ABOVE_SEA))


def waypoint_places(items: Sequence[MissionItem], prefix: str = "waypoint") -> tuple[PhysicalProperty, ...]:
    """Return the destinations of a mission as places named by their index; home is `<prefix>0`.

    Altitudes above home are converted to altitudes above sea level if the file has that of home; those above terrain
    are unknown.
    """
    home = next((item.altitude for item in items if item.is_home), None)
    return tuple(
        PhysicalProperty(f"{prefix}{item.index}", "Waypoint", item.point, _band(item, home), source=HEADER)
        for item in items
        if item.point is not None
    )


def read_mission(items: Sequence[MissionItem], beside: Mapping[str, int] = EMPTY) -> Read:
    """Return the places of a mission with the account of its items, and of the other things in the file (`beside`)."""
    places, counting = waypoint_places(items), Counting()
    for item in items:
        if item.point is None:
            counting.leave(_nowhere(item))
        else:
            counting.take("home" if item.is_home else "waypoint")
    for kind, count in beside.items():
        counting.leave(kind, count)
    unknown = sum(place.altitude is None for place in places)
    above_terrain = sum(item.point is not None and _is_above_terrain(item) for item in items)
    if above_terrain:
        counting.note("altitude above the terrain: it is not known above the sea", above_terrain)
    if unknown > above_terrain:
        counting.note(
            "altitude above a home without an altitude in the file: it is not known", unknown - above_terrain
        )
    return Read(places, (counting.tally(len(items) + sum(beside.values()), "item"),))


def _is_above_terrain(item: MissionItem) -> bool:
    return item.frame in (AltitudeFrame.TERRAIN, AltitudeFrame.TERRAIN_INT)


def _nowhere(item: MissionItem) -> str:
    """Return the description of an item without a place."""
    name = command_name(item.command)
    if item.command in POSITIONS or item.command not in _GOING:
        home = item.index == 0 and item.command in _HOMES
        return "home at latitude 0 and longitude 0" if home else name
    if item.frame not in _GLOBAL:
        return f"{name} in frame {item.frame}, which has no latitude and longitude"
    return "home at latitude 0 and longitude 0" if item.index == 0 else f"{name} without a position"


def write_waypoints(
    points: Sequence[Geometry],
    altitude: float,
    home: Geometry | None = None,
    home_altitude: float = 0.0,
    bands: Sequence[Band | None] = (),
) -> str:
    """Return a waypoint file that visits points at an altitude in metres above home.

    A point with a band of altitudes above sea level is visited within that band instead. Item 0 is home, by default the
    first point.
    """
    stops = stops_of(points, altitude, home, home_altitude, bands)
    return "".join(f"{line}\n" for line in (HEADER, *(_line(i, stop) for i, stop in enumerate(stops))))


class MissionStop(NamedTuple):
    """A stop of a written mission: a point, the reference of its altitude, and the altitude in metres."""

    point: Geometry
    frame: AltitudeFrame
    altitude: float


def stops_of(
    points: Sequence[Geometry],
    altitude: float,
    home: Geometry | None,
    home_altitude: float,
    bands: Sequence[Band | None],
) -> tuple[MissionStop, ...]:
    """Return home and the visited points, each with its altitude; raises PhysicalError."""
    at = [home or points[0], *points] if points else []
    if not at or not all(each.is_point for each in at):
        raise PhysicalError(
            "waypoint-file", "a waypoint file visits points", "take the waypoints of polygons"
        )
    above_home = Band(altitude, altitude).low  # raises an error unless it is a finite number
    heights = [*bands, *[None] * (len(points) - len(bands))]
    start, *stops = map(_beside_zero, at)
    return (
        MissionStop(start, AltitudeFrame.SEA_LEVEL, Band(home_altitude, home_altitude).low),
        *(_stop(each, band, above_home) for each, band in zip(stops, heights, strict=True)),
    )


def _beside_zero(at: Geometry) -> Geometry:
    """Return the point to write: (0, 0) would mean *the present position*, so it is moved by 1 cm."""
    return point(1e-7, 0.0) if at is point(0.0, 0.0) else at


def _stop(at: Geometry, band: Band | None, above_home: float) -> MissionStop:
    if band is None:
        return MissionStop(at, AltitudeFrame.HOME, above_home)
    middle = (band.low + band.high) / 2
    rounded = round(middle, 2)
    return MissionStop(at, AltitudeFrame.SEA_LEVEL, rounded if band.low <= rounded <= band.high else middle)


def visited(commands: Iterable[MobilityCommand], entity: str) -> tuple[Geometry, ...]:
    """Return the points to which a trace's mobility commands send an entity, in order."""
    return tuple(
        command.point for command in commands if isinstance(command, Waypoint) and command.entity == entity
    )


def _line(index: int, stop: MissionStop) -> str:
    ((latitude, longitude),) = stop.point.vertices
    numbers = [f"{value:.7f}" for value in (0.0, 0.0, 0.0, 0.0, latitude, longitude)]
    altitude = f"{stop.altitude:.7f}"
    exact = altitude if float(altitude) == stop.altitude else repr(stop.altitude)
    columns = [index, int(index == 0), int(stop.frame), int(MAVCommand.WAYPOINT), *numbers, exact, 1]
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
        at = point(latitude, longitude) if goes_to(index, frame, command, latitude, longitude) else None
        altitude = Band(altitude, altitude).low
    except PhysicalError as problem:
        raise PhysicalError(problem.code, problem.message, problem.hint, where) from None
    return MissionItem(index, frame, command, (p1, p2, p3, p4), at, altitude)


def _band(item: MissionItem, home: float | None) -> Band | None:
    if item.altitude is None:
        return None
    if item.frame in _ABOVE_SEA:
        return Band(item.altitude, item.altitude)
    if item.frame in _ABOVE_HOME and home is not None:
        return Band(home + item.altitude, home + item.altitude)
    return None
