"""The points that a drifting entity covers while it stays in one face of its drift (`physical.drift`)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise

import shapely

from physical.drift import Aboard, Cell, MetricPlane, Places, face_at, plane_of, quotient
from physical.frame import PositionE7, normal_longitude
from physical.geometry_measures import centroid
from physical.placement import Offset, outline, still
from physical.regions import FaceCover
from physical.shape import Geometry


@dataclass(frozen=True, slots=True)
class DriftWithin:
    """The arguments of `physical.drift_faces` for an entity that drifts within a place.

    Attributes:
        mover: The entity, at its first placement.
        within: The place.
        places: The places that may contain it, by name.
        aboard: The shapes that may be aboard, each with the places that may contain it.
    """

    mover: Geometry
    within: Geometry
    places: Places
    aboard: Aboard = field(default_factory=dict)


def face_of(drift: DriftWithin, at: Geometry) -> int | None:
    """Return the number of the face in which a placement is: a representative, or another one; None if in none."""
    return face_at(at, drift.within, drift.places, drift.aboard)


def standing_for(drift: DriftWithin, middle: Geometry) -> int | None:
    """Return the face for which P has the entity's centroid at a point: a representative's, or the first one."""
    if centroid(drift.mover) is middle:
        return face_of(drift, drift.mover)
    faces = quotient(drift.mover, drift.within, drift.places, drift.aboard).faces
    return next((i for i, face in enumerate(faces) if centroid(face.representative) is middle), None)


def face_covers(drift: DriftWithin) -> tuple[tuple[FaceCover, ...], ...]:
    """Return, for each face, the cover of the entity in each of its cells.

    Cells narrower than 10 cm are in no face.
    """
    found = quotient(drift.mover, drift.within, drift.places, drift.aboard)
    plane = plane_of(drift.mover, drift.within, drift.aboard)
    covers = [_cover(drift, cell, plane) for cell in found.cells]
    return tuple(
        tuple(cover for cover, face in zip(covers, found.face_of, strict=True) if face == index)
        for index in range(len(found.faces))
    )


def _cover(drift: DriftWithin, cell: Cell, plane: MetricPlane) -> FaceCover:
    mover, middle = still(drift.mover), centroid(drift.within).ring[0][1]
    covered = cell.shape if mover.is_point else _swept(cell.shape, outline(mover))
    inside = {drift.places[name] for name in cell.relations[0]}
    others = {place for place in drift.places.values() if not place.is_point} - inside

    def ring(line: shapely.LinearRing) -> tuple[PositionE7, ...]:
        positions = (plane.position(x, y) for x, y in line.coords[:-1])
        return tuple((north, middle + normal_longitude(east - middle)) for north, east in positions)

    return FaceCover(
        ring(covered.exterior),
        tuple(ring(hole) for hole in covered.interiors),
        tuple(sorted(inside)),
        tuple(sorted(others)) if mover.is_point else (),
    )


def _swept(cell: shapely.Polygon, offsets: Iterable[Offset]) -> shapely.Polygon:
    """Return the points that a convex mover covers with its centroid in a cell: their Minkowski sum."""
    around = list(offsets)
    edges = [edge for line in (cell.exterior, *cell.interiors) for edge in pairwise(line.coords)]
    swept = [
        shapely.MultiPoint([(x + dx, y + dy) for x, y in edge for dx, dy in around]).convex_hull
        for edge in edges
    ]
    covered = shapely.union_all([cell, *swept])
    return max(shapely.get_parts(covered), key=lambda part: float(part.area))
