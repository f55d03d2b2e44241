"""Rounds: the progress that workers exchange, and the decisions that all derive from it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from bigraphs.resources import memory_taken


@dataclass(frozen=True, slots=True)
class RoundLimits:
    """The limits within which workers continue without their leader.

    Attributes:
        rows: The rows that each expands in a round.
        seconds: The time, rounded up to whole rounds.
        configurations: The greatest total number of configurations, None for no limit.
        memory: The greatest memory of each worker in bytes, None for no limit.
    """

    rows: int
    seconds: float
    configurations: int | None
    memory: int | None

    def is_over(self, marks: Sequence["Mark"]) -> bool:
        """Return whether all workers stop: a time or memory limit is met, or no row is left to expand."""
        memory = self.memory is not None and max(each.memory for each in marks) > self.memory
        return memory or any(each.is_late for each in marks) or all(each.is_done for each in marks)


class Mark(NamedTuple):
    """A worker's progress, which it sends to the others after a round.

    Attributes:
        size: The number of its rows.
        expanded: The number of expanded rows.
        end: The end of its layer.
        memory: The bytes of memory of its process.
        is_late: Whether its time is over.
    """

    size: int
    expanded: int
    end: int
    memory: int
    is_late: bool

    @property
    def is_done(self) -> bool:
        """Whether it has no row left to expand."""
        return self.expanded == self.size


def mark(size: int, expanded: int, end: int, *, is_late: bool) -> Mark:
    """Return a worker's present progress."""
    return Mark(size, expanded, end, memory_taken(), is_late)


def kept(before: Sequence[int], sizes: Sequence[int], most: int) -> list[int]:
    """Return the number of rows that each worker keeps within the limit; the last workers drop their new rows first.

    >>> kept([5, 5], [9, 8], 15)
    [9, 6]
    """
    found, excess = list(sizes), sum(sizes) - most
    for worker in reversed(range(len(found))):
        given_up = min(max(excess, 0), found[worker] - before[worker])
        found[worker] -= given_up
        excess -= given_up
    return found
