"""What the commands write is what docs/reference/json.md and its schemas say."""

import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

from bigactors.checking import FAILURE_SCHEMA, REPORTS_SCHEMA
from checker.reports.report import SCHEMA as REPORT
from checker.traces import SCHEMA as TRACE
from semantics.properties.kinds import PropertyKind

DOCS = Path(__file__).parents[2] / "docs" / "reference"


def schema(name):
    return json.loads((DOCS / f"{name}.schema.json").read_text(encoding="utf-8"))


def validator(name):
    """Validate by one file alone, as the readers of the page do."""
    return Draft202012Validator(schema(name))


def test_the_schema_of_reports_has_that_of_traces_in_it():
    assert schema("report")["$defs"]["trace.schema.json"] == schema("trace")


@pytest.mark.parametrize("name", ["report", "trace"])
def test_the_schemas_are_schemas(name):
    Draft202012Validator.check_schema(schema(name))


def test_the_report_of_a_stale_observation_race_is_valid_and_says_which_steps_make_it(bigactors):
    report = json.loads(bigactors("check", "look_before_entry_racy", "--json", "-")[1])
    validator("report").validate(report)
    trace = report["properties"][1]["trace"]
    validator("trace").validate(trace)
    assert [each["role"] for each in trace["steps"] if "role" in each] == ["sensed", "changed", "acted"]


@pytest.mark.usefixtures("missions")
@pytest.mark.parametrize("mission", ["holds", "race", "endless", "mistaken", "nowhere"])
def test_the_report_of_a_mission_is_valid(bigactors, mission):
    _, out, _ = bigactors("check", f"{mission}.mission", "--json", "-", "--max-configurations", "50")
    validator("report").validate(json.loads(out))


@pytest.mark.parametrize("name", ["unserved", "unserved_behind", "runs"])
def test_the_report_of_runs_that_go_on_for_ever_is_valid(bigactors, name):
    path = Path(__file__).parents[1] / "corpus" / "violated" / f"{name}.mission"
    report = json.loads(bigactors("check", str(path), "--json", "-")[1])
    validator("report").validate(report)
    loops = [each["trace"].get("loop") for each in report["properties"] if each["trace"]]
    assert any(loop is not None for loop in loops)


@pytest.mark.usefixtures("missions")
def test_the_report_of_several_missions_is_valid(bigactors):
    names = [f"{name}.mission" for name in ("holds", "race", "mistaken")]
    code, out, _ = bigactors("check", *names, "--json", "-")
    report = json.loads(out)
    validator("report").validate(report)
    assert report["schema"] == REPORTS_SCHEMA
    assert [each["schema"] for each in report["reports"]] == [REPORT, REPORT, FAILURE_SCHEMA]
    assert [each["exit_code"] for each in report["reports"]] == [0, 1, 2]
    assert report["exit_code"] == code == 2
    assert [each["mission"] for each in report["reports"]] == names


@pytest.mark.usefixtures("missions")
def test_the_diagnostics_of_a_mistake_have_their_places(bigactors):
    failure = json.loads(bigactors("check", "mistaken.mission", "--json", "-")[1])
    assert failure["diagnostics"] == [
        {
            "code": "LS201",
            "line": 17,
            "column": 24,
            "end_line": 17,
            "end_column": 34,
            "message": "unknown name 'serchArea0'",
            "hint": "did you mean 'searchArea0'?",
        }
    ]


@pytest.mark.usefixtures("missions")
def test_every_violation_and_witness_has_a_valid_trace_of_its_length(bigactors):
    report = json.loads(bigactors("check", "race.mission", "--json", "-")[1])
    properties = {each["name"]: each for each in report["properties"]}
    race = properties["race_freedom"]
    assert race["trace"] == race["violations"][0]["trace"]
    assert len(race["trace"]["steps"]) == 2
    assert race["witness"] is None
    for each in report["properties"]:
        for trace in (each["trace"], each["witness"]):
            if trace is not None:
                validator("trace").validate(trace)


@pytest.mark.usefixtures("missions")
def test_a_simulation_is_a_valid_trace(bigactors):
    trace = json.loads(bigactors("simulate", "holds.mission", "--json", "-")[1])
    validator("trace").validate(trace)
    assert trace["schema"] == TRACE


@pytest.mark.usefixtures("missions")
def test_the_schemas_refuse_what_is_not_so(bigactors):
    report = json.loads(bigactors("check", "holds.mission", "--json", "-")[1])
    for changed in (
        report | {"schema": "bigactors.report/2"},
        report | {"complete": "yes"},
        report | {"exit_code": 2},
        {key: value for key, value in report.items() if key != "complete"},
        report | {"properties": [{"name": "found"}]},
    ):
        with pytest.raises(ValidationError):
            validator("report").validate(changed)


@pytest.mark.parametrize("name", [REPORT, TRACE, FAILURE_SCHEMA, REPORTS_SCHEMA])
def test_every_schema_is_described(name):
    assert f"`{name}`" in (DOCS / "json.md").read_text(encoding="utf-8")


def test_the_schema_of_reports_names_every_kind_of_property():
    assert schema("report")["$defs"]["property"]["properties"]["kind"]["enum"] == list(PropertyKind)


def test_every_member_of_a_report_is_described():
    page = (DOCS / "json.md").read_text(encoding="utf-8")
    definitions = schema("report")["$defs"]
    for part in ("report", "failure", "reports"):
        for member in definitions[part]["properties"]:
            assert f"`{member}`" in page, member
    for member in schema("trace")["properties"]:
        assert f"`{member}`" in page, member
