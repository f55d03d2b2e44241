"""Shortest runs into fair components beside all lassos there are, enumerated by length and judged by definition."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from scale import examples
from structures import P, conditions, fairnesses, graph_from, is_fair, is_run, lassos, truths

from checker.properties.temporal import cycles, shortest
from checker.properties.temporal.branching import Branching
from checker.properties.temporal.components import Conditions, fair_components
from checker.properties.temporal.effort import Effort
from checker.properties.temporal.shortest import run_into
from semantics.properties.temporal import Globally, Now, OnSomePath

LONGEST = 7
"""Of the lassos that are enumerated."""

STAYING = OnSomePath(Globally(Now(P)))


@examples(250)
@given(truths(5), st.lists(fairnesses, max_size=3))
def test_no_fair_lasso_through_some_configurations_is_shorter(truth, declared):
    tree = Branching(truth.graph, truth, conditions(truth, declared))
    assume(tree.where(STAYING)[0])
    found = tree.evidence(STAYING)
    assert found.shortest  # so small a graph takes no effort
    shorter = lassos(truth.graph, min(len(found) - 1, LONGEST))
    sources = truth.graph.sources
    assert not any(
        is_fair(truth, loop, declared) and all(truth.values[P][sources[e]] for e in (*stem, *loop))
        for stem, loop in shorter
    )


def rings(*sizes):
    """Return a graph of rings through configuration 0."""
    edges, at = [], 1
    for size in sizes:
        ring = [0, *range(at, at + size - 1), 0]
        edges += [(a, 0, b) for a, b in pairwise(ring)]
        at += size - 1
    return graph_from(edges, at)


def met_at(graph, *nodes):
    """Return what a run has to do infinitely often: to come to one of some configurations, for each such set."""
    return Conditions(tuple(np.isin(graph.targets, each) for each in nodes))


def run_round(graph, owed):
    """Return a run that goes round in the graph, where all of it is one component."""
    return run_into(graph, fair_components(graph, owed), owed, 0)


def test_a_shortest_loop_has_all_that_recurs_and_not_the_nearest_of_each():
    graph = rings(9, 9, 4)  # each is met a step away on a ring of nine, both on a ring of four
    found = run_round(graph, met_at(graph, [1, 18], [9, 19]))
    assert (len(found), found.shortest) == (4, True)


def test_where_too_much_has_to_be_met_a_lasso_is_not_said_to_be_shortest(monkeypatch):
    monkeypatch.setattr(cycles, "MOST_BITS", 0)
    graph = rings(2, 2)
    found = run_round(graph, met_at(graph, [1], [2]))
    assert is_run(graph, found.stem, found.loop)
    assert not found.shortest


def test_where_effort_ends_a_lasso_is_not_said_to_be_shortest(monkeypatch):
    monkeypatch.setattr(shortest, "Effort", lambda: Effort(300))
    graph = rings(3, 5)
    found = run_round(graph, met_at(graph, [6]))
    assert is_run(graph, found.stem, found.loop)
    assert not found.shortest


def test_a_run_of_what_was_cut_off_is_not_said_to_be_shortest():
    graph = rings(3, 5)
    partial = replace(graph, partial=np.arange(graph.size) == 4)
    assert not run_round(partial, met_at(partial, [1])).shortest
