"""Facts that regions need: all that may ever happen to each entity, from a mission's text."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from physical import EntityMotion, Ways
from semantics.fixpoints import closure
from semantics.state.signature import Name


@dataclass(frozen=True, eq=False)
class RegionFacts:
    """The facts of a mission.

    Attributes:
        motions: The possible motion of each entity, by name.
        movers: For each entity the agents whose flights may move it, sorted; none if its placement determines them.
    """

    motions: Mapping[Name, EntityMotion]
    movers: Mapping[Name, tuple[Name, ...]]

    def __reduce__(self) -> tuple[object, ...]:
        return RegionFacts, (self.motions, self.movers)

    @cached_property
    def ways(self) -> Ways:
        """The regions of the mission's entities."""
        return Ways(self.motions.values())

    def bearers(self, entity: Name) -> frozenset[Name]:
        """Return an entity with all that may carry it, at any depth."""
        return closure([entity], lambda name: self.motions[name].carriers)
