"""Bounds: the possible contents, carriers and places of a mission's entities, from its kinds and its first world."""

from collections.abc import Callable
from functools import cache

from semantics.environment import Appears, Drops
from semantics.fixpoints import closure
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, InTransit
from semantics.state.signature import REGION, Name

Names = frozenset[Name]


class Overapproximation:
    """Over-approximations of all reachable configurations.

    Attributes:
        names: Every entity.
        known: The nodes of the first L; a node never leaves L.
        channels: The channels that may drop.
        cyclic: Nodes that may lie on a cycle of L before it is broken.
        passive: Whether some kind of place is passive.
    """

    def __init__(self, initial: Configuration) -> None:
        setting = initial.setting
        self.initial = initial
        self.setting = setting
        self.names: Names = frozenset(setting.kinds)
        self.known: Names = frozenset(initial.structure.logical.nodes())
        self.channels = frozenset(each.channel for each in setting.environment if isinstance(each, Drops))
        self.passive = any(setting.signature[kind].passive for kind in setting.kinds.values())
        self.carriers = cache(self._carriers)
        self.holders = cache(self._holders)
        self.around: Callable[[Name], Names] = cache(lambda name: closure([name], self.holders))
        self.aboard: Callable[[Name], Names] = cache(self._aboard)
        self.believable = cache(self._believable)
        self.above: Callable[[Name], Names] = cache(
            lambda name: closure(self.believable(name), self.believable)
        )
        self.inside: Callable[[Name], Names] = cache(self._inside)
        self.believed_inside: Callable[[Name], Names] = cache(self._believed_inside)
        self.cyclic: Names = frozenset(name for name in self.names if name in self.above(name))

    def _carriers(self, name: Name) -> Names:
        """Return the possible carriers of an entity: by its kind, at the start, and where it may appear."""
        setting = self.setting
        found = {other for other in self.names if setting.carries(other, name)}
        first = self.initial.structure.physical.placement(name)
        appearing = (
            p
            for each in setting.environment
            if isinstance(each, Appears) and each.entity == name
            for p in each.placements
        )
        found.update(placement.by for placement in (first, *appearing) if isinstance(placement, Carried))
        return frozenset(found)

    def _holders(self, name: Name) -> Names:
        """Return the possible parents of an entity in A(P), and its possible destinations; without the region."""
        first = self.initial.structure.physical.placement(name)
        flying = {first.to} & self.names if isinstance(first, InTransit) else set[Name]()
        return self.carriers(name).union(self.setting.containers(self.setting.kind(name)), flying)

    def _aboard(self, name: Name) -> Names:
        """Return the possible cargo of an entity, at any depth."""
        return frozenset(
            other for other in self.names if name in closure(self.carriers(other), self.carriers)
        )

    def _believable(self, name: Name) -> Names:
        """Return the possible parents of an entity in L; without the region."""
        believed = self.initial.structure.logical.parent(name)
        return self.holders(name) | (
            {believed} & self.names if believed not in (None, REGION) else frozenset()
        )

    def _inside(self, place: Name) -> Names:
        """Return the possible children of a place, or of the region, in A(P)."""
        return frozenset(name for name in self.names if place == REGION or place in self.holders(name))

    def _believed_inside(self, place: Name) -> Names:
        """Return the possible children of a place in L."""
        return frozenset(name for name in self.names if place in self.believable(name))
