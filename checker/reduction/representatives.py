"""Representatives: the order in which the members of each class appear in a representative configuration.

Each member has a colour: a digest of the items that mention it, without names. Members are sorted by colour. Where
members of equal colour share items with others, colours are refined by those of the others. Then members of equal
colour that can be exchanged keep their order. If the rest has few orders, all are tried, so symmetric configurations
have one representative. If there are many, one member after another gets a colour of its own. There may be several
representatives then, which costs configurations but is sound.
"""

from collections.abc import Iterator, Sequence
from itertools import groupby, pairwise, permutations, product
from math import factorial, prod
from typing import Any

from checker.reduction.configuration_renaming import Renaming
from checker.reduction.member_items import BITS, Items, Member, Place, Roles, mix
from semantics.state.configuration import Configuration

MOST_ORDERS = 120
"""The most orders of equal members that are tried for one configuration."""

Group = tuple[Member, ...]

Said = list[tuple[Place, Any, Roles]]
"""The items of a configuration that mention members."""


def to_representative(items: Items, c: Configuration) -> Renaming:
    """Return the renaming of a configuration to its representative."""
    told = ((place, value, items.roles(place, value)) for place, value in items.of(c))
    said = [each for each in told if each[2]]
    orders = _orders(items, said)
    if len(orders) == 1:
        return _renaming(items, orders[0])
    return min((_renaming(items, order) for order in orders), key=lambda each: _spelling(items, each, said))


def _renaming(items: Items, order: Sequence[Member]) -> Renaming:
    return items.exchanging({member: place for place, member in enumerate(order) if member != place})


def _spelling(items: Items, renaming: Renaming, said: Said) -> int:
    """Return a digest of a renamed configuration."""
    return sum(items.number(*items.renamed(renaming, place, value)) for place, value, _ in said) & BITS


def _orders(items: Items, said: Said) -> list[tuple[Member, ...]]:
    """Return the orders of all members that remain after sorting."""
    colours = [0] * len(items.members)
    for _, _, roles in said:
        for member, role in roles:
            colours[member] = (colours[member] + role) & BITS
    together = [roles for _, _, roles in said if len(roles) > 1]
    beside = {member for roles in together for member, _ in roles}
    while True:
        groups, count = list(_groups(items, colours)), 0
        while _tied(groups, beside) and len(groups) > count:
            count, colours = len(groups), _refined(colours, together)
            groups = list(_groups(items, colours))
        for group in _tied(groups, beside):
            if all(_may_change(items, said, one, other) for one, other in pairwise(group)):
                beside.difference_update(group)
        tied = _tied(groups, beside)
        if prod(factorial(len(group)) for group in tied) <= MOST_ORDERS:
            choices = [permutations(group) if group in tied else (group,) for group in groups]
            return [
                tuple(member for group in reversed(chosen) for member in group)
                for chosen in product(
                    *reversed(choices)
                )  # the compiled loops vary the first group fastest, too
            ]
        colours[tied[0][0]] = mix(colours[tied[0][0]], 1)


def _may_change(items: Items, said: Said, one: Member, other: Member) -> bool:
    """Return whether exchanging two members preserves a configuration."""
    both = {one, other}
    about = [each for each in said if not both.isdisjoint(member for member, _ in each[2])]
    return _spelling(items, items.exchanging({one: other, other: one}), about) == _spelling(
        items, Renaming(), about
    )


def _groups(items: Items, colours: Sequence[int]) -> Iterator[Group]:
    """Yield the members in order, those of equal colour together."""

    def place(member: Member) -> tuple[int, int]:
        return items.class_of[member], colours[member]

    for _, group in groupby(sorted(range(len(colours)), key=place), key=place):
        yield tuple(group)


def _tied(groups: Sequence[Group], beside: set[Member]) -> list[Group]:
    """Return the groups of several members whose order is relevant, since some of them share items with others."""
    return [group for group in groups if len(group) > 1 and not beside.isdisjoint(group)]


def _refined(colours: Sequence[int], together: Sequence[Roles]) -> list[int]:
    """Return colours that distinguish members by the colours of the members they share items with."""
    met = [0] * len(colours)
    for roles in together:
        parts = [mix(role, colours[member]) for member, role in roles]
        for (member, role), part in zip(roles, parts, strict=True):
            met[member] = (met[member] + mix(role, (sum(parts) - part) & BITS)) & BITS
    return [mix(colour, each) for colour, each in zip(colours, met, strict=True)]
