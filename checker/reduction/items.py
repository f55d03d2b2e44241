"""Items: what a configuration says of interchangeable members, piece by piece, and how that is exchanged.

An item is a cell's value, or what one observation in it says of one mobile name: no piece is larger than what the fast
explorer has a column for. Numbers of 64 bits stand for items, and sums of them for many, in whatever order: both
explorers come to the same ones.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from hashlib import blake2b
from typing import Any

from checker.engines.fast.skeletons import holes, put_together, taken_apart
from checker.reduction.renaming import Renaming, mentioned, spelled
from semantics.behaviours.observations import NOTHING_SEEN, Observation
from semantics.state.cells import AGENTS, NAMES, Cell, Row
from semantics.state.configuration import Configuration
from semantics.state.signature import Name

BITS = (1 << 64) - 1

SAME, OTHER = "⟨same⟩", "⟨other⟩"
"""Placeholders of a member's own names, and of those of other members."""

Member = int
"""Interchangeable members are numbered class by class."""

Place = tuple[Cell, int, Name] | tuple[Cell]
"""Where an item is said: in a cell, or by the observation of that number in it of a name."""

Roles = tuple[tuple[Member, int], ...]
"""The members that an item mentions, each with a number for what it says of that one, without names."""


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
        """Return the parts of the renaming that replaces member `order[i]` by member i."""
        return renamed_parts(
            (self.members[member], self.members[place]) for place, member in enumerate(order)
        )


def renamed_parts(pairs: Any) -> tuple[dict[Any, Any], ...]:
    """Return the parts of the renaming that replaces the first of each pair of members by the second."""
    parts: tuple[dict[Any, Any], ...] = ({}, {}, {}, {})
    for before, after in pairs:
        for part, old, new in zip(parts, before, after, strict=True):
            part.update((one, other) for one, other in zip(old, new, strict=True) if one != other)
    return parts


@dataclass
class Items:
    """The items of configurations, for given classes.

    Attributes:
        initial: The first configuration: every exchange leaves it as it is, so what is as there says nothing.
        mobile: The names of which observations speak item by item.
        unordered: Whether requests stand in the order of their texts.
        begins: The number of each class's first member, and the number of members.
        owner: The member that a name, or a counter's cell, belongs to.
    """

    initial: Row
    classes: tuple[Class, ...]
    mobile: frozenset[Name]
    unordered: bool
    begins: tuple[int, ...] = field(init=False)
    owner: dict[Any, Member] = field(init=False)

    def __post_init__(self) -> None:
        self.members = [member for each in self.classes for member in each.members]
        self.class_of = [number for number, each in enumerate(self.classes) for _ in each.members]
        self.begins = tuple(
            sum(len(each.members) for each in self.classes[:k]) for k in range(len(self.classes) + 1)
        )
        self.owner = {
            each: k for k, member in enumerate(self.members) for part in (0, 3) for each in member[part]
        }
        self.movable = frozenset(name for each in self.classes for names in each.names for name in names)
        firsts = [self.members[self.begins[number]] for number in self.class_of]
        self.plain = renamed_parts(zip(self.members, firsts, strict=True))
        self.roles = lru_cache(maxsize=1 << 16)(self._roles)
        self.number = lru_cache(maxsize=1 << 16)(self._number)

    def of(self, c: Configuration) -> Iterator[tuple[Place, Any]]:
        """Yield the items of a configuration that are not as at first."""
        assert isinstance(c.state, Row)
        for cell, value in c.state.items():
            if cell in (AGENTS, NAMES) or (
                cell in self.initial.layout.index and self.initial.read(cell) == value
            ):
                continue
            skeleton, families = taken_apart(value, self.mobile)
            if not families or self.is_whole(cell, skeleton):
                yield (cell,), value
                continue
            yield (cell,), skeleton
            for number, family in enumerate(families):
                told = ((name, family[name]) for name in self.mobile.intersection(family))
                yield from (((cell, number, name), fact) for name, fact in told if fact != NOTHING_SEEN)

    def is_whole(self, cell: Cell, skeleton: Any) -> bool:
        """Tell whether a value is one item: an exchange may change the order of the observations in it."""
        kept_in_order = cell[0] in ("mailbox", "sends") or (cell[0] == "line" and self.unordered)
        return kept_in_order and len(skeleton) > 1 and has_holes(skeleton)

    def renamed(self, renaming: Renaming, place: Place, value: Any) -> tuple[Place, Any]:
        """Return the image of an item."""
        cell = renaming.cell(place[0])
        if len(place) == 3:
            ((name, fact),) = renaming.value(Observation({place[2]: value})).facts
            return (cell, place[1], name), fact
        content = renaming.content(place[0], _of_the_still(value), unordered=self.unordered)
        return (cell,), taken_apart(content, self.mobile)[0] if has_holes(value) else content

    def mentions(self, place: Place, value: Any) -> tuple[Member, ...]:
        """Return the members that an item mentions: first whose cell it is, then as they occur."""
        first = [self.owner[place[0]]] if place[0] in self.owner else []
        said = Observation({place[2]: value}) if len(place) == 3 else _of_the_still(value)
        names = mentioned((place[0][1:], said), self.movable)
        return tuple(dict.fromkeys((*first, *(self.owner[name] for name in names))))

    def exchanging(self, pairs: Mapping[Member, Member]) -> Renaming:
        """Return an exchange by which each of some members is replaced by another of its class."""
        moved = dict(pairs)
        free = [member for member in moved if member not in set(moved.values())]
        for member in set(moved.values()) - pairs.keys():
            moved[member] = next(one for one in free if self.class_of[one] == self.class_of[member])
            free.remove(moved[member])
        return Renaming(
            *renamed_parts((self.members[one], self.members[other]) for one, other in moved.items())
        )

    def _roles(self, place: Place, value: Any) -> Roles:
        return tuple((member, self._role(place, value, member)) for member in self.mentions(place, value))

    def _role(self, place: Place, value: Any, member: Member) -> int:
        """Return a number for what an item says of a member, the same for all that are alike."""
        names = dict.fromkeys(self.movable, OTHER)
        names |= {name: f"{SAME}{k}" for k, name in enumerate(self.members[member][0])}
        return number_of(
            (self.class_of[member], self.renamed(Renaming(names, *self.plain[1:]), place, value))
        )

    def _number(self, place: Place, value: Any) -> int:
        return number_of((place, value))


def has_holes(skeleton: Any) -> bool:
    """Tell whether a skeleton is one of a value with observations."""
    return any(True for _ in holes(skeleton))


def _of_the_still(skeleton: Any) -> Any:
    """Return a value with observations that say only what they do of names that are not mobile."""
    return put_together(skeleton, lambda hole: dict(hole.still))


def number_of(value: Any) -> int:
    """Return 64 bits that stand for a value, the same in every process."""
    return int.from_bytes(blake2b(spelled(value).encode(), digest_size=8).digest(), "little")


def mix(one: int, other: int) -> int:
    """Return 64 bits that stand for two numbers in their order."""
    mixed = ((one ^ (one >> 32)) * 0x9E3779B97F4A7C15 + other) & BITS
    mixed = ((mixed ^ (mixed >> 29)) * 0xBF58476D1CE4E5B9) & BITS
    return mixed ^ (mixed >> 32)
