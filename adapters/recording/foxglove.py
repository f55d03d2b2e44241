"""A recording's messages in Foxglove's schemas, so that other programs show its map and its log.

They are derived from the other messages, and no code here reads them. Their topics begin with `/`.
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
"""The prefix of the topics for other programs."""

APART: Final = 1.0
"""The least seconds between two positions of an entity: arrivals have all of them."""

MOST_ENTITIES: Final = 1_000
"""The most entities of a mission with a topic of their own; the others share one, with those that it does not name."""

MOST_LATEST: Final = 10_000
"""The most entities whose latest position is remembered."""

LATEST: Final = 2.0**32 - 1
"""The latest time: seconds have 32 bits in Foxglove's other encodings."""

LEVELS: Final = ("UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL")
_, DEBUG, INFO, WARNING, ERROR, FATAL = range(6)
"""Foxglove's levels."""

SEVERITIES: Final = (FATAL, FATAL, FATAL, ERROR, WARNING, INFO, INFO, DEBUG)
"""The level of each severity of MAVLink, from emergency to debug."""

FINDINGS: Final = {
    "broken assumption": ERROR,
    "broken property": ERROR,
    "failed": ERROR,
    **dict.fromkeys(("refused", "taken over", "lost link", "late", "blocked"), WARNING),
}
"""The level of each kind of finding; all others have INFO."""

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
    """Return the part of a schema that other readers know: they hide a topic with more.

    They know single types, and arrays of these and of objects, but no nullable types and no arrays of arrays. The
    messages keep all their data: only the types of such parts are left out.
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


class FoxgloveMessage(NamedTuple):
    """A Foxglove message: its topic, its schema and its data."""

    topic: str
    schema: Schema
    data: dict[str, Any]


class Showing:
    """Derives Foxglove messages from the messages of a recording.

    A program that reads them may draw every GeoJSON message that there is, not only the last one. So static places are
    written once, and each moving area has a topic of its own, with a message for each change.
    """

    def __init__(self, names: Collection[str] = ()) -> None:
        """Begin without messages; `names` are the entities of the mission."""
        self._names = names if len(names) <= MOST_ENTITIES else frozenset(sorted(names)[:MOST_ENTITIES])
        self._last: dict[str, tuple[float, Ring]] = {}

    def places(
        self, fixed: Iterable[PhysicalProperty], fences: Mapping[str, Any]
    ) -> Iterator[FoxgloveMessage]:
        """Show the static places, and the vehicles' fences."""
        named = sorted((_pairs(ring), name) for name, ring in fences.items())
        around = [
            PhysicalProperty(f"fence of {', '.join(name for _, name in group)}", "Fence", _polygon(ring))
            for ring, group in groupby(named, key=itemgetter(0))
        ]
        if everything := [*fixed, *around]:
            yield FoxgloveMessage("/places", GEOJSON, {"geojson": write_geojson(everything)})

    def of(self, topic: str, time: float, data: Mapping[str, Any]) -> Iterator[FoxgloveMessage]:
        """Show a message, if these schemas have a form for it."""
        if topic == "arrivals":
            yield from self._arrival(time, data)
        elif topic in LINES:
            level, name, message = LINES[topic](data)
            said = {"timestamp": _stamp(time), "level": level, "message": message, "name": name}
            yield FoxgloveMessage("/log", LOG, {**said, "file": "", "line": 0})

    def _arrival(self, time: float, data: Mapping[str, Any]) -> Iterator[FoxgloveMessage]:
        """Show the position of an entity, at most once in a while, and a place only if it has changed."""
        entity, ring = data["entity"], _pairs(data.get("ring") or ())
        before, known = self._last.get(entity, (-math.inf, ()))
        if 0 <= time - before < APART or (len(ring) != 1 and ring == known):
            return
        if len(self._last) >= MOST_LATEST:
            self._last.clear()
        self._last[entity] = time, ring
        topic = entity if entity in self._names else f"{data['plugin']}/others"
        if len(ring) == 1:
            yield FoxgloveMessage(f"/{topic}/fix", FIX, _fix(time, data))
        elif len(ring) > 1 or len(known) > 1:
            place = [PhysicalProperty(entity, str(data.get("kind")), _polygon(ring))] if ring else []
            yield FoxgloveMessage(f"/{topic}/area", GEOJSON, {"geojson": write_geojson(place)})


def _pairs(ring: Any) -> Ring:
    return tuple((north, east) for north, east in ring)


def _polygon(ring: Ring) -> Geometry:
    return polygon((north / E7, east / E7) for north, east in ring)


def _stamp(time: float) -> dict[str, int]:
    """Return a time in Foxglove's form; a sender's time may be any number."""
    nanoseconds = round(min(max(time, 0.0), LATEST) * NANOSECONDS)
    return {"sec": nanoseconds // NANOSECONDS, "nsec": nanoseconds % NANOSECONDS}


def _fix(time: float, data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the observed position of an entity: an unknown altitude is 0, and so is the covariance."""
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


# --- the log: a level, the subject, and the message -------------------------------------------------

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
    return _spoken(data, data["agent"], f"the message {data['message']!r}")


def _given_back(data: Json) -> Line:
    return _spoken(data, data["vehicle"], f"heard at {data['at']}" if data.get("at") else "given back")


def _order(data: Json) -> Line:
    told = data["vehicle"] or "all"
    return _spoken(data, told if isinstance(told, str) else ", ".join(told), f"ordered to {data['order']}")


def _spoken(data: Json, name: str, message: str) -> Line:
    """Return an operator's message, with the reason if it was refused."""
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
"""The log line for each topic's messages; other topics have none."""
