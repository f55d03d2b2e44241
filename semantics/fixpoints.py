"""Least fixpoints: of a relation from some values, and of a monotone function."""

from collections.abc import Callable, Hashable, Iterable
from typing import TypeVar

Node = TypeVar("Node", bound=Hashable)
Value = TypeVar("Value")


def closure(start: Iterable[Node], lead: Callable[[Node], Iterable[Node]]) -> frozenset[Node]:
    """Return the reflexive transitive closure of some values under a relation.

    >>> sorted(closure([1], lambda n: [2 * n] if n < 5 else []))
    [1, 2, 4, 8]
    """
    seen: set[Node] = set()
    waiting = list(start)
    while waiting:
        node = waiting.pop()
        if node not in seen:
            seen.add(node)
            waiting.extend(lead(node))
    return frozenset(seen)


def fixpoint(grow: Callable[[Value], Value], start: Value) -> Value:
    """Return the first value that a function leaves as it is, from a start on.

    >>> fixpoint(lambda n: min(2 * n, 100), 1)
    100
    """
    grown = grow(start)
    while grown != start:
        start, grown = grown, grow(grown)
    return start
