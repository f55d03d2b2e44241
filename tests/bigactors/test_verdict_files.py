import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from bigactors.cli import main
from bigactors.mistakes import Mistake
from bigactors.verdict_files import find_verdict, licence_for
from specs.elaboration import Variation

SCHEMA = Path(__file__).parents[2] / "docs" / "verdict.schema.json"
ANY = Variation(None, None, {})


@pytest.fixture
def verdict(tmp_path, monkeypatch):
    """Check a mission, and return the path of its verdict."""
    monkeypatch.chdir(tmp_path)

    def check(name, *more):
        path = tmp_path / "x.verdict.json"
        main(["check", "--no-traces", "--verdict", str(path), name, *more])
        return str(path)

    return check


def changed(path, **members):
    data = json.loads(Path(path).read_text())
    Path(path).write_text(json.dumps({**data, **members}))
    return path


def test_a_verdict_is_as_its_schema_says(verdict):
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(schema)
    data = json.loads(Path(verdict("oil_spill", "--control", "timed")).read_text())
    Draft202012Validator(schema).validate(data)
    resting = {each["name"]: each["rests_on"] for each in data["properties"]}
    assert resting["race_freedom"] == "text"
    assert resting["local_consistency"] == "environment"


def test_a_verdict_under_timed_control_that_everything_holds_is_a_licence(verdict):
    licence = licence_for("oil_spill", verdict("oil_spill", "--control", "timed"), ANY)
    assert "local_consistency" in licence.resting
    assert "race_freedom" not in licence.resting


def test_a_verdict_under_atomic_control_is_none(verdict):
    with pytest.raises(Mistake, match="control atomic"):
        licence_for("oil_spill", verdict("oil_spill"), ANY)


def test_a_verdict_that_something_is_violated_is_none(verdict):
    path = verdict("broken_inconsistent", "--control", "timed")
    with pytest.raises(Mistake, match="not that everything holds"):
        licence_for("broken_inconsistent", path, ANY)


def test_a_verdict_of_a_search_that_was_cut_off_is_none(verdict):
    path = verdict("oil_spill", "--control", "timed", "--max-configurations", "5")
    with pytest.raises(Mistake, match="not that everything holds"):
        licence_for("oil_spill", path, ANY)


def test_a_verdict_of_another_mission_says_what_differs(verdict):
    with pytest.raises(Mistake, match="text, the places that never move, the entities"):
        licence_for("spill_watch", verdict("oil_spill", "--control", "timed"), ANY)


@pytest.mark.parametrize(
    ("members", "says"),
    [
        ({"version": "0.0.0"}, "version 0.0.0"),
        ({"parts": {}}, "changed since"),
        ({"digest": "sha256:0"}, "digest"),
        ({"schema": "other"}, "no verdict"),
        ({"scheduler": "random"}, "no scheduler"),
        ({"holds": 1}, "not that everything holds"),
        ({"engine": "reference"}, "changed after it was reached"),
        ({"properties": []}, "changed after it was reached"),
        ({"seal": None}, "changed after it was reached"),
    ],
)
def test_a_verdict_that_was_tampered_with_is_none(verdict, members, says):
    path = changed(verdict("oil_spill", "--control", "timed"), **members)
    with pytest.raises(Mistake, match=says):
        licence_for("oil_spill", path, ANY)


def test_the_verdict_beside_the_mission_is_found(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mission = tmp_path / "a" / "m.mission"
    mission.parent.mkdir()
    assert find_verdict(str(mission), None) is None
    (tmp_path / "m.verdict.json").touch()
    assert find_verdict(str(mission), None) == "m.verdict.json"
    (mission.parent / "m.verdict.json").touch()
    assert find_verdict(str(mission), None) == str(mission.parent / "m.verdict.json")
    assert find_verdict(str(mission), "given") == "given"


def test_one_verdict_is_written_of_one_mission(tmp_path, capsys):
    assert main(["check", "--verdict", str(tmp_path / "v"), "oil_spill", "handover"]) == 2
    assert "one mission" in capsys.readouterr().err
