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

pytestmark = pytest.mark.usefixtures("missions")

DOCS = Path(__file__).parents[2] / "docs" / "reference"


def schema(name):
    return json.loads((DOCS / f"{name}.schema.json").read_text(encoding="utf-8"))


def validator(name):
    """Validate by one file alone, as the readers of the page do."""
    return Draft202012Validator(schema(name))


def test_the_schema_of_reports_has_that_of_traces_in_it():
    assert schema("report")["$defs"]["trace.schema.json"] == schema("trace")


@pytest.mark.parametrize("name", ["report", "trace", "verdict", "sarif"])
def test_the_schemas_are_schemas(name):
    Draft202012Validator.check_schema(schema(name))


@pytest.fixture
def reported(bigactors):
    """Check missions; returns the report, which is as its schema says."""

    def run(*words):
        code, out, _ = bigactors("check", *words, "--json", "-")
        report = json.loads(out)
        validator("report").validate(report)
        assert report["exit_code"] == code
        return report

    return run


def test_the_report_of_a_stale_observation_race_says_which_steps_make_it(reported):
    trace = reported("look_before_entry_racy")["properties"][1]["trace"]
    validator("trace").validate(trace)
    assert [each["role"] for each in trace["steps"] if "role" in each] == ["sensed", "changed", "acted"]


@pytest.mark.parametrize("name", ["unserved", "unserved_behind", "runs"])
def test_the_report_of_runs_that_go_on_for_ever_is_valid(reported, name):
    report = reported(str(Path(__file__).parents[1] / "corpus" / "violated" / f"{name}.mission"))
    assert any("loop" in each["trace"] for each in report["properties"] if each["trace"])


def test_the_report_of_several_missions_is_valid(reported):
    names = [f"{name}.mission" for name in ("holds", "race", "endless", "mistaken", "nowhere")]
    report = reported(*names, "--max-configurations", "50")
    assert report["schema"] == REPORTS_SCHEMA
    assert [each["schema"] for each in report["reports"]] == [*[REPORT] * 3, *[FAILURE_SCHEMA] * 2]
    assert [each["exit_code"] for each in report["reports"]] == [0, 1, 3, 2, 2]
    assert [each["mission"] for each in report["reports"]] == names


def test_the_diagnostics_of_a_mistake_have_their_places(reported):
    (found,) = reported("mistaken.mission")["diagnostics"]
    assert list(found) == ["code", "line", "column", "end_line", "end_column", "message", "hint"]
    place = ("LS201", 17, 24, 17, 34, "unknown name 'serchArea0'", "did you mean 'searchArea0'?")
    assert tuple(found.values()) == place


def test_every_violation_and_witness_has_a_valid_trace_of_its_length(reported):
    report = reported("race.mission")
    race = next(each for each in report["properties"] if each["name"] == "race_freedom")
    assert race["trace"] == race["violations"][0]["trace"]
    assert (len(race["trace"]["steps"]), race["witness"]) == (2, None)
    for trace in (each[key] for each in report["properties"] for key in ("trace", "witness")):
        if trace is not None:
            validator("trace").validate(trace)


def test_a_simulation_is_a_valid_trace(done):
    trace = json.loads(done("simulate", "holds.mission", "--json", "-"))
    validator("trace").validate(trace)
    assert trace["schema"] == TRACE


def test_the_schemas_refuse_what_is_not_so(reported):
    report = reported("holds.mission")
    for changed in (
        report | {"schema": "bigactors.report/2"},
        report | {"complete": "yes"},
        report | {"exit_code": 2},
        {key: value for key, value in report.items() if key != "complete"},
        report | {"properties": [{"name": "found"}]},
    ):
        with pytest.raises(ValidationError):
            validator("report").validate(changed)


def test_the_schema_of_reports_names_every_kind_of_property():
    assert schema("report")["$defs"]["property"]["properties"]["kind"]["enum"] == list(PropertyKind)


def test_every_schema_and_every_member_of_a_report_is_described():
    page = (DOCS / "json.md").read_text(encoding="utf-8")
    definitions = schema("report")["$defs"]
    parts = [*(definitions[part] for part in ("report", "failure", "reports")), schema("trace")]
    members = [member for part in parts for member in part["properties"]]
    for name in (REPORT, TRACE, FAILURE_SCHEMA, REPORTS_SCHEMA, *members):
        assert f"`{name}`" in page
