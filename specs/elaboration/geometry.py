"""Elaboration of written geometry to geometry on the earth."""

from __future__ import annotations

from physical import Band, Geometry, PhysicalError, box, centroid, circle, point, polygon, translate_to
from physical.geometry_measures import metres_text
from physical.long_edges import check_edges
from physical.outliers import is_swapped, outliers
from semantics.state.physical_model import Placed
from specs import syntax as s
from specs.codes import Code
from specs.construct_text import write
from specs.elaboration.mission_mistakes import Findings


def elaborate_geometry(node: s.Geometry, findings: Findings) -> Geometry | None:
    """Return the written geometry; None, and a finding, if it is invalid."""
    try:
        geometry = _geometry(node)
        _warn_of_swapped_corner(node, findings)
        return geometry
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
            found = polygon([_pair(corner) for corner in corners])
            check_edges([_pair(corner) for corner in corners])
            return found
        case s.Circle(centre, radius):
            return circle(_pair(centre), radius.metres)


def _warn_of_swapped_corner(node: s.Geometry, findings: Findings) -> None:
    """Warn of a corner far from the others that is near them once its latitude and longitude are exchanged."""
    if not isinstance(node, s.Box | s.Polygon):
        return
    corners = (node.first, node.second) if isinstance(node, s.Box) else node.corners
    spread = {key: point(*_pair(corner)) for key, corner in enumerate(corners)}
    for key, metres in outliers(spread).items():
        rest = [each for other, each in spread.items() if other != key]
        if is_swapped(spread[key], rest, metres):
            message = f"the corner {write(corners[key])} lies {metres_text(metres)} from the others"
            hint = "are latitude and longitude swapped? exchanged, it would be near"
            findings.warn(Code.FAR_FROM_THE_REST, corners[key], message, hint)


def _pair(coordinate: s.Coordinate) -> tuple[float, float]:
    return coordinate.latitude, coordinate.longitude


def elaborate_placement(node: s.Placement, findings: Findings) -> Placed | None:
    """Return the written placement; None, and a finding, if it is invalid."""
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
    """Return a shape moved to the centre of a geometry; without a shape, that centre."""
    centre = centroid(at)
    return Placed(centre) if shape is None else Placed(translate_to(shape.geometry, centre), shape.altitude)
