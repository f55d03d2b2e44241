"""The physical model: geometry, altitude and channels of entities on the WGS 84 earth, and their motion.

It reads and writes GeoJSON, waypoint files and plans. It knows nothing of bigraphs, agents or missions. AIS
recordings are read by `physical.ais_receiver` and its neighbours, which need the extra `ais`.
"""

from physical.altitude import Band, band_contains
from physical.containment import Conflict, Place, PlaceIndex, check_places, holds
from physical.drift import Face, drift_faces, face_at
from physical.errors import GeometryError, PhysicalError
from physical.files import open_file
from physical.geojson import GeoJSONError, read_geojson, reading_geojson, write_geojson
from physical.measure import area, centroid, distance, interior_point, waypoint
from physical.mobility_commands import JoinChannel, LeaveChannel, MobilityCommand, Waypoint, go_to, rechannel
from physical.physical_property import PhysicalProperty, Velocity
from physical.place_files import read_places
from physical.placement import nearest_placement, translate_to
from physical.qgc_plan import read_plan, write_plan
from physical.shape import Geometry, box, circle, contains, equal, overlaps, point, polygon
from physical.untrusted_text import is_text, is_word, legible, read_json
from physical.waypoints import MissionItem, read_waypoints, visited, waypoint_places, write_waypoints

__all__ = [
    "Band",
    "Conflict",
    "Face",
    "GeoJSONError",
    "Geometry",
    "GeometryError",
    "JoinChannel",
    "LeaveChannel",
    "MissionItem",
    "MobilityCommand",
    "PhysicalError",
    "PhysicalProperty",
    "Place",
    "PlaceIndex",
    "Velocity",
    "Waypoint",
    "area",
    "band_contains",
    "box",
    "centroid",
    "check_places",
    "circle",
    "contains",
    "distance",
    "drift_faces",
    "equal",
    "face_at",
    "go_to",
    "holds",
    "interior_point",
    "is_text",
    "is_word",
    "legible",
    "nearest_placement",
    "open_file",
    "overlaps",
    "point",
    "polygon",
    "read_geojson",
    "read_json",
    "read_places",
    "read_plan",
    "read_waypoints",
    "reading_geojson",
    "rechannel",
    "translate_to",
    "visited",
    "waypoint",
    "waypoint_places",
    "write_geojson",
    "write_plan",
    "write_waypoints",
]
