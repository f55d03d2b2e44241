"""`check --output`: which document goes where, and what it says of the missions' lines."""

import json
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from bigactors import __version__, outputs
from bigactors.arguments.values import FORMATS

SCHEMA = Path(__file__).parents[2] / "docs" / "reference" / "sarif.schema.json"
ALL = ("holds.mission", "race.mission", "endless.mission", "mistaken.mission", "nowhere.mission")


def test_each_format_that_can_be_asked_for_can_be_written():
    assert set(outputs.FORMATS) == set(FORMATS)


def test_every_format_goes_into_its_file_beside_the_text(missions, bigactors):
    words = [word for name in FORMATS for word in ("--output", f"{name}:report.{name}")]
    code, out, _ = bigactors("check", *ALL, "--max-configurations", "50", *words, "--json", "plain.json")
    texts = {name: (missions / f"report.{name}").read_text(encoding="utf-8") for name in FORMATS}
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


@pytest.mark.usefixtures("missions")
def test_a_document_on_the_standard_output_is_alone(bigactors):
    code, out, err = bigactors("check", "race.mission", "holds.mission", "--output", "sarif:-")
    assert (code, err) == (1, "")
    assert [each["ruleId"] for each in json.loads(out)["runs"][0]["results"]] == ["race_freedom", "invariant"]


@pytest.mark.usefixtures("missions")
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


@pytest.mark.usefixtures("missions")
@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            ("--output", "sarrif:x"),
            "bigactors: argument --output: unknown format 'sarrif': did you mean 'sarif'?\n",
        ),
        (
            ("--output", "html:x"),
            "bigactors: argument --output: unknown format 'html': the formats are json, junit, sarif, github\n",
        ),
        (
            ("--output", "junit"),
            "bigactors: argument --output: 'junit' is not FORMAT:FILE, such as junit:report\n",
        ),
        (("--output", "junit:no/such/folder.xml"), "no/such/folder.xml: there is no such folder\n"),
        (("--output", "sarif:."), ".: this is a folder, not a file\n"),
        (("--output", "sarif:a\0b"), "'a\\x00b': this is no path of a file\n"),
        (
            ("--output", "junit:-", "--output", "sarif:-"),
            "bigactors: junit and sarif cannot both go to the standard output\n",
        ),
        (
            ("--json", "-", "--output", "github:-"),
            "bigactors: json and github cannot both go to the standard output\n",
        ),
        (
            ("--output", "junit:x", "--output", "sarif:./x"),
            "bigactors: junit and sarif cannot both go to ./x\n",
        ),
    ],
)
def test_what_cannot_be_written_is_told_before_anything_is_explored(bigactors, words, said):
    code, out, err = bigactors("check", "holds.mission", *words)
    assert (code, out) == (2, "")
    assert err.split("  hint: ")[0] == said


@pytest.mark.usefixtures("missions")
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


@pytest.mark.usefixtures("missions")
def test_a_mission_that_ships_has_the_path_of_its_file(bigactors):
    _, out, _ = bigactors("check", "oil_spill", "--output", "junit:-")
    file = next(ET.fromstring(out.encode()).iter("testcase")).get("file")
    assert Path(file).is_absolute()
    assert Path(file).is_file()


def test_a_file_in_the_working_directory_is_named_from_there(missions):
    assert outputs.file_of(str(missions / "race.mission")) == "race.mission"
    assert outputs.file_of("no/such\0file") == "no/such\0file"


def test_a_name_that_is_not_utf_8_can_be_written(missions, bigactors):
    words = [word for name in FORMATS for word in ("--output", f"{name}:report.{name}")]
    assert bigactors("check", "\udcff.mission", *words)[0] == 2
    assert json.loads((missions / "report.json").read_text(encoding="utf-8"))["mission"] == "\udcff.mission"
    assert "%FF.mission" in (missions / "report.sarif").read_text(encoding="utf-8")


WARNED = Path(__file__).parents[1] / "corpus" / "warned" / "LS702_swapped.mission"


def test_what_is_hardly_meant_is_told_in_every_format_and_fails_nothing(missions, bigactors):
    (missions / "warned.mission").write_bytes(WARNED.read_bytes())
    words = [word for name in FORMATS for word in ("--output", f"{name}:report.{name}")]
    code, out, err = bigactors("check", "warned.mission", *words)
    texts = {name: (missions / f"report.{name}").read_text(encoding="utf-8") for name in FORMATS}
    assert (code, err) == (0, "")
    said = "warned.mission:10: warning: LS702: airfield0 lies 6,941 km from everything else\n"
    assert out.startswith(f"{said}  hint: are latitude and longitude swapped?")  # before any verdict
    assert said in (ET.fromstring(texts["junit"].encode()).findtext(".//system-out") or "")
    assert 'failures="0" errors="0"' in texts["junit"]
    warnings = json.loads(texts["json"])["warnings"]
    assert [(each["code"], each["line"], each["column"]) for each in warnings] == [
        ("LS702", 10, 3),
        ("LS702", 18, 3),
    ]
    run = json.loads(texts["sarif"])["runs"][0]
    found = [(each["ruleId"], each["level"]) for each in run["results"] if each["ruleId"] == "LS702"]
    assert found == [("LS702", "warning")] * 2
    assert run["invocations"][0]["executionSuccessful"] is True
    assert (
        texts["github"].count("::warning file=warned.mission,line=10,endLine=10,col=3,endColumn=12,title=")
        == 1
    )


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
def test_where_nothing_would_be_checked_there_is_no_pass(missions, bigactors, text, said):
    (missions / "nothing.mission").write_text(text, encoding="utf-8")
    code, out, err = bigactors(
        "check", "nothing.mission", "--output", "junit:report.xml", "--verdict", "v.json"
    )
    assert (code, out) == (2, "")
    assert said in err
    assert 'errors="1"' in (missions / "report.xml").read_text(encoding="utf-8")
    assert not (missions / "v.json").exists()
    assert bigactors("run", "nothing.mission", "--unverified")[0] == 2
    assert bigactors("show", "nothing.mission")[0] == 0
