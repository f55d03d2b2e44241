"""The physical model P as a view over cells: placements, and σ_P = {contains, carries, connected}."""

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import takewhile
from typing import NamedTuple

from physical import Band, Geometry, PlaceIndex, area, band_contains, contains, point, share_interior
from semantics.state.cell_values import NAMES, Cell, Cells, Changes, Written, is_something
from semantics.state.signature import REGION, EntityKinds, Name
from semantics.state.views import CellView


@dataclass(frozen=True, slots=True)
class Placed:
    """A geometry on the earth, with its band of altitudes (metres) if it has one."""

    geometry: Geometry
    altitude: Band | None = None


@dataclass(frozen=True, slots=True)
class Carried:
    """Carried by another entity, at the carrier's position; `shape` is the placed form once it is put down.

    The position of a carried shape has no meaning. So the shape is normalised to its template, and a point to the
    origin.
    """

    by: Name
    shape: Placed

    def __post_init__(self) -> None:
        geometry = self.shape.geometry
        still = point(0, 0) if geometry.is_point else geometry.template or geometry
        object.__setattr__(self, "shape", Placed(still, self.shape.altitude))


@dataclass(frozen=True, slots=True)
class InTransit:
    """Commanded from `origin` to a node (`control timed`), and possibly anywhere between the two."""

    origin: Placed
    to: Name


Placement = Placed | Carried | InTransit


class Holder(NamedTuple):
    """A possible container: its area in square metres, its name, and its placement."""

    area: float
    place: Name
    at: Placed


def placement_cell(entity: Name) -> Cell:
    """Address the placement of an entity; None means that it is not in P."""
    return ("placement", entity)


def channels_cell(entity: Name) -> Cell:
    """Address the sorted channels that an entity is on."""
    return ("channels", entity)


def left_cell(entity: Name, channel: Name) -> Cell:
    """Address whether an entity is off a channel because it left (`environment.Leaves`)."""
    return ("left", entity, channel)


def down_cell(channel: Name) -> Cell:
    """Address whether a channel that may drop is down."""
    return ("down", channel)


@lru_cache(maxsize=1 << 12)  # small: in a live mission each position occurs once
def encloses(outer: Placed, inner: Placed) -> bool:
    """Whether the interior contains a placement, and its band of altitudes does too if both have one."""
    levels = band_contains(outer.altitude, inner.altitude)
    return levels and not outer.geometry.is_point and contains(outer.geometry, inner.geometry)


def is_carried(placement: Placement | None) -> bool:
    """Whether an entity is carried; a question about a cell."""
    return isinstance(placement, Carried)


def is_aboard(placement: Placement | None, carriers: frozenset[Name]) -> bool:
    """Whether an entity is carried by one of some carriers; a question about a cell."""
    return isinstance(placement, Carried) and placement.by in carriers


def is_placed(placement: Placement | None) -> bool:
    """Whether an entity is placed: neither absent, carried nor in transit; a question about a cell."""
    return isinstance(placement, Placed)


def stands_within(placement: Placement | None, at: Placed) -> bool:
    """Whether an entity is placed within a place; a question about a cell."""
    return isinstance(placement, Placed) and encloses(at, placement)


def stands_outside(placement: Placement | None, places: tuple[Placed, ...]) -> bool:
    """Whether an entity is placed within none of some places; a question about a cell."""
    return isinstance(placement, Placed) and not any(encloses(at, placement) for at in places)


class PhysicalModel(CellView):
    """P and σ_P over the cells of a configuration."""

    __slots__ = ("cells", "sorting")
    SORTS = frozenset({"placement", "channels", "down"})

    def __init__(self, cells: Cells, sorting: EntityKinds) -> None:
        self.cells = cells
        self.sorting = sorting

    def placement(self, entity: Name) -> Placement | None:
        """Return the placement of an entity, None if it has no image in P."""
        placement: Placement | None = self.cells.read(placement_cell(entity))
        return placement

    def channels(self, entity: Name) -> tuple[Name, ...]:
        """Return the channels that an entity is set to, up or down."""
        return self.cells.read(channels_cell(entity)) or ()

    def __contains__(self, entity: Name) -> bool:
        return self.cells.test(placement_cell(entity), is_something)

    def entities(self) -> tuple[Name, ...]:
        """Return dom(P), sorted."""
        return tuple(name for name in self.cells.read(NAMES) if name in self)

    def carrier(self, entity: Name) -> Name | None:
        """Return the carrier of an entity, None if nothing carries it."""
        if not self.cells.test(placement_cell(entity), is_carried):
            return None
        placement = self.placement(entity)
        return placement.by if isinstance(placement, Carried) else None

    def carriers(self, entity: Name) -> Iterator[Name]:
        """Yield the carrier of an entity, then the carrier of that, and so on."""
        by = self.carrier(entity)
        while by is not None:
            yield by
            by = self.carrier(by)

    def cargo(self, entity: Name) -> frozenset[Name]:
        """Return all cargo of an entity, at any depth."""
        aboard, names = frozenset({entity}), self.cells.read(NAMES)
        while more := {name for name in names if name not in aboard and self._is_aboard(name, aboard)}:
            aboard |= more
        return aboard - {entity}

    def _is_aboard(self, entity: Name, carriers: frozenset[Name]) -> bool:
        return self.cells.test(placement_cell(entity), is_aboard, carriers)

    def position(self, entity: Name) -> Placed | None:
        """Return the position of an entity: that of its outermost carrier, or that before its takeoff."""
        placement = self.placement(entity)
        while isinstance(placement, Carried):
            placement = self.placement(placement.by)
        return placement.origin if isinstance(placement, InTransit) else placement

    def going_to(self, entity: Name) -> Name:
        """Return the destination of an entity in transit; empty otherwise."""
        placement = self.placement(entity)
        return placement.to if isinstance(placement, InTransit) else ""

    def transit(self, entity: Name) -> InTransit | None:
        """Return the flight of an entity, or of its carrier."""
        placement = self.placement(entity)
        while isinstance(placement, Carried):
            placement = self.placement(placement.by)
        return placement if isinstance(placement, InTransit) else None

    def contains(self, place: Name, entity: Name) -> bool:
        """Whether σ_P has the pair `contains(place, entity)`.

        A place contains an entity in transit only if it contains both ends of the flight; the destination itself does
        not, so no agent sees the entity arrive early. A carried entity contains nothing, since it has no area of its
        own.
        """
        at = None if place == entity else self._standing(place)
        return at is not None and self._is_within(entity)(place, at)

    def _is_within(self, entity: Name) -> Callable[[Name, Placed], bool]:
        """Return the predicate that decides whether a place with a placement contains an entity."""
        inner, flight = self.position(entity), self.transit(entity)
        destination = None if flight is None or flight.to == REGION else self.position(flight.to)

        def is_within(place: Name, at: Placed) -> bool:
            if inner is None or not encloses(at, inner):
                return False
            return flight is None or (
                place != flight.to and destination is not None and encloses(at, destination)
            )

        return is_within

    def carries(self, carrier: Name, entity: Name) -> bool:
        """Whether σ_P has the pair `carries(carrier, entity)`."""
        return self._is_aboard(entity, frozenset({carrier}))

    def connected(self, channel: Name, entity: Name) -> bool:
        """Whether σ_P has `connected(channel, entity)`: the entity is present and on the channel, which is up."""
        return channel in self.channels(entity) and not self.is_down(channel) and entity in self

    def is_down(self, channel: Name) -> bool:
        """Whether a channel that may drop has dropped."""
        return bool(self.cells.read(down_cell(channel)))

    def abstract_parent(self, entity: Name) -> Name:
        """Return the parent of an entity in A(P) (paper, 3.2.2): its carrier, else the smallest total container."""
        by = self.carrier(entity)
        if by is not None:
            return by
        holders = self.holders(entity)
        if not holders:
            return REGION
        is_within = self._is_within(entity)
        return next((place for _, place, at in holders if is_within(place, at)), REGION)

    def abstract_parents(self) -> dict[Name, Name]:
        """Return the parents in A(P) of all present entities; a spatial index finds the places near each."""
        entities = self.entities()
        standing = ((name, self._standing(name)) for name in entities)
        places = {name: at for name, at in standing if at is not None and not at.geometry.is_point}
        index = PlaceIndex({name: at.geometry for name, at in places.items()})
        containers = cache(lambda kind: frozenset(self.sorting.containers(kind)))
        return {name: self._parent_among(name, places, index, containers) for name in entities}

    def _parent_among(
        self,
        entity: Name,
        places: Mapping[Name, Placed],
        index: PlaceIndex,
        containers: Callable[[Name], frozenset[Name]],
    ) -> Name:
        """Return the result of `abstract_parent`, given the places with an area of their own."""
        if (by := self.carrier(entity)) is not None:
            return by
        inner = self.position(entity)
        allowed, is_within = containers(self.sorting.kind(entity)), self._is_within(entity)
        near = () if inner is None else index.near(inner.geometry)
        around = (
            name for name in near if name != entity and name in allowed and is_within(name, places[name])
        )
        return min(around, key=lambda name: (measure(places[name].geometry), name), default=REGION)

    def is_in(self, entity: Name, place: Name) -> bool:
        """Whether an entity's parent in A(P) is a place; the entity's placement is tested, not read."""
        where = placement_cell(entity)
        if place != REGION and place not in self.sorting.containers(self.sorting.kind(entity)):
            return self.carries(place, entity)
        if not self.cells.test(where, is_placed):
            return entity in self and self.abstract_parent(entity) == place
        at = None if place in (REGION, entity) else self._standing(place)
        if place != REGION and (at is None or not self.cells.test(where, stands_within, at)):
            return False  # most places: no other holder has to be examined
        return self.cells.test(where, stands_outside, self.before(entity, place, at))

    def _standing(self, place: Name) -> Placed | None:
        """Return the placement of a place with an area of its own; a carried place has none."""
        match self.placement(place):
            case Carried():
                return None
            case InTransit(origin=origin):
                return origin
            case placement:
                return placement

    def before(self, entity: Name, place: Name, at: Placed | None) -> tuple[Placed, ...]:
        """Return the placements of smaller holders, which A(P) tries before a place; only those overlapping `at`."""
        smaller = (
            each for _, _, each in takewhile(lambda holder: holder.place != place, self.holders(entity))
        )
        return tuple(each for each in smaller if at is None or share_interior(each.geometry, at.geometry))

    def holders(self, entity: Name) -> tuple[Holder, ...]:
        """Return the possible containers of an entity, in the order of A(P): by area, then by name.

        A carried entity contains nothing.
        """
        places = self.sorting.containers(self.sorting.kind(entity))
        standing = [(place, self._standing(place)) for place in places if place != entity]
        found = (Holder(measure(at.geometry), place, at) for place, at in standing if at is not None)
        return tuple(sorted(found, key=lambda holder: holder[:2]))

    def children(self, place: Name) -> tuple[Name, ...]:
        """Return the children of a place, or of the region, in A(P), sorted."""
        return tuple(name for name in self.cells.read(NAMES) if self.is_in(name, place))

    def links(self, entity: Name) -> tuple[Name, ...]:
        """Return the links of an entity in A(P), sorted."""
        return tuple(channel for channel in self.channels(entity) if self.connected(channel, entity))

    def points(self, channel: Name) -> tuple[Name, ...]:
        """Return the entities on a link of A(P), sorted."""
        return tuple(name for name in self.cells.read(NAMES) if self.connected(channel, name))

    def without(self, entities: Collection[Name]) -> "PhysicalModel":
        """Return P without some entities and their cargo."""
        gone = frozenset(entities).union(*map(self.cargo, entities))
        return PhysicalModel(Written(self.cells, {placement_cell(each): None for each in gone}), self.sorting)

    def placing(self, entity: Name, placement: Placement | None) -> Changes:
        """Return the writes of P[entity ↦ placement]."""
        return {placement_cell(entity): placement}

    def joining(self, entity: Name, channels: frozenset[Name]) -> Changes:
        """Return the writes of an entity's channels; a channel that it joins is no longer one that it has left."""
        joined = sorted(channels.difference(self.channels(entity)))
        back = {left_cell(entity, each): False for each in joined if self.cells.read(left_cell(entity, each))}
        return {channels_cell(entity): tuple(sorted(channels))} | back


@lru_cache(maxsize=1 << 14)
def measure(geometry: Geometry) -> float:
    """Return the area of a geometry in square metres."""
    return area(geometry)
