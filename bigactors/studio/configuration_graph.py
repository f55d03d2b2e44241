"""The graph of a mission's configurations: all of a small mission, else those around one configuration."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Final

from bigactors.commands.simulate.one_run import Choice
from bigactors.studio.run_address import joined
from checker import Trace
from checker.reports.plain_steps import step_words
from semantics.state.configuration import Configuration

MOST_NODES: Final = 500
"""The most configurations of a whole graph."""

MOST_AROUND: Final = 60
"""The most configurations of a neighbourhood."""

SECONDS: Final = 5.0

Steps = Callable[[Configuration], Iterable[Configuration]]


@dataclass(slots=True)
class ConfigurationGraph:
    """Configurations as numbers, in the order of discovery, and the steps between them.

    Attributes:
        numbers: The number of each configuration.
        address: For each configuration, the address of the run by which it was found.
        depths: For each configuration, the number of steps of this run.
        edges: The words of the steps between two configurations.
        whole: Whether each step of each configuration is in it.
    """

    numbers: dict[Configuration, int] = field(default_factory=dict)
    address: list[str] = field(default_factory=list)
    depths: list[int] = field(default_factory=list)
    edges: dict[tuple[int, int], list[tuple[str | None, str]]] = field(default_factory=dict)
    whole: bool = True

    def add(self, c: Configuration, address: str, depth: int) -> int:
        """Return the number of a configuration, which is new if it was not known."""
        if c not in self.numbers:
            self.numbers[c] = len(self.address)
            self.address.append(address)
            self.depths.append(depth)
        return self.numbers[c]

    def follow(self, trace: Trace) -> None:
        """Add the edges of a run, of which a seen world may have decided steps."""
        for (before, after), step in zip(pairwise(trace.configurations), trace.steps, strict=True):
            begin, end = self.numbers.get(before), self.numbers.get(after)
            if begin is not None and end is not None and (begin, end) not in self.edges:
                self.edges[begin, end] = [(step.label.agent, step_words(before, step.label, after))]


def reached(
    starts: Mapping[Configuration, tuple[str, int]],
    choices: Callable[[str, Configuration], Iterable[Choice]],
    most: int,
) -> ConfigurationGraph:
    """Return the graph of at most so many configurations that is reached from some, breadth first.

    `starts` has their addresses and depths.
    """
    graph, end = ConfigurationGraph(), time.monotonic() + SECONDS
    for c, (address, depth) in starts.items():
        graph.add(c, address, depth)
    for c in (waiting := list(starts)):
        here = graph.numbers[c]
        if time.monotonic() > end:
            graph.whole = False
            break
        for rank, choice in enumerate(choices(graph.address[here], c)):
            target = choice.transition.target
            known = target in graph.numbers
            if not known and len(graph.numbers) >= most:
                graph.whole = False
                continue
            there = graph.add(target, joined(graph.address[here], rank), graph.depths[here] + 1)
            words = step_words(c, choice.transition.label, target)
            graph.edges.setdefault((here, there), []).append((choice.transition.label.agent, words))
            if not known:
                waiting.append(target)
    return graph


def graph_json(
    graph: ConfigurationGraph, run: list[Configuration], bad: Callable[[Configuration], bool]
) -> dict[str, Any]:
    """Return a graph as plain data; chains of configurations without another way are folded into one edge."""
    on_run = {graph.numbers[c]: at for at, c in enumerate(run) if c in graph.numbers}
    bads = {number for c, number in graph.numbers.items() if bad(c)}
    kept = {*on_run, *bads, *_branching(graph)}
    nodes = [
        {"id": n, "depth": graph.depths[n], "run": graph.address[n]}
        | ({"at": on_run[n]} if n in on_run else {})
        | ({"bad": True} if n in bads else {})
        for n in sorted(kept)
    ]
    edges = [
        {
            "from": begin,
            "to": end,
            "words": [words for _, words in steps],
            "agents": sorted({a or "" for a, _ in steps}),
        }
        | ({"folded": folded} if folded else {})
        for begin, end, steps, folded in _chains(graph, kept)
    ]
    return {"whole": graph.whole, "count": len(graph.numbers), "nodes": nodes, "edges": edges}


def _branching(graph: ConfigurationGraph) -> Iterator[int]:
    """Yield the first configuration, and those that do not have exactly one way in and one way out."""
    ins, outs = Counter(end for _, end in graph.edges), Counter(begin for begin, _ in graph.edges)
    for number in range(len(graph.address)):
        if number == 0 or (ins[number], outs[number]) != (1, 1) or (number, number) in graph.edges:
            yield number


def _chains(
    graph: ConfigurationGraph, kept: set[int]
) -> Iterator[tuple[int, int, list[tuple[str | None, str]], int]]:
    """Yield the edges between kept configurations: begin, end, steps, and the number of folded configurations."""
    onward = {begin: end for begin, end in graph.edges if begin not in kept}
    for (begin, end), steps in graph.edges.items():
        if begin not in kept:
            continue
        folded, told = 0, list(steps)
        while end not in kept:
            folded, told, end = folded + 1, [*told, *graph.edges[end, onward[end]]], onward[end]  # noqa: PLW2901
        yield begin, end, told, folded
