"""The history of flights: it bounds the positions of vehicles and the remaining duration of flights.

For a vehicle in transit, P only has its origin and destination. For one that has arrived, P has the middle of a place,
although it may be anywhere in that place. With a `timing` section, a cell of each vehicle therefore remembers more.
`remembering` writes it after every step that changes P, as the race monitor does; the rules do not know it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from functools import partial
from typing import Final

from physical import Geometry
from physical.extents import Extent, extent, span
from semantics.behaviours.reaction_rules import moved
from semantics.brr_driver import stops
from semantics.control import commits
from semantics.environment import Drifts
from semantics.fixpoints import closure
from semantics.regions.possible_moves import may_move
from semantics.state.cell_values import VOYAGE, Cell, Changes
from semantics.state.configuration import Configuration, Transition
from semantics.state.eta import line_cell
from semantics.state.physical_model import Carried, InTransit, PhysicalModel, Placed, placement_cell
from semantics.state.requests import FLY, Request
from semantics.state.setting import Setting
from semantics.state.signature import REGION, Name

MOVING: Final = frozenset({"actuate", "command", "commit", "env"})
"""The rules that change P."""


@dataclass(frozen=True, slots=True)
class Voyage:
    """A flight under way, from its `command` on.

    Attributes:
        origin: The possible positions of the vehicle at the `command`.
        toward: Its current targets: the VIA in order, then the destination.
        waypoints: Every point that it was sent to in this flight, sorted.
        hull: Its possible positions: the hull of its origin and of all its targets so far. None (unknown) if one of
            them drifts within a place. Absent targets add nothing, since no vehicle is sent there.
    """

    origin: Extent
    toward: tuple[Name, ...]
    waypoints: tuple[Geometry, ...]
    hull: Extent | None


class Adrift(Enum):
    """Marks cargo put down by a carrier that drifts within a place: P has one of many possible points."""

    PUT_DOWN = "put down"


Memory = Voyage | Extent | Adrift | None
"""The memory of a vehicle: its flight, the area of its last arrival at that time, a carrier's drift, or None.

`Adrift` means that a carrier that drifts within a place has put it down.
"""


def memory_cell(vehicle: Name) -> Cell:
    """Address the memory of a vehicle."""
    return (VOYAGE, vehicle)


def remembered_at_first(setting: Setting) -> Changes:
    """Return the initial memory cells of all vehicles."""
    return {} if setting.timing is None else {memory_cell(name): None for name in _remembered(setting)}


def _remembered(setting: Setting) -> tuple[Name, ...]:
    """Return the entities with a memory, sorted: those that can be driven, or put down at an unknown position."""
    return tuple(sorted({*setting.driven(), *_drifting_cargo(setting)}))


def _drifting_cargo(setting: Setting) -> Iterator[Name]:
    """Yield the entities that may be aboard an entity that drifts within a place."""
    drifting = {setting.kind(each.entity) for each in _adrift(setting)}
    first = (cargo for kind in drifting for cargo in setting.signature[kind].carries)
    kinds = closure(first, lambda kind: setting.signature[kind].carries)
    return (name for name, kind in setting.kinds.items() if kind in kinds)


def _adrift(setting: Setting) -> Iterator[Drifts]:
    return (each for each in setting.environment if isinstance(each, Drifts) and each.within)


# --- possible positions ---------------------------------------------------------------------------


def whereabouts(c: Configuration, entity: Name) -> Extent | None:
    """Return the possible positions of an entity; None if it, or an entity around it, drifts within a place.

    In transit, it is anywhere in the hull of its flight. After arrival, it is anywhere in the place as that was then.
    Otherwise it is at its position in P. Cargo is at the position of its outermost carrier.
    """
    physical = c.structure.physical
    bearer = _outermost(physical, entity)
    kept: Memory = c.read(memory_cell(bearer))
    if isinstance(kept, Voyage):
        return kept.hull
    at = physical.position(bearer)
    if at is None or isinstance(kept, Adrift) or _is_adrift(c, bearer):
        return None
    return kept or extent(at.geometry)


def is_there(c: Configuration, entity: Name) -> bool:
    """Whether P has a position for an entity's outermost carrier, or for the entity itself if nothing carries it."""
    physical = c.structure.physical
    return physical.position(_outermost(physical, entity)) is not None


def origin(c: Configuration, vehicle: Name) -> Extent | None:
    """Return O(u), the possible positions of a vehicle at the beginning of a flight; None if unknown.

    They are the place of its last arrival, as that was then, enlarged by the circle that the vehicle flies there. If it
    never flew, or drifted or appeared since, they are its parent in A(P), or in the region its own position.
    """
    physical = c.structure.physical
    if physical.carrier(vehicle) is not None:
        return whereabouts(c, vehicle)
    kept: Memory = c.read(memory_cell(vehicle))
    if isinstance(kept, Voyage):
        return kept.origin
    if _is_adrift(c, vehicle):
        return None
    if isinstance(kept, Extent):
        return kept
    parent = physical.abstract_parent(vehicle)
    if kept is Adrift.PUT_DOWN and parent == REGION:
        return None
    at = physical.position(vehicle if parent == REGION else parent)
    return None if at is None else extent(at.geometry)


def _outermost(physical: PhysicalModel, entity: Name) -> Name:
    bearer = entity
    for bearer in physical.carriers(entity):  # noqa: B007 - the last
        pass
    return bearer


def _is_adrift(c: Configuration, entity: Name) -> bool:
    """Whether an entity, or one around it, drifts within a place."""
    adrift = {each.entity for each in _adrift(c.setting)}
    around, seen = entity, set[Name]()
    while around != REGION and around not in seen and adrift:
        if around in adrift:
            return True
        seen.add(around)
        around = c.structure.physical.abstract_parent(around)
    return False


# --- remembering ----------------------------------------------------------------------------------


def remembering(c: Configuration, transition: Transition) -> Transition:
    """Return the transition with the memory of flights updated, if the mission has a `timing` section."""
    if c.setting.timing is None or transition.label.rule not in MOVING:
        return transition
    after, driven = transition.target, c.setting.driven()
    written = {cell[1] for cell in after.state.changed(c.state) if cell[0] == "placement"}
    changed = {
        name for name in sorted(written) if after.read(placement_cell(name)) != c.read(placement_cell(name))
    }
    if not changed:
        return transition
    begun = {name: _memory(c, after, name) for name in _remembered(c.setting) if name in changed}
    after = after.with_({memory_cell(name): kept for name, kept in begun.items()})
    return replace(transition, target=after.with_each(after.each(driven, partial(_widened, after))))


def _memory(c: Configuration, after: Configuration, vehicle: Name) -> Memory:
    """Return the new memory of a vehicle whose placement a step has changed."""
    before, now = c.structure.physical.placement(vehicle), after.structure.physical.placement(vehicle)
    if isinstance(now, InTransit):
        begin = origin(c, vehicle)
        return None if begin is None else Voyage(begin, (), (), begin)
    if isinstance(before, InTransit) and not isinstance(now, Carried):
        place = after.structure.physical.position(before.to)
        return None if place is None else extent(place.geometry, circle(c.setting, vehicle))
    if isinstance(before, Carried) and isinstance(now, Placed) and whereabouts(c, vehicle) is None:
        return Adrift.PUT_DOWN
    return None


def _widened(c: Configuration, vehicle: Name) -> Changes:
    """Return the writes that widen a flight's hull by all its targets, through chains of flights."""
    flights = dict(_chain(c, vehicle))
    points = {name: waypoints(c, fly, name) for name, (fly, _) in flights.items()}
    while True:
        wider = c.with_(dict(_sent(c, flights, points)))
        if wider == c:
            return {memory_cell(vehicle): c.read(memory_cell(vehicle))} if flights else {}
        c = wider


def _chain(c: Configuration, vehicle: Name) -> Iterator[tuple[Name, tuple[FLY, tuple[Name, ...]]]]:
    """Yield a vehicle in transit with its request and its targets, then all vehicles in transit among those targets."""
    physical, waiting, seen = c.structure.physical, [vehicle], set[Name]()
    while waiting:
        name = waiting.pop()
        if name in seen or not isinstance(physical.placement(name), InTransit):
            continue
        seen.add(name)
        for fly in _flights_of(c, name):
            for node, place in travelling(c, fly):
                if node == name:
                    toward = (*fly.reaction.via, place)
                    yield name, (fly, toward)
                    waiting += [_outermost(physical, each) for each in toward]


def _flights_of(c: Configuration, vehicle: Name) -> Iterator[FLY]:
    """Yield the requests by which a vehicle is in transit; only lines that may have some are read."""
    for a in c.alpha.names():
        if may_move(c.setting, a, vehicle) and c.test(line_cell(a), flies, vehicle):
            yield from (each for each in c.read(line_cell(a)) if flies((each,), vehicle))


def flies(line: tuple[Request, ...] | None, vehicle: Name) -> bool:
    """Whether a vehicle flies by one of an agent's requests; a question about a cell."""
    return any(
        isinstance(each, FLY) and vehicle in dict(moved(each.reaction, each.match)) for each in line or ()
    )


def _sent(
    c: Configuration,
    flights: Mapping[Name, tuple[FLY, tuple[Name, ...]]],
    points: Mapping[Name, tuple[Geometry, ...]],
) -> Iterator[tuple[Cell, Voyage]]:
    """Yield each flight, widened by its current targets."""
    for name, (_, toward) in flights.items():
        kept: Memory = c.read(memory_cell(name))
        if isinstance(kept, Voyage):
            where = [whereabouts(c, each) for each in toward if is_there(c, each)]
            sent_to = tuple(sorted({*kept.waypoints, *points[name]}))
            yield memory_cell(name), Voyage(kept.origin, toward, sent_to, _hull([kept.hull, *where]))


def _hull(extents: Iterable[Extent | None]) -> Extent | None:
    known = list(extents)
    return None if None in known else span(each for each in known if each is not None)


def travelling(c: Configuration, fly: FLY) -> tuple[tuple[Name, Name], ...]:
    """Return the nodes in transit by a request, with their destinations."""
    physical = c.structure.physical
    pairs = moved(fly.reaction, fly.match)
    return tuple((node, place) for node, place in pairs if isinstance(physical.placement(node), InTransit))


def waypoints(c: Configuration, fly: FLY, vehicle: Name) -> tuple[Geometry, ...]:
    """Return the current waypoints of a vehicle, those that the runtime sends it to; empty if it can't arrive now."""
    found = commits(c, fly)
    if found is None:
        return ()
    flying = (pair for pair in found.flying if pair[0] == vehicle)
    return tuple(stop.point for pair in flying for stop in stops(c, found, *pair))


def circle(setting: Setting, vehicle: Name) -> float:
    """Return the diameter in metres of the circle that a vehicle flies if it cannot hover, else 0."""
    motion = None if setting.timing is None else setting.timing.motion(vehicle)
    return 0.0 if motion is None else motion.circle
