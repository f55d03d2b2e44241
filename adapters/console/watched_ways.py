"""The ways of vehicles, with the metres to which they keep, and the invariants about ways with their figures."""

from __future__ import annotations

from typing import Any, Final

from adapters.console.console_view import Json
from adapters.console.facts import MOST_VEHICLES, Facts, Position
from adapters.console.parsing import count, number, position, text, texts

MOST_POINTS: Final = 500
MOST_INVARIANTS: Final = 200


def take_way(draft: Facts, _time: float, data: Any) -> None:
    """Take in the points to which a vehicle is sent."""
    match data:
        case {"vehicle": str(name), "way": {"to": to, "points": [*points], "passed": passed}}:
            found = [each for point in points[:MOST_POINTS] if (each := position(point)) is not None]
            draft.ways[name] = {"to": text(to), "points": found, "passed": max(1, count(passed) or 1)}
            draft.ways.bounded(MOST_VEHICLES)
        case {"vehicle": str(name)}:
            draft.ways.pop(name, None)


def take_invariant(draft: Facts, _time: float, data: Any) -> None:
    """Take in an invariant about ways, as it was compared with what is seen."""
    match data:
        case {"property": str(name), "holds": bool(holds), "points": [*points]}:
            draft.invariants[text(name)] = {
                "holds": holds,
                "figure": text(data.get("figure")),
                "entities": texts(data.get("entities")),
                "points": [each for point in points[:2] if (each := _degrees(point)) is not None],
            }
            draft.invariants.bounded(MOST_INVARIANTS)


def _degrees(point: Any) -> Position | None:
    match point:
        case [north, east]:
            latitude, longitude = number(north), number(east)
            if (
                latitude is not None
                and longitude is not None
                and abs(latitude) <= 90
                and abs(longitude) <= 180
            ):
                return latitude, longitude
    return None


def ways(facts: Facts) -> dict[str, Json]:
    """Return the section `ways`: the lines to which vehicles keep, from the present one on, and how near."""
    strays = {} if facts.standing is None else facts.standing.rules.initial.setting.strays
    return {
        name: {
            "to": way["to"],
            "points": way["points"][min(way["passed"], len(way["points"])) - 1 :],
            "strays": strays.get(name),
        }
        for name, way in facts.ways.items()
        if way["points"] and (way["to"] or name in strays)
    }
