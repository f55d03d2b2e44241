"""Branching time: fixpoints on arrays beside fixpoints on sets."""

from hypothesis import given
from hypothesis import strategies as st
from scale import examples
from structures import Sets, Unrolled, branching, conditions, fairnesses, is_fair, is_run, truths

from checker.properties.temporal.branching import Branching
from semantics.properties.temporal import OnAllPaths, OnSomePath, parts

declarations = st.lists(fairnesses, max_size=3)


@examples(300)
@given(truths(), branching, declarations)
def test_a_formula_is_true_where_the_definitions_say_so(truth, formula, declared):
    found = Branching(truth.graph, truth, conditions(truth, declared)).where(formula)
    assert set(found.nonzero()[0].tolist()) == Sets(truth, declared).where(formula)


@examples(300)
@given(truths(), branching, declarations)
def test_evidence_is_a_fair_run_and_fulfils_the_formula_if_that_is_about_one_path(truth, formula, declared):
    checked = Branching(truth.graph, truth, conditions(truth, declared))
    claimed = bool(checked.where(formula)[0])
    found = checked.evidence(formula, claimed=claimed)
    assert is_run(truth.graph, found.stem, found.loop)
    if found.loop:
        assert is_fair(truth, found.loop, declared)
    if found.loop and claimed and is_about_one_path(formula):
        assert Unrolled(truth, found.stem, found.loop).holds(formula.formula)


def is_about_one_path(formula):
    return isinstance(formula, OnSomePath) and not any(map(quantified, parts(formula.formula)))


def quantified(formula):
    return isinstance(formula, OnSomePath | OnAllPaths) or any(map(quantified, parts(formula)))
