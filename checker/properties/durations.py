"""How long runs may stay among some states, and whether time can go on: graphs whose edges take a tick, or none."""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Final

from checker.engines.runs import DELAY, Edge
from checker.limits import look

NEVER: Final = -math.inf
"""How long runs take to an end that none comes to."""

LOOKING: Final = 1 << 14
"""After so many states it is looked whether a bound is met."""

Graph = Sequence[Sequence[Edge]]


def longest(graph: Graph, inside: Sequence[bool], ends: Callable[[int], bool]) -> list[float]:
    """Return for each state how many ticks a run inside may take at most to a state that is an end.

    That is `math.inf` where a run may go round as often as it likes, and `NEVER` outside and where no run ends. Linear:
    strongly connected components are found in reverse topological order (Tarjan 1972).
    """
    most = [NEVER] * len(graph)
    for component in components(graph, inside):
        members = set(component)
        best, turns = NEVER, False
        for state in component:
            best = max(best, 0 if ends(state) else NEVER)
            for step, target in graph[state]:
                if target in members:
                    turns = turns or step == DELAY
                elif inside[target]:
                    best = max(best, most[target] + (step == DELAY))
        for state in component:
            most[state] = math.inf if turns and best > NEVER else best
    return most


def components(graph: Graph, inside: Sequence[bool]) -> Iterator[list[int]]:
    """Yield the strongly connected components of the states inside, each after those that it leads to."""
    order: dict[int, int] = {}
    low: dict[int, int] = {}
    stack: list[int] = []
    waiting: set[int] = set()
    for root in range(len(graph)):
        if not inside[root] or root in order:
            continue
        path = [(root, iter(graph[root]))]
        order[root] = low[root] = len(order)
        stack.append(root)
        waiting.add(root)
        while path:
            state, edges = path[-1]
            for _, target in edges:
                if not inside[target]:
                    continue
                if target not in order:
                    if len(order) % LOOKING == 0:
                        look()
                    order[target] = low[target] = len(order)
                    stack.append(target)
                    waiting.add(target)
                    path.append((target, iter(graph[target])))
                    break
                if target in waiting:
                    low[state] = min(low[state], order[target])
            else:
                path.pop()
                if path:
                    before = path[-1][0]
                    low[before] = min(low[before], low[state])
                if low[state] == order[state]:
                    component = [stack.pop()]
                    while component[-1] != state:
                        component.append(stack.pop())
                    waiting.difference_update(component)
                    yield component


def stopped(graph: Graph, open_ends: Sequence[bool]) -> list[bool]:
    """Return for each state whether no time can ever pass again; at an open end it may."""
    sources: list[list[int]] = [[] for _ in graph]
    for state, edges in enumerate(graph):
        for _, target in edges:
            sources[target].append(state)
    passing = [
        state
        for state, edges in enumerate(graph)
        if open_ends[state] or any(step == DELAY for step, _ in edges)
    ]
    stops = [True] * len(graph)
    for state in passing:
        stops[state] = False
    while passing:
        for source in sources[passing.pop()]:
            if stops[source]:
                stops[source] = False
                passing.append(source)
    return stops
