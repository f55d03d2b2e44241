"""Lanes and comparisons: who took each step, what it changed, and where two runs part."""

from dataclasses import replace

import pytest
from checked_missions import PILOTS, WORLD, load, moves, start, verdict, violation

from checker import Trace
from checker.reports.lanes import LeftOut, Repetition, bounded, folded, lanes_of_trace, lanes_text, steps_of
from checker.reports.trace_comparison import AlignedSteps, compare, comparison_text
from checker.steps import candidates
from semantics.state.configuration import Label
from semantics.state.differences import Difference

DRIFTS = moves("gate0", "a", "uav0") + "environment { uav0 drifts among south0 }"


def follow(text, *labels):
    """Return the trace that takes the first transition whose label contains each word, one after the other."""
    trace = Trace(start(text))
    for word in labels:
        found = candidates(trace.configurations[-1])
        trace = trace.extended(next(each for each in found if word in str(each.label)))
    return trace


def test_each_step_stands_in_its_actors_lane_with_what_it_changed():
    trace = violation(verdict(DRIFTS, "local_consistency"), "inconsistent").trace
    lanes = lanes_of_trace(trace)
    assert lanes.names == ("a", "environment")
    assert [(step.number, step.lane, step.label.rule, step.serves) for step in lanes.steps] == [
        (1, 0, "req_ctr", False),
        (2, 1, "env", False),
    ]
    assert [list(map(str, step.changes)) for step in lanes.steps] == [
        ["α  a ended", "η  + CTR(a, MOVE_HOST_TO gate0)"],
        ["P  uav0 : in north0 ↦ in south0"],
    ]


def test_lanes_are_columns_of_text():
    trace = violation(verdict(DRIFTS, "local_consistency"), "inconsistent").trace
    assert list(lanes_text(lanes_of_trace(trace), 72)) == [
        "      a                                environment",
        "      ───────────────────────────────  ───────────────────────────────",
        "c1    ● req_ctr                        │",
        "        control(MOVE_HOST_TO gate0)    │",
        "        α  a ended                     │",
        "        η  + CTR(a, MOVE_HOST_TO       │",
        "          gate0)                       │",
        "c2    │                                ● env",
        "      │                                  uav0 drifts to south0",
        "      │                                  P  uav0 : in north0 ↦ in",
        "      │                                    south0",
    ]


def test_a_run_that_repeats_says_from_where():
    trace = follow(PILOTS, *ONE)
    assert (
        list(lanes_text(lanes_of_trace(replace(trace, loop=2))))[-1]
        == "↻ c4 is c2: from there on again and again"
    )
    assert list(lanes_text(lanes_of_trace(replace(trace, loop=4))))[-1] == "c4, for ever"


def test_a_spawned_agent_has_a_lane_from_the_start():
    text = (
        "BigActor b hosted_at uav0 with_behavior { spawn a hosted_at uav0 with_behavior looks() }\n"
        "def looks() = { observe(ALL) }"
    )
    lanes = lanes_of_trace(follow(text, "spawn", "req_obs"))
    assert lanes.names == ("a", "b")
    assert [step.lane for step in lanes.steps] == [1, 0]


# --- comparison -----------------------------------------------------------------------------------------------

ONE = ("req_ctr : a", "req_ctr : b", "actuate : CTR(a", "actuate : CTR(b")
OTHER = ("req_ctr : a", "req_ctr : b", "actuate : CTR(b", "actuate : CTR(a")


def test_a_comparison_as_text():
    assert list(comparison_text(follow(PILOTS, *ONE), follow(PILOTS, *OTHER), ("one", "other"))) == [
        "< one: 4 steps",
        "> other: 4 steps",
        "the same for 2 steps, up to c2; then",
        "  > c2 --⟨actuate : CTR(b, MOVE uav0 TO gate0)⟩--> c3",
        "  = c2 --⟨actuate : CTR(a, MOVE uav0 TO south0)⟩--> c3 (c4 there)",
        "  < c3 --⟨actuate : CTR(b, MOVE uav0 TO gate0)⟩--> c4",
        "the end of the second differs from the end of the first:",
        "  L  uav0 : gate0 ↦ south0",
        "  P  uav0 : in gate0 ↦ in south0",
    ]


def test_a_trace_is_the_same_as_itself_and_parts_from_a_longer_one_at_its_end():
    one, longer = follow(PILOTS, *ONE[:3]), follow(PILOTS, *ONE)
    assert list(comparison_text(one, one, ("x", "y")))[-1] == "they are the same: 3 steps"
    assert compare(one, longer).shared == 3
    assert compare(one, longer).pairs == (AlignedSteps(None, 4),)
    apart = moves("gate0", "a", "uav0") + moves("south0", "b", "uav1")
    first = follow(apart, "req_ctr : a", "req_ctr : b", "CTR(a", "CTR(b")
    other = follow(apart, "req_ctr : b", "req_ctr : a", "CTR(b", "CTR(a")
    assert list(comparison_text(first, other, ("x", "y")))[-1] == "they end in the same configuration"


def test_of_long_traces_only_so_many_steps_are_aligned(monkeypatch):
    monkeypatch.setattr("checker.reports.trace_comparison.MOST_ALIGNED", 1)
    found = compare(follow(PILOTS, *ONE), follow(PILOTS, *OTHER))
    assert (found.pairs, found.beyond) == ((AlignedSteps(3, None), AlignedSteps(None, 3)), (1, 1))


def test_traces_of_missions_with_other_entities_are_compared_by_their_steps_alone():
    larger = WORLD.replace("spill0: OilSpill absent", "spill0: OilSpill absent\n  spill1: OilSpill absent")
    one, other = Trace(start(PILOTS)), Trace(load(PILOTS, larger).initial)
    assert compare(one, other).ends is None
    other = other.extended(candidates(other.initial)[0])
    said = list(comparison_text(one, other, ("x", "y")))
    assert said[-1] == "their ends are not compared: the missions have different entities"


LOOK = "BigActor a hosted_at gcs0 with_behavior { while true { observe(ALL) react { case seen => skip } } }"
COUNT = """
BigActor a hosted_at gcs0 with_behavior {
  let n = 0
  while n < 9 { observe(ALL) react { case seen => n = n + 1 } }
}
"""


def follow_first(text, count):
    trace = Trace(start(text))
    for _ in range(count):
        trace = trace.extended(candidates(trace.configurations[-1])[0])
    return lanes_of_trace(trace)


@pytest.mark.parametrize("text", [LOOK, COUNT], ids=["an observation loop", "a loop that counts"])
def test_steps_that_only_repeat_others_are_one_line(text):
    lanes = follow_first(text, 24)
    rows = list(folded(lanes.steps))
    assert isinstance(rows[-1], Repetition)
    assert len(rows[-1].steps) >= 16
    assert [step for row in rows for step in steps_of(row)] == list(lanes.steps)
    assert f"↻ {len(rows[-1].steps)} steps, to c24" in "\n".join(lanes_text(lanes, 200))
    assert "↻" not in "\n".join(lanes_text(lanes, 200, unfolded=True))


def test_what_changes_the_world_and_a_few_steps_are_never_folded():
    steps = follow_first(LOOK, 24).steps
    drop = replace(steps[0], label=Label("env", None, "x"), changes=(Difference("P", "x", "x drops"),))
    assert list(folded([*steps, *[drop] * 20]))[-20:] == [drop] * 20
    first = list(folded(steps))
    assert list(folded(steps[: len(first) + 6])) == list(steps[: len(first) + 6])


def test_of_too_many_rows_the_ends_and_those_around_a_step_are_kept():
    steps = follow_first(COUNT, 24).steps
    rows = list(bounded(steps, 6, 12))
    assert [(row.number, row.last) for row in rows] == [
        (1, 1), (2, 2), (3, 10), (11, 11), (12, 12), (13, 22), (23, 23), (24, 24)
    ]  # fmt: skip
    assert [isinstance(row, LeftOut) for row in rows] == [number in (2, 5) for number in range(8)]
    assert list(bounded(steps, 24)) == list(steps)
