"""The longest stays of runs among some states, and timelocks: graphs whose edges take one tick or no time."""

import math
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from typing import Final

from checker.engines.timed.first_runs import DELAY, RunEdge
from checker.limits import look

NEVER: Final = -math.inf
"""The duration of runs to an unreachable end."""

LOOKING: Final = 1 << 14
"""The number of states between two checks of the bounds."""

Graph = Sequence[Sequence[RunEdge]]


def longest(graph: Graph, inside: Sequence[bool], ends: Callable[[int], bool]) -> list[float]:
    """Return for each state the most ticks of a run to an end that stays inside.

    It is `math.inf` if such a run may repeat a cycle with a delay, and `NEVER` outside and where no run ends. Linear
    time: strongly connected components are found in reverse topological order (Tarjan 1972).
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
    """Yield the strongly connected components of the states inside, each after its successors."""
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


def first_ticks(graph: Graph) -> list[float]:
    """Return for each state the least ticks from the first state."""
    first = [math.inf] * len(graph)
    first[0] = 0
    waiting = deque([0])
    while waiting:
        state = waiting.popleft()
        if state % LOOKING == 0:
            look()
        for step, target in graph[state]:
            ticks = first[state] + (step == DELAY)
            if ticks < first[target]:
                first[target] = ticks
                (waiting.append if step == DELAY else waiting.appendleft)(target)
    return first


def last_ticks(graph: Graph) -> list[float]:
    """Return for each state the most ticks from the first state; infinite after a cycle with a delay."""
    last = [NEVER] * len(graph)
    last[0] = 0
    for component in reversed(list(components(graph, [True] * len(last)))):
        members = set(component)
        ticks = max(last[state] for state in component)
        if any(step == DELAY and target in members for state in component for step, target in graph[state]):
            ticks = math.inf
        for state in component:
            last[state] = ticks
            for step, target in graph[state]:
                if target not in members:
                    last[target] = max(last[target], ticks + (step == DELAY))
    return last


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
