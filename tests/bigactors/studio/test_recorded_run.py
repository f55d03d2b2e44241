"""Runs from files in the explorer: recordings of flights, and traces under another control."""

import base64
import json
import tempfile
from pathlib import Path

import pytest

from bigactors.cli import main
from bigactors.studio.exploration import Exploration
from checker import Trace, check, replay, to_json
from checker.steps import Step, candidates
from semantics.state.setting import Control, Scheduler
from semantics.successors import successors
from specs.elaboration import load_mission, read_mission
from specs.missions import shipped_missions

NEAR = """\
signature standard
world {
  west0: Location = circle (37.01, -8.60) radius 300 m
  east0: Location = circle (37.01, -8.59) radius 300 m
  gcs0: Station = point (37.01, -8.60) linked control:gcs0
  uav0: UAV = point (37.01, -8.60) linked control:gcs0
}
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO east0)
  observe(PARENT(HOST))
}
check {
  local_consistency
  invariant "it stays": not uav0 in east0
}
"""
TIMED = shipped_missions()["endurance"].read_text()
PLANES = {"near": ("--for=300",), "timed": ("--for=290",)}


@pytest.fixture(scope="module")
def recordings():
    """Fly both missions by a simulated plane; return the paths of their recordings."""
    with tempfile.TemporaryDirectory() as name:  # short: the path of a socket has at most 100 bytes
        for stem, text in (("near", NEAR), ("timed", TIMED)):
            file = Path(name, f"{stem}.mission")
            file.write_text(text, encoding="utf-8")
            more = [f"--record={name}/{stem}.mcap", f"--socket={name}/{stem}.sock", "--speed=200"]
            main(["run", str(file), "--unverified", "--vehicle=uav0=simulated:plane", *more, *PLANES[stem]])
        yield {stem: Path(name, f"{stem}.mcap") for stem in PLANES}


def asked(exploration, **request):
    answer = json.loads(json.dumps(exploration.handle(request)))  # it is plain data
    assert "error" not in answer, answer
    return answer


def labels(shown):
    return [each["label"] for each in shown["steps"]]


def test_a_flight_is_stepped_through_left_at_any_configuration_and_saved_as_a_trace_that_replays(recordings):
    mission = read_mission(NEAR, ".", name="near.mission")
    exploration = Exploration(mission, given=recordings["near"])
    flight = asked(exploration, ask="load", given=True)
    last = flight["length"]
    assert flight["run"] == f"~{last}"
    assert any(label.startswith("⟨commit") for label in labels(flight))
    seconds = [step["at"] for step in flight["steps"]]
    assert seconds == sorted(seconds)
    assert seconds[-1] > 10_000
    (value,) = (each for each in flight["values"] if each["name"] == "it stays")
    assert value["bad"]
    asks = asked(exploration, ask="run", run=flight["run"], at=2)
    assert (asks["here"], asks["next"]) == ("~2", "")
    c = exploration._recorded.trace.configurations[2]
    assert [each["label"] for each in asks["choices"]] == [str(each.label) for each in successors(c)]
    left = asked(exploration, ask="run", run="~2.0")
    assert labels(left)[:2] == labels(flight)[:2]
    assert labels(left)[2] == asks["choices"][0]["label"]
    assert "at" not in left["steps"][2]
    walked = asked(exploration, ask="random", run="~2.0", count=3, seed=1)
    assert asked(exploration, ask="run", run=walked["run"]) == walked
    saved = asked(exploration, ask="save", run=flight["run"])["trace"]
    assert (saved["scheduler"], saved["control"]) == ("fcfs", "timed")
    again = asked(Exploration(mission), ask="load", trace=saved)
    assert labels(again) == labels(flight)


def test_the_graph_of_a_flight_leads_along_it_and_to_each_node(recordings):
    exploration = Exploration(read_mission(NEAR, "."), given=recordings["near"])
    flight = asked(exploration, ask="load", given=True)
    graph = asked(exploration, ask="graph", run=flight["run"])
    on_run = {node["at"]: node for node in graph["nodes"] if "at" in node}
    assert [on_run[at]["run"] for at in sorted(on_run)] == [f"~{at}" for at in sorted(on_run)]
    assert on_run[0]["depth"] == 0
    pairs = {(edge["from"], edge["to"]) for edge in graph["edges"]}
    kept = sorted(on_run)
    assert all((on_run[a]["id"], on_run[a + 1]["id"]) in pairs for a in kept if a + 1 in on_run)
    for node in graph["nodes"]:
        assert exploration._go(node["run"]) is not None


def test_a_flight_with_times_has_those_of_its_recording_and_steps_after_it_have_none(recordings):
    exploration = Exploration(read_mission(TIMED, "."), given=recordings["timed"])
    flight = asked(exploration, ask="load", given=True)
    assert flight["steps"][-1]["date"].endswith(" s")
    assert all("ticks" not in each for each in asked(exploration, ask="run", run="~1")["choices"])
    assert asked(exploration, ask="run", run="")["choices"][0]["ticks"]


def test_an_address_with_steps_from_a_file_needs_that_file_and_its_steps(recordings):
    exploration = Exploration(read_mission(NEAR, "."))
    assert "open that file again" in exploration.handle({"ask": "run", "run": "~2"})["error"]
    content = base64.b64encode(recordings["near"].read_bytes()).decode()
    shown = asked(exploration, ask="load", content=content)
    assert "has only" in exploration.handle({"ask": "run", "run": f"~{shown['length'] + 1}"})["error"]
    assert asked(exploration, ask="run", run="~2")["length"] == 2


@pytest.mark.parametrize("content", ["", "bm8gSlNPTg==", "?", 7, None, "e30=", "iU1DQVAwDQo="])
def test_a_file_that_holds_no_run_is_refused_in_words_without_a_path(content):
    exploration = Exploration(read_mission(NEAR, "."))
    refused = exploration.handle({"ask": "load", "content": content})["error"]
    assert refused
    assert "/tmp" not in refused
    assert asked(exploration, ask="run", run="0")["length"] == 1


def test_a_trace_under_another_control_is_shown_under_it():
    mission = load_mission("oil_spill")
    timed = mission.under(Scheduler.FCFS, Control.TIMED)
    trace = check(timed).verdicts["over the spill"].witness
    data = to_json(trace, "m", "d") | {"scheduler": "fcfs", "control": "timed"}
    exploration = Exploration(mission)
    shown = asked(exploration, ask="load", trace=data)
    assert shown["run"] == f"~{len(trace)}"
    assert labels(shown) == [str(step.label) for step in trace.steps]
    saved = asked(exploration, ask="save", run=shown["run"])["trace"]
    assert len(replay(timed.initial, saved)) == len(trace)


def test_a_run_in_which_a_request_had_to_wait_is_shown_as_it_was_recorded(tmp_path, capsys):
    watch = "BigActor b hosted_at gcs0 with_behavior { observe(ALL) }\nscheduler fcfs\ncontrol timed\n"
    mission = read_mission(NEAR + watch, ".")
    steps, at = [], mission.initial
    for words in ("req_ctr : a", "req_obs : b", "sense : OBS(b"):
        step = next(each for each in candidates(at, in_turn=False) if words in str(each.label))
        steps.append(Step(step.label, 0, step.target))
        at = step.target
    trace = Trace(mission.initial, tuple(steps), in_turn=False)
    data = to_json(trace, "m", "d") | {"scheduler": "fcfs", "control": "timed"}
    exploration = Exploration(mission)
    shown = asked(exploration, ask="load", trace=data)
    assert labels(shown) == [str(each.label) for each in steps]
    saved = asked(exploration, ask="save", run=shown["run"])["trace"]
    assert replay(mission.initial, saved) == trace
    (tmp_path / "near.mission").write_text(NEAR + watch)
    (tmp_path / "trace.json").write_text(json.dumps(data))
    main(["replay", f"{tmp_path}/trace.json", "--mission", f"{tmp_path}/near.mission"])
    assert "requests were served out of turn" in capsys.readouterr().err
    assert "out of turn" in exploration.handle({"ask": "load", "trace": data | {"in_turn": True}})["error"]
