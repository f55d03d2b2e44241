"""Vacuity: parts of invariants that are never needed, by replacing them; and invariants that nothing can break."""

import pytest
from checked_missions import moves, verdict
from hypothesis import given
from hypothesis import strategies as st

from checker.properties.invariant_vacuity import remarks_on, truth
from checker.properties.subformulas import is_quantified, replaced
from semantics.properties.propositions import Always, And, Inside, LinkedWith, Not, Or, Waiting

A, B, C = Waiting("a"), Waiting("b"), Waiting("c")
RANGES = (("a", "b", "c"), ("uav0", "uav1"))


def invariant(formula):
    """Return the remarks on an invariant."""
    text = moves("gate0", "a", "uav0")
    return verdict(f'{text}check {{ invariant "it": {formula} }}', "it").remarks


# --- in missions ----------------------------------------------------------------------------------------------

INVARIANTS = {
    "uav0 in gate0 -> uav0 linked mesh": (
        "'uav0 in gate0' is never needed: 'uav0 linked mesh' is always true",
    ),
    "uav0 in south0 -> ended a": (
        "vacuous: 'uav0 in south0' is never true, so that 'ended a' is never needed",
    ),
    "forall x, y: Vessel . x != y -> not uav0 in gate0": (
        "vacuous: the comparison of names before it is never true, so that 'uav0 in gate0' is never needed",
    ),
    "uav0 in gate0 -> ended a": (),
    "uav0 in north0 or uav0 in gate0": (),
    "uav0 in north0 or uav0 in gate0 or uav0 in vessel0": (
        "'uav0 in vessel0' is never needed: 'uav0 in north0 or uav0 in gate0' is always true",
    ),
    "not (uav0 in gate0 and uav0 in south0)": (
        "'uav0 in gate0' is never needed: 'uav0 in south0' is never true",
    ),
    "not uav0 in south0": (),
    "not uav1 in gate0": ("vacuous: none of its atoms ever changes",),
    "true": ("vacuous: none of its atoms ever changes",),
    "forall u: UAV . not u in south0 or ended a or not pending a": (
        "'uav0 in south0' and its like are never needed: 'ended a or not pending a' is always true",
    ),
}


@pytest.mark.parametrize("formula", INVARIANTS)
def test_what_is_never_needed_of_an_invariant_is_told(formula):
    assert invariant(formula) == INVARIANTS[formula]


def test_the_body_of_a_quantifier_is_judged_once_for_all_of_its_instances():
    assert invariant("forall u: UAV . u in vessel0 -> ended a") == (
        "vacuous: 'uav0 in vessel0' and its like are never true, so that 'ended a' and its like are never needed",
    )
    assert invariant("forall u: UAV . u in gate0 -> ended a") == ()
    assert invariant("exists u: UAV . u in north0 or u in gate0") == ()
    assert invariant("uav0 in gate0 and uav1 in south0") == ()  # it is violated


# --- against the definition -----------------------------------------------------------------------------------

formulas = st.recursive(
    st.sampled_from([A, B, C, Always(True)]),
    lambda inner: st.one_of(
        inner.map(Not),
        st.lists(inner, min_size=1, max_size=3).map(lambda parts: And(tuple(parts))),
        st.lists(inner, min_size=1, max_size=3).map(lambda parts: Or(tuple(parts))),
    ),
    max_leaves=6,
)
rows = st.sets(st.tuples(st.booleans(), st.booleans(), st.booleans()), min_size=1)


def columns(met):
    return {
        atom: sum(1 << n for n, row in enumerate(met) if row[rank]) for rank, atom in enumerate((A, B, C))
    }


def value(formula, row):
    match formula:
        case Not(inner):
            return not value(inner, row)
        case And(parts):
            return all(value(part, row) for part in parts)
        case Or(parts):
            return any(value(part, row) for part in parts)
        case Always(said):
            return said
    return row[(A, B, C).index(formula)]


@given(formulas, rows)
def test_truth_by_columns_is_truth_row_by_row(formula, met):
    met = sorted(met)
    found = truth(formula, columns(met), (1 << len(met)) - 1)
    assert [bool(found >> n & 1) for n in range(len(met))] == [value(formula, row) for row in met]


def occurrences(formula, path=()):
    yield path, formula
    parts = (formula.formula,) if isinstance(formula, Not) else getattr(formula, "formulas", ())
    for rank, part in enumerate(parts):
        yield from occurrences(part, (*path, rank))


@given(formulas, rows)
def test_a_part_is_never_needed_exactly_where_anything_may_stand_in_its_place(formula, met):
    """Each operand that is told may be replaced by either truth value; where none is told, none may."""
    met = sorted(met)
    told = list(remarks_on(formula, columns(met), len(met), {}))
    if not all(value(formula, row) for row in met):
        assert told == []
        return
    free = [
        path
        for path, part in occurrences(formula)
        if path
        and not isinstance(part, Always)
        and all(value(replaced(formula, path, Always(said)), row) for row in met for said in (True, False))
    ]
    constant = {path for path, part in occurrences(formula) if isinstance(part, Always)}
    outermost = [p for p in free if not any(p[:n] in free for n in range(1, len(p)))]
    assert len(told) == len(outermost), (free, constant)


# --- quantifiers ----------------------------------------------------------------------------------------------


def test_operands_that_go_through_a_kind_are_a_quantifiers():
    every = And(tuple(Not(Inside(name, "gate0")) for name in ("uav0", "uav1")))
    assert is_quantified(every.formulas, RANGES)
    assert not is_quantified(every.formulas[:1], RANGES)
    assert not is_quantified(every.formulas, (("uav0", "uav1", "uav2"),))
    assert not is_quantified((Inside("uav0", "a"), LinkedWith("uav1", "a")), RANGES)
    assert not is_quantified((Inside("uav0", "a"), Inside("uav1", "b")), RANGES)
    pairs = And(tuple(Or((Always(x == "uav0"), Inside(x, "uav0"))) for x in ("uav0", "uav1")))
    assert is_quantified(pairs.formulas, RANGES)
