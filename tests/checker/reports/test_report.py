"""Reports as text and as data, and exit codes with their precedence."""

import json
import re
from dataclasses import replace

import pytest
from checked_missions import PILOTS, checked, load, moves, start

from checker import (
    Bound,
    Limits,
    Outcome,
    Report,
    Stop,
    Trace,
    Verdict,
    Violation,
    check,
    replay,
    report_json,
    report_text,
)
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.state.setting import Control


def lines(text, limits=None):
    mission = load(text)
    report = check(mission, limits=limits)
    return [re.sub(r"\d+\.\d\d s$", "T s", line) for line in report_text("m", report, traces=False)]


ENTERS = moves("gate0", "a", "uav0")
EVERYTHING = """
check { local_consistency race_freedom deadlock_freedom arrival invariant "never": not (actually uav1 in gate0)
        reachable "in": actually uav0 in gate0 }
"""

# --- text (of whole reports: `test_corpus_verdicts`) ------------------------------------------------------------


def test_a_search_that_met_no_control_is_vacuous():
    text = PILOTS.replace("{ control", '{ react { case "never" => skip } control')
    assert lines(text + "check { race_freedom }")[1] == (
        "  ✓ race_freedom  holds; searched over 1 configuration with the monitor's memory; "
        "vacuous: no control was ever served"
    )


THREE_STALE = """
BigActor a hosted_at gcs0 with_behavior { control(MOVE uav1 TO gate0) }
BigActor b hosted_at gcs1 with_behavior { control(MOVE uav0 TO gate0) control(MOVE uav0 TO south0) }
BigActor c hosted_at vessel0 with_behavior { control(MOVE_HOST_TO gate0) }
environment { vessel0 drifts among point (36.985, -8.71), point (37.02, -8.69) }
check { local_consistency }
"""


def test_only_so_many_violations_are_shown_and_the_others_counted():
    mission = load(THREE_STALE)
    for most, said in ((1, "3 different, of which 1 is shown"), (2, "3 different, of which 2 are shown")):
        report = check(mission, violations=most)
        assert len(report.verdicts[0].violations) == most
        assert said in next(line for line in report_text("m", report) if "✗" in line)
        assert [each.kind for each in report.verdicts[0].violations] == ["unmatched", "inconsistent"][:most]


def test_what_was_cut_off_says_where_and_decides_nothing():
    found = lines(ENTERS + EVERYTHING, limits=Limits(configurations=2))
    assert found[:-1] == [
        "m: 2 configurations, 2 transitions, depth 1, INCOMPLETE, T s",
        "  stopped at the limit of 2 configurations: the rest was not explored",
        "  ? local_consistency  incomplete; examined 1 control next in line, a witness of 2 steps",
        (
            "  ✓ race_freedom       holds; by ownership, without a search: no agent may change anything that "
            "another's control depends on"
        ),
        "  ? deadlock_freedom   incomplete; nothing against it so far",
        "  ? arrival            incomplete; nothing against it so far",
        "  ? never              incomplete; examined 2 configurations, a witness of 0 steps",
        "  ? in                 incomplete; not found so far",
        "  ? computation        incomplete; nothing against it so far",
    ]


def test_what_was_found_before_the_end_stands():
    found = lines(
        ENTERS + 'check { invariant "out": pending a reachable "asked": pending CTR a }',
        limits=Limits(configurations=2),
    )
    assert "  ✗ out          violated; found once" in found
    assert "  ✓ asked        holds; examined 1, a witness of 1 step" in found


def test_the_notes_of_a_mission_come_last():
    report = replace(checked(ENTERS), notes=("borders are left out",))
    assert list(report_text("m", report))[-1] == "  note: borders are left out"


# --- data -----------------------------------------------------------------------------------------------------


def as_json(text, limits=None):
    mission = load(text)
    report = check(mission, limits=limits, notes=("a note",))
    return json.loads(json.dumps(report_json("m", "sha256:0", report, mission.setting.control)))


def test_the_data_say_what_the_report_says():
    data = as_json(PILOTS + EVERYTHING)
    assert {key: value for key, value in data.items() if key not in ("properties", "seconds")} == {
        "schema": "bigactors.report/1",
        "mission": "m",
        "digest": "sha256:0",
        "complete": True,
        "bounds": [],
        "configurations": 10,
        "transitions": 12,
        "depth": 4,
        "reduced": [],
        "ways": None,
        "transitions_allowed": 12,
        "exit_code": 1,
        "rules": {"actuate": 6, "req_ctr": 6},
        "rules_never_used": [
            "fun",
            "req_obs",
            "sense",
            "rcv_obs",
            "req_snd",
            "snd",
            "rcv_msg",
            "timeout",
            "req_mgr",
            "migrate",
            "spawn",
        ],
        "coverage": {
            "complete": True,
            "statements": {"reached": 2, "of": 2},
            "branches": {"reached": 0, "of": 0},
            "rules": {"reached": 0, "of": 0},
            "clauses": {"reached": 0, "of": 0},
            "lines_reached": [25, 26],
            "lines_not_reached": [],
            "gaps": [],
        },
        "notes": ["a note"],
        "times": None,
    }
    assert data["seconds"] >= 0
    assert [(each["name"], each["kind"], each["verdict"]) for each in data["properties"]] == [
        ("local_consistency", "local_consistency", "holds"),
        ("race_freedom", "race_freedom", "violated"),
        ("deadlock_freedom", "deadlock_freedom", "holds"),
        ("arrival", "arrival", "holds"),
        ("never", "invariant", "holds"),
        ("in", "reachable", "holds"),
        ("computation", "computation", "holds"),
    ]


def test_the_traces_among_the_data_replay():
    data = as_json(PILOTS + EVERYTHING)
    c = start(PILOTS)
    for each in data["properties"]:
        first = each["violations"][0]["trace"] if each["violations"] else None
        assert each["trace"] == first
        assert (each["trace"] is None) == (each["verdict"] != "violated")
        for trace in filter(None, (each["trace"], each["witness"])):
            assert (trace["schema"], trace["mission"], trace["digest"]) == (
                "bigactors.trace/1",
                "m",
                "sha256:0",
            )
            assert len(replay(c, trace)) == len(trace["steps"])


def test_the_rules_that_never_fired_depend_on_how_control_goes():
    atomic, timed = as_json(ENTERS), as_json(ENTERS + "control timed")
    assert "commit" not in atomic["rules_never_used"]
    assert timed["rules"] == {"command": 1, "commit": 1, "req_ctr": 1}
    assert "actuate" in timed["rules_never_used"]


def test_the_data_of_what_was_cut_off_are_incomplete():
    data = as_json(ENTERS + EVERYTHING, Limits(configurations=2))
    assert (data["complete"], data["exit_code"]) == (False, 3)
    assert data["bounds"] == ["the limit of 2 configurations"]
    verdicts = {each["name"]: each["verdict"] for each in data["properties"]}
    assert verdicts.pop("race_freedom") == "holds"
    assert set(verdicts.values()) == {"incomplete"}


# --- exit codes -----------------------------------------------------------------------------------------------

HOLDS, VIOLATED, INCOMPLETE = Outcome.HOLDS, Outcome.VIOLATED, Outcome.INCOMPLETE


@pytest.mark.parametrize(
    ("outcomes", "bounds", "code"),
    [
        ((), (), 0),
        ((HOLDS, HOLDS), (), 0),
        ((HOLDS, VIOLATED), (), 1),
        ((HOLDS,), (Bound(Stop.INTERRUPTION),), 3),
        ((HOLDS, INCOMPLETE), (Bound(Stop.INTERRUPTION),), 3),
        ((HOLDS, INCOMPLETE), (), 3),
        ((INCOMPLETE, VIOLATED), (Bound(Stop.INTERRUPTION),), 1),
        ((VIOLATED, INCOMPLETE, HOLDS), (), 1),
    ],
)
def test_a_violation_goes_before_what_is_incomplete_and_that_before_success(outcomes, bounds, code):
    verdicts = tuple(Verdict(Property(PropertyKind.INVARIANT, "x"), outcome) for outcome in outcomes)
    report = Report(verdicts, configurations=1, transitions=0, depth=0, bounds=bounds)
    assert report.exit_code == code
    assert report.complete == (not bounds)


def test_a_verdict_and_its_violations_are_values():
    c = start(ENTERS)
    one, other = (Violation("deadlock", "x", Trace(c)) for _ in range(2))
    assert one == other
    assert report_json("m", "d", Report((), 1, 0, 0), Control.TIMED)["rules_never_used"][6:8] == [
        "command",
        "commit",
    ]


def test_race_freedom_by_ownership_has_a_run_in_which_a_control_is_served():
    (race,) = (each for each in as_json(ENTERS + EVERYTHING)["properties"] if each["name"] == "race_freedom")
    assert race["note"].startswith("by ownership")
    assert [step["label"] for step in race["witness"]["steps"]] == [
        "⟨req_ctr : a, control(MOVE_HOST_TO gate0)⟩",
        "⟨actuate : CTR(a, MOVE_HOST_TO gate0)⟩",
    ]
