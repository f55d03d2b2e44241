"""The abstraction A(P): the paper's Bigraph Driver (3.2.2), and the merging of several stations' observations."""

from collections.abc import Callable, Iterable

from bigraphs import Bigraph
from physical import PhysicalProperty
from semantics.behaviours.program import Program
from semantics.state.cell_values import Changes
from semantics.state.configuration import Configuration
from semantics.state.initial import initial
from semantics.state.logical_model import links_cell, parent_cell
from semantics.state.physical_model import Carried, Placed, Placement
from semantics.state.setting import Setting
from semantics.state.signature import Name, Signature


def merged(*sources: Iterable[PhysicalProperty]) -> tuple[PhysicalProperty, ...]:
    """Return the newest property of each entity, sorted by entity.

    A property without a time is older than any with one. Of two equally new ones, the last by source name is kept, so
    that every station keeps the same.
    """
    newest: dict[str, PhysicalProperty] = {}
    for each in (each for source in sources for each in source):
        known = newest.get(each.entity)
        if known is None or _age(each) >= _age(known):
            newest[each.entity] = each
    return tuple(newest[entity] for entity in sorted(newest))


def _age(seen: PhysicalProperty) -> tuple[float, str]:
    return (float("-inf") if seen.time is None else seen.time, seen.source or "")


def world(properties: Iterable[PhysicalProperty], signature: Signature) -> Configuration:
    """Return the configuration without agents that has these properties as P, and A(P) as L."""
    seen = merged(properties)
    setting = Setting(signature, {each.entity: each.kind for each in seen}, Program())
    placements = {each.entity: placement_of(each) for each in seen}
    return initial(setting, placements, {each.entity: each.channels for each in seen}, {})


def placement_of(seen: PhysicalProperty) -> Placement:
    """Return the placement that a property gives its entity."""
    placed = Placed(seen.geometry, seen.altitude)
    return placed if seen.carried_by is None else Carried(seen.carried_by, placed)


def abstraction(properties: Iterable[PhysicalProperty], signature: Signature) -> Bigraph:
    """Return A(P) as a bigraph: each node in its smallest total container, or in its carrier."""
    return world(properties, signature).structure.logical.bigraph()


def as_it_is(c: Configuration) -> Configuration:
    """Return the configuration with L = A(P), the belief of an omniscient observer."""
    physical = c.structure.physical
    return _with_parents(c, physical.abstract_parent)


def all_as_it_is(c: Configuration) -> Configuration:
    """Return the result of `as_it_is`, fast for thousands of places; it reads every placement."""
    return _with_parents(c, c.structure.physical.abstract_parents().__getitem__)


def _with_parents(c: Configuration, parent: Callable[[Name], Name]) -> Configuration:
    physical = c.structure.physical
    slots: Changes = {}
    for name in c.setting.kinds:
        slots[parent_cell(name)] = parent(name) if name in physical else None
        slots[links_cell(name)] = physical.links(name) if name in physical else ()
    return c.with_(slots)
