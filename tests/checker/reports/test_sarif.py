"""Reports as SARIF, valid and at the right lines."""

import json
from pathlib import Path

import pytest
from checked_missions import SPARE
from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError
from mission_results import (
    BUG,
    ENTERS,
    GAPS,
    HOSTILE,
    MISTAKE,
    NOT_BEGUN,
    PILOTS,
    UNPLACED,
    all_sorts,
    cut_off,
    failed,
    hostile,
    result,
)

from checker import check
from checker.reports.results import CheckResult, clean
from checker.reports.sarif import RULES, artifact, sarif_json
from checker.reports.source_lines import step_lines, violation_line
from specs.elaboration import load_mission

ROOT = Path(__file__).parents[3]
SCHEMA = json.loads((ROOT / "docs" / "reference" / "sarif.schema.json").read_text(encoding="utf-8"))
VALIDATOR = Draft202012Validator(SCHEMA)


def run_of(*results):
    document = json.loads(json.dumps(sarif_json(results, "1.2.3"), ensure_ascii=False).encode())
    VALIDATOR.validate(document)
    return document["runs"][0]


def region(found):
    return found["locations"][0]["physicalLocation"].get("region")


def test_the_schema_is_a_schema():
    Draft202012Validator.check_schema(SCHEMA)


def test_warnings_are_results_and_the_run_is_a_success_all_the_same():
    found = run_of(result(GAPS))
    assert [(each["ruleId"], each["level"], region(each)["startLine"]) for each in found["results"]] == [
        ("vacuity", "warning", 32),
        ("coverage", "warning", 28),
    ]
    assert found["invocations"][0] == {"executionSuccessful": True, "toolExecutionNotifications": []}
    moved = run_of(result("\n" + GAPS))
    fingerprints = [[each["partialFingerprints"] for each in run["results"]] for run in (found, moved)]
    assert fingerprints[0] == fingerprints[1]


def test_every_sort_of_result_is_valid():
    found = run_of(*all_sorts())
    assert found["tool"]["driver"]["version"] == "1.2.3"
    assert not found["invocations"][0]["executionSuccessful"]
    rules = found["tool"]["driver"]["rules"]
    assert [rules[each["ruleIndex"]]["id"] for each in found["results"]] == [
        each["ruleId"] for each in found["results"]
    ]
    for each in found["invocations"][0]["toolExecutionNotifications"]:
        assert rules[each["associatedRule"]["index"]]["id"] == each["associatedRule"]["id"]


def test_what_holds_has_no_results_and_was_successful():
    found = run_of(result(ENTERS))
    assert (found["results"], found["invocations"][0]["toolExecutionNotifications"]) == ([], [])
    assert found["invocations"][0]["executionSuccessful"]
    assert {each["id"] for each in found["tool"]["driver"]["rules"]} == set(RULES)


def test_a_violation_is_at_its_statement_and_related_to_the_line_that_asks():
    (race,) = run_of(result(PILOTS))["results"]
    line = result(PILOTS).issues()[0].line
    assert (race["ruleId"], race["level"], region(race)) == ("race_freedom", "error", {"startLine": line})
    assert line > 20
    assert region({"locations": race["relatedLocations"]}) == {"startLine": 7}
    steps = race["codeFlows"][0]["threadFlows"][0]["locations"]
    assert [each["location"]["physicalLocation"]["region"]["startLine"] for each in steps] == [line, line + 1]
    assert steps[0]["location"]["message"]["text"].startswith("c0 --⟨req_ctr : a, control(MOVE_HOST_TO ")


def test_what_was_cut_off_is_a_note_and_no_success():
    found = run_of(cut_off())
    assert found["results"] == []
    (invocation,) = found["invocations"]
    assert not invocation["executionSuccessful"]
    assert {each["level"] for each in invocation["toolExecutionNotifications"]} == {"note"}
    assert {region(each)["startLine"] for each in invocation["toolExecutionNotifications"]} == {7}


def test_a_mistake_is_a_result_with_line_and_column():
    found = run_of(failed(MISTAKE, UNPLACED))
    assert [(each["ruleId"], region(each)) for each in found["results"]] == [
        ("LS201", {"startLine": 17, "startColumn": 24, "endLine": 17, "endColumn": 29}),
        ("mistake", None),
    ]
    assert not found["invocations"][0]["executionSuccessful"]


def test_a_bug_is_an_error_and_what_was_not_begun_a_note():
    found = run_of(failed(BUG), failed(NOT_BEGUN))["invocations"][0]["toolExecutionNotifications"]
    assert [each["level"] for each in found] == ["error", "note"]


def fingerprints(*results):
    return [each["partialFingerprints"]["bigactorsIssue/v1"] for each in run_of(*results)["results"]]


def test_a_fingerprint_stays_when_lines_move_and_tells_issues_apart():
    assert fingerprints(result(PILOTS)) == fingerprints(result(f"// moved\n\n{PILOTS}"))
    assert fingerprints(result(PILOTS)) != fingerprints(result(PILOTS, "other.mission"))
    assert len(set(fingerprints(failed(MISTAKE, MISTAKE, UNPLACED), failed(MISTAKE, name="b")))) == 4


def test_hostile_texts_are_cleaned():
    document = sarif_json([hostile()], HOSTILE.replace("\ud800", ""))
    VALIDATOR.validate(document)
    text = json.dumps(document, ensure_ascii=False)
    text.encode()
    (found,) = document["runs"][0]["results"]
    assert found["message"]["text"].startswith(f"{clean(HOSTILE)} violated: ")
    assert "%00" in found["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]


@pytest.mark.parametrize(
    ("file", "uri"),
    [
        ("a.mission", "a.mission"),
        ("sub/ä b#?.mission", "sub/%C3%A4%20b%23%3F.mission"),
        ("/far/a.mission", "file:///far/a.mission"),
        ("javascript:alert(1)", "javascript%3Aalert%281%29"),
    ],
)
def test_files_are_uris(file, uri):
    assert artifact(file)["uri"] == uri


@pytest.mark.parametrize(
    "changed",
    [{"version": "2.0.0"}, {"runs": []}, {"more": 1}, {"runs": [{"results": []}]}],
)
def test_the_schema_refuses_what_is_not_so(changed):
    with pytest.raises(ValidationError):
        VALIDATOR.validate(sarif_json([], "1") | changed)


def test_the_three_steps_of_a_race_are_essential_and_say_what_they_are():
    mission = load_mission(ROOT / "tests" / "corpus" / "violated" / "stale_message.mission")
    report = check(mission, limits=SPARE)
    said = sarif_json([CheckResult("stale_message", "stale_message.mission", report)], "1")
    VALIDATOR.validate(said)
    (found,) = (each for each in said["runs"][0]["results"] if "stale" in each["message"]["text"])
    steps = found["codeFlows"][0]["threadFlows"][0]["locations"]
    essential = [
        each["location"]["message"]["text"] for each in steps if each.get("importance") == "essential"
    ]
    assert [each.rpartition(" ")[2] for each in essential] == ["[sensed]", "[changed]", "[acted]"]


# --- places ---------------------------------------------------------------------------------------------------

PLACED = {
    "control_race": "control(MOVE uav0 TO gate0)",
    "deadlock": 'case "ready"',
    "deadlock_unlinked": 'send("there", b)',
    "diverges": "let seen = false",
    "fails": "first(obs of Vessel)",
    "inconsistent": "control(MOVE_HOST_TO gate0)",
    "lost_target": "control(MOVE_HOST_TO spill0)",
    "not_arrived": "control(MOVE_HOST_TO gate0)",
    "stale_message": 'case "clear" => control(MOVE_HOST_TO gate0)',
    "stale_timed": "control(MOVE_HOST_TO gate0)",
    "unmatched": "control(MOVE uav0 TO gate0)",
    "unserved": "control(",
    "unrealisable": "control(PUT drifter0 IN spill0)",
}


@pytest.mark.parametrize("stem", PLACED)
def test_a_violation_belongs_to_the_statement_that_it_is_about(stem):
    mission = load_mission(ROOT / "tests" / "corpus" / "violated" / f"{stem}.mission")
    lines = mission.source.text.splitlines()
    report = check(mission, limits=SPARE)
    found = [each for verdict in report.verdicts for each in verdict.violations]
    assert found
    for violation in found:
        assert PLACED[stem] in lines[violation_line(violation) - 1]
        for step, line in zip(violation.trace.steps, step_lines(violation.trace), strict=True):
            assert (line == 0) == (step.label.agent is None)


def test_an_invariant_is_about_no_single_statement():
    given = result(f'{PILOTS}check {{ invariant "home": actually uav0 in north0 }}')
    assert violation_line(given.report.verdicts[0].violations[0]) == 0


def test_a_property_that_nobody_wrote_belongs_to_the_check_section():
    assert {CheckResult("m", "m", check_line=9).line_of(each) for each in cut_off().report.verdicts} == {9}
