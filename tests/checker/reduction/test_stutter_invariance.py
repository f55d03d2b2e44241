"""Stutter invariance, beside its definition: idle steps in words of states and steps."""

from random import Random

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scale import examples

from checker.engines.graph import Graph
from checker.properties.temporal.lasso_evaluation import is_true_on
from checker.properties.temporal.lassos import Lasso
from checker.properties.temporal.truth import FormulaTruth
from checker.reduction.stutter_invariance import is_stutter_invariant
from semantics.properties.propositions import Always, Present
from semantics.properties.temporal import (
    Both,
    Denied,
    Either,
    Eventually,
    Globally,
    Next,
    Now,
    Release,
    Steps,
    Taken,
    Until,
    WeakUntil,
)
from semantics.state.configuration import Label

P, Q = Now(Present("p")), Now(Present("q"))
A, B = Taken(Steps(("sense",))), Taken(Steps(("actuate",)))
LABELS = (Label("fun", "x"), Label("sense", "x"), Label("actuate", "x"))

LETTERS = st.tuples(st.booleans(), st.booleans(), st.sampled_from([0, 0, 1, 2]))
"""Whether p is true, whether q is, and the step that is taken."""

WORDS = [(p, False, step) for p in (False, True) for step in (0, 1)]

FORMULAS = st.recursive(
    st.sampled_from([P, Q, A, B]),
    lambda inner: st.one_of(
        *(st.builds(make, inner) for make in (Denied, Eventually, Globally, Next)),
        *(st.builds(make, inner, inner) for make in (Both, Either, Until, WeakUntil, Release)),
    ),
    max_leaves=6,
)


def is_true(formula, stem, loop):
    """Return whether a word satisfies a formula."""
    word = [*stem, *loop]
    size = len(word)
    targets = np.array([*range(1, size), len(stem)])
    graph = Graph(np.arange(size + 1), targets, np.array([step for *_, step in word]), LABELS)
    values = {each.proposition: np.array([letter[k] for letter in word]) for k, each in enumerate((P, Q))}
    run = Lasso(tuple(range(len(stem))), tuple(range(len(stem), size)))
    return is_true_on(run, formula, FormulaTruth(graph, values))


def with_idle(letters, counts):
    """Return a word with so many idle steps before each letter."""
    return [
        each
        for (p, q, step), count in zip(letters, counts, strict=True)
        for each in [(p, q, 0)] * count + [(p, q, step)]
    ]


@given(FORMULAS, st.data())
@examples(900)
def test_idle_steps_never_change_the_truth_of_an_invariant_formula(formula, data):
    assume(is_stutter_invariant(formula))
    stem, loop = (
        data.draw(st.lists(LETTERS, max_size=3)),
        data.draw(st.lists(LETTERS, min_size=1, max_size=3)),
    )
    counts = st.integers(0, 2)
    longer = [with_idle(part, [data.draw(counts) for _ in part]) for part in (stem, loop)]
    assert is_true(formula, stem, loop) == is_true(formula, *longer), str(formula)


INVARIANT = [
    Eventually(Both(A, P)),
    Globally(Either(Denied(A), Eventually(B))),
    Until(Denied(B), A),
    WeakUntil(Either(Denied(A), P), Both(B, Q)),
    Release(A, Either(Denied(B), P)),
    Globally(Eventually(A)),
]
COUNTING = [
    A,
    Next(P),
    Eventually(Next(P)),
    Until(P, A),
    Globally(A),
    Eventually(Denied(A)),
    Release(P, Denied(A)),
]


@pytest.mark.parametrize("formula", INVARIANT, ids=str)
def test_what_skips_idle_steps_is_invariant(formula):
    assert is_stutter_invariant(formula)


@pytest.mark.parametrize("formula", COUNTING, ids=str)
def test_what_asks_for_the_very_next_step_is_not(formula):
    assert not is_stutter_invariant(formula)


OPERANDS = [
    *(P, Denied(P), A, Denied(A), Both(A, P), Either(A, P), Either(Denied(A), P), Eventually(A), Next(P)),
    *(Both(A, Next(P)), Either(Denied(A), Next(P)), Both(Denied(A), Denied(B)), Both(A, Now(Always(True)))),
]
WAITING = [
    *(make(one) for make in (Eventually, Globally) for one in OPERANDS),
    *(make(one, other) for make in (Until, WeakUntil, Release) for one in OPERANDS for other in OPERANDS),
]


def test_of_all_small_formulas_no_idle_step_changes_one_that_is_taken_for_invariant():
    draw = Random(0)
    invariant = [each for each in WAITING if is_stutter_invariant(each)]
    assert len(invariant) == 93  # of 533
    for formula in invariant:
        for _ in range(12):
            stem, loop = (draw.choices(WORDS, k=size) for size in (draw.randrange(3), draw.randrange(1, 3)))
            longer = [with_idle(part, draw.choices((0, 1), k=len(part))) for part in (stem, loop)]
            assert is_true(formula, stem, loop) == is_true(formula, *longer), str(formula)
