"""Symmetry: interchangeable agents and entities, and one representative of symmetric configurations.

The symmetry group contains every permutation of the members of a class.
"""

from collections.abc import Iterable, Iterator
from functools import cached_property, lru_cache
from itertools import combinations
from typing import Any

from checker.recording.value_templates import mobile_names
from checker.reduction.alpha_equivalence import UNLIKE_TEXTS, Pairing, Unlike
from checker.reduction.configuration_renaming import Renaming
from checker.reduction.member_items import Class, Items
from checker.reduction.mission_automorphisms import Automorphisms
from checker.reduction.name_order import ordered
from checker.reduction.refusals import Reduction, RefusedError
from checker.reduction.representatives import to_representative
from semantics.properties.propositions import Proposition
from semantics.state.cell_values import Row
from semantics.state.configuration import Configuration
from semantics.state.setting import Scheduler
from semantics.state.signature import Name

MOST_PAIRS = 2_000
"""The most pairs of entities without agents that are tried."""


class MissionSymmetry:
    """The interchangeable parts of a mission, and representatives.

    Raises:
        RefusedError: Nothing is interchangeable, or the order of names is relevant.
    """

    def __init__(self, initial: Configuration, formulas: Iterable[Proposition] = ()) -> None:
        reason = ordered(initial)
        if reason is not None:
            raise RefusedError(Reduction.SYMMETRY, reason)
        self.initial = initial
        self.automorphisms = Automorphisms(initial, formulas)
        self.unlike: list[str] = []
        self.classes = tuple(self._classes(initial.alpha.names()))
        self.classes += tuple(self._of_entities())
        if not self.classes:
            near = [why for why in self.unlike if not why.endswith(UNLIKE_TEXTS)]
            why = f": {(near or self.unlike)[0]}" if self.unlike else ""
            raise RefusedError(Reduction.SYMMETRY, f"nothing in the mission is interchangeable{why}")
        assert isinstance(initial.state, Row)
        mobile = mobile_names(initial.setting, initial.state)
        unordered = initial.setting.scheduler is Scheduler.UNORDERED
        self.items = Items(initial.state, self.classes, mobile, unordered)
        self.sorting = lru_cache(maxsize=4096)(self._sorting)

    # --- classes ----------------------------------------------------------------------------------------------

    def _of_entities(self) -> Iterator[Class]:
        moved = {name for each in self.classes for names in each.names for name in names}
        hosts = {self.initial.alpha.host(agent) for agent in self.initial.alpha.names()}
        free = sorted(set(self.initial.setting.kinds) - moved - hosts)
        by_kind = {kind: [name for name in free if self.initial.setting.kind(name) == kind]
                   for kind in sorted(set(self.initial.setting.kinds.values()))}  # fmt: skip
        for names in by_kind.values():
            if len(list(combinations(names, 2))) <= MOST_PAIRS:
                yield from self._classes(names)

    def _classes(self, names: Iterable[Name]) -> Iterator[Class]:
        """Yield classes of at least two members, each beginning with one of the given names."""
        left, taken = list(names), set[Any]()
        while left:
            first = left.pop(0)
            likes: list[Renaming] = []
            for other in list(left):
                swap = self._swap(first, other)
                if swap is not None and self._fits(swap, likes, taken):
                    likes.append(swap)
                    left.remove(other)
            if likes:
                found = Class(tuple(self._members(likes)))
                taken |= {name for member in found.names for name in member}
                yield found

    def _swap(self, one: Name, other: Name) -> Renaming | None:
        pairing = Pairing(self.initial)
        try:
            if one in self.initial.alpha:
                pairing.agents(one, other)
            else:
                pairing.pair(pairing.names, one, other)
            return self.automorphisms.transposition(pairing)
        except Unlike as reason:
            self.unlike.append(f"'{one}' is not like '{other}', since {reason}")
            return None

    def _fits(self, swap: Renaming, likes: list[Renaming], taken: set[Any]) -> bool:
        """Return whether a member is disjoint from those found before."""
        used = {name for like in likes for name in like.names} | taken
        first = [side[0] for side in self._sides(swap)]
        if not likes:
            return taken.isdisjoint(swap.names)
        alike = first == [side[0] for side in self._sides(likes[0])]
        return alike and len(used.intersection(swap.names)) == len(first[0])

    def _sides(self, swap: Renaming) -> tuple[tuple[tuple[Any, ...], tuple[Any, ...]], ...]:
        """Return for each part of a swap both sides, position by position."""
        return tuple(_halves(part) for part in swap.parts)

    def _members(self, likes: list[Renaming]) -> Iterator[tuple[tuple[Any, ...], ...]]:
        for number, swap in enumerate(likes):
            sides = self._sides(swap)
            if number == 0:
                yield tuple(side[0] for side in sides)
            yield tuple(side[1] for side in sides)

    @cached_property
    def exchanges(self) -> tuple[Renaming, ...]:
        """The exchanges of the first member of a class with each other one; they generate the group."""
        return tuple(
            Renaming(*each.moving((other, *range(1, other), 0, *range(other + 1, len(each.members)))))
            for each in self.classes
            for other in range(1, len(each.members))
        )

    @property
    def moves_agents(self) -> bool:
        """Whether some exchange changes the name of a bigActor."""
        return any(name in self.initial.alpha for each in self.exchanges for name in each.names)

    # --- representatives --------------------------------------------------------------------------------------

    def representative(self, c: Configuration) -> Configuration:
        """Return the representative of a configuration and its symmetric ones."""
        return self.sorting(c)[1]

    def _sorting(self, c: Configuration) -> tuple[Renaming, Configuration]:
        """Return the renaming to the representative, and the representative."""
        renaming = to_representative(self.items, c)
        return renaming, renaming.configuration(c)


def _halves(part: Any) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """Return the two sides of an involution, position by position."""
    first: list[Any] = []
    for one, other in part.items():
        if other not in first:
            first.append(one)
    return tuple(first), tuple(part[one] for one in first)
