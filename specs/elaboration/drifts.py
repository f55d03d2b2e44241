"""Drifts: among listed placements, and within a place by its finite quotient."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from physical import DriftWithin, Geometry, PhysicalError, band_contains, drift_faces, face_at
from physical.placement import still
from semantics.environment import Drifts
from semantics.fixpoints import closure
from semantics.state.physical_model import Carried, Placed
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.geometry import elaborate_placement, moved_to
from specs.elaboration.mission_mistakes import shorten
from specs.elaboration.mobility import Mobility, moves
from specs.elaboration.names import Names
from specs.elaboration.world import InitialWorld

LIST_THEM: Final = "list its placements: drifts among ..."


@dataclass(slots=True)
class Spots:
    """Elaborates written placements, and names of places, to placements of an entity."""

    names: Names
    world: InitialWorld

    def placed(self, spot: s.Placement | s.Name, entity: str) -> Placed | None:
        """Return the placement; for a named place or a point, it is the entity's shape centred there."""
        shape = self.world.shape(entity)
        if isinstance(spot, s.Placement):
            placed = elaborate_placement(spot, self.names.findings)
            if placed is None or shape is None:
                return placed
            altitude = placed.altitude or shape.altitude
            translated = placed.geometry.is_point and not shape.geometry.is_point
            geometry = self._translated(shape, placed.geometry, spot) if translated else placed.geometry
            return None if geometry is None else Placed(geometry, altitude)
        if self.names.entity(spot) is None:
            return None
        place = self.world.position(spot.text)
        if place is None:
            if spot.text in self.world.absent:
                message = f"'{spot.text}' is absent at first, so it has no centre"
                self.names.findings.add(Code.NO_WHEREABOUTS, spot, message, "write the placement out")
            return None
        geometry = self._translated(shape, place.geometry, spot)
        return None if geometry is None else Placed(geometry, shape.altitude if shape else None)

    def _translated(self, shape: Placed | None, to: Geometry, where: s.Node) -> Geometry | None:
        try:
            return moved_to(shape, to).geometry
        except PhysicalError as error:
            self.names.findings.add(Code.BAD_GEOMETRY, where, error.message, error.hint)
            return None

    def check_different(self, spots: Sequence[s.Node], placements: Sequence[object]) -> None:
        """Report placements that are listed twice."""
        seen: set[object] = set()
        for spot, placement in zip(spots, placements, strict=True):
            if placement is not None and placement in seen:
                hint = "leave one of the two out"
                self.names.findings.add(Code.SAME_PLACEMENT, spot, "this placement is listed before", hint)
            seen.add(placement)

    def called(self, spot: s.Node) -> str:
        """Return the name of a placement: its text."""
        text = self.names.findings.source.text[spot.span.start : spot.span.end]
        return shorten(" ".join(text.split()))


def drifts_among(clause: s.DriftsAmong, spots: Spots) -> Drifts | None:
    """Return the drift among listed placements, from each to every other."""
    spots.names.entity(clause.entity)
    placements = [spots.placed(spot, clause.entity.text) for spot in clause.placements]
    spots.check_different(clause.placements, placements)
    found = tuple(placement for placement in placements if placement is not None)
    every = tuple(range(len(found)))
    others = tuple(tuple(to for to in every if to != at) for at in every)
    called = tuple(map(spots.called, clause.placements))
    return Drifts(clause.entity.text, found, called, others, every) if len(found) == len(placements) else None


def drifts_within(
    clause: s.DriftsWithin, spots: Spots, mobility: Mobility, clauses: Sequence[s.EnvironmentClause]
) -> Drifts | None:
    """Return the drift within a place by its faces; reports one that is not exact."""
    names, world = spots.names, spots.world
    if None in (names.entity(clause.entity), names.entity(clause.place)):
        return None
    reason = _inexact(clause, spots, mobility, clauses)
    if reason:
        names.findings.add(Code.INEXACT_DRIFT, clause, reason, LIST_THEM)
        return None
    here, within = world.placements.get(clause.entity.text), world.placements.get(clause.place.text)
    if not isinstance(here, Placed) or not isinstance(within, Placed):
        return None
    places, aboard = _arrangement(clause.entity.text, here, spots, mobility, clauses)
    try:
        faces = drift_faces(here.geometry, within.geometry, places, aboard)
        at = face_at(here.geometry, within.geometry, places, aboard)
    except PhysicalError as error:
        names.findings.add(Code.INEXACT_DRIFT, clause, error.message, error.hint or LIST_THEM)
        return None
    if at is None:
        message = f"'{clause.entity.text}' is not within '{clause.place.text}' at first"
        names.findings.add(Code.INEXACT_DRIFT, clause.place, message, "put it there, or choose another place")
        return None
    world.notes.append(f"borders are left out of the drift of {clause.entity.text}")
    placements = tuple(Placed(face.representative, here.altitude) for face in faces)
    called = tuple(_face(clause.place.text, face.relations) for face in faces)
    following = tuple(face.adjacent for face in faces)
    arrangement = DriftWithin(here.geometry, within.geometry, places, aboard)
    first = faces[at].adjacent
    return Drifts(clause.entity.text, placements, called, following, first, True, arrangement)


def _face(within: str, relations: tuple[tuple[str, ...], ...]) -> str:
    around = dict.fromkeys(name for inside in relations for name in inside)
    return " and ".join([f"somewhere in {within}", *(name for name in around if name != within)])


def _inexact(
    clause: s.DriftsWithin, spots: Spots, mobility: Mobility, clauses: Sequence[s.EnvironmentClause]
) -> str:
    """Return why a drift within a place is not exact; empty if it is."""
    names, world = spots.names, spots.world
    entity, place = clause.entity.text, clause.place.text
    here, within, kind = world.placements.get(entity), world.placements.get(place), names.kinds[entity]
    if not isinstance(here, Placed):
        return f"'{entity}' is {'carried' if isinstance(here, Carried) else 'absent'} at first"
    if entity in mobility.coming and any(
        isinstance(c, s.Appears) and c.entity.text == entity for c in clauses
    ):
        return f"'{entity}' also appears elsewhere"
    if names.signature[kind].driven:
        return f"'{entity}' is not only drifting: its kind {kind} is driven"
    if not isinstance(within, Placed) or within.geometry.is_point:
        return f"'{place}' is no place with a border that is there at first"
    if moves(place, names, mobility):
        return f"'{place}' may move itself"
    inside = _contents(entity, names)
    if inside and not here.geometry.is_point:
        return f"'{entity}' may itself contain '{inside[0]}'"
    swallowing = _roaming(entity, spots, mobility, clauses)
    if swallowing:
        return f"'{swallowing}', which may contain it, moves too"
    return next(
        filter(None, (_inexact_aboard(o, spots, mobility, clauses) for o in _cargo(entity, names, mobility))),
        "",
    )


def _inexact_aboard(
    other: str, spots: Spots, mobility: Mobility, clauses: Sequence[s.EnvironmentClause]
) -> str:
    """Return why the placements of cargo unloaded from the drifting carrier are not exact; empty if they are."""
    inside = _contents(other, spots.names)
    if inside and any(not shape.geometry.is_point for shape in _shapes(other, spots, clauses)):
        return f"'{other}', which it may carry, may contain '{inside[0]}' once it is put down"
    swallowing = _roaming(other, spots, mobility, clauses)
    return f"'{swallowing}', which may contain '{other}' from aboard, moves too" if swallowing else ""


def _contents(entity: str, names: Names) -> list[str]:
    """Return the entities that may be in an entity, except its cargo."""
    contains = names.signature[names.kinds[entity]].contains
    return [name for name, kind in sorted(names.kinds.items()) if kind in contains and name != entity]


def _containers(entity: str, names: Names) -> list[str]:
    kind = names.kinds[entity]
    return [
        name
        for name, of in sorted(names.kinds.items())
        if kind in names.signature[of].contains and name != entity
    ]


def _cargo(entity: str, names: Names, mobility: Mobility) -> list[str]:
    """Return the entities that may ever be aboard an entity, at any depth, or on their way to it."""
    signature = names.signature
    aboard = closure(signature[names.kinds[entity]].carries, lambda kind: signature[kind].carries)
    return [
        name
        for name, kind in sorted(names.kinds.items())
        if kind in aboard and name != entity and (names.signature[kind].driven or name in mobility.carried)
    ]


def _shapes(entity: str, spots: Spots, clauses: Sequence[s.EnvironmentClause]) -> set[Placed]:
    """Return all possible shapes of an entity, regardless of position."""
    shapes = {spots.world.shape(entity), *(placed for _, placed in _listed(entity, spots, clauses))}
    return {Placed(still(each.geometry), each.altitude) for each in shapes if each is not None}


def _roaming(
    entity: str, spots: Spots, mobility: Mobility, clauses: Sequence[s.EnvironmentClause]
) -> str | None:
    """Return a polygon that may contain an entity and may be at an unlisted placement; None if there is none."""
    return next((o for o in _containers(entity, spots.names) if _roams(o, spots, mobility, clauses)), None)


def _roams(name: str, spots: Spots, mobility: Mobility, clauses: Sequence[s.EnvironmentClause]) -> bool:
    """Whether a polygon may be at an unlisted placement."""
    shape = spots.world.shape(name)
    if shape is not None and shape.geometry.is_point and name not in mobility.drifting | mobility.coming:
        return False
    within = any(isinstance(clause, s.DriftsWithin) and clause.entity.text == name for clause in clauses)
    return within or spots.names.signature[spots.names.kinds[name]].driven or name in mobility.carried


Polygons = dict[str, Geometry]


def _arrangement(
    entity: str,
    here: Placed,
    spots: Spots,
    mobility: Mobility,
    clauses: Sequence[s.EnvironmentClause],
) -> tuple[Polygons, dict[Geometry, Polygons]]:
    """Return all polygons that may ever contain an entity, or another one at its position.

    Cargo, and an entity that flies to it, is at the entity's position. Once it is put down, it stands there in its
    own shape.
    """
    own, aboard = _around(entity, here, spots, clauses), dict[Geometry, Polygons]()
    for other in _cargo(entity, spots.names, mobility):
        own |= _around(other, here, spots, clauses)
        for shape in _shapes(other, spots, clauses):
            aboard.setdefault(shape.geometry, {}).update(_around(other, shape, spots, clauses))
    return own, aboard


def _around(entity: str, here: Placed, spots: Spots, clauses: Sequence[s.EnvironmentClause]) -> Polygons:
    """Return all polygons that may ever contain an entity, at their initial and their listed placements."""
    return {
        called: placed.geometry
        for name in _containers(entity, spots.names)
        for called, placed in [(name, spots.world.placements.get(name)), *_listed(name, spots, clauses)]
        if isinstance(placed, Placed)
        and not placed.geometry.is_point
        and band_contains(placed.altitude, here.altitude)
    }


def _listed(
    entity: str, spots: Spots, clauses: Sequence[s.EnvironmentClause]
) -> Iterator[tuple[str, Placed | None]]:
    """Yield the listed placements of an entity, with their names."""
    for clause in clauses:
        if isinstance(clause, s.DriftsAmong | s.Appears) and clause.entity.text == entity:
            for number, spot in enumerate(clause.placements, 1):
                yield f"{entity} ({number})", spots.placed(spot, entity)
