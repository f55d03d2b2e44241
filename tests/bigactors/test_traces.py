"""simulate, replay and show: runs written, run again, and looked at."""

import json
import os
import re
import subprocess
import sys

import pytest

from adapters.live.batch import Heard
from adapters.recording.writing import Recorder
from physical import Band, PhysicalProperty, point

pytestmark = pytest.mark.usefixtures("missions")


PORT = {
    "type": "FeatureCollection",
    "features": [
        {
            "type": "Feature",
            "properties": {"name": "port", "kind": "Location"},
            "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]},
        }
    ],
}
PORT_MISSION = """signature standard
world { from "nowhere.geojson" uav0: UAV = point (0.3, 0.8) }
BigActor a hosted_at uav0 with_behavior { observe(HOST) }
check { reachable "asked": not ended a }
"""


@pytest.fixture
def run(missions, bigactors):
    """A run of holds.mission in run.json, and how to change it."""
    assert bigactors("simulate", "holds.mission", "--seed", "3", "--json", "run.json")[0] == 0
    path = missions / "run.json"

    def change(**members):
        data = json.loads(path.read_text(encoding="utf-8"))
        path.write_text(json.dumps(data | members), encoding="utf-8")
        return data

    return change


# --- simulate -------------------------------------------------------------------------------------------------


def test_a_simulation_is_printed_in_the_notation_of_the_paper(bigactors):
    code, out, err = bigactors("simulate", "holds.mission", "--seed", "3")
    lines = out.splitlines()
    assert (code, err) == (0, "")
    assert lines[0] == "c0 = ⟨ α"
    assert "c0 --⟨req_ctr : a, control(MOVE_HOST_TO searchArea0)⟩--> c1" in lines
    assert "      L  parent(uav0) : base0 ↦ searchArea0" in lines
    assert lines[-1] == "nothing more is enabled"


def test_one_seed_gives_one_run_and_another_another(done):
    runs = [done("simulate", "race.mission", "--seed", str(seed)) for seed in [*range(6), *range(6)]]
    assert runs[:6] == runs[6:]
    assert len(set(runs)) > 1


def test_a_run_and_its_digest_do_not_depend_on_the_hash_seed(done):
    words = ["simulate", "race.mission", "--seed", "1", "--json", "-"]
    there = {**os.environ, "PYTHONHASHSEED": "2" if os.environ.get("PYTHONHASHSEED") == "1" else "1"}
    line = [sys.executable, "-m", "bigactors", *words]
    assert subprocess.run(line, stdout=subprocess.PIPE, env=there, check=True, text=True).stdout == done(
        *words
    )


def test_a_simulation_stops_after_its_steps(bigactors, done):
    out = done("simulate", "endless.mission", "--steps", "7")
    assert out.endswith("stopped after 7 steps\n")
    assert out.count("--⟨") == 7
    assert bigactors("simulate", "holds.mission", "--steps", "0")[1].endswith("⟩\nstopped after 0 steps\n")


def test_what_is_displayed_is_shown(missions, bigactors):
    text = (missions / "holds.mission").read_text()
    (missions / "shown.mission").write_text(text.replace("  react {", '  display("ready")\n  react {'))
    assert "displayed: " in bigactors("simulate", "shown.mission")[1]


# --- replay ---------------------------------------------------------------------------------------------------


@pytest.mark.usefixtures("run")
def test_a_simulation_replays(done):
    out = done("replay", "run.json")
    assert "c7 --⟨actuate : CTR(a, MOVE_HOST_TO oilSpill0)⟩--> c8" in out
    assert out.endswith("run.json: 8 steps replayed on figure_2\n")


def test_the_traces_of_a_check_replay_those_of_the_monitor_too(missions, bigactors, done):
    report = json.loads(bigactors("check", "look_before_entry_racy", "--json", "-")[1])
    traces = [each[key] for each in report["properties"] for key in ("trace", "witness") if each[key]]
    assert {trace["monitored"] for trace in traces} == {True, False}
    for trace in traces:
        (missions / "trace.json").write_text(json.dumps(trace))
        done("replay", "trace.json")


def test_a_step_or_a_choice_that_is_not_allowed_is_told_with_what_was_enabled(run, bigactors):
    steps = run()["steps"]
    run(steps=[*steps[:2], *steps[3:]])
    code, _, err = bigactors("replay", "run.json")
    assert code == 1
    assert re.search(r"run\.json: step 3: (.|\n)*is not enabled(.|\n)*enabled instead:\n  ⟨", err)
    run(steps=[steps[0] | {"choice": 5}, *steps[1:]])
    code, _, err = bigactors("replay", "run.json")
    assert (code, "step 1: " in err) == (1, True)


@pytest.mark.usefixtures("run")
def test_a_trace_of_another_mission_is_replayed_with_a_warning_naming_both(bigactors, missions):
    text = (missions / "holds.mission").read_text()
    (missions / "other.mission").write_text(text.replace("radius 400 m", "radius 401 m"))
    code, _, err = bigactors("replay", "run.json", "--mission", "other.mission")
    assert code == 0
    for said in ("warning: it was written of another mission", "written of: holds.mission, digest sha256:"):
        assert said in err
    assert "replayed on: other.mission, digest sha256:" in err


@pytest.mark.usefixtures("run")
def test_a_trace_of_a_mission_that_does_not_allow_it_is_refused_once(bigactors, missions):
    text = (missions / "holds.mission").read_text()
    (missions / "other.mission").write_text(text.replace("MOVE_HOST_TO searchArea0", "MOVE_HOST_TO base0"))
    code, _, err = bigactors("show", "other.mission", "--trace", "run.json")
    assert (code, err.count("may have changed"), "warning" in err) == (1, 1, False)


def test_the_mission_of_a_trace_is_found_beside_it(run, done, missions, monkeypatch, tmp_path_factory):
    without = {key: each for key, each in run().items() if key not in ("text", "folder")}
    (missions / "run.json").write_text(json.dumps(without))
    monkeypatch.chdir(tmp_path_factory.mktemp("elsewhere"))
    done("replay", str(missions / "run.json"))


def test_a_trace_has_its_mission_in_any_folder_and_after_any_change(
    bigactors, missions, monkeypatch, tmp_path_factory
):
    (missions / "map.geojson").write_text(json.dumps(PORT))
    mission = missions / "port.mission"
    mission.write_text(PORT_MISSION)
    options = (
        "--scheduler",
        "fcfs",
        "--control",
        "timed",
        "--source",
        f"nowhere.geojson={missions / 'map.geojson'}",
    )
    assert bigactors("check", "port.mission", "--trace", "traces", *options)[0] == 0
    (trace, *_) = (missions / "traces").rglob("trace.json")
    mission.write_text("mission edited")
    monkeypatch.chdir(tmp_path_factory.mktemp("elsewhere"))
    trace = trace.rename("moved.json")
    assert bigactors("show", "--trace", str(trace))[::2] == (0, "picture written to port.svg\n")
    assert bigactors("replay", str(trace))[::2] == (0, "")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "the text is not JSON"),
        (
            "mission m",
            "hint: give a trace.json that check --trace wrote, or a recording that run --record wrote",
        ),
        ("[" * 100_000, "the text is nested too deeply"),
        ("[]", "the file names no mission"),
        ('{"mission": 3}', "the file names no mission"),
        ('{"mission": "m", "text": "world"}', "m:1:6: LS"),
        ('{"mission": "m", "text": "", "scheduler": 3}', "3 is not a valid Scheduler"),
        ('{"mission": "holds.mission"}', "this is no trace"),
        ('{"mission": "nowhere.mission"}', "nowhere.mission: there is no such file"),
        ('{"mission": "holds.mission", "schema": "bigactors.trace/1", "steps": 3}', "this is no trace"),
        ('{"mission": "holds.mission", "schema": "bigactors.trace/1", "steps": [{}]}', "step 1 should have"),
        (
            '{"mission": "\\u0000\\u001b[2J"}',
            "\N{REPLACEMENT CHARACTER}\N{REPLACEMENT CHARACTER}[2J: there is no such file",
        ),
    ],
)
def test_what_is_no_trace_is_told(missions, refused, text, said):
    (missions / "trace.json").write_text(text)
    assert said in refused("replay", "trace.json")


# --- show -----------------------------------------------------------------------------------------------------


def test_a_mission_is_printed_and_drawn(missions, bigactors):
    code, out, err = bigactors("show", "holds.mission", "--output", "picture.png")
    assert code == 0
    assert out.startswith("c0 = ⟨ α\n  a@uav0 at control")
    assert "picture written to picture.png" in err
    assert (missions / "picture.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.usefixtures("run")
def test_any_configuration_of_a_trace_is_shown(bigactors, missions):
    code, out, _ = bigactors("show", "--trace", "run.json", "--step", "2")
    assert code == 0
    assert out.startswith("c1 --⟨actuate : CTR(a, MOVE_HOST_TO searchArea0)⟩--> c2\nc2 = ⟨ α")
    assert (missions / "figure_2-c2.svg").is_file()


@pytest.mark.usefixtures("run")
def test_a_trace_is_shown_in_lanes_and_drawn_only_if_asked(bigactors, done, missions):
    out = done("show", "--trace", "run.json", "--lanes")
    assert out.splitlines()[2] == "c1    ● req_ctr"
    assert not list(missions.glob("*.svg"))
    code, _, err = bigactors("show", "--trace", "run.json", "--lanes", "--output", "lanes.svg")
    assert (code, err) == (0, "picture written to lanes.svg\n")
    assert (missions / "lanes.svg").stat().st_size > 1000


@pytest.mark.usefixtures("run")
def test_a_trace_becomes_a_page(bigactors, missions):
    code, _, err = bigactors("show", "--trace", "run.json", "--out", "page.html", "--step", "3")
    assert (code, err) == (0, "page written to page.html\n")
    page = (missions / "page.html").read_text(encoding="utf-8")
    assert page.startswith("<!DOCTYPE html>\n")
    assert '"start":3,' in page
    assert page.count('"parts":') == 9


@pytest.fixture
def shown(bigactors, missions):
    """Make the page of a trace that `check` wrote; returns the header of a page."""

    def header(page):
        return re.search("<header>.*?</header>", page.read_text(encoding="utf-8"))[0]

    def show(folder):
        assert bigactors("show", "--trace", str(folder / "trace.json"), "--output", "page.html")[0] == 0
        return header(missions / "page.html"), header(folder / "trace.html")

    return show


@pytest.mark.parametrize("name", ["look_before_entry_racy", "broken_inconsistent", "oil_spill"])
def test_the_page_of_a_trace_file_has_the_headline_of_the_page_that_check_wrote(
    bigactors, missions, shown, name
):
    bigactors("check", name, "--trace", "traces")
    for folder in (missions / "traces" / name).iterdir():
        again, first = shown(folder)
        assert again == first
        assert "<p" in again


@pytest.fixture
def violating(bigactors, missions):
    """The trace of a violation, and how to change it."""
    bigactors("check", "broken_inconsistent", "--trace", "traces")
    (path,) = (missions / "traces").glob("*/*-inconsistent/trace.json")

    def change(**members):
        data = json.loads(path.read_text(encoding="utf-8"))
        path.write_text(json.dumps(data | members), encoding="utf-8")
        return path

    return change


@pytest.mark.parametrize(
    ("said", "message"),
    [
        ([], "'violation' should be an object"),
        ({"property": "none", "kind": "k", "message": "m"}, "'property' should be the name of one of"),
        ({"property": ["local_consistency"], "kind": "k", "message": "m"}, "'property' should be the name"),
        ({"property": "local_consistency", "message": "m"}, "'kind' of a violation should be a text"),
        (
            {"property": "local_consistency", "kind": "k", "message": "m" * 2_001},
            "of at most 2,000 characters",
        ),
        (
            {"property": "local_consistency", "kind": "k", "message": "m", "details": ["d"] * 201},
            "of at most 200",
        ),
        (
            {"property": "local_consistency", "kind": "k", "message": "m", "details": [7]},
            "'details' of a violation",
        ),
    ],
)
def test_a_malformed_violation_of_a_trace_is_refused(violating, refused, said, message):
    assert message in refused("show", "--trace", str(violating(violation=said)))


def test_a_witness_of_an_unknown_property_is_refused(violating, refused):
    path = violating()
    data = json.loads(path.read_text(encoding="utf-8"))
    del data["violation"]
    path.write_text(json.dumps(data | {"witness": 3}), encoding="utf-8")
    assert "'witness' should be the name of one of the mission's properties" in refused("replay", str(path))


def test_the_violation_of_a_trace_is_not_repeated_on_another_mission(bigactors, missions, violating):
    mission = json.loads(violating().read_text(encoding="utf-8"))["text"]
    (missions / "other.mission").write_text(f"// mended\n{mission}")
    code, _, err = bigactors("show", "other.mission", "--trace", str(violating()), "--output", "page.html")
    assert code == 0
    assert "its violation is not shown: it was found there" in err
    assert "is violated" not in (missions / "page.html").read_text(encoding="utf-8")


@pytest.mark.usefixtures("run")
def test_the_tracks_of_a_trace_are_written(bigactors, missions):
    code, out, err = bigactors("show", "--trace", "run.json", "--output", "tracks.geojson")
    assert (code, out, err) == (0, "", "1 track written to tracks.geojson\n")
    (feature,) = json.loads((missions / "tracks.geojson").read_text(encoding="utf-8"))["features"]
    assert feature["properties"] == {"name": "uav0", "kind": "UAV"}
    assert feature["geometry"]["type"] == "LineString"
    assert feature["geometry"]["coordinates"][0] == [-8.7, 37.15]


def test_the_tracks_of_a_recording_have_every_position_with_its_time(bigactors, missions):
    run = {"mission": "holds.mission", "text": "", "digest": ""}
    recorder = Recorder(missions / "run.mcap", run, 0.0, ["uav0"])
    for k in range(4):
        at = PhysicalProperty("uav0", "UAV", point(37 + k, -8), Band(0, 10), time=k / 2)
        recorder.arrival(Heard("p", at), float(k))
    recorder.close("done", 4.0)
    code, out, err = bigactors("show", "--trace", "run.mcap", "--output", "tracks.geojson")
    assert (code, out, err) == (0, "", "1 track written to tracks.geojson\n")
    (feature,) = json.loads((missions / "tracks.geojson").read_text(encoding="utf-8"))["features"]
    assert feature["geometry"]["coordinates"] == [[-8, 37 + k, 5] for k in range(4)]
    assert feature["properties"]["coordTimes"][3] == "1970-01-01T00:00:01.500Z"


@pytest.mark.usefixtures("run")
def test_two_traces_are_compared(bigactors, done):
    bigactors("simulate", "holds.mission", "--seed", "3", "--steps", "2", "--json", "short.json")
    out = done("show", "--trace", "run.json", "--against", "short.json")
    assert out.splitlines()[:4] == [
        "< run.json: 8 steps",
        "> short.json: 2 steps",
        "the same for 2 steps, up to c2; then",
        "  < c2 --⟨req_obs : a, observe(CHILDREN(PARENT(uav0)))⟩--> c3",
    ]
