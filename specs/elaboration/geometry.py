"""Elaborate written geometry to geometry on the earth."""

from __future__ import annotations

from physical import Band, Geometry, PhysicalError, box, centroid, circle, point, polygon, translate_to
from semantics.state.physical_model import Placed
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.findings import Findings


def elaborate_geometry(node: s.Geometry, findings: Findings) -> Geometry | None:
    """Return the geometry that is written, None (and a finding) where it is none on the earth."""
    try:
        return _geometry(node)
    except PhysicalError as error:
        findings.add(Code.BAD_GEOMETRY, node, error.message, error.hint)
        return None


def _geometry(node: s.Geometry) -> Geometry:
    match node:
        case s.Point(position):
            return point(*_pair(position))
        case s.Box(first, second):
            return box(_pair(first), _pair(second))
        case s.Polygon(corners):
            return polygon([_pair(corner) for corner in corners])
        case s.Circle(centre, radius):
            return circle(_pair(centre), radius.metres)


def _pair(coordinate: s.Coordinate) -> tuple[float, float]:
    return coordinate.latitude, coordinate.longitude


def elaborate_placement(node: s.Placement, findings: Findings) -> Placed | None:
    """Return the placement that is written."""
    geometry = elaborate_geometry(node.geometry, findings)
    try:
        altitude = None if node.altitude is None else _band(node.altitude)
    except PhysicalError as error:
        findings.add(Code.BAD_GEOMETRY, node.altitude or node, error.message, error.hint)
        return None
    return None if geometry is None else Placed(geometry, altitude)


def _band(node: s.AltitudeBand) -> Band:
    return Band(node.lowest.metres, node.highest.metres)


def moved_to(shape: Placed | None, at: Geometry) -> Placed:
    """Return a shape, centred where another geometry has its centre; without a shape, that centre."""
    centre = centroid(at)
    return Placed(centre) if shape is None else Placed(translate_to(shape.geometry, centre), shape.altitude)
