"""Graphs that were not explored to the end: what is said of them is true of every way in which they may go on."""

from dataclasses import replace
from random import Random

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scale import examples
from structures import (
    Unrolled,
    branching,
    conditions,
    fairnesses,
    graph_from,
    is_fair,
    is_run,
    linear,
    random_graph,
    valued,
)

from checker.properties.temporal.branching import Branching
from checker.properties.temporal.linear import counterexample

declarations = st.lists(fairnesses, max_size=3)


@st.composite
def cut_truths(draw):
    """Yield a graph with its values, and the same as an exploration leaves it that was cut off."""
    chance = Random(draw(st.integers(0, 2**32)))
    whole = random_graph(chance, 4)
    partial = np.array([chance.random() < 0.4 for _ in range(whole.size)])
    edges = zip(whole.sources.tolist(), whole.actions.tolist(), whole.targets.tolist(), strict=True)
    kept = [edge for edge in edges if not partial[edge[0]] or chance.random() < 0.5]
    cut = replace(graph_from(kept, whole.size), partial=partial if partial.any() else None)
    truth = valued(whole.total(), chance)
    return truth, replace(truth, graph=cut.total(), known={})


@examples(300)
@given(cut_truths(), linear, declarations)
def test_a_run_found_in_a_part_violates_the_formula_in_the_whole(truths, formula, declared):
    whole, part = truths
    found = counterexample(part.graph, part, formula, conditions(part, declared))
    if found is None:
        return
    stem, loop = (tuple(edge_in(whole.graph, part.graph, e) for e in es) for es in (found.stem, found.loop))
    assert is_run(whole.graph, stem, loop)
    if loop:
        assert is_fair(whole, loop, declared)
        assert not Unrolled(whole, stem, loop).holds(formula)


@examples(300)
@given(cut_truths(), branching, declarations)
def test_what_is_sure_of_a_part_is_true_of_the_whole_and_what_is_true_may_be(truths, formula, declared):
    whole, part = truths
    true = Branching(whole.graph, whole, conditions(whole, declared)).where(formula)
    seen = Branching(part.graph, part, conditions(part, declared))
    assert not (seen.where(formula) & ~true).any()
    assert not (true & ~seen.where(formula, perhaps=True)).any()


@examples(200)
@given(cut_truths(), branching, declarations)
def test_evidence_of_what_is_sure_is_a_fair_run_of_the_whole(truths, formula, declared):
    whole, part = truths
    seen = Branching(part.graph, part, conditions(part, declared))
    true, false = seen.where(formula)[0], not seen.where(formula, perhaps=True)[0]
    if not (true or false):
        return
    found = seen.evidence(formula, claimed=bool(true))
    stem, loop = (tuple(edge_in(whole.graph, part.graph, e) for e in es) for es in (found.stem, found.loop))
    assert is_run(whole.graph, stem, loop)
    assert not loop or is_fair(whole, loop, declared)


def edge_in(whole, part, edge):
    """Return the same edge in another graph."""
    same = (
        (whole.sources == part.sources[edge])
        & (whole.targets == part.targets[edge])
        & (whole.actions == part.actions[edge])
    )
    return int(np.flatnonzero(same)[0])
