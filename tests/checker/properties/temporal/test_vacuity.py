"""Vacuity of temporal properties: beside the definition on generated graphs, and as missions are told of it."""

from dataclasses import fields, replace

import pytest
from checked_missions import load
from hypothesis import assume, given
from hypothesis import strategies as st
from scale import examples
from structures import (
    P,
    Q,
    Sets,
    Unrolled,
    branching,
    conditions,
    fairnesses,
    is_fair,
    is_run,
    lassos,
    linear,
    truths,
)
from test_decide import ONCE, verdict

from checker import Engine, Outcome, check
from checker.limits import Bound, BoundMet, Stop
from checker.properties.subformulas import Subformula, at, strengthened, unneeded
from checker.properties.temporal import vacuity
from checker.properties.temporal.branching import Branching
from checker.properties.temporal.linear import counterexample
from checker.properties.temporal.vacuity import judge_linear
from semantics.properties.propositions import Always, Inside, Known
from semantics.properties.temporal import Both, Denied, Either, Eventually, Globally, Now, Path, State, parts

CONSTANTS = (Now(Always(False)), Now(Always(True)))


def occurrences(formula, path=()):
    """Yield where each part of a formula stands that says something of configurations or runs by itself."""
    if not isinstance(formula, Path):
        yield path
    for rank, part in enumerate(parts(formula)):
        yield from occurrences(part, (*path, rank))


def put(formula, path, by):
    if not path:
        return by
    name = fields(formula)[path[0]].name
    return replace(formula, **{name: put(getattr(formula, name), path[1:], by)})


def told(formula, holds):
    """Return where the parts stand that are told to be never needed."""
    return {part.paths[0] for _, part in unneeded(formula, (), holds)}


@examples(120)
@given(truths(3), branching, st.lists(fairnesses, max_size=2))
def test_a_part_is_never_needed_if_anything_may_stand_there_in_branching_time(truth, formula, declared):
    naive = Sets(truth, declared)
    assume(0 in naive.where(formula))
    tree = Branching(truth.graph, truth, conditions(truth, declared))
    free = {
        path
        for path in occurrences(formula)
        if path and all(0 in naive.where(put(formula, path, each)) for each in CONSTANTS)
    }
    found = told(formula, lambda each: bool(tree.where(each)[0]))
    assert all(any(path[: len(one)] == one for one in free) for path in found)
    leaves = {path for path in free if isinstance(at(formula, path), State)}
    assert all(any(path[: len(one)] == one for one in found) for path in leaves)


@examples(120)
@given(truths(3), linear, st.lists(fairnesses, max_size=2))
def test_no_run_violates_a_formula_in_which_anything_stands_for_a_part_that_is_never_needed(
    truth, formula, declared
):
    fairness = conditions(truth, declared)
    assume(counterexample(truth.graph, truth, formula, fairness) is None)
    runs = [each for each in lassos(truth.graph, 4) if is_fair(truth, each[1], declared)]
    failed = []

    def holds(each):
        run = counterexample(truth.graph, truth, each, fairness)
        failed.extend([each] if run is not None else [])
        return run is None

    for path in told(formula, holds):
        for each in CONSTANTS:
            changed = put(formula, path, each)
            assert all(Unrolled(truth, *run).holds(changed) for run in runs)
    judged = judge_linear(truth, formula, fairness, {})
    if judged.witness is not None:
        stem, loop = judged.witness.stem, judged.witness.loop
        assert is_run(truth.graph, stem, loop)
        assert is_fair(truth, loop, declared)
        run = Unrolled(truth, stem, loop)
        assert run.holds(formula)
        assert not failed or not all(run.holds(each) for each in failed)


# --- quantifiers and polarity ---------------------------------------------------------------------------------

RANGES = (("gate0",), ("uav0", "uav1"))


def body(name):
    return Globally(Either(Denied(Now(Inside(name, "gate0"))), Eventually(Now(Known(name)))))


def test_the_body_of_a_quantifier_is_one_part_in_all_places():
    formula = Both(Both(Both(body("uav0"), body("uav1")), Now(P)), Now(Q))
    found = {part.formula: part for part in Subformula(formula).parts(RANGES)}
    assert len(found) == 4  # of other operands beside it, it is none
    (part,) = Subformula(Both(body("uav0"), body("uav1"))).parts(RANGES)
    assert part.paths == ((0,), (1,))
    (either,) = part.parts(RANGES)
    condition, _ = either.parts(RANGES)
    (atom,) = condition.parts(RANGES)
    assert (len(atom.paths), atom.positive) == (2, False)
    true = Now(Always(True))
    assert strengthened(Both(body("uav0"), body("uav1")), atom) == Both(
        *(Globally(Either(Denied(true), Eventually(Now(Known(name))))) for name in ("uav0", "uav1"))
    )


# --- in missions ----------------------------------------------------------------------------------------------

TOLD = [
    (
        "pending MGR a leads to ended a",
        "vacuous: 'pending MGR a' is never true, so that '<> ended a' is never needed",
    ),
    (
        "always (uav0 in vessel0 and taken actuate a -> next uav0 in gate0)",
        "vacuous: 'uav0 in vessel0 and taken actuate a' is never true, so that 'X uav0 in gate0' is never needed",
    ),
    ("pending CTR a leads to uav0 in gate0", "'pending CTR a' is never needed: it holds without"),
    (
        "<> (uav0 in gate0 or uav0 in vessel0)",
        "'uav0 in vessel0' is never needed: it holds without",
    ),
    (
        "forall u: UAV . u in vessel0 leads to ended a",
        "vacuous: 'uav0 in vessel0' and its like are never true, so that '<> ended a' and its like are never needed",
    ),
]
NEEDED = [
    "always (pending CTR a -> uav0 in north0)",
    "eventually always uav0 in gate0",
    "uav0 in north0 U uav0 in gate0",
    "always (taken actuate a -> next uav0 in gate0)",
    "always (uav0 in gate0 <-> not uav0 in north0)",
]


@pytest.mark.parametrize(("formula", "remark"), TOLD)
def test_what_is_never_needed_is_told(formula, remark):
    assert remark in verdict(ONCE, f'ltl "q": {formula}').remarks


@pytest.mark.parametrize("formula", NEEDED)
def test_of_what_is_needed_there_is_a_witness_and_no_remark(formula):
    found = verdict(ONCE, f'ltl "q": {formula}')
    assert found.remarks == ()
    assert len(found.witness) == found.witness.loop == 2


def test_a_branching_formula_is_told_of_too():
    assert verdict(ONCE, 'ctl "q": AG (uav0 in vessel0 -> EF ended a)').remarks == (
        "vacuous: 'uav0 in vessel0' is never true, so that 'E <> ended a' is never needed",
    )
    found = verdict(ONCE, 'ctl "q": AG (uav0 in gate0 -> AX uav0 in gate0)')
    assert (found.remarks, len(found.witness)) == ((), 2)
    assert verdict(ONCE, 'ctl "q": AG (uav0 in north0 or uav0 in gate0 or AF ended a)').remarks == (
        "'uav0 in north0 or uav0 in gate0' is never needed: it holds without",
        "'A <> ended a' is never needed: it holds without",
    )


def test_where_the_time_ends_or_the_graph_is_too_large_what_holds_still_does(monkeypatch):
    def late(*_):
        raise BoundMet(Bound(Stop.TIME, (1.0,)))

    for name, instead in (("MOST_EDGES", 1), ("counterexample", late)):
        with monkeypatch.context() as patch:
            patch.setattr(vacuity, name, instead)
            found = verdict(ONCE, 'ltl "q": uav0 in north0 or uav0 in vessel0')
        assert (found.outcome, found.remarks, found.witness) == (Outcome.HOLDS, (), None)


NEVER_BOUND = """
signature { kind OilTank }
BigActor c hosted_at gcs0 with_behavior {
  let m = 0
  react { case ("never", x) => let n = 2 m = n }
}
"""
UNCHANGING = {
    'ltl "q": [] c.n == 1': True,
    'ltl "q": [] not c.n == 1': True,
    'ctl "q": AG c.n == 1': True,
    'ltl "q": [] (c.m == 0 or c.n == 7)': False,  # m gets a value
    'invariant "q": c.n == 1': True,
    'invariant "q": c.m < 3': False,
    'ltl "q": [] c.m < 3': False,
    'ltl "q": [] (uav0 in gate0 -> c.n == 1)': False,
    'ltl "q": [] not taken migrate a': False,
    'ltl "q": [] forall v: OilTank . present v': True,  # there is none
    'ltl "q": forall v: OilTank . [] present v': True,
    'ltl "q": (exists v: OilTank . present v) leads to false': True,
    'ctl "q": AG forall v: OilTank . EF present v': True,
    'ctl "q": not EF exists v: OilTank . present v': True,
    'ltl "q": [] forall v: OilTank . taken a': True,
    'ltl "q": [] ((forall v: OilTank . present v) and not (uav0 in north0 and uav0 in gate0))': False,
    'ctl "q": AG forall v: UAV . not (v in north0 and v in gate0)': False,
}


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_what_speaks_of_nothing_that_changes_is_vacuous_on_runs_as_in_configurations(engine):
    claims = [claim.replace('"q"', f'"{number}"') for number, claim in enumerate(UNCHANGING)]
    mission = load(f"{NEVER_BOUND} {ONCE} check {{ {' '.join(claims)} }}")
    found = check(mission, engine=engine).verdicts
    for claim, said in zip(UNCHANGING, found, strict=False):
        assert said.outcome is Outcome.HOLDS, claim
        vacuous = said.remarks == ("vacuous: none of its atoms ever changes",)
        assert vacuous is UNCHANGING[claim], claim
