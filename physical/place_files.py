"""Files of places, by their suffix: GeoJSON, waypoint files, plans of QGroundControl."""

from __future__ import annotations

from typing import Final

from physical.geojson import read_features
from physical.physical_property import PhysicalProperty
from physical.qgc_plan import read_plan_places
from physical.tally import Read
from physical.waypoints import read_mission, read_waypoints

GEOJSON: Final = (".geojson", ".json")
WAYPOINTS: Final = ".waypoints"
PLAN: Final = ".plan"
PLACES: Final = (*GEOJSON, WAYPOINTS, PLAN)
"""The endings of files of places."""


def read_places(suffix: str, data: bytes) -> tuple[PhysicalProperty, ...]:
    """Return the places of a file: of a mission its points, `waypoint0` (home), `waypoint1`, ...

    Raises PhysicalError with the place of the first mistake (GeoJSONError with all).
    """
    return read_place_file(suffix, data).properties


def read_place_file(suffix: str, data: bytes) -> Read:
    """Return the places of a file with the account of what was in it; raises as `read_places` does."""
    match suffix.lower():
        case ".waypoints":
            return read_mission(read_waypoints(_text(data)))
        case ".plan":
            return read_plan_places(_text(data))
    return read_features(data)


def _text(data: bytes) -> str:
    return data.decode("utf-8", errors="replace")  # what isn't text is refused with its line
