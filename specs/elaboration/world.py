"""The world phase: entities, their placements, carriers and channels."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from physical import centroid, point
from semantics.state.physical_model import Carried, Placed, Placement
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.geometry import elaborate_placement
from specs.elaboration.mission_mistakes import a
from specs.elaboration.names import Names
from specs.elaboration.world_files import Library, read_source

MOST_ENTITIES: Final = 2_000
MOST_PAIRS: Final = 1_200_000
"""The largest number of pairs of a place and an entity."""

_NOWHERE: Final = point(0, 0)


@dataclass(slots=True)
class InitialWorld:
    """The initial P, and the facts about absent entities.

    Attributes:
        placements: The placement of each present entity.
        channels: The channels of each entity, whether present or absent.
        absent: Entities that are declared and absent at first.
        notes: Notes on the world that accompany every verdict.
    """

    placements: dict[str, Placement] = field(default_factory=dict)
    channels: dict[str, tuple[str, ...]] = field(default_factory=dict)
    absent: set[str] = field(default_factory=set)
    notes: list[str] = field(default_factory=list)

    def position(self, entity: str) -> Placed | None:
        """Return the position of an entity, or of its outermost carrier."""
        seen: set[str] = set()
        placement = self.placements.get(entity)
        while isinstance(placement, Carried) and placement.by not in seen:
            seen.add(placement.by)
            placement = self.placements.get(placement.by)
        return placement if isinstance(placement, Placed) else None

    def shape(self, entity: str) -> Placed | None:
        """Return the shape of an entity, regardless of its position; None if it is absent."""
        placement = self.placements.get(entity)
        return (
            placement.shape
            if isinstance(placement, Carried)
            else placement
            if isinstance(placement, Placed)
            else None
        )


@dataclass(frozen=True, slots=True)
class _Load:
    """An entity and its carrier, with the declaration."""

    name: str
    by: str
    where: s.Node
    shape: Placed | None


def elaborate_world(mission: s.Mission, names: Names, library: Library) -> InitialWorld:
    """Declare all entities and channels, and return P."""
    world, loads = InitialWorld(), list[_Load]()
    entries = [entry for section in mission.each(s.World) for entry in section.entries]
    for entry in entries:  # before entities, whose links declare all other channels
        if isinstance(entry, s.ChannelDeclaration):
            names.channels.add(entry.name.text)
            names.declare("channel", entry.name.text, entry.name)
    for entry in entries:
        if isinstance(entry, s.Entity):
            loads += _entity(entry, names, world)
        elif isinstance(entry, s.FromSource):
            loads += _from_file(entry, names, world, library)
    for entry in entries:
        if isinstance(entry, s.Entity):
            _join(entry.channels, names)
    _check_size(entries, names)
    _load(loads, names, world)
    return world


def _check_size(entries: list[s.WorldEntry], names: Names) -> None:
    places = sum(bool(names.signature[kind].contains) for kind in names.kinds.values())
    pairs = places * len(names.kinds)
    if len(names.kinds) > MOST_ENTITIES or pairs > MOST_PAIRS:
        message = f"the mission has {len(names.kinds):,} entities, more than {MOST_ENTITIES:,}"
        if len(names.kinds) <= MOST_ENTITIES:
            message = (
                f"{len(names.kinds):,} entities and {places:,} places are more than {MOST_PAIRS:,} pairs"
            )
        names.findings.add(
            Code.TOO_MANY_ENTITIES, entries[0], message, "reduce the file: within, keep, limit"
        )


def _join(channels: tuple[s.Name, ...], names: Names) -> None:
    for channel in channels:
        if channel.text not in names.channels:
            names.channels.add(channel.text)
            names.declare("channel", channel.text, channel)


def _entity(entry: s.Entity, names: Names, world: InitialWorld) -> Iterator[_Load]:
    name = entry.name.text
    names.kind(entry.kind)
    placed = None if entry.placement is None else elaborate_placement(entry.placement, names.findings)
    if not names.declare("entity", name, entry.name):
        return
    names.kinds[name] = entry.kind.text
    world.channels[name] = tuple(sorted({channel.text for channel in entry.channels}))
    if entry.absent:
        world.absent.add(name)
    if problem := _whereabouts(entry):
        names.findings.add(Code.NO_WHEREABOUTS, entry.name, *problem)
    elif entry.carrier is not None:
        yield _Load(name, entry.carrier.text, entry.carrier, placed)
    elif placed is not None:
        world.placements[name] = placed


def _whereabouts(entry: s.Entity) -> tuple[str, str] | None:
    name = entry.name.text
    if entry.absent and (entry.placement or entry.carrier):
        return (
            f"'{name}' is absent and yet somewhere",
            f"give its possible placements: environment {{ {name} appears at ... }}",
        )
    if not entry.absent and entry.placement is None and entry.carrier is None:
        return (
            f"'{name}' has no placement",
            "write '= point (latitude, longitude)', 'carried by' or 'absent'",
        )
    return None


def _from_file(entry: s.FromSource, names: Names, world: InitialWorld, library: Library) -> Iterator[_Load]:
    found = read_source(entry, library, names, world.notes)
    hint = 'let the names of the file begin otherwise: from "FILE" as second has second_NAME'
    _, *others = [item.entity for item in found if names.is_taken("entity", item.entity)] or [""]
    told = frozenset(others)
    for item in found:
        if item.entity in told:
            continue  # one finding for a file: its hint remedies all of its names
        if names.declare("entity", item.entity, entry.file, hint):
            names.kinds[item.entity] = item.kind
            world.channels[item.entity] = item.channels
            placed = Placed(item.geometry, item.altitude)
            if item.carried_by is None:
                world.placements[item.entity] = placed
            else:
                yield _Load(item.entity, item.carried_by, entry.file, placed)
    for channel in sorted({channel for item in found for channel in item.channels}):
        _join((s.Name(channel, span=entry.file.span),), names)


# --- cargo ------------------------------------------------------------------------------------------------------


def _load(loads: list[_Load], names: Names, world: InitialWorld) -> None:
    sound = [load for load in loads if _check_load(load, names, world)]
    by = {load.name: load.by for load in sound}
    for load in sound:
        if _is_cyclic(load.name, by):
            message = f"cyclic nesting: '{load.name}' is carried by itself, by way of '{load.by}'"
            hint = "one of the circle is carried by nothing"
            names.findings.add(Code.CYCLIC_NESTING, load.where, message, hint)
        else:
            world.placements[load.name] = Carried(load.by, load.shape or Placed(_NOWHERE))
    for load in sound:
        here = world.position(load.name)
        if load.shape is None and here is not None and load.name in world.placements:
            world.placements[load.name] = Carried(load.by, Placed(centroid(here.geometry)))


def _check_load(load: _Load, names: Names, world: InitialWorld) -> bool:
    kind = names.entity(
        load.where if isinstance(load.where, s.Name) else s.Name(load.by, span=load.where.span)
    )
    if kind is None:
        return False
    cargo = names.kinds[load.name]
    if cargo not in names.signature[kind].carries:
        message = f"'{load.by}' is {a(kind)}, which does not carry {a(cargo)}"
        names.findings.add(Code.BAD_CARRIER, load.where, message, f"declare it: kind {kind} carries {cargo}")
        return False
    if load.by in world.absent:
        message = f"'{load.name}' is carried by '{load.by}', which is absent"
        names.findings.add(Code.BAD_CARRIER, load.where, message, f"make '{load.name}' absent too")
        return False
    return True


def _is_cyclic(start: str, by: Mapping[str, str]) -> bool:
    slow = fast = start
    while fast in by and by[fast] in by:
        slow, fast = by[slow], by[by[fast]]
        if slow == fast:
            return True
    return False
