"""Tarjan's algorithm (1972) for strongly connected components, without recursion: in Python, or compiled."""

from collections.abc import MutableSequence, Sequence
from typing import NamedTuple


class SearchRoom(NamedTuple):
    """The room of a search, a number for each node, all 0 before.

    Attributes:
        order: The position of each node in the order of the search, from 1.
        low: The least position that is known to be reached from a node in its component.
        path: The nodes on the search's path.
        stack: The nodes without a component.
        at: The next edge of each node on the path.
    """

    order: MutableSequence[int]
    low: MutableSequence[int]
    path: MutableSequence[int]
    stack: MutableSequence[int]
    at: MutableSequence[int]


def divide(
    starts: Sequence[int], targets: Sequence[int], component: MutableSequence[int], room: SearchRoom
) -> int:
    """Number the components, and return how many there are; `component` is -1 for each node before."""
    order, low, path, stack, at = room
    count = seen = depth = height = 0
    for root in range(len(component)):
        if order[root]:
            continue
        node = root
        while True:
            if not order[node]:
                seen += 1
                order[node] = low[node] = seen
                at[node] = starts[node]
                path[depth] = stack[height] = node
                depth += 1
                height += 1
            if at[node] < starts[node + 1]:
                target = targets[at[node]]
                at[node] += 1
                if not order[target]:
                    node = target
                elif component[target] < 0:
                    low[node] = min(low[node], order[target])
                continue
            if low[node] == order[node]:
                while component[node] < 0:
                    height -= 1
                    component[stack[height]] = count
                count += 1
            depth -= 1
            if not depth:
                break
            parent = path[depth - 1]
            low[parent] = min(low[parent], low[node])
            node = parent
    return count
