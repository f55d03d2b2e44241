"""One search in progress, and its results."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, NamedTuple, TypeAlias

from bigraphs.engine.patterns import Pattern
from bigraphs.engine.state import State

OFTEN: Final = 0x3FF
"""After how many steps, less one, a search pauses."""


class Occurrence(NamedTuple):
    """Where a pattern is: the slot of each of its nodes, the link of each of its links, the mask of the slots.

    A link of the pattern that is on no node has -1.
    """

    nodes: tuple[int, ...]
    links: tuple[int, ...]
    mask: int


class Run:
    """One search: the pattern, the state, what is placed so far, and what was found."""

    __slots__ = ("allowed", "found", "links", "nodes", "once", "pattern", "state", "steps")

    def __init__(self, state: State, pattern: Pattern, allowed: int, *, once: bool) -> None:
        self.pattern = pattern
        self.state = state
        self.allowed = allowed
        self.once = once
        self.steps = 0
        self.nodes = [-1] * pattern.size
        self.links = [-1] * len(pattern.on)
        self.found: list[Occurrence] = []


Step: TypeAlias = Callable[[Run, int], bool]
"""Places what is left of a pattern beside the slots in a mask; says whether the search is over."""

Placing: TypeAlias = Callable[[Run, int, int], bool]
"""Places one node at a slot, and then what is left."""
