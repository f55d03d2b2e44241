import json
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from json_mutations import mutated
from jsonschema import Draft202012Validator
from scale import examples

from bigactors.arguments import parse_arguments
from bigactors.cli import main
from bigactors.commands.run import flight as run
from bigactors.files import MOST_JSON
from bigactors.mission_lookup import open_mission
from bigactors.mistakes import Mistake
from bigactors.verdict_files import _seal, find_verdict, licence_for
from physical import PhysicalError, read_json
from semantics.state.setting import Scheduler
from specs.elaboration.variation import AS_WRITTEN
from specs.missions import shipped_missions

SCHEMA = Path(__file__).parents[2] / "docs" / "reference" / "verdict.schema.json"


@pytest.fixture
def verdict(tmp_path, monkeypatch):
    """Check a mission, and return the path of its verdict."""
    monkeypatch.chdir(tmp_path)

    def check(name, *more):
        path = tmp_path / "x.verdict.json"
        main(["check", "--no-traces", "--verdict", str(path), name, *more])
        return str(path)

    return check


@pytest.fixture(scope="module")
def licensed(tmp_path_factory):
    """Return a path, the content of a verdict, and its mission."""
    path = tmp_path_factory.mktemp("licensed") / "x.verdict.json"
    main(["check", "--no-traces", "--verdict", str(path), "oil_spill", "--control", "timed"])
    return path, json.loads(path.read_text()), open_mission("oil_spill", AS_WRITTEN)


def licence(name, path):
    return licence_for(name, path, open_mission(name, AS_WRITTEN))


def validate(data):
    Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8"))).validate(data)


def test_a_verdict_is_as_its_schema_says_and_a_licence(verdict):
    path = verdict("oil_spill", "--control", "timed")
    data = json.loads(Path(path).read_text())
    validate(data)
    found = licence("oil_spill", path)  # under timed control, and everything holds
    assert "local_consistency" in found.resting
    assert "race_freedom" not in found.resting
    resting = {each["name"]: each["rests_on"] for each in data["properties"]}
    assert resting["race_freedom"] == "text"
    assert resting["local_consistency"] == "environment"


@pytest.mark.parametrize(
    ("limit", "short"),
    [
        ("FLY patrol within 5 min", True),
        ("anyone within 5 min", True),
        ("OBS patrol within 5 min", False),
        ("FLY patrol within 1 h", False),
    ],
)
def test_no_flight_may_be_given_up_before_it_takes_too_long(verdict, capsys, limit, short):
    text = shipped_missions()["endurance"].read_text(encoding="utf-8")
    Path("limited.mission").write_text(f"{text}\nlive {{ {limit}: return }}\n", encoding="utf-8")
    path = verdict("limited.mission")
    said = "live lets patrol fly for 5 min, but by the times its flight may take "
    assert (f"limited.mission: {said}" in capsys.readouterr().err) == short
    validate(json.loads(Path(path).read_text()))
    if short:
        with pytest.raises(Mistake, match=said):
            licence("limited.mission", path)
    else:
        licence("limited.mission", path)


@pytest.mark.parametrize(
    ("checked", "flown", "says"),
    [
        ("oil_spill", "oil_spill", "control atomic"),
        ("broken_inconsistent --control timed", "broken_inconsistent", "does not confirm every property"),
        ("oil_spill --control timed --max-configurations 5", "oil_spill", "does not confirm every property"),
        ("oil_spill --control timed", "spill_watch", "text, the places that never move, the entities"),
    ],
)
def test_a_verdict_that_not_everything_holds_under_timed_control_of_this_mission_is_none(
    verdict, checked, flown, says
):
    with pytest.raises(Mistake, match=says):
        licence(flown, verdict(*checked.split()))


@pytest.mark.parametrize(
    ("members", "says"),
    [
        ({"version": "0.0.0"}, "version 0.0.0"),
        ({"build": "sha256:" + "0" * 64}, "another build of version"),
        ({"build": None}, "another build of version"),
        ({"parts": {}}, "changed since"),
        ({"digest": "sha256:0"}, "digest"),
        ({"schema": "other"}, "no verdict"),
        ({"scheduler": "random"}, "no scheduler"),
        ({"holds": 1}, "does not confirm every property"),
        ({"engine": "reference"}, "changed after it was reached"),
        ({"properties": []}, "changed after it was reached"),
        ({"seal": None}, "changed after it was reached"),
    ],
)
def test_a_verdict_that_was_tampered_with_is_none(licensed, members, says):
    path, verdict, mission = licensed
    path.write_text(json.dumps(verdict | members))
    with pytest.raises(Mistake, match=says):
        licence_for("oil_spill", str(path), mission)


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


# --- a mission that is swapped while it is read -------------------------------------------------------------------

WORLD = """{"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"name": "hole0", "kind": "Location"},
   "geometry": {"type": "Polygon", "coordinates": [[[%s, 37.0], [-8.5, 37.0], [-8.5, 37.1], [%s, 37.1], [%s, 37.0]]]}}
]}"""

FLOWN = """
signature { kind Location contains UAV  kind UAV driven }
world { from "world.geojson"  uav0: UAV = point (37.05, -8.7) }
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO hole0) }
check { invariant "never in the hole": not actually uav0 in hole0 or %s }
"""
HARMLESS, FATAL = FLOWN % "true", FLOWN % "false"
NARROW, BROAD = WORLD % ((-8.6,) * 3), WORLD % ((-8.65,) * 3)


@pytest.mark.parametrize(
    ("name", "read", "left"), [("m.mission", FATAL, HARMLESS), ("world.geojson", BROAD, NARROW)]
)
def test_a_mission_swapped_between_reading_and_licensing_does_not_fly(
    tmp_path, monkeypatch, verdict, name, read, left
):
    (tmp_path / "m.mission").write_text(HARMLESS, encoding="utf-8")
    (tmp_path / "world.geojson").write_text(NARROW, encoding="utf-8")
    path = verdict("m.mission", "--control", "timed")
    options = parse_arguments(["run", "m.mission", "--verdict", path, "--vehicle=uav0=udp:127.0.0.1:0"])
    assert run.prepare(options).licence is not None
    (tmp_path / name).write_text(read, encoding="utf-8")

    def swapping(*asked):
        (tmp_path / name).write_text(left, encoding="utf-8")
        return find_verdict(*asked)

    monkeypatch.setattr(run, "find_verdict", swapping)
    with pytest.raises(Mistake, match="the verdict belongs to another mission"):
        run.prepare(options)


@examples(200)
@given(data=st.data())
def test_a_verdict_with_a_fault_is_a_licence_or_a_mistake_even_when_it_is_sealed_again(licensed, data):
    path, verdict, mission = licensed
    said = data.draw(mutated([verdict]))
    with suppress(PhysicalError):
        found = read_json(said, MOST_JSON)
        if isinstance(found, dict) and "seal" in found:
            said = json.dumps({**found, "seal": _seal(found)}).encode()
    path.write_bytes(said)
    with suppress(Mistake):
        assert licence_for("oil_spill", str(path), mission).scheduler in Scheduler
