"""Shortest lassos beside all lassos there are, enumerated by length and judged by the definitions."""

from dataclasses import replace
from itertools import pairwise
from random import Random

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from scale import examples
from structures import (
    STEPS,
    P,
    Q,
    Unrolled,
    conditions,
    fairnesses,
    graph_from,
    is_fair,
    is_run,
    lassos,
    linear,
    random_graph,
    truths,
    valued,
)

from checker.properties.temporal import cycles, shortest
from checker.properties.temporal.branching import Branching
from checker.properties.temporal.effort import Effort
from checker.properties.temporal.linear import counterexample, shortest_counterexample
from checker.properties.temporal.truth import Truth
from semantics.properties.temporal import (
    Both,
    Denied,
    Either,
    Eventually,
    Globally,
    Next,
    Now,
    OnSomePath,
    Taken,
    Until,
)

LONGEST = 7
"""Of the lassos that are enumerated."""

moments = st.recursive(
    st.sampled_from([Now(P), Now(Q), *map(Taken, STEPS)]),
    lambda inner: (
        st.builds(Denied, inner)
        | st.builds(Next, inner)
        | st.builds(Both, inner, inner)
        | st.builds(Either, inner, inner)
        | st.builds(Until, inner, inner)
    ),
    max_leaves=4,
)
recurrences = moments.map(lambda f: Globally(Eventually(f))) | moments.map(lambda f: Eventually(Globally(f)))
formulas = linear | recurrences | st.builds(Either, recurrences, recurrences)


def violates(truth, formula, declared, stem, loop):
    return is_fair(truth, loop, declared) and not Unrolled(truth, stem, loop).holds(formula)


@examples(250)
@given(truths(5), formulas, st.lists(fairnesses, max_size=3))
def test_no_lasso_that_violates_a_formula_is_shorter_than_one_said_to_be_shortest(truth, formula, declared):
    found = shortest_counterexample(truth.graph, truth, formula, conditions(truth, declared))
    assume(found is not None and found.loop)
    assert is_run(truth.graph, found.stem, found.loop)
    assert violates(truth, formula, declared, found.stem, found.loop)
    assert found.shortest  # so small a graph takes no effort
    shorter = lassos(truth.graph, min(len(found) - 1, LONGEST))
    assert not any(violates(truth, formula, declared, *each) for each in shorter)


@examples(200)
@given(truths(5), st.lists(fairnesses, max_size=3))
def test_no_fair_lasso_through_some_configurations_is_shorter(truth, declared):
    tree = Branching(truth.graph, truth, conditions(truth, declared))
    assume(tree.where(OnSomePath(Globally(Now(P))))[0])
    found = tree.evidence(OnSomePath(Globally(Now(P))))
    assert found.shortest
    shorter = lassos(truth.graph, min(len(found) - 1, LONGEST))
    sources = truth.graph.sources
    assert not any(
        is_fair(truth, loop, declared) and all(truth.values[P][sources[e]] for e in (*stem, *loop))
        for stem, loop in shorter
    )


def rings(*sizes):
    """Return a graph of rings through configuration 0, and what is true nowhere."""
    edges, at = [], 1
    for size in sizes:
        ring = [0, *range(at, at + size - 1), 0]
        edges += [(a, 0, b) for a, b in pairwise(ring)]
        at += size - 1
    graph = graph_from(edges, at)
    return Truth(graph, {each: np.zeros(at, dtype=np.bool_) for each in (P, Q)})


def test_a_loop_is_not_gone_round_twice_for_the_automaton():
    truth = rings(3)
    truth.values[P][[0, 2]] = True
    twice = Denied(Both(Now(P), Globally(Eventually(Both(Now(P), Next(Next(Next(Denied(Now(Q))))))))))
    found = shortest_counterexample(truth.graph, truth, twice, conditions(truth, []))
    assert (len(found), found.shortest) == (3, True)


BOTH = Denied(Both(Globally(Eventually(Now(P))), Globally(Eventually(Now(Q)))))


def two_near():
    """Return rings on which p and q are true, each a step away on a ring of nine, both on a ring of four."""
    truth = rings(9, 9, 4)
    truth.values[P][[1, 18]] = truth.values[Q][[9, 19]] = True
    return truth


def test_a_shortest_loop_has_all_that_recurs_and_not_the_nearest_of_each():
    truth = two_near()
    found = shortest_counterexample(truth.graph, truth, BOTH, conditions(truth, []))
    assert (len(found), found.shortest) == (4, True)


def test_what_was_found_first_is_shortened():
    three = Denied(Both(BOTH.formula, Globally(Eventually(Taken(STEPS[3])))))
    lengths = []
    for seed in range(40):
        chance = Random(seed)
        truth = valued(random_graph(chance, 12).total(), chance)
        first, least = (
            search(truth.graph, truth, three, conditions(truth, []))
            for search in (counterexample, shortest_counterexample)
        )
        lengths.append((0, 0) if first is None else (len(first), len(least)))
    assert all(least <= first for first, least in lengths)
    assert any(least < first for first, least in lengths)


def test_where_too_much_has_to_be_met_a_lasso_is_not_said_to_be_shortest(monkeypatch):
    monkeypatch.setattr(cycles, "MOST_BITS", 0)
    truth = rings(2, 2)
    truth.values[P][1] = truth.values[Q][2] = True
    found = shortest_counterexample(truth.graph, truth, BOTH, conditions(truth, []))
    assert is_run(truth.graph, found.stem, found.loop)
    assert not found.shortest


def test_where_effort_ends_a_lasso_is_not_said_to_be_shortest(monkeypatch):
    monkeypatch.setattr(shortest, "Effort", lambda: Effort(300))
    truth = rings(3, 5)
    found = shortest_counterexample(truth.graph, truth, Eventually(Now(P)), conditions(truth, []))
    assert is_run(truth.graph, found.stem, found.loop)
    assert not found.shortest


def test_a_run_of_what_was_cut_off_is_not_said_to_be_shortest():
    truth = rings(3, 5)
    partial = replace(truth.graph, partial=np.arange(truth.graph.size) == 4)
    cut = Truth(partial, truth.values)
    assert not shortest_counterexample(partial, cut, Eventually(Now(P)), conditions(cut, [])).shortest
    assert not shortest_counterexample(partial, cut, Globally(Now(P)), conditions(cut, [])).shortest
