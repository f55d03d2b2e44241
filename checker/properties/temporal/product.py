"""The reachable product of a graph and an automaton: the runs that violate a formula."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from checker.engines.graph import Bools, Graph, Numbers
from checker.limits import look
from checker.properties.temporal.buchi_automaton import BuchiAutomaton, Move
from checker.properties.temporal.components import Conditions
from checker.properties.temporal.digraph import leaving
from checker.properties.temporal.truth import FormulaTruth, is_about_steps
from semantics.properties.temporal import Taken


@dataclass(frozen=True, eq=False)
class Product:
    """Pairs of a configuration and a state of the automaton, numbered by their distance from the first.

    Attributes:
        starts: The start of the edges of each node, and the end of the last.
        targets: The target of each edge.
        edges: For each edge, the graph's edge.
        marks: For each edge, the promises that it keeps, a bit each.
        configurations: For each node, its configuration.
        before: For each node, its predecessor on a shortest path; -1 for the first.
        by: For each node, the graph's edge from that predecessor.
        prefix: The graph's edges of a shortest path after which the automaton accepts any continuation, if there is
            one; the product is incomplete then.
    """

    starts: Numbers
    targets: Numbers
    edges: Numbers
    marks: Numbers
    configurations: Numbers
    before: Numbers
    by: Numbers
    prefix: tuple[int, ...] | None = None

    @cached_property
    def sources(self) -> Numbers:
        """The source of each edge."""
        return np.repeat(np.arange(len(self.starts) - 1), np.diff(self.starts))

    def way_to(self, node: int) -> tuple[int, ...]:
        """Return the graph's edges of a shortest path to a node."""
        return _way(self.before, self.by, node)

    def conditions(self, promises: int, fairness: Conditions) -> Conditions:
        """Return the conditions of an accepted fair run: each promise is kept infinitely often, and fairness."""
        kept = tuple((self.marks >> bit) & 1 == 1 for bit in range(promises))
        fair = fairness.over(self.configurations, self.edges)
        return Conditions((*kept, *fair.recurrent), fair.strong)


def product_of(graph: Graph, automaton: BuchiAutomaton, truth: FormulaTruth) -> Product:
    """Return the product, breadth-first from configuration 0 and the automaton's first state."""
    return _Search(graph, automaton, truth).run()


def _way(before: Numbers, by: Numbers, node: int) -> tuple[int, ...]:
    found = []
    while before[node] >= 0:
        found.append(int(by[node]))
        node = int(before[node])
    return tuple(reversed(found))


@dataclass(frozen=True, eq=False)
class _Found:
    """Edges of the product: the numbers of their sources, the codes of their targets, the graph's edges, marks."""

    sources: Numbers
    codes: Numbers
    edges: Numbers
    marks: Numbers


@dataclass(eq=False)
class _Search:
    """A node's code is its configuration times the number of states, plus the state."""

    graph: Graph
    automaton: BuchiAutomaton
    truth: FormulaTruth
    found: list[_Found] = field(default_factory=list)
    prefix: tuple[int, ...] | None = None

    def __post_init__(self) -> None:
        self.states = len(self.automaton.moves)
        self.marks = np.min_scalar_type((1 << self.automaton.marks) - 1)
        self.numbers = np.full(self.graph.size * self.states, -1, dtype=np.int32)
        self.numbers[0] = 0
        self.codes: list[Numbers] = [np.zeros(1, dtype=np.int64)]
        self.before: list[Numbers] = [np.full(1, -1, dtype=np.int32)]
        self.by: list[Numbers] = [np.full(1, -1, dtype=np.int64)]
        self.count = 1

    def run(self) -> Product:
        if self.automaton.whatever == 0:
            self.prefix = ()
        while self.prefix is None and len(self.codes[-1]):
            look()
            frontier = self.codes[-1]
            self.accept(frontier)
            if self.prefix is None:
                layer = self.expand(frontier)
                self.found.append(layer)
                self.discover(layer)
        return self.product()

    def accept(self, frontier: Numbers) -> None:
        """Record the first node from which the automaton accepts any continuation without a further step."""
        for state, moves in enumerate(self.automaton.moves):
            free = [m for m in moves if m.target == self.automaton.whatever and not self.on_edges(m)]
            codes = frontier[frontier % self.states == state] if free else frontier[:0]
            for move in free:
                fulfilled = codes[self.allowed(codes // self.states, move)]
                if len(fulfilled) and self.prefix is None:
                    self.prefix = self.way(int(self.numbers[fulfilled[0]]))

    def expand(self, frontier: Numbers) -> _Found:
        """Return the edges that leave a layer."""
        parts = []
        for state, moves in enumerate(self.automaton.moves):
            codes = frontier[frontier % self.states == state]
            parts += [self.follow(codes, move) for move in moves if len(codes)]
        empty = np.zeros(0, dtype=np.int64)
        parts.append(_Found(empty.astype(np.int32), empty, empty, empty.astype(self.marks)))
        columns = zip(*((p.sources, p.codes, p.edges, p.marks) for p in parts), strict=True)
        return _Found(*map(np.concatenate, columns))

    def follow(self, codes: Numbers, move: Move) -> _Found:
        """Return the edges by one move of the automaton."""
        configurations = codes // self.states
        allowed = self.allowed(configurations, move)
        configurations, numbers = configurations[allowed], self.numbers[codes[allowed]]
        edges = leaving(self.graph, configurations)
        sources = np.repeat(numbers, np.diff(self.graph.starts)[configurations])
        for atom, claimed in self.on_edges(move):
            kept = self.truth.taken(atom)[edges] == claimed
            edges, sources = edges[kept], sources[kept]
        if move.target == self.automaton.whatever and len(edges) and self.prefix is None:
            self.prefix = (*self.way(int(sources[0])), int(edges[0]))
        targets = self.graph.targets[edges].astype(np.int64) * self.states + move.target
        return _Found(sources, targets, edges, np.full(len(edges), move.marks, dtype=self.marks))

    def allowed(self, configurations: Numbers, move: Move) -> Bools:
        """Return whether each configuration fulfils a move's literals."""
        found = np.ones(len(configurations), dtype=np.bool_)
        for formula, claimed in map(self.automaton.literals.__getitem__, move.literals):
            if not isinstance(formula, Taken):
                found &= self.truth.here(formula)[configurations] == claimed
                if is_about_steps(formula):  # unknown where successors may be missing
                    found &= ~self.graph.open[configurations]
        return found

    def on_edges(self, move: Move) -> list[tuple[Taken, bool]]:
        """Return a move's literals about the taken step."""
        literals = map(self.automaton.literals.__getitem__, move.literals)
        return [(formula, claimed) for formula, claimed in literals if isinstance(formula, Taken)]

    def discover(self, layer: _Found) -> None:
        """Number the nodes that a layer is the first to reach."""
        fresh = np.flatnonzero(self.numbers[layer.codes] < 0)
        _, first = np.unique(layer.codes[fresh], return_index=True)
        new = fresh[np.sort(first)]
        codes = layer.codes[new]
        self.numbers[codes] = np.arange(self.count, self.count + len(codes), dtype=np.int32)
        self.count += len(codes)
        self.codes.append(codes)
        self.before.append(layer.sources[new])
        self.by.append(layer.edges[new])

    def way(self, node: int) -> tuple[int, ...]:
        return _way(np.concatenate(self.before), np.concatenate(self.by), node)

    def product(self) -> Product:
        """Return the product, its edges sorted by their sources."""
        codes, before, by = (np.concatenate(each) for each in (self.codes, self.before, self.by))
        found = self.found or [self.expand(codes[:0])]
        sources, targets, edges, marks = (
            np.concatenate([getattr(layer, column) for layer in found])
            for column in ("sources", "codes", "edges", "marks")
        )
        order = np.argsort(sources, kind="stable")
        starts = np.concatenate(([0], np.cumsum(np.bincount(sources, minlength=self.count))))
        targets = self.numbers[targets[order]]
        return Product(
            starts, targets, edges[order], marks[order], codes // self.states, before, by, self.prefix
        )
