"""Formulas about variables: what is compared, and what a comparison is where there is no value yet."""

import pytest
from elaborating import elaborated, told
from hypothesis import given
from hypothesis import strategies as st

from semantics.properties.propositions import And, Not, Or, VariableIs
from semantics.properties.temporal import Now, Temporal, parts
from specs.formatter import format_mission

WORLD = """
signature { kind Location contains UAV kind UAV driven kind Drone }
world { base0: Location = box (37.04, -8.59) (36.94, -8.79) uav0: UAV = point (37.08, -8.55) }
BigActor a hosted_at uav0 with_behavior {
  let n = 0
  control(MOVE_HOST_TO base0)
  n = -1
  react { case m: Message => skip }
}
"""


def checked(logic, text):
    prop = elaborated(f'{WORLD}check {{ {logic} "it": {text} }}').properties[0]
    return prop.temporal or prop.formula


def compared(formula):
    """Yield the comparisons of a formula from left to right, each with whether it is true without a value."""
    match formula:
        case VariableIs(_, value, operator, unbound):
            yield f"{operator} {value}", unbound
        case Now(inner) | Not(inner):
            yield from compared(inner)
        case And(formulas) | Or(formulas):
            for each in formulas:
                yield from compared(each)
        case _ if isinstance(formula, Temporal):
            for each in parts(formula):
                yield from compared(each)


def unbound(logic, text):
    return [true for _, true in compared(checked(logic, text))]


# --- where there is no value ----------------------------------------------------------------------------------

ALONE = [
    ("invariant", "a.n == 1", True),
    ("invariant", "not a.n == 1", False),
    ("invariant", "a.n != 1", False),
    ("invariant", "a.n == 1 -> present uav0", False),
    ("invariant", "present uav0 -> not (present uav0 or not a.n == 1)", True),
    ("invariant", "forall u: UAV . exists l: Location . u in l and a.n == 1", True),
    ("reachable", "a.n == 1", False),
    ("reachable", "not a.n == 1", True),
    ("ltl", "a.n == 1", False),
    ("ltl", "not a.n == 1", True),
    ("ltl", "X a.n == 1", False),
    ("ltl", "not X a.n == 1", True),
    ("ltl", "[] X a.n == 1", True),
    ("ltl", "[] a.n == 1", True),
    ("ltl", "[] not a.n == 1", False),
    ("ltl", "not [] a.n == 1", True),
    ("ltl", "<> a.n == 1", False),
    ("ltl", "<> not a.n == 1", True),
    ("ltl", "not <> a.n == 1", False),
    ("ltl", "[] <> a.n == 1", False),
    ("ltl", "infinitely often a.n == 1", False),
    ("ltl", "<> [] a.n == 1", True),
    ("ctl", "AG a.n == 1", True),
    ("ctl", "EG a.n == 1", True),
    ("ctl", "AF a.n == 1", False),
    ("ctl", "EF a.n == 1", False),
    ("ctl", "not EF not a.n == 1", True),
    ("ctl", "AG EX a.n == 1", True),
    ("ctl", "EF AX a.n == 1", False),
]


BOTH = [
    ("ltl", "a.n == 1 U a.n == 2", [True, False]),
    ("ltl", "a.n == 1 W a.n == 2", [True, False]),
    ("ltl", "a.n == 1 R a.n == 2", [False, True]),
    ("ltl", "a.n == 1 leads to a.n == 2", [False, False]),
    ("ctl", "a.n == 1 leads to a.n == 2", [False, False]),
    ("ctl", "A (a.n == 1 U a.n == 2)", [True, False]),
    ("invariant", "a.n == 1 <-> a.m == 2", [False, True, False, True]),
    ("reachable", "a.n == 1 <-> a.m == 2", [True, False, True, False]),
    ("ltl", "[] (a.n == 1 <-> <> a.m == 2)", [False, False, False, True]),
]


@pytest.mark.parametrize(("logic", "text", "each"), [*((*row, [true]) for *row, true in ALONE), *BOTH])
def test_a_comparison_without_a_value_neither_violates_nor_fulfils_and_stands_by_itself(logic, text, each):
    assert unbound(logic, text) == each


leaves = st.integers(0, 3).map(lambda value: f"a.n == {value}")


def grown(of):
    return st.one_of(
        st.tuples(st.sampled_from(["not", "[]", "<>", "X"]), of),
        st.tuples(st.sampled_from(["and", "or", "U", "R"]), of, of),
    )


trees = st.recursive(leaves, grown, max_leaves=6)
DUALS = {"[]": "<>", "X": "X", "<>": "[]", "and": "or", "or": "and", "U": "R", "R": "U"}


def written(tree, pushed=False, denied=False):
    """Write a tree; `denied` as its denial, and where that is `pushed`, with negations at its leaves only."""
    if not isinstance(tree, str):
        if denied and not pushed:
            return f"not ({written(tree)})"
        if tree[0] == "not" and pushed:
            return written(tree[1], pushed, not denied)
        sign = DUALS[tree[0]] if denied else tree[0]
        inner = [f"({written(each, pushed, denied)})" for each in tree[1:]]
        return f"{sign} {inner[0]}" if len(inner) == 1 else f"{inner[0]} {sign} {inner[1]}"
    return f"not {tree}" if denied else tree


@given(trees, st.booleans())
def test_a_denial_is_the_dual_formula(tree, denied):
    """So it doesn't matter for what has no value whether negations stand outside or inside."""
    outside, inside = written(tree, denied=denied), written(tree, pushed=True, denied=denied)
    assert list(compared(checked("ltl", outside))) == list(compared(checked("ltl", inside)))


def test_what_is_compared_alike_is_printed_alike():
    assert str(checked("ltl", "[] a.n == 1 and <> a.n == 1")) == "[] a.n == 1 and <> a.n == 1"


# --- what is compared -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("operator", ["==", "!=", "<", "<=", ">", ">="])
@pytest.mark.parametrize("value", ["0", "3", "-3"])
def test_numbers_are_compared_below_zero_too(operator, value):
    claim = f"a.n {operator} {value}"
    denied = operator == "!="
    found = checked("invariant", claim)
    assert isinstance(found, Not) is denied
    atom = found.formula if denied else found
    assert (atom.operator, atom.value) == ("==" if denied else operator, int(value))
    text = f'check {{\n  invariant "it": {claim}\n  reachable "b": bound a.n\n}}\n'
    assert format_mission(text) == text


def test_someone_outside_says_a_negative_number():
    text = "environment {\n  says -3 to a at most once\n}\n"
    (clause,) = elaborated(WORLD + text).setting.environment
    assert clause.message == -3
    assert format_mission(text) == text


@pytest.mark.parametrize("claim", ["bound a.x", "bound b.n", "a.x < 1", "b.n < 1", "a.x == 1 <-> true"])
def test_a_variable_that_nobody_has_is_unknown_and_is_told_once(claim):
    assert [code for code, *_ in told(f'{WORLD}check {{ invariant "it": {claim} }}')] == ["LS201"]


def test_what_may_be_anything_may_be_compared_with_anything():
    for value in ("1", '"x"', "uav0", "true", "(1, 2)", "{1}"):
        checked("invariant", f"a.m == {value}")
