"""The corpus: missions whose folder is the verdict, with the reports expected of them."""

import re
from pathlib import Path

import pytest

from checker import check, report_text
from specs.elaboration import load_mission

CORPUS = Path(__file__).parents[1] / "corpus"
VIOLATED = sorted((CORPUS / "violated").glob("*.mission"))
HOLDS = sorted(path.with_suffix(".mission") for path in (CORPUS / "ok").glob("*.expected"))


def report_of(path):
    """Return a mission's report as text, without the time that it took, and its exit code."""
    mission = load_mission(path)
    report = check(mission, notes=mission.notes)
    lines = report_text(mission.name, report)
    return "".join(f"{re.sub(r', [0-9.]+ s$', '', line)}\n" for line in lines), report.exit_code


def expected(path):
    return path.with_suffix(".expected").read_text(encoding="utf-8")


@pytest.mark.parametrize("path", VIOLATED, ids=lambda path: path.stem)
def test_what_is_violated_is_reported(path, expect):
    text, code = report_of(path)
    expect(text, path.with_suffix(".expected"))
    assert code == 1


@pytest.mark.parametrize("path", HOLDS, ids=lambda path: path.stem)
def test_what_holds_is_reported(path, expect):
    text, code = report_of(path)
    expect(text, path.with_suffix(".expected"))
    assert code == 0


def test_every_kind_of_violation_has_a_mission():
    kinds = {
        "unmatched", "inconsistent", "unrealisable", "control race", "stale-observation race", "deadlock",
        "not arrived", "fails", "diverges", "invariant", "ltl", "ctl", "unserved CTR", "unserved OBS",
    }  # fmt: skip
    shown = {
        found for path in VIOLATED for found in re.findall(r"^      (\S.*?): ", expected(path), re.MULTILINE)
    }
    assert kinds <= shown
