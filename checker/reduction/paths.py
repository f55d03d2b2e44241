"""Paths that followed steps make, so that no step is ignored: put off in every configuration of a cycle, for ever.

From every configuration one of the followed steps leads *on*. These steps make a forest; what a tree ends in was not
expanded yet, or ignores no step. Where a cycle is closed, what was taken on it is taken together.
"""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from checker.reduction.actors import Acting, Actor
from semantics.state.signature import Name

Part = tuple[str, Name | int]
"""An actor, but that all requests of an agent outside its line are one part: taken only where all of them are."""

Parts = frozenset[Part]


def part_of(actor: Actor) -> Part:
    """Return the part that an actor belongs to."""
    return (actor.kind, actor.owner)


def parts_of(inside: Iterable[Actor], acting: Mapping[Actor, Acting]) -> Parts:
    """Return the parts of which all actors are inside."""
    within = set(inside)
    return frozenset(map(part_of, within)) - {part_of(each) for each in acting if each not in within}


NOWHERE = -1
"""What stands for the number of a configuration that is new."""


class Lead(NamedTuple):
    """Where a path leads from some configuration: to another, with what is taken before that."""

    to: int
    taken: Parts


class Paths:
    """The paths of one exploration, configuration by configuration, by their numbers.

    Args:
        named: Whether an actor has the same name all along a path; under symmetry it has not, and nothing is taken
            to be the same.
    """

    def __init__(self, *, named: bool = True) -> None:
        self.named = named
        self.movers: dict[int, Name | None] = {0: None}
        self.leads: dict[int, Lead] = {}

    def end(self, number: int | None) -> Lead:
        """Return where the path from a configuration ends, and what is taken on it; of one that is new, nowhere."""
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
        """Note where the path leads on from a configuration."""
        self.leads[number] = Lead(to, taken)
