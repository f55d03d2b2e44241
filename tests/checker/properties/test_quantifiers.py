"""Quantifiers over entities are not written out, and say what they would: here every formula is checked both ways."""

import re

import pytest
from checked_missions import load
from hypothesis import given
from hypothesis import strategies as st
from scale import examples

from checker import Engine, Outcome, check
from checker.check import reductions_of
from semantics.properties.propositions import Instances
from specs.diagnostics import MissionError
from specs.elaboration.formulas import FormulaElaborator

WORLD = """
signature {
  kind Yard contains Cell, UAV, Crate
  kind Cell contains UAV, Crate
  kind UAV driven carries Crate
  kind Crate
}
world {
  yard0: Yard = box (37.10, -8.50) (36.90, -8.90)
  cell0: Cell = box (37.01, -8.69) (36.99, -8.71)
  cell1: Cell = box (37.05, -8.69) (37.03, -8.71)
  cell2: Cell = box (37.09, -8.69) (37.07, -8.71)
  uav0: UAV = point (37.00, -8.70) linked radio
  uav1: UAV = point (37.04, -8.70) linked radio
  uav2: UAV = point (37.08, -8.70)
  crate0: Crate = point (37.005, -8.70)
}
def tour() = { control(MOVE_HOST_TO cell1) control(MOVE_HOST_TO cell2) }
BigActor a0 hosted_at uav0 with_behavior { tour() }
BigActor a1 hosted_at uav1 with_behavior { control(MOVE_HOST_TO cell0) }
"""

KINDS = ("UAV", "Cell", "Crate", "Yard")
VARIABLES = ("x", "y", "z")


def atoms(names):
    """Return a strategy of atoms about some names."""
    name = st.sampled_from(names)
    return st.one_of(
        st.builds("{} in {}".format, name, name),
        st.builds("actually {} directly in {}".format, name, name),
        st.builds("{} linked {}".format, name, name),
        st.builds("{} == {}".format, st.sampled_from(names[:1]), name),
        st.builds("known {}".format, name),
        st.builds("present {}".format, name),
    )


@st.composite
def formulas(draw):
    """Draw a formula of up to three quantifiers over entities."""
    variables = VARIABLES[: draw(st.integers(1, 3))]
    quantifiers = st.sampled_from(("forall", "exists", "not forall", "not exists"))
    heads = [f"{draw(quantifiers)} {each}: {draw(st.sampled_from(KINDS))} . " for each in variables]
    some = st.sampled_from(("forall", "exists"))
    body = draw(
        st.recursive(
            atoms((*variables, "uav0", "cell1")).filter(lambda text: text not in ("uav0 == uav0",)),
            lambda inner: st.one_of(
                st.builds("({} and {})".format, inner, inner),
                st.builds("({} or {})".format, inner, inner),
                st.builds("({} -> {})".format, inner, inner),
                st.builds("not ({})".format, inner),
                st.builds(
                    "({} {}: {} . {})".format, some, st.sampled_from(VARIABLES), st.sampled_from(KINDS), inner
                ),
            ),
            max_leaves=4,
        )
    )
    return "".join(heads) + body


def both(properties):
    """Return a mission with properties written out, and with their quantifiers left."""
    found = []
    for patched in ({"_size": lambda *_: None}, {}):
        with pytest.MonkeyPatch.context() as patch:
            for name, instead in patched.items():
                patch.setattr(FormulaElaborator, name, instead)
            found.append(load(f"{WORLD}\ncheck {{ {properties} }}", ""))
    return found


def said(report):
    """Return what a report says, but for how formulas are shown."""
    return [
        (
            each.outcome,
            each.count,
            each.examined,
            [len(violation.trace.steps) for violation in each.violations],
            each.witness and len(each.witness.steps),
        )
        for each in report.verdicts
    ]


@examples(60, 6, deadline=None)
@given(formulas())
def test_a_quantifier_that_is_left_says_what_it_says_written_out(formula):
    written, left = both(f'invariant "i": {formula} reachable "r": {formula}')
    reports = [
        check(mission, engine=engine)
        for mission in (written, left)
        for engine in (Engine.REFERENCE, Engine.FAST)
    ]
    assert all(said(each) == said(reports[0]) for each in reports)
    assert len({bool(each.verdicts["i"].remarks) for each in reports}) == 1


@examples(20, 5, deadline=None)
@given(formulas())
def test_a_left_quantifier_is_refused_by_no_reduction_that_takes_it_written_out(formula):
    written, left = both(f'invariant "i": {formula}')
    assert reductions_of(left) == reductions_of(written)
    for reduction in reductions_of(written):
        outcomes = {check(each, reduce=(reduction,)).verdicts["i"].outcome for each in (written, left)}
        assert outcomes == {check(written).verdicts["i"].outcome}


@examples(40, 5, deadline=None)
@given(formulas())
def test_the_names_that_are_told_of_a_violation_make_the_formula_false(formula):
    _, left = both(f'invariant "i": {formula}')
    for violation in check(left).verdicts["i"].violations:
        told = violation.details[0].removeprefix("where ").split(", ") if violation.details else []
        for each in told:
            variable, name = each.split(" = ")
            written_in = f"forall {variable}: "
            assert written_in in formula
            rest = formula.split(written_in)[1].split(" . ", 1)[1]
            formula = re.sub(rf"\b{variable}\b", name, formula.split(written_in)[0] + rest)
        if told and not re.search("forall|exists|==", formula):
            _, instance = both(f'invariant "i": {formula}')
            assert check(instance).verdicts["i"].outcome is Outcome.VIOLATED


def test_only_places_that_something_is_in_are_asked():
    _, left = both('invariant "i": forall c: Cell . forall x, y: UAV . x != y -> not (x in c and y in c)')
    formula = left.properties[0].formula
    assert str(formula) == (
        "forall x: UAV . forall y: UAV . forall c: Cell . not not x == y or not (x in c and y in c)"
    )
    places = formula.formulas[0].formulas[0].formulas
    assert isinstance(places, Instances)
    assert str(places.anchor) == f"uav0 in {places.variable}"
    assert len(list(places.worth_asking(left.initial))) == 1


def test_a_fleet_of_fifty_on_two_hundred_places_is_asked_whether_two_are_in_one():
    cells = "\n".join(
        f"  c{n}: Cell = circle ({36 + n % 20 / 10:.1f}, {-9 + n // 20 / 10:.1f}) radius 1 km"
        for n in range(200)
    )
    robots = "\n".join(
        f"  r{n}: Robot = point ({36 + n % 20 / 10:.1f}, {-9 + n // 20 / 10:.1f})" for n in range(50)
    )
    mission = load(
        f"signature {{ kind Cell contains Robot kind Robot driven }} world {{\n{cells}\n{robots}\n}}\n"
        "BigActor a0 hosted_at r0 with_behavior { control(MOVE_HOST_TO c1) }\n"
        'check { invariant "apart": forall x, y: Robot . x != y -> forall c: Cell . not (x in c and y in c) }',
        "",
    )
    verdict = check(mission).verdicts["apart"]
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.count == 1
    assert len(verdict.violations[0].trace.steps) == 2
    assert verdict.violations[0].details == ("where x = r0, y = r1, c = c1",)


def test_what_would_ask_too_much_of_each_configuration_is_refused():
    places = "\n".join(f"  p{n}: Cell = circle (36.0, {-9 + n / 50:.2f}) radius 1 m" for n in range(60))
    kinds = "signature { kind Cell contains Robot kind Robot driven }"
    agent = "BigActor a hosted_at r with_behavior {}"
    asked = 'check { invariant "i": forall x, y, z: Cell . known x or y == z }'
    with pytest.raises(MissionError, match="would be asked 432,000 atoms, and 200,000 is the most"):
        load(f"{kinds} world {{\n{places}\n  r: Robot = point (36, -9)\n}} {agent} {asked}", "")
