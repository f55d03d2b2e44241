"""Kinds: a mission's signature, with the controls of its nodes."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Final, Self

from semantics.fixpoints import closure

Name = str
"""A symbol of logical space: a node, a channel or an agent."""

REGION: Final = "region"
"""The outermost place of L and of A(P): it contains everything, and has no physical image of its own."""

UNKNOWN: Final = "unknown"
"""The place, in an observation, of a node that it has not seen anywhere."""

NO_ENTITIES: Final = frozenset({REGION, UNKNOWN})
"""The names of places that no entity may have."""


@dataclass(frozen=True, slots=True)
class Kind:
    """One control: the kinds that it may contain or carry, whether it can be driven, and whether it is passive."""

    name: str
    contains: frozenset[str] = frozenset()
    carries: frozenset[str] = frozenset()
    driven: bool = False
    passive: bool = False

    @property
    def holds(self) -> bool:
        """Whether a node of this kind may have children."""
        return bool(self.contains or self.carries)

    def may_contain(self, kind: str) -> bool:
        """Whether a node of `kind` may be a child; carried nodes are children too."""
        return kind in self.contains or kind in self.carries


@dataclass(frozen=True)
class Signature:
    """The kinds of a mission by name; an unknown name is a kind without any abilities."""

    kinds: Mapping[str, Kind] = field(default_factory=dict)

    def __getitem__(self, kind: str) -> Kind:
        return self.kinds.get(kind) or Kind(kind)

    def within(self, kind: str, *, directly: bool = False) -> frozenset[str]:
        """Return the kinds that may be inside one: its possible children, and unless `directly` their descendants."""

        def inside(around: str) -> frozenset[str]:
            return self[around].contains | self[around].carries

        return inside(kind) if directly else closure(inside(kind), inside)

    @staticmethod
    def of(kinds: Iterable[Kind]) -> "Signature":
        """Return the signature of some kinds, sorted by name.

        >>> Signature.of([Kind("Sea", frozenset({"Boat"})), Kind("Boat", driven=True)])["Sea"].may_contain("Boat")
        True
        """
        return Signature({kind.name: kind for kind in sorted(kinds, key=lambda kind: kind.name)})


@dataclass(frozen=True, eq=False)
class EntityKinds:
    """The part of a mission that P and L need: its kinds, and the kind of each of its entities.

    Attributes:
        signature: The kinds.
        kinds: The kind of each entity that the mission names, whether present at first or not.
    """

    signature: Signature
    kinds: Mapping[Name, str]

    def kind(self, name: Name) -> str:
        """Return the kind of an entity."""
        return self.kinds[name]

    def driven(self) -> tuple[Name, ...]:
        """Return the entities that agents may drive, sorted."""
        return tuple(sorted(name for name, kind in self.kinds.items() if self.signature[kind].driven))

    def naming(self, kinds: Mapping[Name, str]) -> Self:
        """Return the sorting with more entities; the containers are recomputed only if one of them is a place."""
        more = replace(self, kinds={**self.kinds, **kinds})
        if not any(self.signature[kind].contains for kind in kinds.values()):
            vars(more)["_containers"] = self._containers
        return more

    @cached_property
    def _containers(self) -> dict[str, tuple[Name, ...]]:
        found: dict[str, list[Name]] = {}
        for name, kind in sorted(self.kinds.items()):
            for held in self.signature[kind].contains:
                found.setdefault(held, []).append(name)
        return {kind: tuple(names) for kind, names in found.items()}

    def containers(self, kind: str) -> tuple[Name, ...]:
        """Return the possible containers of entities of a kind, sorted."""
        return self._containers.get(kind, ())

    def carries(self, carrier: Name, name: Name) -> bool:
        """Whether an entity's kind carries the kind of another."""
        return self.kind(name) in self.signature[self.kind(carrier)].carries
