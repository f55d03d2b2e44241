"""Places and entities: their positions in P, their sightings, and their parents in L and in P."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import lru_cache
from typing import Any, Final, NamedTuple

from adapters.console.console_view import Json
from adapters.console.facts import Facts, Position, SeenEntity, Shape
from physical import Geometry
from physical.frame import E7
from semantics.state.canonical import written
from semantics.state.cell_values import Cell, Cells, Edit, Part, Question
from semantics.state.configuration import Configuration
from semantics.state.physical_model import InTransit, PhysicalModel, Placed
from semantics.state.signature import Name


class Whereabouts(NamedTuple):
    """The parents of a node in L (believed) and in A(P) (actual); None where it has no parent."""

    believed: Name | None
    actual: Name | None

    @property
    def differs(self) -> bool:
        """Whether L and P disagree."""
        return self.believed != self.actual


UNKNOWN = Whereabouts(None, None)


class _Reading:
    """A reader of cells that records the cells read."""

    def __init__(self, cells: Cells) -> None:
        self._cells = cells
        self.cells: set[Cell] = set()

    def read(self, cell: Cell) -> Any:
        """Return the value of a cell."""
        self.cells.add(cell)
        return self._cells.read(cell)

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Ask one question of a cell."""
        return bool(self.ask(cell, question, *constants))

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Ask one question of a cell."""
        return question(self.read(cell), *constants)

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return a cell's value after an edit."""
        return edit(self.read(cell), *constants)

    def each(self, names: Iterable[str], part: Callable[[str], Part]) -> Mapping[str, Part]:
        """Return the value of a pointwise definition for each name."""
        return {name: part(name) for name in names}


class _Parents:
    """The parents in A(P), cached: a parent is computed anew only if a cell that it was read from has changed."""

    def __init__(self) -> None:
        self._before: Configuration | None = None
        self._known: dict[Name, tuple[Name, set[Cell]]] = {}

    def of(self, c: Configuration) -> Mapping[Name, Name]:
        """Return the parent of each entity of P."""
        before, known = self._before, self._known
        if before is None or before.setting is not c.setting:
            before, known = c, {}
        changed = written(before, c).keys() | written(c, before).keys()
        names = c.structure.physical.entities()
        kept = {name: known[name] for name in names if name in known and changed.isdisjoint(known[name][1])}
        self._before, self._known = c, {name: kept.get(name) or _parent(c, name) for name in names}
        return {name: parent for name, (parent, _) in self._known.items()}


def _parent(c: Configuration, name: Name) -> tuple[Name, set[Cell]]:
    """Return the parent of an entity in A(P), and the cells that it was read from."""
    reading = _Reading(c.state)
    return PhysicalModel(reading, c.setting).abstract_parent(name), reading.cells


_PARENTS: Final = _Parents()


@lru_cache(maxsize=256)
def whereabouts(c: Configuration) -> Mapping[Name, Whereabouts]:
    """Return the parents of each node of L or P."""
    logical, actual = c.structure.logical, _PARENTS.of(c)
    believed = {name: logical.parent(name) for name in logical.nodes()}
    names = sorted(believed.keys() | actual.keys())
    return {name: Whereabouts(believed.get(name), actual.get(name)) for name in names}


def known_whereabouts(facts: Facts) -> Mapping[Name, Whereabouts]:
    """Return the parents of each node; empty if the run's steps cannot be replayed."""
    return {} if facts.standing is None else whereabouts(facts.standing.change.after)


# --- places -------------------------------------------------------------------------------------------


def places(facts: Facts) -> dict[str, Json]:
    """Return the section `places`: entities with an area, and entities that never move."""
    found = dict(_sighted_places(facts))
    if facts.standing is not None:
        found |= places_of(facts.standing.change.after, facts.standing.rules.fixed, _vehicles(facts))
    return found


def _sighted_places(facts: Facts) -> Iterator[tuple[str, Json]]:
    """Yield the sighted areas that the mission does not name; all of them if the steps cannot be replayed."""
    kinds = {} if facts.standing is None else facts.standing.configuration.setting.kinds
    vehicles = _vehicles(facts)
    for name, shape in facts.shapes.items():
        if name not in kinds and name not in vehicles:
            yield name, _place(shape, UNKNOWN)


@lru_cache(maxsize=256)
def places_of(c: Configuration, fixed: frozenset[Name], vehicles: frozenset[Name]) -> Mapping[str, Json]:
    """Return the section `places` of a configuration: entities with an area, and those that never move."""
    where = whereabouts(c)
    placed = ((name, c.structure.physical.placement(name)) for name in c.structure.physical.entities())
    return {
        name: _place(_shape(c.setting.kind(name), at), where[name])
        for name, at in placed
        if isinstance(at, Placed) and name not in vehicles and (name in fixed or not at.geometry.is_point)
    }


def _shape(kind: str, at: Placed) -> Shape:
    band = None if at.altitude is None else (at.altitude.low, at.altitude.high)
    return Shape(kind, degrees(at.geometry), band)


@lru_cache(maxsize=1 << 12)
def degrees(geometry: Geometry) -> tuple[Position, ...]:
    """Return the corners of a geometry in degrees."""
    return tuple((north / E7, east / E7) for north, east in geometry.ring)


def _place(shape: Shape, where: Whereabouts) -> Json:
    return {
        "kind": shape.kind,
        "ring": shape.ring,
        "parent": where.actual,
        "altitude": shape.altitude,
        "differs": where.differs,
    }


def _vehicles(facts: Facts) -> frozenset[Name]:
    return frozenset() if facts.run is None else frozenset(facts.run.vehicles)


# --- entities -----------------------------------------------------------------------------------------


def entities(facts: Facts, now: float, shown: Mapping[str, Json]) -> dict[str, Json]:
    """Return the section `entities`: entities with one position, except the places in `shown`."""
    where, vehicles = known_whereabouts(facts), _vehicles(facts)
    named = facts.standing.rules.initial.setting.kinds if facts.standing is not None else {}
    found = {
        name: entity_of(seen, where.get(name, UNKNOWN), name in named, name in vehicles)
        for name, seen in facts.seen.items()
        if name not in shown and (seen.until >= now or name in named or name in vehicles)
    }
    for name, (kind, at) in _unheard(facts):
        if name not in shown and name not in found:
            silent = SeenEntity(kind, at, None, None, 0.0, 0.0, "", ())
            entity = entity_of(silent, where.get(name, UNKNOWN), name in named, name in vehicles)
            found[name] = {**entity, "seen": None, "source": None}
    return found


@lru_cache(maxsize=1 << 13)  # most entities have not moved since the last view
def entity_of(seen: SeenEntity, where: Whereabouts, named: bool, vehicle: bool) -> dict[str, Json]:
    """Return an entity of the section `entities`."""
    return {
        "kind": seen.kind,
        "at": seen.at,
        "course": seen.course,
        "speed": seen.speed,
        "seen": seen.time,
        "believed": where.believed,
        "actual": where.actual,
        "differs": where.differs,
        "named": named,
        "vehicle": vehicle,
        "source": seen.source,
    }


def _unheard(facts: Facts) -> Iterator[tuple[Name, tuple[str, Position]]]:
    """Yield the kind and the position of each entity that P places at a point; the caller drops the sighted ones."""
    if facts.standing is not None:
        yield from positions_of(facts.standing.change.after).items()


@lru_cache(maxsize=256)
def positions_of(c: Configuration) -> Mapping[Name, tuple[str, Position]]:
    """Return the kind and the position of each entity that P places at a point."""
    found = {}
    for name in c.structure.physical.entities():
        at = c.structure.physical.position(name)
        if at is not None:
            north, east = at.geometry.ring[0]
            found[name] = (c.setting.kind(name), (north / E7, east / E7))
    return found


def destination(facts: Facts, name: Name) -> Name | None:
    """Return the destination of an entity in transit, of any station's order; None if it is not in transit.

    L keeps the entity at its old place until it arrives.
    """
    physical = None if facts.standing is None else facts.standing.configuration.structure.physical
    placement = None if physical is None else physical.placement(name)
    return placement.to if isinstance(placement, InTransit) else None
