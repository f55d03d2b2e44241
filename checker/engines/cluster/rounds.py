"""Rounds: what workers tell each other between them, and what follows for all alike."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from checker.limits import memory_taken


@dataclass(frozen=True, slots=True)
class Stage:
    """How far workers go on before they ask whoever leads them.

    Attributes:
        rows: How many rows each expands in a round.
        seconds: For how long, in whole rounds.
        configurations: How many there may be in all, None for any number.
        memory: How many bytes each may take, None for any number.
    """

    rows: int
    seconds: float
    configurations: int | None
    memory: int | None

    def is_over(self, marks: Sequence["Mark"]) -> bool:
        """Tell whether all stop here: one's time or memory ends, or nothing is left to be expanded."""
        memory = self.memory is not None and max(each.memory for each in marks) > self.memory
        return memory or any(each.is_late for each in marks) or all(each.is_done for each in marks)


class Mark(NamedTuple):
    """What a worker tells the others after a round.

    Attributes:
        size: How many rows it has.
        expanded: How many of them were expanded.
        end: Where its layer ends.
        memory: How many bytes its process takes.
        is_late: Whether its time is over.
    """

    size: int
    expanded: int
    end: int
    memory: int
    is_late: bool

    @property
    def is_done(self) -> bool:
        """Whether it has nothing to expand."""
        return self.expanded == self.size


def mark(size: int, expanded: int, end: int, *, is_late: bool) -> Mark:
    """Return what a worker tells the others now."""
    return Mark(size, expanded, end, memory_taken(), is_late)


def kept(before: Sequence[int], sizes: Sequence[int], most: int) -> list[int]:
    """Return how many rows each worker keeps, that there are no more than allowed: it gives up what came last.

    >>> kept([5, 5], [9, 8], 15)
    [9, 6]
    """
    found, excess = list(sizes), sum(sizes) - most
    for worker in reversed(range(len(found))):
        given_up = min(max(excess, 0), found[worker] - before[worker])
        found[worker] -= given_up
        excess -= given_up
    return found
