"""Symmetry: interchangeable agents and entities, and one representative of symmetric configurations.

Any permutation may exchange the members of a class. In the representative of a configuration they are sorted by what it
says of each, without names. If this leaves a few orders, all are tried, so symmetric configurations have one
representative. If it leaves many, they may have several, which costs configurations but is sound.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations, groupby, permutations, product
from math import factorial, prod
from typing import Any

from checker.reduction.automorphisms import UNLIKE_TEXTS, Pairing, Unlike, is_invariant, transposition
from checker.reduction.order import ordered
from checker.reduction.refusals import Reduction, RefusedError
from checker.reduction.renaming import Renaming, mentioned, spelled
from semantics.properties.propositions import Proposition
from semantics.state.cells import AGENTS, NAMES, Cell, Row
from semantics.state.configuration import Configuration
from semantics.state.setting import Scheduler
from semantics.state.signature import Name

MOST_ORDERS = 120
"""How many orders of equal members are tried for one configuration."""

MOST_PAIRS = 2_000
"""How many pairs of entities without agents are tried."""

SAME, OTHER = "⟨same⟩", "⟨other⟩"
"""Placeholders of a member's own names, and of those of other members."""


@dataclass(frozen=True)
class Class:
    """Interchangeable members: for each its own names, statements, variables and counters.

    Attributes:
        members: For each member the parts of a renaming, position by position.
    """

    members: tuple[tuple[tuple[Any, ...], ...], ...]

    @property
    def names(self) -> tuple[tuple[Name, ...], ...]:
        """The names of each member."""
        return tuple(member[0] for member in self.members)

    def moving(self, order: Sequence[int]) -> tuple[dict[Any, Any], ...]:
        """Return the parts of the renaming that replaces member i by the member `order[i]`."""
        parts: tuple[dict[Any, Any], ...] = ({}, {}, {}, {})
        for place, member in enumerate(order):
            for part, old, new in zip(parts, self.members[member], self.members[place], strict=True):
                part.update((one, other) for one, other in zip(old, new, strict=True) if one != other)
        return parts


class Symmetry:
    """The interchangeable parts of a mission, and representatives.

    Raises:
        RefusedError: There are none, or the order of names matters.
    """

    def __init__(self, initial: Configuration, formulas: Iterable[Proposition] = ()) -> None:
        reason = ordered(initial)
        if reason is not None:
            raise RefusedError(Reduction.SYMMETRY, reason)
        self.initial = initial
        self.formulas = tuple(formulas)
        self.unlike: list[str] = []
        self.classes = tuple(self._classes(initial.alpha.names()))
        self.classes += tuple(self._of_entities())
        if not self.classes:
            near = [why for why in self.unlike if not why.endswith(UNLIKE_TEXTS)]
            why = f": {(near or self.unlike)[0]}" if self.unlike else ""
            raise RefusedError(Reduction.SYMMETRY, f"nothing in the mission is interchangeable{why}")
        self.owner = {name: (number, place) for number, each in enumerate(self.classes)
                      for place, names in enumerate(each.names) for name in names}  # fmt: skip
        self.movable = frozenset(self.owner)
        self.unordered = initial.setting.scheduler is Scheduler.UNORDERED
        self.sorting = lru_cache(maxsize=4096)(self._sorting)
        self.mentions = lru_cache(maxsize=1 << 16)(lambda value: mentioned(value, self.movable))
        self._said = lru_cache(maxsize=1 << 16)(self._of_one)

    # --- what is interchangeable ------------------------------------------------------------------------------

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
        """Yield classes of at least two members that each begin with one of some names."""
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
            renaming = transposition(self.initial, pairing)
            for formula in self.formulas:
                if not is_invariant(renaming, formula):
                    raise Unlike(f"a property tells them apart: {formula}")
        except Unlike as reason:
            self.unlike.append(f"'{one}' is not like '{other}', since {reason}")
            return None
        return renaming

    def _fits(self, swap: Renaming, likes: list[Renaming], taken: set[Any]) -> bool:
        """Tell whether a member shares nothing with those found before."""
        used = {name for like in likes for name in like.names} | taken
        first = [side[0] for side in self._sides(swap)]
        if not likes:
            return taken.isdisjoint(swap.names)
        alike = first == [side[0] for side in self._sides(likes[0])]
        return alike and len(used.intersection(swap.names)) == len(first[0])

    def _sides(self, swap: Renaming) -> tuple[tuple[tuple[Any, ...], tuple[Any, ...]], ...]:
        """Return for each part of a swap the one side and the other, position by position."""
        return tuple(_halves(part) for part in swap.parts)

    def _members(self, likes: list[Renaming]) -> Iterator[tuple[tuple[Any, ...], ...]]:
        for number, swap in enumerate(likes):
            sides = self._sides(swap)
            if number == 0:
                yield tuple(side[0] for side in sides)
            yield tuple(side[1] for side in sides)

    # --- representatives --------------------------------------------------------------------------------------

    def representative(self, c: Configuration) -> Configuration:
        """Return the representative of a configuration and its symmetric ones."""
        return self.sorting(c)[1]

    def _sorting(self, c: Configuration) -> tuple[Renaming, Configuration]:
        """Return the renaming to the representative, and the representative."""
        found = [(renaming, renaming.configuration(c)) for renaming in self._renamings(c)]
        return found[0] if len(found) == 1 else min(found, key=lambda each: _spelling(each[1]))

    def _renamings(self, c: Configuration) -> Iterator[Renaming]:
        for orders in product(*self._choices(c)):
            parts: tuple[dict[Any, Any], ...] = ({}, {}, {}, {})
            for each, order in zip(self.classes, orders, strict=True):
                for part, moved in zip(parts, each.moving(order), strict=True):
                    part.update(moved)
            yield Renaming(*parts)

    def _choices(self, c: Configuration) -> list[list[tuple[int, ...]]]:
        """Return for each class the orders of its members that remain after sorting."""
        ranked = [self._ranked(c, number) for number in range(len(self.classes))]
        several = prod(factorial(len(group)) for groups in ranked for group in groups)
        if several > MOST_ORDERS:
            return [[tuple(member for group in groups for member in group)] for groups in ranked]
        return [_orders(groups) for groups in ranked]

    def _ranked(self, c: Configuration, number: int) -> list[list[int]]:
        """Return the members of a class in order, equal ones together."""
        names = self.classes[number].names
        said = {member: self._say(c, number, member) for member in range(len(names))}
        groups = groupby(sorted(said, key=lambda member: (said[member], member)), key=said.__getitem__)
        return [group for _, found in groups for group in self._apart(c, names, list(found))]

    def _apart(self, c: Configuration, names: Sequence[Sequence[Name]], group: list[int]) -> list[list[int]]:
        """Keep equal members together only if one names another: otherwise their order does not matter."""
        own = {self.owner[name] for member in group for name in names[member]}
        for cell, value in _rows(c):
            if cell not in (AGENTS, NAMES):
                whose = self.owner.get(str(cell[-1])) if len(cell) > 1 else None
                others = {self.owner[name] for name in self.mentions(value)} - {whose}
                if others and (whose in own or others & own):
                    return [group]
        return [[member] for member in group]

    def _say(self, c: Configuration, number: int, member: int) -> str:
        """Return all that a configuration says of a member, without names."""
        mine = (number, member)
        found = []
        for cell, value in _rows(c):
            if cell in (AGENTS, NAMES):
                continue
            whose = self.owner.get(str(cell[-1])) if len(cell) > 1 else None
            if whose == mine or any(self.owner[name] == mine for name in self.mentions(value)):
                found.append(self._said(cell, value, mine))
        return "\n".join(sorted(found))

    def _of_one(self, cell: Cell, value: Any, mine: tuple[int, int]) -> str:
        base = self.classes[mine[0]].members
        names = dict.fromkeys(self.movable, OTHER)
        names |= {name: f"{SAME}{place}" for place, name in enumerate(base[mine[1]][0])}
        parts = [dict(zip(base[mine[1]][part], base[0][part], strict=True)) for part in (1, 2, 3)]
        blank = Renaming(names, *parts)
        return f"{spelled(blank.cell(cell))}={spelled(blank.content(cell, value, unordered=self.unordered))}"


def _halves(part: Any) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """Return the two sides of an involution, position by position."""
    first: list[Any] = []
    for one, other in part.items():
        if other not in first:
            first.append(one)
    return tuple(first), tuple(part[one] for one in first)


def _rows(c: Configuration) -> Iterator[tuple[Cell, Any]]:
    assert isinstance(c.state, Row)
    return c.state.items()


def _orders(groups: list[list[int]]) -> list[tuple[int, ...]]:
    return [
        tuple(member for group in chosen for member in group)
        for chosen in product(*(permutations(group) for group in groups))
    ]


def _spelling(c: Configuration) -> str:
    return "\n".join(spelled(value) for _, value in _rows(c))
