"""The causes of violations: who did what, and when, in plain sentences."""

from pathlib import Path

import pytest

from checker import check
from checker.reports.causes import causes_of, formulas_of
from specs.elaboration import load_mission

TOLD = [
    (
        "look_before_entry_racy",
        "race_freedom",
        {
            7: "b on uav1 looks into gate0, and sees nobody",
            8: "uav0 moves from north0 to gate0, as a wants",
            12: "b acts on what it saw: uav1 moves from south0 to gate0",
        },
    ),
    (
        "broken_inconsistent",
        "local_consistency",
        {1: "pilot on uav0 asks for MOVE_HOST_TO west0", 2: "uav0 drifts to shore0"},
    ),
    (
        "broken_control_race",
        "race_freedom",
        {1: "first on gcs0 asks for MOVE uav0 TO west0", 2: "second on gcs0 asks for MOVE uav0 TO east0"},
    ),
    (
        "broken_deadlock",
        "deadlock_freedom",
        {
            7: "corridor waits at a react",
            11: "first waits at a react",
            18: "pad waits at a react",
            22: "second waits at a react",
        },
    ),
    (
        "broken_crossing",
        "apart",
        {2: "uav0 sets off for east0, as first wants", 4: "uav1 sets off for north0, as second wants"},
    ),
]


CORPUS = Path(__file__).parents[2] / "corpus" / "violated"

FOR_EVER = [
    ("runs", "it comes south", {6: "the steps since c0 repeat for ever"}),
    ("runs", "never south", {3: "uav0 moves from north0 to south0, as a wants"}),
    (
        "unserved",
        "a patient hand, the link gone",
        {1: "g on gcs0 asks for MOVE uav0 TO south0", 2: "the run may stay as it is for ever"},
    ),
]


@pytest.mark.parametrize(("mission", "name", "told"), FOR_EVER, ids=[each[1] for each in FOR_EVER])
def test_a_run_that_never_ends_is_told_with_what_it_does_for_ever(mission, name, told):
    verdict = check(load_mission(CORPUS / f"{mission}.mission")).verdicts[name]
    violation = verdict.violations[0]
    found = causes_of(violation.trace, violation, formulas_of(verdict.property))
    assert {each.number: each.text for each in found} == told


PASSED_ON = """\
signature standard
world {
  gate: Location = circle (37, -8.7) radius 300 m
  north: Location = circle (37.02, -8.7) radius 300 m
  uav0: UAV = point (37.02, -8.7) linked net
  uav1: UAV = point (37.0201, -8.7) linked net
}
BigActor looker hosted_at uav1 with_behavior {
  observe(CHILDREN(gate))
  react {
    case seen if not uav1 in seen => send "go" to mover
  }
  control(MOVE_HOST_TO gate)
}
BigActor mover hosted_at uav0 with_behavior {
  react {
    case "go" => control(MOVE_HOST_TO gate)
  }
}
"""


def test_one_who_acts_on_what_another_saw_is_told_from_one_who_looked(tmp_path):
    file = tmp_path / "passed_on.mission"
    file.write_text(PASSED_ON, encoding="utf-8")
    violation = check(load_mission(file)).verdicts["race_freedom"].violations[0]
    last = causes_of(violation.trace, violation)[-1]
    assert last.text == "mover acts on what looker saw: uav0 moves from north to gate"


@pytest.mark.parametrize(("mission", "name", "told"), TOLD, ids=[each[0] for each in TOLD])
def test_a_violation_has_its_causes_in_the_order_of_the_run(mission, name, told):
    verdict = check(load_mission(mission)).verdicts[name]
    violation = verdict.violations[0]
    found = {
        each.number: each.text
        for each in causes_of(violation.trace, violation, formulas_of(verdict.property))
    }
    assert found == told
