"""Edits of the `world` section that a drawing on the map asks for, as changes of the text."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count
from math import cos, radians
from typing import Any, Final

from bigactors.lsp.edited_mission import Reading
from bigactors.studio.page_requests import Add, Position, Reshape
from specs import syntax as s
from specs.standard_signature import standard_kinds

DIGITS: Final = 5
"""The decimals of a degree in the text: 1.1 m."""

DEGREE: Final = 111_195.0
"""Metres in a degree of latitude."""


class Uneditable(Exception):
    """An edit that cannot be made; the message says why."""


@dataclass(frozen=True, slots=True)
class TextChange:
    """A replacement of the text between two offsets."""

    start: int
    end: int
    text: str


def shapes(reading: Reading) -> dict[str, Any]:
    """Return the kinds of the text, and the points and the radius of each entity that it places."""
    placed = [(each, each.placement.geometry) for each in _entities(reading) if each.placement is not None]
    return {
        "kinds": list(_kinds(reading)),
        "shapes": {each.name.text: _shape_json(geometry) for each, geometry in placed},
    }


def _shape_json(geometry: s.Geometry) -> dict[str, Any]:
    points = [(each.latitude, each.longitude) for each in _points(geometry)]
    radius = geometry.radius.metres if isinstance(geometry, s.Circle) else None
    return {"shape": type(geometry).__name__.lower(), "points": points, "radius": radius}


def changes(reading: Reading, edit: Reshape | Add) -> tuple[str, list[TextChange]]:
    """Return the name of the entity that is edited, and the changes of the text; raises Uneditable."""
    if isinstance(edit, Add):
        return _added(reading, edit)
    return edit.name, list(_reshaped(reading, edit))


def _reshaped(reading: Reading, edit: Reshape) -> Iterator[TextChange]:
    found = next((each for each in _entities(reading) if each.name.text == edit.name), None)
    if found is None or found.placement is None:
        raise Uneditable(f"the text places no {edit.name}: it comes from a file, is carried, or absent")
    geometry = found.placement.geometry
    points = tuple(_points(geometry))
    if len(points) != len(edit.points):
        raise Uneditable(f"{edit.name} has {len(points)} points in the text")
    for point, to in zip(points, edit.points, strict=True):
        if _position((point.latitude, point.longitude)) != _position(to):
            yield TextChange(point.span.start, point.span.end, _position(to))
    if isinstance(geometry, s.Circle) and edit.radius is not None:
        before, after = geometry.radius, _length(edit.radius)
        if _length(before.metres) != after:
            yield TextChange(before.span.start, before.span.end, after)


def _added(reading: Reading, edit: Add) -> tuple[str, list[TextChange]]:
    if edit.kind not in _kinds(reading):
        raise Uneditable(f"the signature has no kind {edit.kind}")
    name = _free_name(reading, edit.kind)
    line = f"  {name}: {edit.kind} = {_new_shape(edit)}\n"
    return name, [_inserted(reading, line)]


def from_file(reading: Reading, file: str) -> list[TextChange]:
    """Return the change that takes the places of a file beside the mission into the world, unless it is there."""
    worlds = reading.mission.each(s.World)
    known = [each.file.value for world in worlds for each in world.entries if isinstance(each, s.FromSource)]
    return [] if file in known else [_inserted(reading, f'  from "{file}"\n')]


def _inserted(reading: Reading, line: str) -> TextChange:
    """Return the change that adds a line at the end of the world; a text without a world gets one."""
    world = next(iter(reading.mission.each(s.World)), None)
    if world is None:
        at = len(reading.text)
        return TextChange(at, at, f"\nworld {{\n{line}}}\n")
    end = reading.text.rindex("}", world.span.start, world.span.end)
    begins = reading.text.rfind("\n", 0, end) + 1
    at, text = (end, f"\n{line}") if reading.text[begins:end].strip() else (begins, line)
    return TextChange(at, at, text)


def _new_shape(edit: Add) -> str:
    (latitude, longitude), half = edit.at, edit.size / 2
    north, east = half / DEGREE, half / DEGREE / max(cos(radians(latitude)), 0.01)

    def corner(up: int, right: int) -> str:
        return _position((latitude + up * north, longitude + right * east))

    match edit.shape:
        case "circle":
            return f"circle {_position(edit.at)} radius {_length(half)}"
        case "box":
            return f"box {corner(1, 1)} {corner(-1, -1)}"
        case "polygon":
            return f"polygon {corner(1, -1)} {corner(1, 1)} {corner(-1, 1)} {corner(-1, -1)}"
    return f"point {_position(edit.at)}"


def _free_name(reading: Reading, kind: str) -> str:
    """Return a name that stands nowhere in the text: the kind's, with a number."""
    stem = kind.lower() if kind.isupper() else kind[:1].lower() + kind[1:]
    known = {each.symbol.name for each in reading.occurrences.all}
    return next(name for number in count() if (name := f"{stem}{number}") not in known)


def _kinds(reading: Reading) -> Iterator[str]:
    signatures = list(reading.mission.each(s.Signature))
    known: dict[str, None] = {}
    for each in signatures:
        standard = standard_kinds() if each.standard else ()
        known |= dict.fromkeys(kind.name.text for kind in (*standard, *each.kinds))
    yield from known


def _entities(reading: Reading) -> Iterator[s.Entity]:
    for world in reading.mission.each(s.World):
        yield from (each for each in world.entries if isinstance(each, s.Entity))


def _points(geometry: s.Geometry) -> tuple[s.Coordinate, ...]:
    match geometry:
        case s.Point(position):
            return (position,)
        case s.Box(first, second):
            return first, second
        case s.Polygon(corners):
            return corners
        case s.Circle(centre):
            return (centre,)


def _position(position: Position) -> str:
    return f"({_number(position[0])}, {_number(position[1])})"


def _number(value: float) -> str:
    text = f"{value:.{DIGITS}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _length(metres: float) -> str:
    return f"{max(1, round(metres))} m"
