"""Linear time: the automata and the search beside runs that are enumerated and evaluated by the definitions."""

from hypothesis import given
from hypothesis import strategies as st
from scale import examples
from structures import (
    STEPS,
    P,
    Q,
    Unrolled,
    conditions,
    fairnesses,
    is_fair,
    is_run,
    lassos,
    linear,
    truths,
)

from checker.properties.temporal.lasso_evaluation import is_true_on
from checker.properties.temporal.lassos import Lasso
from checker.properties.temporal.linear import counterexample
from semantics.properties.temporal import Both, Denied, Either, Eventually, Globally, Now, Taken

LONGEST = 5
RECURRENCES = (
    Eventually(Now(P)),
    Globally(Eventually(Now(P))),
    Globally(Either(Denied(Now(P)), Eventually(Now(Q)))),
    Globally(Eventually(Taken(STEPS[0]))),
    Eventually(Globally(Now(P))),
    Either(Globally(Eventually(Now(P))), Globally(Eventually(Now(Q)))),
    Both(Eventually(Globally(Now(P))), Eventually(Globally(Now(Q)))),
    Either(Eventually(Globally(Now(P))), Eventually(Globally(Now(Q)))),
)


def violated(truth, formula, declared):
    """Return a fair run of some length on which a formula is false, by going through them all."""
    for stem, loop in lassos(truth.graph, LONGEST):
        if is_fair(truth, loop, declared) and not Unrolled(truth, stem, loop).holds(formula):
            return stem, loop
    return None


def continued(truth, stem, declared):
    """Yield the fair runs that begin with a stem."""
    for before, loop in lassos(truth.graph, LONGEST + len(stem)):
        if (*before, *loop, *loop)[: len(stem)] == stem and is_fair(truth, loop, declared):
            yield before, loop


def decided_as_by_enumeration(truth, formula, declared):
    found = counterexample(truth.graph, truth, formula, conditions(truth, declared))
    if found is None:
        assert violated(truth, formula, declared) is None
    elif found.loop:
        assert is_run(truth.graph, found.stem, found.loop)
        assert is_fair(truth, found.loop, declared)
        assert not Unrolled(truth, found.stem, found.loop).holds(formula)
        assert not is_true_on(found, formula, truth)


@examples(200)
@given(truths(), linear, st.lists(fairnesses, max_size=3))
def test_a_formula_is_violated_if_a_fair_run_violates_it(truth, formula, declared):
    decided_as_by_enumeration(truth, formula, declared)


@examples(200)
@given(truths(), st.sampled_from(RECURRENCES), st.lists(fairnesses, min_size=1, max_size=3))
def test_what_recurs_is_violated_if_a_fair_run_violates_it(truth, formula, declared):
    decided_as_by_enumeration(truth, formula, declared)


@examples(150)
@given(truths(most=3), linear)
def test_after_a_run_without_a_loop_the_formula_is_false_whatever_follows(truth, formula):
    found = counterexample(truth.graph, truth, formula, conditions(truth, []))
    if found is not None and not found.loop:
        assert is_run(truth.graph, found.stem, ())
        for before, loop in continued(truth, found.stem, []):
            assert not Unrolled(truth, before, loop).holds(formula)


@examples(150)
@given(truths(most=3), linear)
def test_the_two_evaluations_of_a_run_agree(truth, formula):
    for stem, loop in lassos(truth.graph, 4):
        assert is_true_on(Lasso(stem, loop), formula, truth) == Unrolled(truth, stem, loop).holds(formula)
