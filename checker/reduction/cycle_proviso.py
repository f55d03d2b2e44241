"""The cycle proviso: paths of followed steps, which ensure that no enabled step is ignored for ever.

From each configuration one of the followed steps leads *onward*. These steps form a forest; the root of a tree is
unexpanded or ignores no step. When a cycle closes, the parts taken along it count together.
"""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from checker.reduction.actor_footprints import Acting, Actor
from semantics.state.signature import Name

Part = tuple[str, Name | int]
"""An actor, except that all requests of an agent outside its line form one part, taken only if all of them are."""

Parts = frozenset[Part]


def part_of(actor: Actor) -> Part:
    """Return the part of an actor."""
    return (actor.kind, actor.owner)


def parts_of(inside: Iterable[Actor], acting: Mapping[Actor, Acting]) -> Parts:
    """Return the parts whose actors are all inside."""
    within = set(inside)
    return frozenset(map(part_of, within)) - {part_of(each) for each in acting if each not in within}


NOWHERE = -1
"""The number of a new configuration."""


class Lead(NamedTuple):
    """The end of a path from a configuration, and the parts taken before it."""

    to: int
    taken: Parts


class Paths:
    """The paths of one exploration, by the numbers of configurations.

    Args:
        named: Whether an actor keeps its name along a path. Under symmetry it doesn't, so no part counts as taken.
    """

    def __init__(self, *, named: bool = True) -> None:
        self.named = named
        self.movers: dict[int, Name | None] = {0: None}
        self.leads: dict[int, Lead] = {}

    def end(self, number: int | None) -> Lead:
        """Return the end of the path from a configuration, and the parts taken on it; `NOWHERE` for a new one."""
        if number is None:
            return Lead(NOWHERE, frozenset())
        passed = []
        while number in self.leads:
            passed.append(number)
            number = self.leads[number].to
        taken: Parts = frozenset()
        for each in reversed(passed):
            taken |= self.leads[each].taken
            self.leads[each] = Lead(number, taken)
        return Lead(number, taken if self.named else frozenset())

    def lead(self, number: int, to: int, taken: Parts) -> None:
        """Record the onward step of a configuration."""
        self.leads[number] = Lead(to, taken)
