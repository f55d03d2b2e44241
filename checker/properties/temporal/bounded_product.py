"""The product of a graph and a tight automaton, up to a number of steps."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from checker.engines.graph import Bools, Graph, Numbers
from checker.properties.temporal.digraph import Indices, leaving, rows_of
from checker.properties.temporal.effort import Effort, Exhausted
from checker.properties.temporal.product import Product
from checker.properties.temporal.tight_automaton import Tight, bits
from checker.properties.temporal.truth import Truth
from semantics.properties.temporal import Taken, Temporal

MOST_CODES: Final = 1 << 26
"""Pairs of a configuration and a state that may be numbered."""


@dataclass(frozen=True, eq=False)
class Nearby:
    """The product, and how far each of its nodes is from the nearest that begins."""

    product: Product
    depths: Numbers


def nearby(graph: Graph, automaton: Tight, truth: Truth, most: int, effort: Effort) -> Nearby:
    """Return the product as far as so many steps lead from configuration 0.

    Raises:
        Exhausted: It would be too large.
    """
    return _Search(graph, automaton, truth, effort).run(most)


@dataclass(frozen=True, eq=False)
class _Layer:
    """Edges of the product: their sources, the codes of their targets, the graph's edges, marks."""

    sources: Indices
    codes: Indices
    edges: Indices
    marks: Numbers


class _Search:
    """A node's code is its configuration times the number of states, plus the state."""

    def __init__(self, graph: Graph, automaton: Tight, truth: Truth, effort: Effort) -> None:
        self.graph, self.automaton, self.truth, self.effort = graph, automaton, truth, effort
        self.states = automaton.states
        if graph.size * self.states > MOST_CODES:
            raise Exhausted
        self.numbers = np.zeros(graph.size * self.states, dtype=np.int32)  # of each code, plus one
        first = np.arange(self.states // 2, self.states, dtype=np.int64)
        nowhere = np.full(len(first), -1, dtype=np.int64)
        self.codes, self.before, self.by, self.count = [first], [nowhere], [nowhere], len(first)
        self.numbers[first] = np.arange(1, self.count + 1)

    def run(self, most: int) -> Nearby:
        found = [self.expand(self.codes[0])]
        while len(self.codes) <= most and len(self.codes[-1]):
            self.discover(found[-1])
            found.append(self.expand(self.codes[-1]))
        sources, codes, edges, marks = (
            np.concatenate([getattr(layer, column) for layer in found])
            for column in ("sources", "codes", "edges", "marks")
        )
        inside = np.flatnonzero(self.numbers[codes])
        targets = self.numbers[codes[inside]].astype(np.int64) - 1
        rows = rows_of(sources[inside], targets, self.count)  # layers come in the order of their numbers
        configurations, before, by = map(np.concatenate, (self.codes, self.before, self.by))
        product = Product(
            rows.starts, targets, edges[inside], marks[inside], configurations // self.states, before, by
        )
        return Nearby(product, np.repeat(np.arange(len(self.codes)), list(map(len, self.codes))))

    def discover(self, layer: _Layer) -> None:
        """Number the nodes that a layer leads to for the first time."""
        fresh = np.flatnonzero(self.numbers[layer.codes] == 0)
        _, first = np.unique(layer.codes[fresh], return_index=True)
        new = fresh[np.sort(first)]
        self.numbers[layer.codes[new]] = np.arange(self.count + 1, self.count + 1 + len(new))
        self.count += len(new)
        self.codes.append(layer.codes[new])
        self.before.append(layer.sources[new])
        self.by.append(layer.edges[new])

    def expand(self, codes: Indices) -> _Layer:
        """Return the edges that leave some nodes."""
        configurations, steps = codes // self.states, self.automaton.steps
        counts = np.diff(self.graph.starts)[configurations]
        self.effort.spend(int(counts.sum()))
        edges = leaving(self.graph, configurations)
        letters = self.letters(edges)
        now = letters * self.states + np.repeat(codes % self.states, counts)
        times = np.diff(steps.starts)[now]
        self.effort.spend(int(times.sum()))
        after = steps.targets[leaving(steps, now)]
        sources = np.repeat(np.repeat(self.numbers[codes].astype(np.int64) - 1, counts), times)
        edges, letters = np.repeat(edges, times), np.repeat(letters, times)
        targets = self.graph.targets[edges].astype(np.int64) * self.states + after
        return _Layer(sources, targets, edges, self.automaton.marks[letters * self.states + after])

    def letters(self, edges: Indices) -> Indices:
        """Return what of the automaton's literals is true of steps, a bit each."""
        return bits((self.literal(edges, *each) for each in self.automaton.literals), len(edges))

    def literal(self, edges: Indices, formula: Temporal, claimed: bool) -> Bools:
        if isinstance(formula, Taken):
            true = self.truth.taken(formula)[edges]
        else:
            true = self.truth.here(formula)[self.graph.sources[edges]]
        return true if claimed else ~true
