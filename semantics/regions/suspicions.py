"""Suspicions about ways: a mission's text gives rise to them, and an exploration confirms or refutes each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class MayCross:
    """An entity may be over a place, on its way or aboard its carrier, while no place has it there."""

    entity: Name
    place: Name

    @property
    def pair(self) -> tuple[Name, Name]:
        """The two entities whose regions are compared."""
        return self.entity, self.place


@dataclass(frozen=True, slots=True)
class MayMeet:
    """Two vehicles may be under way to one place, or at rest there, at one time."""

    one: Name
    other: Name

    @property
    def pair(self) -> tuple[Name, Name]:
        """The two entities whose ways are compared."""
        return self.one, self.other


Suspicion = MayCross | MayMeet


class SuspectedWay(NamedTuple):
    """A way that confirms a suspicion.

    Attributes:
        vehicle: The vehicle that flies.
        begins: Where its flight began, in words; empty if it is at rest.
        to: Where it flies to, or rests.
    """

    vehicle: Name
    begins: str
    to: str
