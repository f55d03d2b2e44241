"""Voyages: what has to be remembered of flights to know where things may be, and how long they still take.

P says of a vehicle in transit from where to where it was sent; of one that has arrived, the middle of a place of which
it may be anywhere. So where `timing` is given, a cell of each vehicle remembers more, and it is written after every
step that changes P (`remembering`), as the race monitor does; the rules know nothing of it.
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
from semantics.state.cells import VOYAGE, Cell, Changes
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
        origin: Where the vehicle may have been at the `command`.
        toward: What it was sent by (VIA, in order) and to.
        waypoints: Every point that it was sent to in this flight, sorted.
        hull: Where it may be: the hull of its origin and of everything that it was sent to or by. None where something
            of it drifts within a place: nothing is known. What is absent adds nothing: nobody is sent there.
    """

    origin: Extent
    toward: tuple[Name, ...]
    waypoints: tuple[Geometry, ...]
    hull: Extent | None


class Adrift(Enum):
    """Says that something was put down where its carrier had drifted within a place: P has one of many points."""

    PUT_DOWN = "put down"


Memory = Voyage | Extent | Adrift | None
"""What is remembered of a vehicle: its flight; the place in which it arrived last, as that was then; that it was put
down by what drifts within a place; or nothing."""


def memory_cell(vehicle: Name) -> Cell:
    """Address what is remembered of a vehicle."""
    return (VOYAGE, vehicle)


def remembered_at_first(setting: Setting) -> Changes:
    """Return the cells of all vehicles, as they are at first."""
    return {} if setting.timing is None else {memory_cell(name): None for name in _remembered(setting)}


def _remembered(setting: Setting) -> tuple[Name, ...]:
    """Return of whom something is remembered, sorted: who can be driven, or put down where nobody knows."""
    return tuple(sorted({*vehicles(setting), *_drifting_cargo(setting)}))


def _drifting_cargo(setting: Setting) -> Iterator[Name]:
    """Yield who may be aboard of what drifts within a place."""
    waiting, kinds = [setting.kind(each.entity) for each in _adrift(setting)], set[str]()
    while waiting:
        more = setting.signature[waiting.pop()].carries - kinds
        kinds |= more
        waiting += more
    return (name for name, kind in setting.kinds.items() if kind in kinds)


def _adrift(setting: Setting) -> Iterator[Drifts]:
    return (each for each in setting.environment if isinstance(each, Drifts) and each.within)


def vehicles(setting: Setting) -> tuple[Name, ...]:
    """Return the entities that can be driven, sorted."""
    return tuple(sorted(name for name, kind in setting.kinds.items() if setting.signature[kind].driven))


# --- where things may be --------------------------------------------------------------------------


def whereabouts(c: Configuration, entity: Name) -> Extent | None:
    """Return where an entity may be; None where nothing is known: it drifts within a place, or lies in what does.

    In transit it is anywhere in the hull of its flight, arrived anywhere in the place, as that was then; else where P
    has it. What is carried is where its outermost carrier is.
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
    """Tell whether P has an entity, and everything that carries it, at some place."""
    physical = c.structure.physical
    return physical.position(_outermost(physical, entity)) is not None


def origin(c: Configuration, vehicle: Name) -> Extent | None:
    """Return O(u), where a vehicle may be as a flight begins; None where nothing is known.

    The place in which it arrived last, as that was then, enlarged by the circle that it flies there. If it never flew,
    or drifted or appeared since, the place in which A(P) has it, else where it is by itself.
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
    """Tell whether something drifts within a place, or lies in something that does."""
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
    """Return the transition with what it changed remembered of flights, where a mission speaks of time."""
    if c.setting.timing is None or transition.label.rule not in MOVING:
        return transition
    after, driven = transition.target, vehicles(c.setting)
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
    """Return what is to be remembered of a vehicle whose placement a step has changed."""
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
    """Write of a flight all that it was sent to or by, through chains of flights."""
    flights = dict(_chain(c, vehicle))
    points = {name: waypoints(c, fly, name) for name, (fly, _) in flights.items()}
    while True:
        wider = c.with_(dict(_sent(c, flights, points)))
        if wider == c:
            return {memory_cell(vehicle): c.read(memory_cell(vehicle))} if flights else {}
        c = wider


def _chain(c: Configuration, vehicle: Name) -> Iterator[tuple[Name, tuple[FLY, tuple[Name, ...]]]]:
    """Yield a vehicle in transit with its request and what it is sent by and to, and all in transit among those."""
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
    """Yield the requests by which a vehicle is in transit."""
    for a in c.alpha.names():
        if c.test(line_cell(a), flies, vehicle):
            yield from (each for each in c.read(line_cell(a)) if flies((each,), vehicle))


def flies(line: tuple[Request, ...] | None, vehicle: Name) -> bool:
    """Ask of an agent's requests whether a vehicle flies by one of them."""
    return any(
        isinstance(each, FLY) and vehicle in dict(moved(each.reaction, each.match)) for each in line or ()
    )


def _sent(
    c: Configuration,
    flights: Mapping[Name, tuple[FLY, tuple[Name, ...]]],
    points: Mapping[Name, tuple[Geometry, ...]],
) -> Iterator[tuple[Cell, Voyage]]:
    """Yield each flight with what it is sent to or by now."""
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
    """Return who is in transit by a request, and where to."""
    physical = c.structure.physical
    pairs = moved(fly.reaction, fly.match)
    return tuple((node, place) for node, place in pairs if isinstance(physical.placement(node), InTransit))


def waypoints(c: Configuration, fly: FLY, vehicle: Name) -> tuple[Geometry, ...]:
    """Return the points to which a vehicle is sent now, as the runtime sends it; none where it can't arrive now."""
    found = commits(c, fly)
    if found is None:
        return ()
    flying = (pair for pair in found.flying if pair[0] == vehicle)
    return tuple(stop.point for pair in flying for stop in stops(c, found, *pair))


def circle(setting: Setting, vehicle: Name) -> float:
    """Return the diameter in metres of the circle that a vehicle flies where it cannot stand, else 0."""
    motion = None if setting.timing is None else setting.timing.motion(vehicle)
    return 0.0 if motion is None else motion.circle
