"""The fast explorer: it visits what the reference explorer visits, in the same order, and stops where that stops."""

from pathlib import Path

import pytest
from hypothesis import given, settings

from checker import Engine, Limits, check, explore
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
    visited = (list(found.configurations), list(map(int, found.origins)), found.depth, found.expanded)
    return (*visited, found.transitions, found.rules, found.bounds)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("variation", VARIATIONS.values(), ids=VARIATIONS)
def test_a_mission_is_explored_alike_by_both_engines(name, variation):
    initial = load_mission(MISSIONS / f"{name}.mission", variation).initial
    assert explored(initial, Engine.FAST) == explored(initial, Engine.REFERENCE)


@pytest.mark.parametrize("name", NAMES)
def test_a_monitored_mission_is_explored_alike_by_both_engines(name):
    initial = monitored(load_mission(MISSIONS / f"{name}.mission").initial)
    assert explored(initial, Engine.FAST) == explored(initial, Engine.REFERENCE)


@given(strategies.initial_configurations())
@settings(max_examples=100)
def test_generated_missions_are_explored_alike_by_both_engines(initial):
    limits = Limits(configurations=60)
    assert explored(initial, Engine.FAST, limits) == explored(initial, Engine.REFERENCE, limits)


@pytest.mark.parametrize("name", ["oil_spill", "takeover", "look_before_entry_racy", "broken_unrealisable"])
def test_both_engines_come_to_the_same_report(name):
    mission = load_mission(MISSIONS / f"{name}.mission")
    reports = [check(mission.initial, mission.properties, engine=engine) for engine in Engine]
    assert reports[0].verdicts == reports[1].verdicts
    assert reports[0].rules == reports[1].rules


def test_the_rules_are_run_far_less_often_than_there_are_transitions():
    found = explore(load_mission(MISSIONS / "rendezvous.mission").initial, engine=Engine.FAST)
    assert (len(found.configurations), found.transitions) == (18_051, 73_275)
    assert found.rule_runs is not None
    assert found.rule_runs < 600
