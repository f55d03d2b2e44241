"""Geometry in one import: shapes, relations, measures and placement."""

from physical.errors import GeometryError
from physical.geometry_measures import area, centroid, distance, interior_point, waypoint
from physical.placement import nearest_placement, translate_to
from physical.shape import Geometry, box, circle, contains, equal, overlaps, point, polygon

__all__ = [
    "Geometry",
    "GeometryError",
    "area",
    "box",
    "centroid",
    "circle",
    "contains",
    "distance",
    "equal",
    "interior_point",
    "nearest_placement",
    "overlaps",
    "point",
    "polygon",
    "translate_to",
    "waypoint",
]
