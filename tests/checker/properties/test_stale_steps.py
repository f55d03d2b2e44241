"""The three steps of a stale-observation race: in the trace, in each report of it, and when it is replayed."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from checked_missions import BOTH_LOOK, load, start, verdict
from stale_missions import written
from swarms import swarm

from checker import ReplayError, Trace, check, print_trace, replay, to_json
from checker.properties.races import STALE
from checker.properties.stale_steps import stale_steps
from checker.reduction import Reduction
from checker.reports.lanes import LaneStep, Repetition, bounded, folded, lanes_of_trace, lanes_text
from checker.reports.trace_comparison import comparison_text
from semantics.races.monitor import monitored

ALIKE = swarm(
    "observe(CHILDREN(room0)) react { case o => if size(o) == 1 { control(MOVE_HOST_TO room0) } }",
    rest="check { race_freedom }",
)


def race_of(text, agent=""):
    """Return a stale race of a mission, that of an agent if one is named."""
    found = (each for each in verdict(text, "race_freedom").violations if each.kind == STALE)
    return next(each for each in found if agent in ("", each.trace.steps[-1].label.agent))


def said(trace):
    return {role: str(trace.steps[number - 1].label) for number, role in trace.race.roles.items()}


SCOUTED = written("""
a@uav0: LOOKS react { case o => send "look" to scout if not (uav1 in o) { ENTER } }
scout@vessel0: react { case "look" => LOOKS } react { case o => send "go" to b }
b@uav1: react { case "go" => ENTER }
""")
"""The scout asks the same as a, and later; b goes by the scout's word."""

TOLD = written("""
a@uav0: react { case "go" => ENTER }
scout@vessel0: LOOKS react { case o => if not (uav1 in o) { send "go" to a } } LOOKS react { case o => send "on" to b }
b@uav1: react { case "on" => ENTER }
""")
"""What a does rests on the scout's first look, and on none of its own."""


@pytest.mark.parametrize("scheduler", ["unordered", "program_order", "fcfs"])
def test_the_look_is_that_of_who_acts_though_another_asks_the_same_later(scheduler):
    assert said(race_of(f"{SCOUTED}scheduler {scheduler}\n", "a").trace) == {
        "sensed": "⟨sense : OBS(a, CHILDREN(gate0))⟩",
        "changed": "⟨actuate : CTR(b, MOVE_HOST_TO gate0)⟩",
        "acted": "⟨actuate : CTR(a, MOVE_HOST_TO gate0)⟩",
    }


def test_of_two_looks_of_one_agent_it_is_the_one_that_another_was_told_of():
    trace = race_of(TOLD, "a").trace
    looks = [number for number, step in enumerate(trace.steps, 1) if step.label.rule == "sense"]
    assert len(looks) == 2
    assert trace.race.sensed == looks[0]


def test_a_trace_that_ends_in_no_race_has_no_such_steps():
    trace = race_of(BOTH_LOOK).trace
    for steps in (trace.steps[:-1], trace.steps[:5], ()):
        assert stale_steps(trace.initial, steps) is None
    assert stale_steps(start(BOTH_LOOK), trace.steps) is None  # nothing is remembered there


def test_the_text_the_lanes_and_the_comparison_mark_the_three_steps():
    trace = race_of(BOTH_LOOK).trace
    marked = {number: f"[{role}]" for number, role in trace.race.roles.items()}
    lines = list(print_trace(trace, changes=False))
    for number, line in enumerate(lines, 1):
        assert line.endswith(f"c{number}  {marked[number]}" if number in marked else f"c{number}")
    columns = "\n".join(lanes_text(lanes_of_trace(trace)))
    compared = "\n".join(comparison_text(trace, Trace(trace.initial), ("one", "other")))
    for text in (columns, compared):
        assert [word for word in text.split() if word in marked.values()] == list(marked.values())


def test_a_replayed_trace_has_the_same_steps_and_a_false_mark_is_refused():
    trace = race_of(BOTH_LOOK).trace
    data = json.loads(json.dumps(to_json(trace, "small.mission", "sha256:0")))
    assert [each.get("role") for each in data["steps"] if "role" in each] == ["sensed", "changed", "acted"]
    assert replay(start(BOTH_LOOK), data).race == trace.race
    for number, role in ((0, "sensed"), (trace.race.changed - 1, "acted"), (trace.race.acted - 1, ["acted"])):
        steps = [dict(each) for each in data["steps"]]
        steps[number]["role"] = role
        with pytest.raises(ValueError, match=f"step {number + 1} should have"):
            replay(start(BOTH_LOOK), {**data, "steps": steps})
    steps = [{key: each[key] for key in each if key != "role"} for each in data["steps"]]
    assert replay(start(BOTH_LOOK), {**data, "steps": steps}).race is None


def test_a_mark_in_a_run_without_the_monitors_memory_is_refused():
    trace = race_of(BOTH_LOOK).trace
    data = to_json(trace, "small.mission", "sha256:0") | {"monitored": False}
    with pytest.raises((ValueError, ReplayError), match="no 'role'"):
        replay(start(BOTH_LOOK), data)


@pytest.mark.parametrize(
    "reduce", [{Reduction.POR}, {Reduction.SYMMETRY}, set(Reduction)], ids=["por", "symmetry", "both"]
)
def test_under_a_reduction_the_marks_are_at_the_steps_of_the_run_that_is_shown(reduce):
    mission = load(ALIKE, "")
    report = check(mission, reduce=reduce)
    races = [each for each in report.verdicts["race_freedom"].violations if each.kind == STALE]
    assert races
    for each in races:
        rules = {role: label[1:].split(" ")[0] for role, label in said(each.trace).items()}
        assert rules == {"sensed": "sense", "changed": "actuate", "acted": "actuate"}
        assert each.details == each.trace.told_race
        assert replay(monitored(mission.initial), to_json(each.trace, "m", "d")).race == each.trace.race


def test_a_step_of_a_race_is_never_folded_nor_left_out():
    lanes = lanes_of_trace(race_of(BOTH_LOOK).trace)
    repeated = [replace(lanes.steps[0], number=number) for number in range(1, 101)]
    marked = replace(repeated[49], role="sensed")
    rows = list(folded([*repeated[:49], marked, *repeated[50:]]))
    assert [each for each in rows if isinstance(each, LaneStep)][1:] == [marked]
    assert sum(isinstance(each, Repetition) for each in rows) == 2
    assert marked in bounded([*repeated[:49], marked, *repeated[50:]], 9)


CASES = Path(__file__).parents[2] / "corpus" / "violated"


@pytest.mark.parametrize("path", sorted(CASES.glob("stale*.mission")), ids=lambda path: path.stem)
def test_each_stale_race_of_the_corpus_has_its_three_steps(path):
    text = path.read_text(encoding="utf-8")
    mission = load(text, "")
    report = check(mission)
    races = [each for found in report.verdicts for each in found.violations if each.kind == STALE]
    assert races
    for each in races:
        assert each.trace.race is not None
        assert list(said(each.trace)) == ["sensed", "changed", "acted"]
        assert each.trace.race.sensed < each.trace.race.changed < each.trace.race.acted == len(each.trace)
