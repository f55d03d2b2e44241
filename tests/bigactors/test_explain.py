"""`bigactors explain`: codes of diagnostics, and words of reports."""

import pytest

from checker.reports.glossary import ALL
from specs import Code


@pytest.mark.parametrize("code", Code)
def test_every_code_is_explained(done, code):
    assert done("explain", code.number).startswith(f"{code.number}: {code.title} ")


def test_without_a_code_all_are_listed(bigactors):
    _, out, _ = bigactors("explain")
    codes = [line.split()[0] for line in out.splitlines() if line.startswith("LS")]
    assert codes == sorted(code.number for code in Code)
    assert set(", ".join(ALL).split()) <= set(out.split())


@pytest.mark.parametrize(
    ("asked", "first"),
    [
        (["stale-observation"], "stale-observation race"),
        (["stale-observation", "race"], "stale-observation race"),
        (["race_freedom"], "race_freedom"),
        (["local_consistency"], "local_consistency"),
        (["Inconsistent"], "inconsistent"),
        (["by", "ownership"], "by ownership"),
        (["unserved", "OBS"], "unserved request"),
        (["possibly"], "possibly"),
        (["at", "least"], "at least"),
    ],
)
def test_a_word_of_a_report_is_explained(done, asked, first):
    assert done("explain", *asked).splitlines()[:2] == [first, ""]


def test_a_rule_is_explained_with_its_bar(bigactors):
    _, out, _ = bigactors("explain", "sense")
    assert "OBS(a, q) ∈ η, in line" in out
    assert "───" in out


def test_endurance_is_explained_with_the_line_that_it_needs(done):
    assert "uav0 lasts 45 min, restored in base0 after 20 min" in done("explain", "endurance")


def test_several_codes_are_explained_one_after_another(done):
    shown = done("explain", "LS704", "LS709")
    assert shown.index("LS704: ") < shown.index("\n\nLS709: ")
