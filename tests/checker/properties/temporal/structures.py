"""Small transition systems and formulas, generated; and what is true of them by the definitions, slowly."""

from itertools import combinations
from random import Random

import networkx as nx
import numpy as np
from hypothesis import strategies as st

from checker.engines.graph import Graph
from checker.properties.temporal.digraph import rows_of
from checker.properties.temporal.fairness import conditions_of
from checker.properties.temporal.truth import FormulaTruth
from semantics.properties.propositions import Always, Known
from semantics.properties.temporal import (
    Both,
    Denied,
    Either,
    Enabled,
    Eventually,
    Fairness,
    Globally,
    Next,
    Now,
    OnAllPaths,
    OnSomePath,
    Release,
    Steps,
    Taken,
    Until,
    WeakUntil,
)
from semantics.state.configuration import Label

LABELS = (Label("fun", "a"), Label("sense", "a"), Label("fun", "b"), Label("env", None, "wind"))
P, Q = Known("p"), Known("q")
STEPS = (Steps((), "a"), Steps(("sense",), "a"), Steps((), "b"), Steps(("env",)), Steps(("fun",)))


def graph_from(edges, size):
    """Make a graph of (source, label, target) triples."""
    triples = sorted(set(edges))
    sources = np.array([source for source, _, _ in triples], dtype=np.int32)
    targets = np.array([target for _, _, target in triples], dtype=np.int32)
    actions = np.array([action for _, action, _ in triples], dtype=np.int32)
    return Graph(rows_of(sources, targets, size).starts, targets, actions, LABELS)


def random_graph(chance, most):
    size = chance.randint(1, most)
    nodes = range(size)
    edges = [
        (chance.choice(nodes), chance.randrange(len(LABELS)), chance.choice(nodes))
        for _ in range(chance.randint(size - 1, 3 * size))
    ]
    return graph_from(edges, size)


@st.composite
def truths(draw, most=4):
    """Yield a total graph, of which some configurations may be terminal, with the values of p and q.

    Drawn by a seed: what hypothesis draws edge by edge is mostly too small to have components of some shape.
    """
    chance = Random(draw(st.integers(0, 2**32)))
    return valued(random_graph(chance, most).total(), chance)


def valued(graph, chance):
    values = {each: [chance.random() < 0.5 for _ in range(graph.size)] for each in (P, Q)}
    values |= {Always(value): [value] * graph.size for value in (False, True)}
    return FormulaTruth(graph, {each: np.array(row, dtype=np.bool_) for each, row in values.items()})


fairnesses = st.builds(
    Fairness, st.booleans(), st.sampled_from(STEPS), st.sampled_from([(), ("agent",), ("label",)])
)

HERE = st.sampled_from([Now(P), Now(Q), Enabled(STEPS[0]), Enabled(STEPS[3])])
ON_EDGES = st.sampled_from([Taken(steps) for steps in STEPS])


def _joined(inner):
    return st.builds(Denied, inner) | st.builds(Both, inner, inner) | st.builds(Either, inner, inner)


def _path(inner):
    one = [st.builds(make, inner) for make in (Next, Eventually, Globally)]
    two = [st.builds(make, inner, inner) for make in (Until, Release, WeakUntil)]
    return st.one_of(*one, *two)


linear = st.recursive(HERE | ON_EDGES, lambda inner: _joined(inner) | _path(inner), max_leaves=5)
branching = st.recursive(
    HERE,
    lambda inner: _joined(inner) | st.builds(OnAllPaths, _path(inner)) | st.builds(OnSomePath, _path(inner)),
    max_leaves=5,
)

# --- linear time, by the definition on a run that is written out ----------------------------------------------


class Unrolled:
    """A run as a function of time; beyond the second round of its loop nothing new happens."""

    def __init__(self, truth, stem, loop):
        self.truth, self.stem, self.loop = truth, tuple(stem), tuple(loop)
        self.known = {}

    def edge(self, time):
        if time < len(self.stem):
            return self.stem[time]
        return self.loop[(time - len(self.stem)) % len(self.loop)]

    def holds(self, formula, time=0):
        if time >= len(self.stem):
            time = len(self.stem) + (time - len(self.stem)) % len(self.loop)
        if (formula, time) not in self.known:
            self.known[formula, time] = self._holds(formula, time)
        return self.known[formula, time]

    def future(self, time):
        return range(time, max(time, len(self.stem)) + len(self.loop) + 1)

    def _holds(self, formula, time):
        graph = self.truth.graph
        source, action = graph.sources[self.edge(time)], graph.actions[self.edge(time)]
        match formula:
            case Now(proposition):
                return bool(self.truth.values[proposition][source])
            case Taken(steps):
                return bool(action >= 0 and steps.has(graph.labels[action]))
            case Enabled(steps):
                return is_enabled(graph, steps, source)
            case Denied(f):
                return not self.holds(f, time)
            case Both(f, g):
                return self.holds(f, time) and self.holds(g, time)
            case Either(f, g):
                return self.holds(f, time) or self.holds(g, time)
            case Next(f):
                return self.holds(f, time + 1)
            case Eventually(f):
                return any(self.holds(f, later) for later in self.future(time))
            case Globally(f):
                return all(self.holds(f, later) for later in self.future(time))
            case Until(f, g):
                return any(
                    self.holds(g, then) and all(self.holds(f, before) for before in range(time, then))
                    for then in self.future(time)
                )
            case WeakUntil(f, g):
                return self._holds(Until(f, g), time) or self._holds(Globally(f), time)
            case Release(f, g):
                return not self._holds(Until(Denied(f), Denied(g)), time)


def is_enabled(graph, steps, source):
    row = range(graph.starts[source], graph.starts[source + 1])
    return any(graph.actions[e] >= 0 and steps.has(graph.labels[graph.actions[e]]) for e in row)


def is_fair(truth, loop, declared, nodes=None):
    """Tell whether going round a loop for ever is fair, by the definition."""
    graph = truth.graph
    groups = {}
    for fairness in declared:
        for label in graph.labels:
            if fairness.steps.has(label):
                key = tuple(str(label) if word == "label" else getattr(label, word) for word in fairness.per)
                groups.setdefault((fairness, key), set()).add(label)
    for (fairness, _), members in groups.items():
        taken = any(graph.actions[e] >= 0 and graph.labels[graph.actions[e]] in members for e in loop)
        ready = [
            any(
                graph.actions[e] >= 0 and graph.labels[graph.actions[e]] in members
                for e in range(graph.starts[node], graph.starts[node + 1])
            )
            for node in (nodes if nodes is not None else [graph.sources[e] for e in loop])
        ]
        if not taken and (any(ready) if fairness.strong else all(ready)):
            return False
    return True


def lassos(graph, most):
    """Yield the stems and loops of the runs from configuration 0 that come round within so many edges."""
    waiting = [((), 0)]
    while waiting:
        path, node = waiting.pop()
        visited = [0, *(int(graph.targets[e]) for e in path)]
        for cut in range(len(path)):
            if visited[cut] == node:
                yield path[:cut], path[cut:]
        if len(path) < most:
            row = range(graph.starts[node], graph.starts[node + 1])
            waiting += [((*path, e), int(graph.targets[e])) for e in row]


def is_run(graph, stem, loop):
    """Tell whether edges make a run from configuration 0 that comes round."""
    at = 0
    for edge in (*stem, *loop):
        if graph.sources[edge] != at:
            return False
        at = int(graph.targets[edge])
    return not loop or at == graph.sources[loop[0]]


# --- branching time, by sets of configurations ----------------------------------------------------------------


class Sets:
    """The configurations of which a branching formula is true, by textbook fixpoints over sets."""

    def __init__(self, truth, declared):
        self.truth, self.declared, self.graph = truth, declared, truth.graph
        self.all = frozenset(range(truth.graph.size))
        self.edges = list(zip(truth.graph.sources.tolist(), truth.graph.targets.tolist(), strict=True))

    def fair_sets(self, within):
        """Yield the sets of configurations that a fair run may visit infinitely often, and no others."""
        for count in range(1, len(within) + 1):
            for nodes in combinations(sorted(within), count):
                inner = [e for e, (a, b) in enumerate(self.edges) if a in nodes and b in nodes]
                shape = nx.MultiDiGraph([self.edges[e] for e in inner])
                shape.add_nodes_from(nodes)
                strong = nx.is_strongly_connected(shape)
                if inner and strong and is_fair(self.truth, inner, self.declared, nodes):
                    yield frozenset(nodes)

    def backwards(self, kept, goal):
        found = set(goal)
        while new := {a for a, b in self.edges if b in found and a in kept and a not in found}:
            found |= new
        return frozenset(found)

    def where(self, formula):
        match formula:
            case Now(proposition):
                return frozenset(np.flatnonzero(self.truth.values[proposition]).tolist())
            case Enabled(steps):
                return frozenset(node for node in self.all if is_enabled(self.graph, steps, node))
            case Denied(f):
                return self.all - self.where(f)
            case Both(f, g):
                return self.where(f) & self.where(g)
            case Either(f, g):
                return self.where(f) | self.where(g)
            case OnSomePath(path):
                return self.on_some(path)
            case OnAllPaths(path):
                return self.all - self.on_some(dual(path))

    def on_some(self, path):
        match path:
            case Next(f):
                after = self.where(f)
                return frozenset(a for a, b in self.edges if b in after)
            case Eventually(f):
                return self.backwards(self.all, self.where(f))
            case Globally(f):
                kept = self.where(f)
                return self.backwards(kept, frozenset().union(*self.fair_sets(kept)))
            case Until(f, g):
                return self.backwards(self.where(f), self.where(g))
            case WeakUntil(f, g):
                return self.on_some(Until(f, g)) | self.on_some(Globally(f))
            case Release(f, g):
                return self.on_some(Until(g, Both(f, g))) | self.on_some(Globally(g))


def dual(path):
    match path:
        case Next(f):
            return Next(Denied(f))
        case Eventually(f):
            return Globally(Denied(f))
        case Globally(f):
            return Eventually(Denied(f))
        case Until(f, g):
            return Release(Denied(f), Denied(g))
        case Release(f, g):
            return Until(Denied(f), Denied(g))
        case WeakUntil(f, g):
            return Until(Denied(g), Both(Denied(f), Denied(g)))


def conditions(truth, declared):
    return conditions_of(declared, truth.graph, ())
