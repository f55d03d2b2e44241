"""Files of places, by their suffix: GeoJSON, waypoint files, plans of QGroundControl."""

from __future__ import annotations

from typing import Final

from physical.file_account import Read
from physical.geojson import read_features
from physical.physical_property import PhysicalProperty
from physical.qgc_plan import read_plan_places
from physical.waypoints import read_mission, read_waypoints

GEOJSON: Final = (".geojson", ".json")
WAYPOINTS: Final = ".waypoints"
PLAN: Final = ".plan"
PLACES: Final = (*GEOJSON, WAYPOINTS, PLAN)
"""The suffixes of place files."""


def read_places(suffix: str, data: bytes) -> tuple[PhysicalProperty, ...]:
    """Return the places of a file; those of a mission are `waypoint0` (home), `waypoint1`, ...

    Raises:
        PhysicalError: With the position of the first mistake (GeoJSONError with all mistakes).
    """
    return read_place_file(suffix, data).properties


def read_place_file(suffix: str, data: bytes) -> Read:
    """Return the places of a file with the account of its content; raises like `read_places`."""
    match suffix.lower():
        case ".waypoints":
            return read_mission(read_waypoints(_text(data)))
        case ".plan":
            return read_plan_places(_text(data))
    return read_features(data)


def _text(data: bytes) -> str:
    return data.decode("utf-8", errors="replace")  # the reader refuses other text, with its line
