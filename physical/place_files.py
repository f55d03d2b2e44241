"""Files of places, by their suffix: GeoJSON, waypoint files, plans of QGroundControl."""

from __future__ import annotations

from typing import Final

from physical.geojson import read_geojson
from physical.physical_property import PhysicalProperty
from physical.qgc_plan import read_plan
from physical.waypoints import read_waypoints, waypoint_places

GEOJSON: Final = (".geojson", ".json")
WAYPOINTS: Final = ".waypoints"
PLAN: Final = ".plan"
PLACES: Final = (*GEOJSON, WAYPOINTS, PLAN)
"""The endings of files of places."""


def read_places(suffix: str, data: bytes) -> tuple[PhysicalProperty, ...]:
    """Return the places of a file: of a mission its points, `waypoint0` (home), `waypoint1`, ...

    Raises PhysicalError with the place of the first mistake (GeoJSONError with all).
    """
    match suffix.lower():
        case ".waypoints":
            return waypoint_places(read_waypoints(_text(data)))
        case ".plan":
            return waypoint_places(read_plan(_text(data)))
    return read_geojson(data)


def _text(data: bytes) -> str:
    return data.decode("utf-8", errors="replace")  # what isn't text is refused with its line
