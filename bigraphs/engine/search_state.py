"""A search in progress, and its results."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, NamedTuple, TypeAlias

from bigraphs.engine.patterns import CompiledPattern
from bigraphs.engine.state_arrays import GroundState

OFTEN: Final = 0x3FF
"""The number of steps between two pauses of a search, minus one."""


class PatternOccurrence(NamedTuple):
    """An occurrence of a pattern: the slot of each node, the link of each pattern link, and the mask of the slots.

    An idle link of the pattern has -1.
    """

    nodes: tuple[int, ...]
    links: tuple[int, ...]
    mask: int


class PatternSearch:
    """A search: the pattern, the state, the partial assignment, and the occurrences found."""

    __slots__ = ("allowed", "found", "links", "nodes", "once", "pattern", "state", "steps")

    def __init__(self, state: GroundState, pattern: CompiledPattern, allowed: int, *, once: bool) -> None:
        self.pattern = pattern
        self.state = state
        self.allowed = allowed
        self.once = once
        self.steps = 0
        self.nodes = [-1] * pattern.size
        self.links = [-1] * len(pattern.on)
        self.found: list[PatternOccurrence] = []


Step: TypeAlias = Callable[[PatternSearch, int], bool]
"""Places the remaining nodes of a pattern outside the slots in a mask; returns whether the search is over."""

Placing: TypeAlias = Callable[[PatternSearch, int, int], bool]
"""Places one node at a slot, then the remaining nodes."""
