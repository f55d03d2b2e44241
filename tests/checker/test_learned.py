"""Learned trees: what they allow is what the rules allow, configuration by configuration, in the same order."""

from pathlib import Path

import pytest
from hypothesis import given, settings

from checker import Engine, Limits, check, explore
from checker.learned import Ask, Inner, Learner, LearningError
from semantics import Control, Scheduler, strategies
from semantics.monitor import monitored
from specs.elaboration import Variation, load_mission

MISSIONS = Path(__file__).parents[2] / "specs" / "missions"
NAMES = sorted(path.stem for path in MISSIONS.glob("*.mission"))
FEW = Limits(configurations=400)

VARIATIONS = {
    "as written": Variation(),
    "timed": Variation(control=Control.TIMED),
    "unordered": Variation(scheduler=Scheduler.UNORDERED),
    "fcfs timed": Variation(scheduler=Scheduler.FCFS, control=Control.TIMED),
}


def explored(initial, engine, limits=FEW):
    found = explore(initial, limits=limits, engine=engine)
    return found.configurations, found.origins, found.labels, found.transitions, found.rules, found.bounds


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("variation", VARIATIONS.values(), ids=VARIATIONS)
def test_a_mission_is_explored_alike_by_both_engines(name, variation):
    initial = load_mission(MISSIONS / f"{name}.mission", variation).initial
    assert explored(initial, Engine.LEARNED) == explored(initial, Engine.REFERENCE)


@pytest.mark.parametrize("name", NAMES)
def test_a_monitored_mission_is_explored_alike_by_both_engines(name):
    initial = monitored(load_mission(MISSIONS / f"{name}.mission").initial)
    assert explored(initial, Engine.LEARNED) == explored(initial, Engine.REFERENCE)


@given(strategies.initial_configurations())
@settings(max_examples=100)
def test_generated_missions_are_explored_alike_by_both_engines(initial):
    limits = Limits(configurations=60)
    assert explored(initial, Engine.LEARNED, limits) == explored(initial, Engine.REFERENCE, limits)


@pytest.mark.parametrize("name", ["oil_spill", "takeover", "look_before_entry_racy", "broken_unrealisable"])
def test_both_engines_come_to_the_same_report(name):
    mission = load_mission(MISSIONS / f"{name}.mission")
    reports = [check(mission.initial, mission.properties, engine=engine) for engine in Engine]
    assert reports[0].verdicts == reports[1].verdicts
    assert reports[0].rules == reports[1].rules


def test_the_rules_are_run_far_less_often_than_they_are_asked_for():
    learner = Learner()
    for c in explore(load_mission(MISSIONS / "takeover.mission").initial).configurations:
        learner.expand(c)
    assert (learner.runs, learner.walks) == (57, 3150)


def test_a_rule_that_asks_something_else_in_the_same_place_is_our_bug():
    c = load_mission(MISSIONS / "oil_spill.mission").initial
    learner = Learner()
    learner.expand(c)
    root = learner.roots["a"]
    assert isinstance(root, Inner)
    learner.roots["a"] = Inner(Ask(("never", "asked")))
    with pytest.raises(LearningError, match="out of turn"):
        learner.expand(c)
