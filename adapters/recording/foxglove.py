"""Messages of a recording as Foxglove's schemas have them, so that other programs show its map and its log.

They follow from the other messages, and nothing here reads them. Their topics begin with `/`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from itertools import groupby
from operator import itemgetter
from typing import Any, Final, NamedTuple

from adapters.recording.mcap_files import NANOSECONDS, Schema
from physical import Geometry, PhysicalProperty, polygon, write_geojson
from physical.frame import E7

OTHERS: Final = "/"
"""What the topics begin with that other programs read."""

APART: Final = 1.0
"""Seconds between two positions of an entity at the least: arrivals have all of them."""

MOST_ENTITIES: Final = 1_000
"""So many entities of a mission have a topic of their own; the others share one, as those do that it does not name."""

MOST_LATEST: Final = 10_000
"""Of so many entities the latest position is remembered."""

LATEST: Final = 2.0**32 - 1
"""Times are not after this: seconds have 32 bits in Foxglove's other encodings."""

LEVELS: Final = ("UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL")
_, DEBUG, INFO, WARNING, ERROR, FATAL = range(6)
"""Foxglove's levels."""

SEVERITIES: Final = (FATAL, FATAL, FATAL, ERROR, WARNING, INFO, INFO, DEBUG)
"""The level of each severity of MAVLink, from emergency to debug."""

FINDINGS: Final = {
    "broken assumption": ERROR,
    "failed": ERROR,
    **dict.fromkeys(("refused", "taken over", "lost link", "late", "blocked"), WARNING),
}
"""The level of each kind of finding; of all others INFO."""

_NUMBER: Final = {"type": "number"}
_TEXT: Final = {"type": "string"}
_COUNT: Final = {"type": "integer", "minimum": 0}
_TIME: Final = {
    "type": "object",
    "title": "time",
    "properties": {"sec": _COUNT, "nsec": {**_COUNT, "maximum": 999_999_999}},
}


def _schema(name: str, /, **properties: Any) -> tuple[str, dict[str, Any]]:
    title = f"foxglove.{name}"
    return title, {"title": title, "type": "object", "properties": properties, "required": [*properties]}


FIX: Final = _schema(
    "LocationFix",
    timestamp=_TIME,
    frame_id=_TEXT,
    latitude=_NUMBER,
    longitude=_NUMBER,
    altitude=_NUMBER,
    position_covariance={"type": "array", "items": _NUMBER, "minItems": 9, "maxItems": 9},
    position_covariance_type={"oneOf": [{"title": "UNKNOWN", "const": 0}]},
)
GEOJSON: Final = _schema("GeoJSON", geojson=_TEXT)
LOG: Final = _schema(
    "Log",
    timestamp=_TIME,
    level={"oneOf": [{"title": title, "const": level} for level, title in enumerate(LEVELS)]},
    message=_TEXT,
    name=_TEXT,
    file=_TEXT,
    line=_COUNT,
)

Ring = tuple[tuple[int, int], ...]
Json = Mapping[str, Any]


PLAIN: Final = ("boolean", "string", "number", "integer")


def simplified(schema: Schema) -> Schema:
    """Return the part of a schema that others' readers know: a topic with more is not shown by them at all.

    They know single types, and arrays of these and of objects; none of what is null or an array of arrays. The messages
    have what they have: only its types are not told.
    """
    name, whole = schema
    return name, _simplified(whole)


def _simplified(schema: Json) -> dict[str, Any]:
    match schema:
        case {"type": "object"}:
            parts = {name: _simplified(part) for name, part in schema.get("properties", {}).items()}
            return {**schema, "properties": {name: part for name, part in parts.items() if part}}
        case {"type": "array", "items": dict(items)} if items.get("type") != "array" and (
            part := _simplified(items)
        ):
            return {**schema, "items": part}
        case {"type": str(kind)} if kind in PLAIN:
            return dict(schema)
    return {}


class Shown(NamedTuple):
    """A message of Foxglove's: its topic, its schema and its data."""

    topic: str
    schema: Schema
    data: dict[str, Any]


class Showing:
    """Shows in Foxglove's messages what the messages of a recording say.

    A program that reads them may draw every GeoJSON message that there is, not the last one alone. So what never moves
    is written once, and what has an extent and moves has a topic of its own, with a message for each change.
    """

    def __init__(self, names: Collection[str] = ()) -> None:
        """Show nothing yet; `names` are the entities of the mission."""
        self._names = names if len(names) <= MOST_ENTITIES else frozenset(sorted(names)[:MOST_ENTITIES])
        self._last: dict[str, tuple[float, Ring]] = {}

    def places(self, fixed: Iterable[PhysicalProperty], fences: Mapping[str, Any]) -> Iterator[Shown]:
        """Show what never moves, and the vehicles' fences."""
        named = sorted((_pairs(ring), name) for name, ring in fences.items())
        around = [
            PhysicalProperty(f"fence of {', '.join(name for _, name in group)}", "Fence", _polygon(ring))
            for ring, group in groupby(named, key=itemgetter(0))
        ]
        if everything := [*fixed, *around]:
            yield Shown("/places", GEOJSON, {"geojson": write_geojson(everything)})

    def of(self, topic: str, time: float, data: Mapping[str, Any]) -> Iterator[Shown]:
        """Show what a message says, if it is anything that these schemas have."""
        if topic == "arrivals":
            yield from self._arrival(time, data)
        elif topic in LINES:
            level, name, message = LINES[topic](data)
            said = {"timestamp": _stamp(time), "level": level, "message": message, "name": name}
            yield Shown("/log", LOG, {**said, "file": "", "line": 0})

    def _arrival(self, time: float, data: Mapping[str, Any]) -> Iterator[Shown]:
        """Show where something is, at most once in a while, and a place only if it has changed."""
        entity, ring = data["entity"], _pairs(data.get("ring") or ())
        before, known = self._last.get(entity, (-math.inf, ()))
        if 0 <= time - before < APART or (len(ring) != 1 and ring == known):
            return
        if len(self._last) >= MOST_LATEST:
            self._last.clear()
        self._last[entity] = time, ring
        topic = entity if entity in self._names else f"{data['plugin']}/others"
        if len(ring) == 1:
            yield Shown(f"/{topic}/fix", FIX, _fix(time, data))
        elif len(ring) > 1 or len(known) > 1:
            place = [PhysicalProperty(entity, str(data.get("kind")), _polygon(ring))] if ring else []
            yield Shown(f"/{topic}/area", GEOJSON, {"geojson": write_geojson(place)})


def _pairs(ring: Any) -> Ring:
    return tuple((north, east) for north, east in ring)


def _polygon(ring: Ring) -> Geometry:
    return polygon((north / E7, east / E7) for north, east in ring)


def _stamp(time: float) -> dict[str, int]:
    """Return a time as Foxglove writes it; what a sender says may be any number."""
    nanoseconds = round(min(max(time, 0.0), LATEST) * NANOSECONDS)
    return {"sec": nanoseconds // NANOSECONDS, "nsec": nanoseconds % NANOSECONDS}


def _fix(time: float, data: Mapping[str, Any]) -> dict[str, Any]:
    """Return where an entity was observed: an altitude that is not known is 0, and so is the covariance."""
    ((north, east),) = data["ring"]
    band = data.get("altitude") or (0.0,)
    return {
        "timestamp": _stamp(data.get("time") or time),
        "frame_id": data["entity"],
        "latitude": north / E7,
        "longitude": east / E7,
        "altitude": sum(band) / len(band),
        "position_covariance": [0.0] * 9,
        "position_covariance_type": 0,
    }


# --- the log: a level, whom it is about, and the message -------------------------------------------

Line = tuple[int, str, str]


def _run(data: Json) -> Line:
    verified = data.get("verified") is True
    unverified = "" if verified else "; nothing was verified of this run"
    return (INFO if verified else WARNING), "", f"{data['mission']} begins{unverified}"


def _finding(data: Json) -> Line:
    kind, fallback = data["kind"], data.get("fallback")
    answer = f"; it falls back on: {fallback}" if fallback else ""
    return FINDINGS.get(kind, INFO), data["about"], f"{kind}: {data['message']}{answer}"


def _said(data: Json) -> Line:
    return SEVERITIES[min(max(data["severity"], 0), 7)], data["entity"], data["text"]


def _command(data: Json) -> Line:
    where = f" {data['name']}" if data.get("name") else ""
    return INFO, data["entity"], f"{data['command']}{where} ({data['request']})"


def _saying(data: Json) -> Line:
    return _spoken(data, data["agent"], f"told {data['message']!r}")


def _given_back(data: Json) -> Line:
    return _spoken(data, data["vehicle"], f"heard at {data['at']}" if data.get("at") else "given back")


def _order(data: Json) -> Line:
    return _spoken(data, data["vehicle"] or "all", f"ordered to {data['order']}")


def _spoken(data: Json, name: str, message: str) -> Line:
    """Return what an operator said, and why it was refused, if it was."""
    by = f" by {data['by']}" if data.get("by") else ""
    refused = f"; refused: {data['refusal']}" if data.get("refusal") else ""
    return (WARNING if refused else INFO), name, f"{message}{by}{refused}"


def _left_out(data: Json) -> Line:
    return WARNING, data["entity"] or data["plugin"], f"{data['arrivals']} arrivals were not recorded"


def _end(data: Json) -> Line:
    return INFO, "", f"the run ends: {data['reason']}"


LINES: Final[Mapping[str, Callable[[Json], Line]]] = {
    "run": _run,
    "findings": _finding,
    "said": _said,
    "commands": _command,
    "sayings": _saying,
    "given_back": _given_back,
    "orders": _order,
    "left_out": _left_out,
    "end": _end,
}
"""What the log says of each topic's messages; of all others nothing."""
