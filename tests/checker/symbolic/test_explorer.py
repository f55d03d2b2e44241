"""The symbolic engine beside the fast one: the same configurations, transitions, rules, verdicts, and lengths of traces."""

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings

import checker.symbolic.explorer
from checker import Engine, Limits, check, explore
from semantics import strategies
from semantics.propositions import Property
from semantics.setting import Control, Scheduler
from specs.elaboration import Variation, load_mission

MISSIONS = Path(__file__).parents[3] / "specs" / "missions"
NAMES = sorted(path.stem for path in MISSIONS.glob("*.mission"))
KINDS = ("local_consistency", "deadlock_freedom", "arrival", "computation", "invariant", "reachable")
VARIATIONS = {
    "as it is": Variation(scheduler=Scheduler.PROGRAM_ORDER),
    "timed": Variation(scheduler=Scheduler.PROGRAM_ORDER, control=Control.TIMED),
    "unordered": Variation(scheduler=Scheduler.UNORDERED),
}


@pytest.fixture(autouse=True)
def few_are_explored_one_by_one(monkeypatch):
    monkeypatch.setattr(checker.symbolic.explorer, "FIRST", 5)


def told(report):
    """Return what both engines say of a mission: all but depth, time and witnesses of what holds everywhere."""
    sizes = (report.configurations, report.transitions, report.rules, report.bounds, report.coverage)
    return (*sizes, [verdict_told(each) for each in report.verdicts])


def verdict_told(verdict):
    shown = sorted((v.kind, v.subject, len(v.trace)) for v in verdict.violations)
    if verdict.different > len(verdict.violations):  # of several as near, others may be shown
        shown = [(kind, length) for kind, _, length in shown][:1]
    witness = verdict.witness if verdict.property.kind == "reachable" else None
    counts = (verdict.count, verdict.examined, verdict.different)
    return (verdict.property.name, verdict.outcome, counts, verdict.remarks, shown, witness and len(witness))


def reports(initial, properties):
    whole = Limits(configurations=None)
    return [check(initial, properties, whole, engine=engine) for engine in (Engine.SYMBOLIC, Engine.FAST)]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("variation", VARIATIONS.values(), ids=VARIATIONS)
def test_a_mission_is_judged_alike(name, variation):
    mission = load_mission(MISSIONS / f"{name}.mission", variation)
    asked = [each for each in mission.properties if each.kind in KINDS]
    ours, theirs = reports(mission.initial, asked)
    assert told(ours) == told(theirs)


@given(strategies.initial_configurations())
@settings(max_examples=30, deadline=None)
def test_a_generated_mission_is_judged_alike(initial):
    initial = replace(initial, setting=replace(initial.setting, scheduler=Scheduler.PROGRAM_ORDER))
    if not explore(initial, limits=Limits(configurations=2_000)).complete:
        return
    ours, theirs = reports(initial, [Property(kind, kind) for kind in KINDS[:4]])
    assert told(ours) == told(theirs)
