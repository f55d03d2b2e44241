"""Each scheduler refines the one before, and control that takes time allows what control in one step does."""

from collections import Counter

import pytest
from checked_missions import checked, load, verdict_of
from hypothesis import assume, given, reject
from mission_texts import missions
from scale import examples

from checker import Limits, Outcome, explore
from specs import MissionError

SCHEDULERS = ("fcfs", "program_order", "unordered")


def reached(text, most=1_500):
    """Return what is reachable, the order of η aside; None where that is too much."""
    try:
        found = explore(load(text).initial, limits=Limits(configurations=most))
    except MissionError:  # what can be known to be unrealisable is no mission
        reject()
    return {view(c) for c in found.configurations} if found.complete else None


def view(c):
    asked = frozenset(Counter(each.request for each in c.eta.all()).items())
    return frozenset(
        (cell, c.read(cell)) for cell, _ in c.state.items() if cell[0] not in ("line", "sends", "queue")
    ), asked


@pytest.mark.long
@examples(40)
@given(missions())
def test_what_is_reachable_in_one_line_is_in_several_and_what_is_in_several_is_in_none(text):
    one, several, none = (reached(f"{text}scheduler {scheduler}") for scheduler in SCHEDULERS)
    assume(one is not None and several is not None and none is not None)
    assert one <= several <= none


@examples(40)
@given(missions())
def test_what_is_reachable_in_one_step_is_when_control_takes_time(text):
    without = text.replace("control atomic\n", "").replace("control timed\n", "")
    atomic, timed = (reached(f"{without}control {control}") for control in ("atomic", "timed"))
    assume(atomic is not None and timed is not None)
    assert atomic <= timed


TWO = """
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO gate0)
  observe(PARENT(HOST))
  react { case o => send("in", b) }
  control(MOVE_HOST_TO south0)
}
BigActor b hosted_at uav1 with_behavior {
  observe(CHILDREN(gate0))
  react { case "in" => control(MOVE_HOST_TO north0) case o: Observation => control(MOVE_HOST_TO gate0) }
}
"""
PILOTS = """
BigActor a hosted_at gcs0 with_behavior { control(MOVE uav0 TO gate0) control(MOVE uav0 TO north0) }
BigActor b hosted_at gcs1 with_behavior { control(HAND uav1 TO gcs2) control(MOVE uav0 TO south0) }
"""
INVARIANTS = (
    "actually uav0 in gate0 -> not (actually uav1 in gate0)",
    "uav0 in gate0 -> not pending SND a",
    "ended a -> not (actually uav0 in north0)",
    "ended a and not pending a -> actually uav0 in south0",
    "actually uav1 linked control:gcs1 or actually uav1 linked control:gcs2",
    "ended a and not pending a -> actually uav0 in north0",
    "pending SND a -> actually uav0 in gate0 or actually uav0 in south0",
    "actually uav0 in gate0 <-> uav0 in gate0",
    "true",
)
CHECKS = "check {" + " ".join(f'invariant "{number}": {each}' for number, each in enumerate(INVARIANTS)) + "}"


@pytest.mark.parametrize("control", ["atomic", "timed"])
@pytest.mark.parametrize("text", [TWO, PILOTS], ids=["two", "pilots"])
def test_an_invariant_of_all_runs_of_a_scheduler_is_one_of_the_next(text, control):
    held = []
    for scheduler in reversed(SCHEDULERS):
        report = checked(f"{text}control {control}\nscheduler {scheduler}\n{CHECKS}")
        assert report.complete
        verdicts = (verdict_of(report, str(number)) for number in range(len(INVARIANTS)))
        held.append({each.property.name for each in verdicts if each.outcome is Outcome.HOLDS})
    assert held[0] <= held[1] <= held[2]
    assert held[0] != held[1]  # the line matters to some
    assert len(held[2]) < len(INVARIANTS)
