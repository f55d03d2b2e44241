"""The symbolic engine beside the fast one: the same configurations, transitions, verdicts, and lengths of traces."""

import re
import sys
from pathlib import Path

import pytest
from checked_missions import load
from hypothesis import assume, given, settings

import checker.symbolic.explorer
from checker import Engine, EngineError, Limits, Outcome, check, explore, replay, report_text, to_json
from semantics import strategies
from semantics.propositions import Property
from semantics.setting import Control, Scheduler
from specs.elaboration import Variation, load_mission

MISSIONS = Path(__file__).parents[3] / "specs" / "missions"
NAMES = sorted(path.stem for path in MISSIONS.glob("*.mission"))
KINDS = ("local_consistency", "deadlock_freedom", "arrival", "computation", "invariant", "reachable")
WHOLE = Limits(configurations=None)
VARIATIONS = {
    "timed": Variation(scheduler=Scheduler.PROGRAM_ORDER, control=Control.TIMED),
    "unordered": Variation(scheduler=Scheduler.UNORDERED),
}
SMALL = ("handover", "look_before_entry_racy", "oil_spill")


@pytest.fixture
def learning_in_sets(monkeypatch):
    """Let nearly all be learned where sets have members that are not known."""
    monkeypatch.setattr(checker.symbolic.explorer, "FIRST", 5)


def told(report):
    """Return what both engines say of a mission: all but depth, time and witnesses of what holds everywhere."""
    sizes = (report.configurations, report.transitions, report.rules, report.bounds, report.coverage)
    return (*sizes, [verdict_told(each) for each in report.verdicts], explained(report))


def explained(report):
    """Return how what holds is explained, in the words of the report."""
    lines = (line for line in report_text("m", report, traces=False) if line.startswith("  ✓"))
    return [re.sub(", a witness of .*", "", line) for line in lines]


def verdict_told(verdict):
    shown = sorted((v.kind, v.subject, len(v.trace)) for v in verdict.violations)
    if verdict.different > len(verdict.violations):  # of several as near, others may be shown
        shown = [(kind, length) for kind, _, length in shown][:1]
    witness = verdict.witness if verdict.property.kind == "reachable" else None
    counts = (verdict.count, verdict.examined, verdict.different)
    return (verdict.property.name, verdict.outcome, counts, verdict.remarks, shown, witness and len(witness))


def reports(initial, properties):
    return [check(initial, properties, WHOLE, engine=engine) for engine in (Engine.SYMBOLIC, Engine.FAST)]


def judged_alike(name, variation):
    mission = load_mission(MISSIONS / f"{name}.mission", variation)
    ours, theirs = reports(mission.initial, asked(mission))
    return told(ours) == told(theirs)


def asked(mission):
    return [each for each in mission.properties if each.kind in KINDS]


@pytest.mark.parametrize("name", NAMES)
def test_a_mission_is_judged_alike(name):
    assert judged_alike(name, Variation(scheduler=Scheduler.PROGRAM_ORDER))


@pytest.mark.parametrize("name", SMALL)
@pytest.mark.parametrize("variation", VARIATIONS.values(), ids=VARIATIONS)
@pytest.mark.usefixtures("learning_in_sets")
def test_a_mission_that_is_learned_in_sets_is_judged_alike(name, variation):
    assert judged_alike(name, variation)


@given(strategies.initial_configurations())
@settings(max_examples=15, deadline=None)
def test_a_generated_mission_is_judged_alike(initial):
    assume(initial.setting.scheduler is not Scheduler.FCFS)
    assume(explore(initial, limits=Limits(configurations=1_000)).complete)
    ours, theirs = reports(initial, [Property(kind, kind) for kind in KINDS[:4]])
    assert told(ours) == told(theirs)


@pytest.mark.usefixtures("learning_in_sets")
def test_every_trace_of_a_violation_replays():
    mission = load_mission(MISSIONS / "broken_deadlock.mission")
    report = check(mission.initial, mission.properties, WHOLE, engine=Engine.SYMBOLIC)
    traces = [violation.trace for verdict in report.verdicts for violation in verdict.violations]
    assert traces
    assert all(replay(trace.initial, to_json(trace, "", "")) == trace for trace in traces)


def test_what_is_said_of_runs_and_races_is_not_decided():
    mission = load_mission(MISSIONS / "surveillance.mission")
    report = check(mission.initial, mission.properties, WHOLE, engine=Engine.SYMBOLIC)
    by_kind = {each.property.kind: each for each in report.verdicts}
    assert by_kind["ltl"].outcome is by_kind["progress"].outcome is Outcome.INCOMPLETE
    assert by_kind["ltl"].note.startswith("not decided: the symbolic engine knows nothing of runs")
    race = load_mission(MISSIONS / "broken_control_race.mission")
    (verdict,) = check(race.initial, [Property("race_freedom", "r")], WHOLE, engine=Engine.SYMBOLIC).verdicts
    assert verdict.outcome is Outcome.INCOMPLETE
    assert report.exit_code == 3


@pytest.mark.parametrize(
    ("limits", "bound"),
    [
        (Limits(configurations=None, seconds=0.0), "the time limit of 0 s"),
        (Limits(configurations=None, memory=1_000_000), "the memory limit of 1 MB"),
        (Limits(configurations=100), "the limit of 100 configurations"),
    ],
)
def test_what_is_cut_is_incomplete(limits, bound, monkeypatch):
    monkeypatch.setattr(checker.symbolic.explorer, "FIRST", 5)
    mission = load_mission(MISSIONS / "takeover.mission", Variation(scheduler=Scheduler.PROGRAM_ORDER))
    report = check(mission.initial, asked(mission), limits, engine=Engine.SYMBOLIC)
    assert report.bounds == (bound,)
    assert {each.outcome for each in report.verdicts} == {Outcome.INCOMPLETE}


SPAWNING = """
BigActor b hosted_at uav0 with_behavior {
  observe(ALL)
  react {
    case seen if drifter0 in seen => spawn a hosted_at uav0 with_behavior looks()
    case seen => skip
  }
  observe(ALL)
}
def looks() = { observe(ALL) control(MOVE_HOST_TO gate0) }
environment { drifter0 vanishes }
"""


@pytest.mark.usefixtures("learning_in_sets")
def test_agents_that_are_spawned_take_part():
    mission = load(SPAWNING)
    ours, theirs = reports(mission.initial, asked(mission))
    assert ours.rules["spawn"] > 0 < ours.rules["actuate"]
    assert told(ours) == told(theirs)


def test_a_queue_for_all_is_refused():
    initial = load_mission(MISSIONS / "oil_spill.mission", Variation(scheduler=Scheduler.FCFS)).initial
    with pytest.raises(EngineError, match="does not do scheduler fcfs"):
        explore(initial, engine=Engine.SYMBOLIC)


def test_without_the_extra_it_says_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "oxidd", None)
    initial = load_mission(MISSIONS / "oil_spill.mission").initial
    with pytest.raises(EngineError, match=r"pip install 'bigactors\[symbolic\]'"):
        explore(initial, engine=Engine.SYMBOLIC)
