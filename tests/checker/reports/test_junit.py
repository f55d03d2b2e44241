"""Reports as JUnit XML, read back."""

import re
import xml.etree.ElementTree as ET

from mission_results import (
    BUG,
    ENTERS,
    GAPS,
    HOSTILE,
    MISTAKE,
    NOT_BEGUN,
    PILOTS,
    all_sorts,
    cut_off,
    failed,
    hostile,
    result,
)

from checker import Bound, Report, Stop
from checker.reports.junit import junit_text
from checker.reports.results import CheckResult, clean


def suites(*results):
    return list(ET.fromstring(junit_text(results).encode()))


def cases(given):
    return {case.get("name"): case for case in suites(given)[0].iter("testcase")}


def test_warnings_fail_no_case_and_stand_in_the_output():
    suite = next(iter(ET.fromstring(junit_text([result(GAPS)]).encode())))
    assert (suite.get("failures"), suite.get("errors")) == ("0", "0")
    assert "  m.mission:28: warning: this case is never taken\n    28 | " in suite.find("system-out").text


def test_a_mission_is_a_suite_and_a_property_is_a_case():
    (suite,) = suites(result(ENTERS))
    assert {key: suite.get(key) for key in ("name", "tests", "failures", "errors", "skipped")} == {
        "name": "m.mission", "tests": "4", "failures": "0", "errors": "0", "skipped": "0",
    }  # fmt: skip
    assert [(case.get("name"), case.get("classname"), len(case)) for case in suite.iter("testcase")] == [
        ("local_consistency", "m.mission", 0),
        ("race_freedom", "m.mission", 0),
        ("deadlock_freedom", "m.mission", 0),
        ("computation", "m.mission", 0),
    ]


def test_a_violation_is_a_failure_with_its_message_and_its_trace():
    case = cases(result(PILOTS))["race_freedom"]
    (failure,) = case
    assert (failure.tag, failure.get("type")) == ("failure", "control race")
    assert failure.get("message").endswith(" end differently in the two orders")
    assert (
        "a shortest trace, 2 steps:\n  c0 --⟨req_ctr : a, control(MOVE_HOST_TO south0)⟩--> c1\n"
        in failure.text
    )
    assert "\n        η  b: CTR(b, MOVE_HOST_TO gate0)" in failure.text
    assert case.get("line") == "7"


def test_what_was_cut_off_is_an_error_and_never_a_pass():
    found = cases(cut_off())
    assert [
        [(each.tag, each.get("type")) for each in found[name]] for name in ("deadlock_freedom", "computation")
    ] == [
        [("error", "incomplete")],
        [("error", "incomplete")],
    ]
    assert "the limit of 2 configurations" in found["computation"][0].get("message")


def test_a_bound_that_no_verdict_tells_of_is_an_error_of_its_own():
    report = Report((), 1, 0, 0, (Bound(Stop.INTERRUPTION),))
    case = cases(CheckResult("m", "m", report, check_line=3))["exploration incomplete"]
    assert (case[0].tag, case[0].get("type"), case.get("line")) == ("error", "incomplete", "3")


def test_a_mistake_is_an_error_with_its_place():
    (case,) = cases(failed(MISTAKE)).values()
    assert (case.get("name"), case.get("file"), case.get("line")) == ("LS201 at 17:24", "m.mission", "17")
    assert (case[0].tag, case[0].get("type"), case[0].get("message")) == (
        "error",
        "LS201",
        "unknown name 'gaet0'",
    )
    assert case[0].text == "m.mission:17:24: LS201\nunknown name 'gaet0'\n  hint: did you mean 'gate0'?"


def test_what_was_never_begun_and_what_broke_are_errors_and_the_sums_are_those_of_the_cases():
    found = [next(iter(cases(failed(issue)).values()))[0] for issue in (NOT_BEGUN, BUG)]
    assert [each.get("type") for each in found] == ["incomplete", "exploration"]
    assert suites() == []
    timed = [CheckResult("a", "a", Report((), 1, 0, 0, seconds=seconds)) for seconds in (1.25, 0.5004)]
    root = ET.fromstring(junit_text(timed).encode())
    assert [each.get("time") for each in (root, *root)] == ["1.750", "1.250", "0.500"]
    root = ET.fromstring(junit_text(all_sorts()).encode())
    for each in (root, *root):
        assert int(each.get("tests")) == len(list(each.iter("testcase")))
        assert int(each.get("failures")) == len(list(each.iter("failure")))
        assert int(each.get("errors")) == len(list(each.iter("error")))


def test_what_xml_cannot_hold_is_replaced_and_the_rest_escaped():
    text = junit_text([hostile()])
    assert not re.search("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]", text)
    (suite,) = ET.fromstring(text.encode())
    case = suite[0]
    assert suite.get("name") == case.get("name") == case.get("file") == clean(HOSTILE)
    assert case[0].get("message") == clean(HOSTILE)
    assert '<a b="c"> & ]]> ::error::' in case[0].text
    assert len(list(suite.iter())) == 6
