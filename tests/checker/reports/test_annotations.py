"""Reports as workflow commands, read back as GitHub's runner reads them."""

import re

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

from checker.reports.annotations import annotations
from checker.reports.results import clean


def unescape(text):
    for code, sign in (("%0D", "\r"), ("%0A", "\n"), ("%3A", ":"), ("%2C", ","), ("%25", "%")):
        text = text.replace(code, sign)
    return text


def read(*results):
    """Return each command with its properties and its message."""
    found = []
    for line in annotations(results):
        command, properties, message = re.fullmatch("::(error|warning) (.*?)::(.*)", line).groups()
        pairs = (each.partition("=") for each in properties.split(","))
        found.append((command, {key: unescape(value) for key, _, value in pairs}, unescape(message)))
    return found


def test_what_holds_vacuously_and_what_is_never_reached_are_warnings():
    vacuous, gap = read(result(GAPS))
    assert vacuous == (
        "warning",
        {"file": "m.mission", "line": "32", "title": "m.mission: local_consistency holds"},
        "vacuous: no control was ever next in line",
    )
    assert gap == (
        "warning",
        {"file": "m.mission", "line": "28", "title": "m.mission: not covered"},
        "this case is never taken\ncase o if uav1 in o => control(MOVE_HOST_TO gate0)",
    )


def test_what_was_cut_off_has_no_warnings_of_what_it_did_not_reach():
    titles = [place["title"] for _, place, _ in read(cut_off(GAPS))]
    assert titles == ["m.mission: local_consistency incomplete", "m.mission: computation incomplete"]


def test_a_violation_is_an_error_at_its_statement():
    given = result(PILOTS)
    ((command, place, message),) = read(given)
    assert command == "error"
    assert place == {
        "file": "m.mission",
        "line": str(given.issues()[0].line),
        "title": "m.mission: race_freedom violated: control race",
    }
    assert message.splitlines()[0].endswith(" end differently in the two orders")
    assert message.splitlines()[1].startswith("enabled here: ⟨actuate : ")


def test_a_mistake_has_line_and_column():
    (placed, unplaced) = read(failed(MISTAKE, UNPLACED))
    assert placed == (
        "error",
        {
            "file": "m.mission", "line": "17", "endLine": "17", "col": "24", "endColumn": "29",
            "title": "m.mission: LS201",
        },
        "unknown name 'gaet0'\nhint: did you mean 'gate0'?",
    )  # fmt: skip
    assert unplaced[1] == {"file": "m.mission", "title": "m.mission: mistake"}


def test_hostile_texts_stay_in_their_place():
    first, second = read(hostile())
    assert (first[1]["file"], first[2]) == (clean(HOSTILE), f"{clean(HOSTILE)}\n{clean(HOSTILE)}")
    assert first[1]["line"] == "3"
    assert set(second[1]) == {"file", "line", "title"}


def test_every_command_is_one_line_without_controls():
    assert read(result(ENTERS)) == []
    assert {command for command, _, _ in read(cut_off())} == {"warning"}
    assert [command for command, _, _ in read(failed(NOT_BEGUN), failed(BUG))] == ["warning", "error"]
    lines = list(annotations(all_sorts()))
    assert len(lines) > 6
    for line in lines:
        assert not re.search("[\x00-\x1f\x7f-\x9f\ud800-\udfff]", line.replace("\t", ""))
        assert line.startswith(("::error ", "::warning "))
