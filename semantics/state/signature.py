"""Kinds: a mission's signature, with the controls of its nodes."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Final, Self

Name = str
"""A symbol of logical space: a node, a channel or an agent."""

REGION: Final = "region"
"""The outermost place of L and of A(P): it contains everything, and has no physical image of its own."""

UNKNOWN: Final = "unknown"
"""What an observation calls the place of a node that it has not seen anywhere."""

NO_ENTITIES: Final = frozenset({REGION, UNKNOWN})
"""The names of places that no entity may have."""


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

    def within(self, kind: str, *, directly: bool = False) -> frozenset[str]:
        """Return the kinds that may be inside one: its children, and unless `directly` theirs too."""
        found: set[str] = set()
        waiting = [kind]
        while waiting:
            here = self[waiting.pop()]
            inside = (here.contains | here.carries) - found
            found |= inside
            waiting += [] if directly else inside
        return frozenset(found)

    @staticmethod
    def of(kinds: Iterable[Kind]) -> "Signature":
        """Collect kinds, sorted by name.

        >>> Signature.of([Kind("Sea", frozenset({"Boat"})), Kind("Boat", driven=True)])["Sea"].may_contain("Boat")
        True
        """
        return Signature({kind.name: kind for kind in sorted(kinds, key=lambda kind: kind.name)})


@dataclass(frozen=True, eq=False)
class Sorting:
    """Hold what P and L need to know of a mission: its kinds, and of which each of its entities is.

    Attributes:
        signature: The kinds.
        kinds: The kind of each entity that the mission names, present at first or not.
    """

    signature: Signature
    kinds: Mapping[Name, str]

    def kind(self, name: Name) -> str:
        """Return the kind of an entity."""
        return self.kinds[name]

    def naming(self, kinds: Mapping[Name, str]) -> Self:
        """Return the sorting with more entities; only where one of them is a place the containers are found anew."""
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
        """Return the names of all that may contain an entity of a kind, sorted."""
        return self._containers.get(kind, ())

    def carries(self, carrier: Name, name: Name) -> bool:
        """Tell whether a kind carries another: what is put into it goes along."""
        return self.kind(name) in self.signature[self.kind(carrier)].carries
