"""The content of a configuration's picture, as pure functions of the configuration."""

from collections.abc import Mapping
from dataclasses import dataclass

from bigraphs.bigraph import points
from bigraphs.drawing import KINDS, LINKS
from physical import Geometry
from physical.drawing import MapEntity
from semantics.behaviours.reaction_rules import moved
from semantics.environment import Placing
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, InTransit
from semantics.state.requests import FLY
from semantics.state.signature import REGION, Name


@dataclass(frozen=True, slots=True)
class Palette:
    """The colours of kinds and of channels, as in the bigraph's picture."""

    kinds: Mapping[str, str]
    channels: Mapping[str, str]


def palette_of(c: Configuration) -> Palette:
    """Return the colours of the bigraph: of all declared kinds, so that they stay the same along a trace."""
    bigraph = c.structure.logical.bigraph()
    declared = sorted(control.name for control in bigraph.signature.controls)
    kinds = {kind: KINDS[rank % len(KINDS)][1] for rank, kind in enumerate(declared)}
    drawn = [str(link) for link, on in points(bigraph).items() if on]
    links = [*drawn, *(channel for channel in channels_of(c) if channel not in drawn)]
    return Palette(kinds, {link: LINKS[rank % len(LINKS)] for rank, link in enumerate(links)})


def channels_of(c: Configuration) -> tuple[Name, ...]:
    """Return the channels that L or P has, sorted."""
    logical, physical = c.structure.logical, c.structure.physical
    believed = {link for node in logical.nodes() for link in logical.links(node)}
    actual = {channel for name in physical.entities() for channel in physical.channels(name)}
    return tuple(sorted(believed | actual))


def differing(c: Configuration) -> frozenset[Name]:
    """Return the names on which L and A(P) differ in presence, parent or links."""
    logical, physical = c.structure.logical, c.structure.physical
    actual = {name: (physical.abstract_parent(name), physical.links(name)) for name in physical.entities()}
    believed = {name: (logical.parent(name), logical.links(name)) for name in logical.nodes()}
    return frozenset(
        name for name in actual.keys() | believed.keys() if actual.get(name) != believed.get(name)
    )


def changed_names(before: Configuration, after: Configuration) -> frozenset[Name]:
    """Return the names whose parent or links changed in L, or whose placement or channels changed in P."""
    return frozenset(
        name
        for name in after.setting.kinds
        if any(
            before.read((what, name)) != after.read((what, name))
            for what in ("parent", "links", "placement", "channels")
        )
    )


def shown_names(c: Configuration) -> tuple[Name, ...]:
    """Return the names of all entities that are in P or believed in L, sorted."""
    return tuple(sorted({*c.structure.physical.entities(), *c.structure.logical.nodes()}))


def map_entities(c: Configuration) -> tuple[MapEntity, ...]:
    """Return the entities on the map of P: all that are in P, and those that only L believes in."""
    return tuple(_map_entity(c, name) for name in shown_names(c))


def _map_entity(c: Configuration, name: Name) -> MapEntity:
    physical, kind = c.structure.physical, c.setting.kind(name)
    placement, links = physical.placement(name), physical.links(name)
    if placement is None:
        return MapEntity(name, kind, None)
    if isinstance(placement, Carried):
        return MapEntity(name, kind, None, channels=links, carried_by=placement.by)
    if isinstance(placement, InTransit):
        target = None if placement.to == REGION else physical.position(placement.to)
        destination = None if target is None else target.geometry
        start = placement.origin.geometry
        return MapEntity(name, kind, start, False, links, None, placement.to, destination, _via(c, name))
    return MapEntity(name, kind, placement.geometry, is_place(c, name), links)


def _via(c: Configuration, name: Name) -> tuple[Geometry, ...]:
    """Return the positions by which an entity in transit flies; P only has its destination."""
    requests = (each.request for each in c.eta.all())
    ways = (
        each.reaction.via
        for each in requests
        if isinstance(each, FLY) and name in dict(moved(each.reaction, each.match))
    )
    spots = (c.structure.physical.position(place) for place in next(ways, ()))
    return tuple(spot.geometry for spot in spots if spot is not None)


def is_place(c: Configuration, name: Name) -> bool:
    """Return whether an entity is a fixed container: its kind is not driven, and the environment does not move it."""
    kind = c.setting.signature[c.setting.kind(name)]
    moves = any(isinstance(clause, Placing) and clause.entity == name for clause in c.setting.environment)
    return bool(kind.contains) and not kind.driven and not moves
