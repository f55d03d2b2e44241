"""Rings: the configurations at each distance from the first, as far as somebody has asked; shortest runs to them."""

from collections.abc import Hashable, Iterator, Mapping
from typing import TypeVar

from checker.bounding import look
from checker.symbolic.diagrams import Set
from checker.symbolic.reaching import Reach
from checker.symbolic.relations import Relation
from semantics.configuration import Configuration

K = TypeVar("K", bound=Hashable)


class Rings:
    """Shortest runs to configurations that are reachable.

    Attributes:
        reach: All that is reachable.
        configurations: Those on the runs that were asked for; the first is the initial one.
        origins: For each the number of the one before it.
    """

    def __init__(self, reach: Reach) -> None:
        self.reach = reach
        self._rings: list[Set] = [reach.first]
        self._seen = reach.first
        first = reach.coding.codes(reach.first)
        self._numbers = {tuple(first): 0}
        self.configurations: list[Configuration] = [reach.configuration(first)]
        self.origins = [0]

    def nearest(self, sets: Mapping[K, Set]) -> Iterator[tuple[K, int]]:
        """Yield sets by the distance of their nearest member, with that one's number; each must have one."""
        waiting = dict(sets)
        depth = 0
        while waiting:
            ring = self._ring(depth)
            for key in [key for key, members in waiting.items() if (ring & members).satisfiable()]:
                yield key, self._number_of(ring & waiting.pop(key), depth)
            depth += 1

    def _ring(self, depth: int) -> Set:
        while len(self._rings) <= depth:
            around = self.reach.diagrams.none
            for relation in self._relations():
                around |= self.reach.diagrams.step(self._rings[-1], relation.steps, relation.image)
                look()
            self._rings.append(around & ~self._seen)
            self._seen |= around
            self.reach.diagrams.tidy()
        return self._rings[depth]

    def _relations(self) -> Iterator[Relation]:
        return (relation for each in self.reach.relations for relation in each.by_writes.values())

    def _number_of(self, members: Set, depth: int) -> int:
        """Number a member of a ring, and those on a run to it."""
        run = [self.reach.coding.codes(members)]
        for ring in reversed(self._rings[:depth]):
            run.append(self._before(run[-1], ring))
        number = 0
        for codes in reversed(run):
            origin, number = number, self._numbers.setdefault(tuple(codes), len(self._numbers))
            if number == len(self.configurations):
                self.configurations.append(self.reach.configuration(codes))
                self.origins.append(origin)
        return number

    def _before(self, codes: list[int], ring: Set) -> list[int]:
        """Return a configuration of a ring from which one step leads to another."""
        coding = self.reach.coding
        for each in self.reach.relations:
            for written, relation in each.by_writes.items():
                fixed = (
                    coding.code(column, code, following=column in written)
                    for column, code in enumerate(codes)
                    if coding.bits[column]
                )
                before = self.reach.diagrams.meet([ring, relation.steps, *fixed])
                if before.satisfiable():
                    return coding.codes(before)
        raise AssertionError("a ring is reached from the one within it")
