"""Kinds: what a mission's signature says of the controls of its nodes."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Final

Name = str
"""A symbol of logical space: a node, a channel or an agent."""

REGION: Final = "region"
"""The outermost place of L and of A(P): it contains everything, and has no physical image of its own."""


@dataclass(frozen=True, slots=True)
class Kind:
    """Describe one control: what it may contain, whether it carries, can be driven, lets rules act inside it."""

    name: str
    contains: frozenset[str] = frozenset()
    carries: frozenset[str] = frozenset()
    driven: bool = False
    passive: bool = False

    @property
    def holds(self) -> bool:
        """Whether anything may be a child of such a node."""
        return bool(self.contains or self.carries)

    def may_contain(self, kind: str) -> bool:
        """Tell whether a node of `kind` may be a child; what is carried is contained."""
        return kind in self.contains or kind in self.carries


@dataclass(frozen=True)
class Signature:
    """Hold the kinds of a mission by name; an unknown kind is one that does and holds nothing."""

    kinds: Mapping[str, Kind] = field(default_factory=dict)

    def __getitem__(self, kind: str) -> Kind:
        return self.kinds.get(kind) or Kind(kind)

    @staticmethod
    def of(kinds: Iterable[Kind]) -> "Signature":
        """Collect kinds, sorted by name.

        >>> Signature.of([Kind("Sea", frozenset({"Boat"})), Kind("Boat", driven=True)])["Sea"].may_contain("Boat")
        True
        """
        return Signature({kind.name: kind for kind in sorted(kinds, key=lambda kind: kind.name)})
