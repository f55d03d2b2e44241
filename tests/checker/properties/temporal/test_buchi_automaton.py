"""Automata of formulas: small where small ones are known, and refused where they would be large."""

import pytest
from structures import P, Q

from checker.properties.temporal.buchi_automaton import AutomatonTooLargeError, automaton_of
from semantics.properties.propositions import Always, Known
from semantics.properties.temporal import (
    Both,
    Denied,
    Either,
    Eventually,
    Globally,
    Next,
    Now,
    OnAllPaths,
    Release,
    Until,
    WeakUntil,
    conjuncts,
)

p, q = Now(P), Now(Q)
TRUE = Now(Always(True))
SIZES = {
    "[] p": (Globally(p), 1),
    "<> p": (Eventually(p), 2),
    "[] <> p": (Globally(Eventually(p)), 1),
    "<> [] p": (Eventually(Globally(p)), 2),
    "not (p leads to q)": (Denied(Globally(Either(Denied(p), Eventually(q)))), 2),
    "[] <> p and [] <> q": (Both(Globally(Eventually(p)), Globally(Eventually(q))), 1),
    "[] <> p or [] <> q": (Either(Globally(Eventually(p)), Globally(Eventually(q))), 1),
    "<> [] p and <> [] q": (Both(Eventually(Globally(p)), Eventually(Globally(q))), 2),
    "X X p": (Next(Next(p)), 4),
    "<> (p U q)": (Eventually(Until(p, q)), 2),
    "[] (p R q)": (Globally(Release(p, q)), 1),
    "p W q": (WeakUntil(p, q), 2),
    "X true": (Next(TRUE), 1),
    "p U p": (Until(p, p), 2),
}


@pytest.mark.parametrize(("formula", "states"), SIZES.values(), ids=SIZES)
def test_an_automaton_has_no_more_states_than_it_needs(formula, states):
    assert len(automaton_of(formula).moves) == states


@pytest.mark.parametrize(
    "formula",
    [Both(Next(p), Next(Denied(p))), Both(Globally(p), Eventually(Denied(p))), Until(p, Now(Always(False)))],
    ids=str,
)
def test_a_formula_that_nothing_fulfils_has_no_moves(formula):
    assert automaton_of(formula).moves[0] == ()


def test_the_state_that_accepts_whatever_follows_is_known():
    finite, infinite = automaton_of(Eventually(p)), automaton_of(Globally(p))
    assert finite.whatever == 1
    assert infinite.whatever is None
    assert automaton_of(TRUE).whatever == 0


def test_a_denial_is_the_automaton_of_the_dual():
    assert automaton_of(Until(p, q), claimed=False) == automaton_of(Release(Denied(p), Denied(q)))


def test_a_large_formula_is_refused():
    each = [Eventually(Now(Known(f"n{number}"))) for number in range(12)]
    formula = each[0]
    for more in each[1:]:
        formula = Both(formula, more)
    with pytest.raises(AutomatonTooLargeError):
        automaton_of(formula)


def test_a_quantifier_of_paths_has_no_place_in_linear_time():
    with pytest.raises(ValueError, match="no path quantifier"):
        automaton_of(OnAllPaths(Globally(p)))


def test_conjuncts_are_taken_apart_under_always_too():
    assert conjuncts(Globally(Both(p, Both(Globally(q), Eventually(p))))) == [
        Globally(p),
        Globally(Globally(q)),
        Globally(Eventually(p)),
    ]
