"""The causes of violations: who did what, and when, in plain sentences."""

from pathlib import Path

import pytest

from checker import check
from checker.reports.causes import causes_of, formulas_of
from specs.elaboration import load_mission

AFTER = None
"""A sentence about the end of the run, and not about a step."""

TOLD = [
    (
        "look_before_entry_racy",
        "race_freedom",
        [
            (7, "b on uav1 looks into gate0, and sees nobody"),
            (8, "uav0 moves from north0 to gate0, as a wants"),
            (12, "b acts on what it saw: uav1 moves from south0 to gate0"),
        ],
    ),
    (
        "broken_inconsistent",
        "local_consistency",
        [
            (1, "pilot on uav0 asks for MOVE_HOST_TO west0"),
            (2, "uav0 drifts to shore0"),
            (AFTER, "uav0: believed in east0, actually in shore0"),
        ],
    ),
    (
        "broken_control_race",
        "race_freedom",
        [
            (1, "first on gcs0 asks for MOVE uav0 TO west0"),
            (2, "second on gcs0 asks for MOVE uav0 TO east0"),
            (AFTER, "nothing decides which of the two comes first, and the outcome depends on it"),
        ],
    ),
    (
        "broken_deadlock",
        "deadlock_freedom",
        [
            (
                7,
                (
                    'corridor on gcs0 delivers "yours" to first; then corridor waits for "free" from first or second; '
                    'no case takes ("take", second)'
                ),
            ),
            (
                11,
                'first on uav0 delivers ("take", first) to pad; then first waits for "yours" from corridor or pad',
            ),
            (
                18,
                (
                    'pad on gcs0 delivers "yours" to second; then pad waits for "free" from first or second; '
                    'no case takes ("take", first)'
                ),
            ),
            (
                22,
                (
                    'second on uav1 delivers ("take", second) to corridor; then second waits for "yours" from corridor '
                    "or pad"
                ),
            ),
        ],
    ),
    (
        "broken_crossing",
        "apart",
        [
            (2, "uav0 sets off for east0, as first wants"),
            (4, "uav1 sets off for north0, as second wants"),
            (
                AFTER,
                (
                    "uav0 may meet uav1: uav0 between west0 and east0, uav1 between south0 and north0; nearest at "
                    "(37.10000, -8.60000) and (37.10000, -8.60000)"
                ),
            ),
        ],
    ),
    (
        "broken_two_lanes",
        "not through the oil",
        [
            (2, "scout on uav0 looks into east0, and sees nobody: it misses spill0"),
            (8, "ship0 moves from harbour0 to east0, as pilot wants"),
            (AFTER, "true here: actually ship0 in east0, actually spill0 in east0"),
        ],
    ),
    (
        "broken_endurance",
        "endurance",
        [
            (17, "uav0 sets off for airfield0, as patrol wants"),
            (AFTER, "uav0 lasts 27 min, and is still not restored at 27:10"),
        ],
    ),
]


CORPUS = Path(__file__).parents[2] / "corpus" / "violated"

FOR_EVER = [
    ("runs", "it comes south", [(AFTER, "all steps repeat for ever")]),
    ("runs", "never south", [(3, "uav0 moves from north0 to south0, as a wants")]),
    (
        "deadlock",
        "deadlock_freedom",
        [(AFTER, 'a waits for "ready" from b'), (AFTER, 'b waits for "ready" from a')],
    ),
    (
        "lost_target",
        "deadlock_freedom",
        [
            (
                5,
                (
                    "a on uav0 asks for MOVE_HOST_TO spill0; then this stays pending: a command rests on a belief that "
                    "is no longer true"
                ),
            )
        ],
    ),
    (
        "unserved",
        "a patient hand, the link gone",
        [(1, "g on gcs0 asks for MOVE uav0 TO south0"), (AFTER, "all may stay like this for ever")],
    ),
]


def told_of(verdict):
    """Return the causes of a verdict's first violation, each with its step."""
    violation = verdict.violations[0]
    found = causes_of(violation.trace, violation, formulas_of(verdict.property))
    assert all(each.is_step or each.number == len(violation.trace) for each in found)
    return [(each.number if each.is_step else AFTER, each.text) for each in found]


@pytest.mark.parametrize(("mission", "name", "told"), FOR_EVER, ids=[each[1] for each in FOR_EVER])
def test_what_never_ends_and_what_never_comes_is_told(mission, name, told):
    verdict = check(load_mission(CORPUS / f"{mission}.mission")).verdicts[name]
    assert told_of(verdict) == told


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
    assert told_of(check(load_mission(mission)).verdicts[name]) == told
