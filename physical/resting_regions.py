"""Stay(g): where an entity may be after a control brought it to a placement g.

The control is committed when the entity is seen in the place. It may then be anywhere there, and flies on to g. It may
also have been put down by a carrier that was still on its own way.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Final

import numpy as np
import shapely

from physical.altitude import Band, band_contains
from physical.entity_motions import EntityMotion
from physical.face_covers import face_covers, face_of, standing_for
from physical.geodesic_areas import projected, source_area
from physical.geometry_measures import area, centroid
from physical.gnomonic import frame_of
from physical.place_nesting import Place
from physical.possible_geometries import PossibleGeometries
from physical.regions import FaceCover, RegionKind, Source
from physical.shape import MEMO, Geometry, contains

LEAVING: Final = 0.5
"""Metres by which a shortest line to g may leave a place that still counts as a whole."""


@dataclass(frozen=True, slots=True)
class GroundPatch:
    """A piece of ground: a source or a hull of several, grown by a margin."""

    sources: tuple[Source, ...]
    spanned: bool = False
    margin: float = 0.0
    kind: RegionKind = RegionKind.REST


class RestingPlaces:
    """Stay(g), and the faces of drifts, for the entities of one mission."""

    def __init__(self, geometries: PossibleGeometries) -> None:
        self._of: Final = geometries
        self._covers: Final[dict[str, tuple[tuple[FaceCover, ...], ...]]] = {}

    def face(self, entity: str, at: Geometry) -> tuple[FaceCover, ...]:
        """Return the cover of a drifting entity in all cells of the face of its placement; empty if it is in none."""
        drift = self._of.motion(entity).drift
        index = None if drift is None else face_of(drift, at)
        return () if index is None else self._faces(entity)[index]

    def _faces(self, entity: str) -> tuple[tuple[FaceCover, ...], ...]:
        if entity not in self._covers:
            drift = self._of.motion(entity).drift
            self._covers[entity] = () if drift is None else face_covers(drift)
        return self._covers[entity]

    def stay(self, entity: str, at: Place) -> tuple[GroundPatch, ...]:
        """Return Stay(g) without the margin r: the pieces of the entity and of all that may have brought it to g."""
        found = dict.fromkeys(self._own(entity, at))
        for carrier in self._of.bringers(entity, at.geometry):
            found |= dict.fromkeys(self._brought(carrier, at.geometry, self._of.radius(entity)))
        return tuple(found)

    def margin(self, entity: str, at: Geometry) -> float:
        """Return the greatest r of an entity and of all that may have brought it to a placement."""
        return max(self._of.motion(name).margin for name in (entity, *self._of.bringers(entity, at)))

    def _own(self, entity: str, at: Place) -> Iterator[GroundPatch]:
        motion = self._of.motion(entity)
        if self._is_exact(motion, at.geometry):
            yield GroundPatch((at.geometry,))
        else:
            yield from self._flown_to(motion, at.geometry, (at.altitude,))

    def _brought(self, carrier: str, at: Geometry, radius: float) -> Iterator[GroundPatch]:
        """Yield where a carrier may be that put an entity of some radius down at a placement."""
        motion, middle = self._of.motion(carrier), centroid(at)
        face = None if motion.drift is None else standing_for(motion.drift, middle)
        for cover in () if face is None else self._faces(carrier)[face]:
            yield GroundPatch((cover,), margin=radius, kind=RegionKind.FACE)
        if self._is_exact(motion, middle):
            yield GroundPatch((at,))
            return
        for each in self._flown_to(motion, middle, self._of.bands(carrier)):
            yield replace(each, margin=each.margin + radius)

    def _is_exact(self, motion: EntityMotion, at: Geometry) -> bool:
        """Whether an entity is at its placement, up to its margin: `run` sent it there, or no flight could have."""
        said = motion.strays is not None and self._of.is_destination(motion.name, at)
        return said or not self._of.may_fly_to(motion.name, at)

    def _flown_to(
        self, motion: EntityMotion, at: Geometry, bands: Iterable[Band | None]
    ) -> Iterator[GroundPatch]:
        """Yield where an entity may be that flew to a placement, and may still be on its way to the waypoint."""
        around = [place for band in bands for place in self._smallest(motion, at, band)]
        if not around:
            yield GroundPatch((at,))
        for place in sorted(set(around)):
            yield GroundPatch((place,), spanned=not is_star(place, at))
        for name in sorted(motion.targets - {motion.name}):
            whole = self._of.whole(name)
            if whole is not None and not self._of.is_fixed(name) and self._of.is_near(name, centroid(at)):
                yield GroundPatch(whole.sources, True, whole.margin)

    def _smallest(self, motion: EntityMotion, at: Geometry, band: Band | None) -> Iterator[Geometry]:
        """Yield the smallest fixed place around a placement that is always there, or else the largest one.

        A smaller place that may be absent may have been so when the entity arrived.
        """
        fixed = sorted(
            (area(self._of.geometry(name)), name)
            for name in motion.containers
            if self._of.is_fixed(name) and self._holds(name, at, band)
        )
        steady = [name for _, name in fixed if self._of.is_steady(name)]
        if fixed:
            yield self._of.geometry((steady or [name for _, name in reversed(fixed)])[0])

    def _holds(self, place: str, at: Geometry, band: Band | None) -> bool:
        levels = any(band_contains(level, band) for level in self._of.bands(place))
        return levels and contains(self._of.geometry(place), at)


@lru_cache(maxsize=MEMO)
def is_star(place: Geometry, at: Geometry) -> bool:
    """Whether every shortest line from a place to a placement in it stays in the place, to half a metre."""
    whole = source_area(place)
    frame = frame_of(whole.disc)
    shape, spots = projected(whole, frame), shapely.get_coordinates(projected(source_area(at), frame))
    corners = shapely.get_coordinates(shape)
    lines = np.stack([np.repeat(corners, len(spots), axis=0), np.tile(spots, (len(corners), 1))], axis=1)
    return bool(shapely.contains(shape.buffer(0.9 * LEAVING), shapely.multilinestrings(lines)))
