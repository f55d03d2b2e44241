"""Deadlock under fairness: beside the same claim in linear time on generated missions, and on small ones."""

import numpy as np
import pytest
from checked_missions import load, rules_of, verdict_of
from hypothesis import assume, given
from hypothesis import strategies as st
from scale import examples

from checker import Engine, Limits, check, explore
from checker.properties.temporal.deadlock import Deadlocks
from checker.properties.temporal.decide import TemporalDecider
from checker.properties.temporal.linear import counterexample
from checker.properties.temporal.truth import FormulaTruth
from checker.reduction import Reduction
from checker.verdicts import Outcome
from semantics.hypothesis_strategies import initial_configurations
from semantics.properties.propositions import Known
from semantics.properties.temporal import ENVIRONMENTS, Denied, Eventually, Fairness, Globally, Now, Steps

FAIRNESS = st.sampled_from(
    [
        (),
        (Fairness(False, Steps(ENVIRONMENTS)),),
        (Fairness(False, Steps(("env",)), ("label",)),),
        (Fairness(True, Steps(("env",)), ("label",)), Fairness(False, Steps(("say",)), ("label",))),
    ]
)


@examples(40)
@given(initial_configurations(monitored=False), FAIRNESS)
def test_there_is_a_deadlock_where_linear_time_says_that_a_fair_run_stays_for_ever(c, fairness):
    found = explore(c, limits=Limits(configurations=400), edges=True)
    assume(found.complete)
    decider = TemporalDecider(found, [])
    conditions = decider.conditions(fairness)
    deadlocks = Deadlocks(decider.graph, conditions, decider.stuck)
    stuck = np.array([still and decider.stuck(n) is not None for n, still in enumerate(deadlocks.still())])
    here = Known("stuck")
    truth = FormulaTruth(decider.graph, {here: stuck})
    stays = Eventually(Globally(Now(here)))
    run = counterexample(decider.graph, truth, Denied(stays), conditions)
    assert bool(deadlocks.found()) == (run is not None)


@examples(20)
@given(initial_configurations(monitored=False))
def test_without_fairness_there_is_one_wherever_there_is_one_by_definition(c):
    found = explore(c, limits=Limits(configurations=400), edges=True)
    assume(found.complete)
    decider = TemporalDecider(found, [])
    deadlocks = Deadlocks(decider.graph, decider.conditions(()), decider.stuck)
    ends = np.zeros(found.size, np.bool_)
    for each in deadlocks.found():
        ends |= each.components >= 0
    assert ends.tolist() == [
        still and decider.stuck(n) is not None for n, still in enumerate(deadlocks.still())
    ]


SENDS = """
BigActor a hosted_at uav0 with_behavior { send("go", b) }
BigActor b hosted_at uav1 with_behavior { react { case "go" => skip } }
environment { mesh drops and returns }
check {
  deadlock_freedom
  deadlock_freedom "fair" under weak fairness of environment
}
"""


def decided(text, engine=Engine.REFERENCE, **more):
    mission = load(text)
    return verdict_of(check(mission, engine=engine, **more), "fair")


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_where_only_a_promised_return_leads_on_is_no_deadlock(engine):
    mission = load(SENDS)
    report = check(mission, engine=engine)
    literal, fair = (verdict_of(report, name) for name in ("deadlock_freedom", "fair"))
    assert (literal.outcome, literal.count) == (Outcome.VIOLATED, 1)
    assert (fair.outcome, fair.note) == (Outcome.HOLDS, "under weak fairness of environment")
    assert (fair.examined, rules_of(fair.witness)) == (3, ["req_snd", "env"])


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_where_nothing_promised_leads_on_is_a_deadlock_with_its_run_and_its_causes(engine):
    found = decided(SENDS.replace(" and returns", ""), engine)
    (violation,) = found.violations
    assert violation.message == (
        'only the environment can move, and SND(a, b, "go") is pending; b waits at a react, '
        "and no promised step leads on"
    )
    assert violation.details == (
        'SND(a, b, "go"): their hosts, uav0 and uav1, share no link: mesh is down',
        'b waits for "go" from a',
    )
    assert (rules_of(violation.trace), violation.trace.loop, found.count) == (["req_snd", "env"], 2, 1)


WIND = (
    "environment { mesh drops and returns; vessel0 drifts among point (36.975, -8.69), point (36.98, -8.71) }"
)


def test_a_change_that_others_may_keep_from_happening_is_promised_only_by_itself():
    text = SENDS.replace("environment { mesh drops and returns }", WIND)
    assert decided(text).outcome is Outcome.VIOLATED  # the wind alone is fair to the environment as a whole
    (violation,) = decided(text).violations
    assert "env" in rules_of(violation.trace)[violation.trace.loop :]
    assert decided(text.replace("fairness of environment", "fairness of env")).outcome is Outcome.HOLDS


def test_what_nobody_may_say_any_more_leads_nowhere():
    text = SENDS.replace('send("go", b)', 'react { case "now" => send("go", b) }')
    assert decided(text).outcome is Outcome.VIOLATED
    said = text.replace("mesh drops and returns", 'says "now" to a').replace("environment\n}", "say\n}")
    assert decided(said).outcome is Outcome.HOLDS


def test_por_leaves_out_no_step_where_only_the_environment_moves():
    assert decided(SENDS, reduce=[Reduction.POR]).outcome is Outcome.HOLDS
    assert decided(SENDS.replace(" and returns", ""), reduce=[Reduction.POR]).outcome is Outcome.VIOLATED


def test_what_was_cut_off_does_not_hold():
    assert decided(SENDS, limits=Limits(configurations=4)).outcome is Outcome.INCOMPLETE
