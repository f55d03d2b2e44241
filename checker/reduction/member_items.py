"""Items: the parts of a configuration that mention interchangeable members, and their images under exchanges.

An item is a cell's value, or the fact about one mobile name in one of its observations; so it fits one column of the
fast explorer. 64-bit digests stand for items, and sums of digests for unordered collections. Both explorers compute the
same ones.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from hashlib import blake2b
from typing import Any

from checker.recording.value_templates import holes, join_value, split_value
from checker.reduction.configuration_renaming import Renaming, mentioned, spelled
from semantics.behaviours.observations import NOTHING_SEEN, Observation
from semantics.state.cell_values import AGENTS, NAMES, Cell, Row
from semantics.state.configuration import Configuration
from semantics.state.signature import Name

BITS = (1 << 64) - 1

SAME, OTHER = "⟨same⟩", "⟨other⟩"
"""Placeholders for a member's own names, and for those of other members."""

Member = int
"""The number of an interchangeable member, class by class."""

Place = tuple[Cell, int, Name] | tuple[Cell]
"""The place of an item: a cell, possibly with the number of an observation in it and a name."""

Roles = tuple[tuple[Member, int], ...]
"""The members that an item mentions, each with a digest of its role in the item, without names."""


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
        initial: The first configuration; every exchange preserves it, so unchanged values need no item.
        mobile: The names with items of their own in observations.
        unordered: Whether requests are sorted by their texts.
        begins: The number of each class's first member, and the number of members.
        owner: The member of each name, and of each counter's cell.
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
        """Yield the items of a configuration that differ from the first configuration."""
        assert isinstance(c.state, Row)
        for cell, value in c.state.items():
            if cell in (AGENTS, NAMES) or (
                cell in self.initial.layout.index and self.initial.read(cell) == value
            ):
                continue
            skeleton, families = split_value(value, self.mobile)
            if not families or self.is_whole(cell, skeleton):
                yield (cell,), value
                continue
            yield (cell,), skeleton
            for number, family in enumerate(families):
                told = ((name, family[name]) for name in self.mobile.intersection(family))
                yield from (((cell, number, name), fact) for name, fact in told if fact != NOTHING_SEEN)

    def is_whole(self, cell: Cell, skeleton: Any) -> bool:
        """Return whether a value is a single item: an exchange may reorder the observations in it."""
        kept_in_order = cell[0] in ("mailbox", "sends") or (cell[0] == "line" and self.unordered)
        return kept_in_order and len(skeleton) > 1 and has_holes(skeleton)

    def renamed(self, renaming: Renaming, place: Place, value: Any) -> tuple[Place, Any]:
        """Return the image of an item."""
        cell = renaming.cell(place[0])
        if len(place) == 3:
            ((name, fact),) = renaming.value(Observation({place[2]: value})).facts
            return (cell, place[1], name), fact
        content = renaming.content(place[0], _of_the_still(value), unordered=self.unordered)
        return (cell,), split_value(content, self.mobile)[0] if has_holes(value) else content

    def mentions(self, place: Place, value: Any) -> tuple[Member, ...]:
        """Return the members that an item mentions: the owner of its cell first, then by occurrence."""
        first = [self.owner[place[0]]] if place[0] in self.owner else []
        said = Observation({place[2]: value}) if len(place) == 3 else _of_the_still(value)
        names = mentioned((place[0][1:], said), self.movable)
        return tuple(dict.fromkeys((*first, *(self.owner[name] for name in names))))

    def exchanging(self, pairs: Mapping[Member, Member]) -> Renaming:
        """Return an exchange that replaces each of some members by another of its class."""
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
        """Return a digest of a member's role in an item; symmetric members have equal ones."""
        names = dict.fromkeys(self.movable, OTHER)
        names |= {name: f"{SAME}{k}" for k, name in enumerate(self.members[member][0])}
        return number_of(
            (self.class_of[member], self.renamed(Renaming(names, *self.plain[1:]), place, value))
        )

    def _number(self, place: Place, value: Any) -> int:
        return number_of((place, value))


def has_holes(skeleton: Any) -> bool:
    """Return whether a skeleton has holes for observations."""
    return any(True for _ in holes(skeleton))


def _of_the_still(skeleton: Any) -> Any:
    """Return a value whose observations keep only their facts about immobile names."""
    return join_value(skeleton, lambda hole: dict(hole.still))


def number_of(value: Any) -> int:
    """Return a 64-bit digest of a value, the same in every process."""
    return int.from_bytes(blake2b(spelled(value).encode(), digest_size=8).digest(), "little")


def mix(one: int, other: int) -> int:
    """Return a 64-bit digest of an ordered pair of numbers."""
    mixed = ((one ^ (one >> 32)) * 0x9E3779B97F4A7C15 + other) & BITS
    mixed = ((mixed ^ (mixed >> 29)) * 0xBF58476D1CE4E5B9) & BITS
    return mixed ^ (mixed >> 32)
