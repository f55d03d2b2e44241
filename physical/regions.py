"""Regions: where an entity may be while a configuration lasts, as plain data.

A region is a union of parts. A part is the smallest set that has every shortest line (geodesic) between the points of
its sources, or a source itself, grown by a margin. `physical.mission_regions` computes regions, and
`physical.region_relations` decides the four relations over them.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from physical.altitude import Band
from physical.frame import PositionE7
from physical.shape import Geometry


class RegionKind(Enum):
    """The reason why an entity may be in a part of its region."""

    PLACED = "placed"
    """The mission or a clause puts it exactly there."""

    REST = "rest"
    """A control brought it there, and it may still be on the way to its waypoint."""

    FACE = "face"
    """It drifts within a place."""

    LEG = "leg"
    """It flies between two neighbours of its way, or anywhere between all of them."""


@dataclass(frozen=True, slots=True)
class FaceCover:
    """The points that an entity covers in one cell of its drift within a place.

    Attributes:
        shell: The outer border in 1e-7 degree, latitude and longitude.
        holes: The inner borders.
        inside: The polygons that contain the entity everywhere in the cell, sorted.
        outside: The polygons of the same drift that contain no point of the entity there, sorted.
    """

    shell: tuple[PositionE7, ...]
    holes: tuple[tuple[PositionE7, ...], ...] = ()
    inside: tuple[Geometry, ...] = ()
    outside: tuple[Geometry, ...] = ()


Source = Geometry | FaceCover


@dataclass(frozen=True, slots=True)
class RegionPart:
    """All points within `margin` metres of a source, or of the hull of several, at some altitudes.

    Attributes:
        sources: The sources, each once; one unless `spanned`.
        spanned: Whether every shortest line between points of the sources belongs to the part.
        margin: Metres around.
        altitude: The altitudes, None for all.
        kind: The reason for the part.
        between: The names of the places between which the entity flies; empty unless it is a leg. An empty name is the
            position at which the flight began.
    """

    sources: tuple[Source, ...]
    spanned: bool = False
    margin: float = 0.0
    altitude: Band | None = None
    kind: RegionKind = RegionKind.PLACED
    between: tuple[str, ...] = ()

    @property
    def is_exact(self) -> bool:
        """Whether the part is a geometry or a face of the mission itself: it compares without a tolerance."""
        return not self.spanned and self.margin == 0.0


@dataclass(frozen=True, slots=True)
class Region:
    """Reg(u): all points and altitudes that an entity may cover while a configuration lasts.

    Attributes:
        parts: Its parts; none if the entity is absent.
        certain: Whether the mission or a clause puts the entity there, and no control could have.
        is_area: Whether the entity has an area of its own, so that it may contain others.
    """

    parts: tuple[RegionPart, ...] = ()
    certain: bool = False
    is_area: bool = False

    def __bool__(self) -> bool:
        return bool(self.parts)


NOWHERE = Region()
"""The region of an absent entity."""


@dataclass(frozen=True, slots=True)
class Located:
    """An entity in a configuration: its region, and its carriers, the innermost first."""

    entity: str
    region: Region
    carriers: tuple[str, ...] = ()

    @property
    def bearer(self) -> str:
        """Return the outermost carrier, or the entity itself if nothing carries it."""
        return self.carriers[-1] if self.carriers else self.entity
