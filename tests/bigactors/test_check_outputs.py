"""`check --output`: which document goes where, and what it says of the missions' lines."""

import json
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from bigactors import __version__, check_outputs
from bigactors.arguments.values import FORMATS

pytestmark = pytest.mark.usefixtures("missions")

SCHEMA = Path(__file__).parents[2] / "docs" / "reference" / "sarif.schema.json"
IN_ALL_FORMATS = [word for name in FORMATS for word in ("--output", f"{name}:report.{name}")]
ALL = ("holds.mission", "race.mission", "endless.mission", "mistaken.mission", "nowhere.mission")


def written(folder):
    return {name: (folder / f"report.{name}").read_text(encoding="utf-8") for name in FORMATS}


def test_each_format_that_can_be_asked_for_can_be_written():
    assert set(check_outputs.FORMATS) == set(FORMATS)


def test_every_format_goes_into_its_file_beside_the_text(missions, bigactors):
    code, out, _ = bigactors(
        "check", *ALL, "--max-configurations", "50", *IN_ALL_FORMATS, "--json", "plain.json"
    )
    texts = written(missions)
    assert code == 2
    assert "✗ race_freedom" in out
    assert "! nowhere.mission   mistake" in out
    plain = json.loads((missions / "plain.json").read_text(encoding="utf-8"))
    assert json.loads(texts["json"]) == plain
    assert plain["exit_code"] == 2
    suites = list(ET.fromstring(texts["junit"].encode()))
    assert [(each.get("name"), each.get("failures"), each.get("errors")) for each in suites] == [
        ("holds.mission", "0", "0"),
        ("race.mission", "2", "0"),
        ("endless.mission", "0", "2"),
        ("mistaken.mission", "0", "1"),
        ("nowhere.mission", "0", "1"),
    ]
    sarif = json.loads(texts["sarif"])
    Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8"))).validate(sarif)
    assert sarif["runs"][0]["tool"]["driver"]["version"] == __version__
    assert [line.split("::")[1].split(",title")[0] for line in texts["github"].splitlines()] == [
        "error file=race.mission,line=15",
        "error file=race.mission,line=24",
        "warning file=endless.mission,line=26",
        "warning file=endless.mission,line=25",
        "error file=mistaken.mission,line=17,endLine=17,col=24,endColumn=34",
        "error file=nowhere.mission",
    ]


def test_a_document_on_the_standard_output_is_alone(bigactors):
    code, out, err = bigactors("check", "race.mission", "holds.mission", "--output", "sarif:-")
    assert (code, err) == (1, "")
    assert [each["ruleId"] for each in json.loads(out)["runs"][0]["results"]] == ["race_freedom", "invariant"]


def test_xml_on_the_standard_output_is_safe_in_any_encoding(bigactors):
    _, out, _ = bigactors("check", "race.mission", "--output", "junit:-")
    assert out.isascii()
    assert "--⟨req_ctr : a, " in next(ET.fromstring(out.encode()).iter("failure")).text


def test_one_document_goes_to_the_standard_output_and_others_into_files(missions, bigactors):
    words = ("--output", "github:-", "--output", "junit:report.xml")
    assert bigactors("check", "holds.mission", *words) == (0, "", "")
    assert (
        (missions / "report.xml")
        .read_text(encoding="utf-8")
        .startswith('<?xml version="1.0" encoding="UTF-8"?>')
    )


def test_a_bug_and_what_was_not_begun_are_no_success_in_any_format(bigactors, monkeypatch):
    def failing(*_, **__):
        raise RuntimeError("our bug")

    monkeypatch.setattr("bigactors.checking.check", failing)
    code, out, _ = bigactors("check", "holds.mission", "--output", "github:-")
    assert code == 4
    assert out == (
        "::error file=holds.mission,title=holds.mission%3A internal error::internal error: RuntimeError: our bug\n"
    )


def test_properties_that_nobody_wrote_are_at_the_check_section_or_the_first_line(missions, bigactors):
    text = (missions / "endless.mission").read_text(encoding="utf-8")
    head, section = text.split("check {")
    for name, said in (("none", head), ("moved", f"// check {{ }}\n\n{head}check {{{section}")):
        (missions / f"{name}.mission").write_text(said, encoding="utf-8")
        bigactors("check", f"{name}.mission", "--max-configurations", "20", "--output", f"github:{name}")
    lines = {name: (missions / name).read_text(encoding="utf-8").splitlines() for name in ("none", "moved")}
    assert ",line=1,title=none.mission%3A deadlock_freedom incomplete::" in "".join(lines["none"])
    assert [",line=27,title=moved.mission%3A computation" in line for line in lines["moved"]] == [False, True]


def test_a_mission_that_ships_has_the_path_of_its_file(bigactors):
    _, out, _ = bigactors("check", "oil_spill", "--output", "junit:-")
    file = next(ET.fromstring(out.encode()).iter("testcase")).get("file")
    assert Path(file).is_absolute()
    assert Path(file).is_file()


def test_a_file_in_the_working_directory_is_named_from_there(missions):
    assert check_outputs.file_of(str(missions / "race.mission")) == "race.mission"
    assert check_outputs.file_of("no/such\0file") == "no/such\0file"


def test_a_name_that_is_not_utf_8_can_be_written(missions, bigactors):
    assert bigactors("check", "\udcff.mission", *IN_ALL_FORMATS)[0] == 2
    texts = written(missions)
    assert json.loads(texts["json"])["mission"] == "\udcff.mission"
    assert "%FF.mission" in texts["sarif"]


WARNED = Path(__file__).parents[1] / "corpus" / "warned" / "LS702_swapped.mission"


def test_what_is_hardly_meant_is_told_in_every_format_and_fails_nothing(missions, bigactors):
    (missions / "warned.mission").write_bytes(WARNED.read_bytes())
    code, out, err = bigactors("check", "warned.mission", *IN_ALL_FORMATS)
    texts = written(missions)
    assert (code, err) == (0, "")
    said = "warned.mission:10: warning: LS702: airfield0 lies 6,941 km from everything else\n"
    assert out.startswith(f"{said}  hint: are latitude and longitude swapped?")  # before any verdict
    assert said in (ET.fromstring(texts["junit"].encode()).findtext(".//system-out") or "")
    assert 'failures="0" errors="0"' in texts["junit"]
    warnings = json.loads(texts["json"])["warnings"]
    places = [(each["code"], each["line"], each["column"]) for each in warnings]
    assert places == [("LS702", 10, 3), ("LS702", 18, 3)]
    run = json.loads(texts["sarif"])["runs"][0]
    found = [(each["ruleId"], each["level"]) for each in run["results"] if each["ruleId"] == "LS702"]
    assert found == [("LS702", "warning")] * 2
    assert run["invocations"][0]["executionSuccessful"] is True
    place = "::warning file=warned.mission,line=10,endLine=10,col=3,endColumn=12,title="
    assert texts["github"].count(place) == 1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "LS614: the file declares nothing"),
        ("mission x // and no more", "LS614: the file declares nothing"),
        ("signature { kind A }", "LS615: there is no bigActor in it"),
        ("check {}", "LS615: there is no bigActor in it"),
        ("world {}", "LS615: there is no bigActor in it"),
        ("scheduler fcfs", "LS615: there is no bigActor in it"),
    ],
)
def test_where_nothing_would_be_checked_there_is_no_pass(missions, bigactors, refused, text, said):
    (missions / "nothing.mission").write_text(text, encoding="utf-8")
    assert said in refused("check", "nothing.mission", "--output", "junit:report.xml", "--verdict", "v.json")
    assert 'errors="1"' in (missions / "report.xml").read_text(encoding="utf-8")
    assert not (missions / "v.json").exists()
    assert bigactors("run", "nothing.mission", "--unverified")[0] == 2
    assert bigactors("show", "nothing.mission")[0] == 0


def test_a_warning_on_the_text_takes_the_place_of_the_gap_that_it_explains_in_every_format(
    missions, bigactors
):
    mission = Path(__file__).parents[1] / "corpus" / "warned" / "LS704_always_the_same.mission"
    code, out, _ = bigactors("check", str(mission), "--all", *IN_ALL_FORMATS)
    assert code == 0
    texts = written(missions)
    for text in (out, texts["junit"], texts["github"]):
        assert "LS704" in text
        assert not re.search(r":11: warning: this condition|line=11,title=warning::this condition", text)
    results = json.loads(texts["sarif"])["runs"][0]["results"]
    line11 = [
        each["ruleId"]
        for each in results
        if each["locations"][0]["physicalLocation"]["region"]["startLine"] == 11
    ]
    assert line11 == ["LS704"]
