import json
import os
import signal
import subprocess
import sys
from collections import Counter
from contextlib import suppress
from dataclasses import fields
from pathlib import Path
from typing import get_args

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st
from json_mutations import mutated
from live_missions import BESIDE, BETWEEN, EAST, TOUR, TWO, WEST, Run, boat, mission, plan_of, seen
from scale import examples

from adapters.live.batch import Acknowledging, GivingBack, Heard, Noting, Ordering, Saying
from adapters.live.operator_findings import Finding
from adapters.plugin import (
    Accepted,
    Aged,
    Battery,
    Gone,
    Presence,
    Report,
    Seen,
    Status,
    StatusText,
    TakenOver,
)
from adapters.recording import mcap_files
from adapters.recording.encoding import arrival_json, command_json, finding_json, report_json, seen_json
from adapters.recording.mcap_files import McapWriter, Message, RecordingError
from adapters.recording.recording_reader import is_recording, read_recording
from adapters.recording.schemas import COMMANDS, SCHEMAS
from adapters.recording.writing import MOST_ARRIVALS, Recorder
from bigactors.commands.console.recorded_history import rules_of
from bigactors.mission_lookup import digest_of
from bigactors.mistakes import Mistake
from bigactors.recordings import open_recording, resume, trace_of
from checker import ReplayError, replay, to_json
from checker.traces import SCHEMA
from physical import Band, PhysicalProperty, Surroundings, Velocity, box
from semantics.live_policy import Fallback, LivePolicy

FLIGHT = (
    TOUR
    + """
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO east0)
  observe(CHILDREN(east0))
  react { case obs => display(obs) }
}
"""
)
HEADER = {"mission": "tour.mission", "text": FLIGHT, "digest": "sha256:0", "version": "0", "verified": False}
HEADER |= {"vehicles": {"uav0": "autopilot"}}


def fly(recorder):
    run = Run(plan_of(FLIGHT, LivePolicy(Fallback.CONTINUE)))
    arrivals = (
        [seen("uav0", WEST, 0.0), boat((37.04, -8.7), 0.0)],
        [seen("uav0", BETWEEN, 1.0), boat(EAST, 1.0, "mmsi1")],
        [seen("uav0", EAST, 2.0)],
    )
    for now, heard in enumerate(arrivals):
        for each in heard:
            recorder.arrival(each, float(now))
        recorder.report(Accepted("a-1", "uav0", float(now)), float(now))
        recorder.turn(run.turn(float(now), *heard), float(now), lambda _finding: ("deadlock_freedom",))
    return run


def validate(recording):
    for message in recording.messages:
        jsonschema.validate(message.data, SCHEMAS[message.topic][1])


@pytest.fixture
def recorded(tmp_path):
    path = tmp_path / "run.mcap"
    recorder = Recorder(path, HEADER, 0.0)
    run = fly(recorder)
    recorder.close("done", 3.0)
    return path, run


def test_members_of_families_and_routes_are_recorded_and_replay(tmp_path):
    patrol = """
    BigActor patrol[i] for u in UAV hosted_at u with_behavior {
      let way = [west0, east0, west0]
      for place in way { control(MOVE_HOST_TO place) send (u, place, way) to op[gcs0] }
    }
    BigActor op[i] for g in {gcs0} hosted_at uav0 with_behavior {
      loop { react { case (u, place, way) => display(way) } }
    }
    """
    path = tmp_path / "run.mcap"
    recorder = Recorder(path, HEADER | {"text": TOUR + patrol}, 0.0)
    run = Run(plan_of(TOUR + patrol, LivePolicy(Fallback.CONTINUE)))
    for now, place in enumerate((WEST, BETWEEN, EAST)):
        recorder.arrival(seen("uav0", place, float(now)), float(now))
        recorder.turn(run.turn(float(now), seen("uav0", place, float(now))), float(now), lambda _: ())
    recorder.close("done", 3.0)
    again = replay(mission(TOUR + patrol).initial, read_recording(path).trace(SCHEMA))
    assert again.configurations[-1] == run.state.configuration
    assert {step.label.agent for step in again.steps} == {"op[gcs0]", "patrol[uav0]"}
    assert "commit" in {step.label.rule for step in again.steps}


TWO_PILOTS = (
    TWO
    + """
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }
BigActor b hosted_at uav1 with_behavior { observe(CHILDREN(PARENT(HOST))) react { case o => display(o) } }
"""
)
KEPT_WAITING = {
    "an operator holds it": ((WEST,), [], [Ordering(Fallback.HOLD, "uav0")]),
    "a pilot flies it": ((WEST,), [TakenOver("uav0", 0.0, "it is in RTL")], []),
    "it is not heard": ((), [], []),
}


@pytest.mark.parametrize("strict", [False, True])
@pytest.mark.parametrize("why", KEPT_WAITING)
def test_while_a_vehicle_keeps_a_request_waiting_others_are_served_unless_the_verdict_is_one_under_fcfs(
    tmp_path, why, strict
):
    places, reports, sayings = KEPT_WAITING[why]
    path, run = tmp_path / "run.mcap", Run(plan_of(TWO_PILOTS, strict=strict))
    recorder = Recorder(path, HEADER | {"text": TWO_PILOTS, "strict": strict}, 0.0)
    heard = [seen("uav0", place, 0.0) for place in places] + [seen("uav1", BESIDE, 0.0)]
    recorder.turn(run.turn(0.0, *heard, reports=reports, sayings=sayings), 0.0, lambda _: ())
    recorder.close("done", 1.0)
    assert ("sense" in run.rules) != strict
    recording = read_recording(path)
    trace = replay(mission(TWO_PILOTS).initial, recording.trace(SCHEMA))
    assert trace.configurations[-1] == run.state.configuration
    assert replay(trace.initial, to_json(trace, "tour", "sha256:0")) == trace
    rules, at = rules_of(recording.run), trace.initial
    for message in recording.of("steps"):  # as the console replays them
        _, at = rules.follow(at, message.data)
    assert at == run.state.configuration
    if not strict:
        with pytest.raises(ReplayError, match="out of turn"):
            replay(trace.initial, recording.trace(SCHEMA) | {"in_turn": True})


def test_a_recording_replays_to_the_same_configurations(recorded):
    path, run = recorded
    recording = read_recording(path)
    assert is_recording(str(path))
    assert not recording.torn
    trace = replay(mission(FLIGHT).initial, recording.trace(SCHEMA))
    assert trace.configurations[-1] == run.state.configuration
    assert [step.target for step in trace.steps] == [step.transition.target for step in run.steps]


def test_a_live_run_is_a_trace_like_any_other_and_every_message_is_as_its_schema_says(recorded):
    recording = read_recording(recorded[0], arrivals=True)
    topics = {message.topic for message in recording.messages}
    assert topics >= {"arrivals", "steps", "commands", "findings", "end"}
    validate(recording)
    data = recording.trace(SCHEMA)
    schema = json.loads(Path("docs/reference/trace.schema.json").read_text())
    schema["properties"]["digest"] = {"type": "string"}
    jsonschema.validate(data, schema)
    again = replay(mission(FLIGHT).initial, data)
    assert replay(mission(FLIGHT).initial, to_json(again, "tour", "sha256:0")) == again


STATUS = dict.fromkeys(("mode", "armed", "battery", "heading", "heard", "height", "home", "returning"))
HOME = {"height": 51.5, "home": (37.0, -8.7), "returning": False}
FULL = Status("uav0", 2.0, "autopilot", 2.0, "LOITER", True, Battery(87, 12.1), 271.5, ("gcs0",), **HOME)


def test_what_vehicles_stations_and_operators_say_is_as_its_schema_says(tmp_path):
    recorder, run = Recorder(tmp_path / "run.mcap", HEADER, 0.0), Run(plan_of(FLIGHT))
    text = StatusText("uav0", 2.0, "Mission: 1 Takeoff", 6)
    presences = Presence("gcs1", 2.0, None, None), Presence("gcs1", 4.0, reached=True, heard=3.5)
    for report in (Status("uav0", 1.0), FULL, text, *presences):
        recorder.report(report, 2.0)
    words = [Ordering(Fallback.RETURN, None, "Ana"), Ordering(Fallback.HOLD, "uav9", "")]
    words += [Acknowledging(1, "Ana"), Acknowledging(7, "Ana")]
    words += [Saying("a", "go", "Ben"), GivingBack("uav0", "", "Ben")]
    words += [
        Ordering(Fallback.HOLD, ("uav0", "uav9"), "Ben"),
        Noting("a boat waits", "Ben"),
        Noting(" ", "Ben"),
    ]
    for turn in (run.turn(3.0, seen("uav0", WEST, 3.0)), *(run.turn(4.0, sayings=[word]) for word in words)):
        recorder.turn(turn, 4.0, lambda _finding: ())
    recorder.close("done", 5.0)
    recording = read_recording(tmp_path / "run.mcap")
    validate(recording)
    said = {topic: [message.data for message in recording.of(topic)] for topic in SCHEMAS}
    assert said["status"] == [
        STATUS | {"plugin": "", "entity": "uav0", "time": 1.0, "authority": []},
        {"plugin": "autopilot", "entity": "uav0", "time": 2.0, "mode": "LOITER", "armed": True}
        | {"battery": {"percent": 87, "volts": 12.1}, "authority": ["gcs0"], "heard": 2.0, "height": 51.5}
        | {"home": [37.0, -8.7], "returning": False, "heading": 271.5},
    ]
    assert said["said"] == [{"entity": "uav0", "time": 2.0, "text": "Mission: 1 Takeoff", "severity": 6}]
    assert [each["reached"] for each in said["stations"]] == [None, True]
    no = "there is no vehicle 'uav9'; there are uav0"
    assert said["orders"] == [
        {"order": "return", "vehicle": None, "by": "Ana", "requests": {"uav0": "operator-2"}, "refusal": ""},
        {"order": "hold", "vehicle": "uav9", "by": "", "requests": {}, "refusal": no},
        {"order": "hold", "vehicle": ["uav0", "uav9"], "by": "Ben", "requests": {"uav0": "operator-5"}}
        | {"left_out": {"uav9": no}, "refusal": ""},
    ]
    assert said["notes"] == [{"text": "a boat waits", "by": "Ben"}]
    assert said["acknowledged"] == [{"finding": 1, "by": "Ana"}]
    assert [each["by"] for each in (*said["sayings"], *said["given_back"])] == ["Ben", "Ben"]


def test_what_comes_in_is_there_for_who_reads_along_ten_times_a_second(tmp_path):
    path = tmp_path / "run.mcap"
    recorder = Recorder(path, HEADER, 0.0)
    lags = []
    for k in range(1, 150):
        now = k / 100
        recorder.arrival(seen("uav0", WEST, now), now)
        newest = max((m.time for m in read_recording(path, arrivals=True).of("arrivals")), default=0.0)
        lags.append(now - newest)
    recorder.close("done", 4.0)
    assert max(lags) <= 0.1 + 1e-6
    assert sum(lag == 0.0 for lag in lags) <= 16  # and not at each message


def test_a_recording_ends_after_all_that_is_in_it_by_whatever_clock_it_was_flown(tmp_path):
    recorder = Recorder(tmp_path / "run.mcap", HEADER, 0.0)
    recorder.arrival(seen("uav0", WEST, 900.0), 900.0)
    recorder.close("done", 90.0)
    assert [each.time for each in read_recording(tmp_path / "run.mcap").of("end")] == [900.0]


def test_of_a_flood_so_much_is_recorded_and_every_step(tmp_path):
    path = tmp_path / "run.mcap"
    recorder = Recorder(path, HEADER, 0.0, mission(FLIGHT).setting.kinds)
    for k in range(300):
        recorder.arrival(boat(EAST, k / 1_000, f"mmsi{k}"), k / 1_000)
        recorder.arrival(seen("uav0", WEST, k / 1_000), k / 1_000)
    recorder.arrival(boat((37.04, -8.7), 0.5), 0.5)
    run = fly(recorder)
    recorder.close("done", 3.0)
    recording = read_recording(path, arrivals=True)
    entities = [message.data["entity"] for message in recording.of("arrivals") if message.time < 1.0]
    assert (entities.count("uav0"), entities.count("boat0")) == (MOST_ARRIVALS, 2)
    assert sum(entity.startswith("mmsi") for entity in entities) == MOST_ARRIVALS
    left_out = Counter()
    for message in recording.of("left_out"):
        left_out[message.data["entity"]] += message.data["arrivals"]
    assert left_out == {"": 201, "uav0": 201}  # one stranger comes again before the others had their turn
    assert recording.left_out == 402
    validate(recording)
    trace = replay(mission(FLIGHT).initial, recording.trace(SCHEMA))
    assert trace.configurations[-1] == run.state.configuration


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (lambda steps: steps.pop(0), "step 1"),
        (lambda steps: steps.append(steps[0]), "is not enabled"),
        (lambda steps: steps[-1].update(digest="sha256:1"), "another configuration"),
    ],
)
def test_a_recording_that_the_rules_do_not_allow_names_the_step(recorded, spoil, says):
    data = read_recording(recorded[0]).trace(SCHEMA)
    spoil(data["steps"])
    with pytest.raises(ReplayError, match=says):
        replay(mission(FLIGHT).initial, data)


def test_a_flight_that_was_not_seen_to_end_is_no_commit(recorded):
    data = read_recording(recorded[0]).trace(SCHEMA)
    number, commit = next((n, s) for n, s in enumerate(data["steps"], 1) if s["label"].startswith("⟨commit"))
    commit["observed"]["writes"][0][1]["at"]["ring"] = [[370100000, -86300000]]
    with pytest.raises(ReplayError, match=f"step {number}"):
        replay(mission(FLIGHT).initial, data)


def test_what_is_no_observation_is_no_trace(recorded):
    data = read_recording(recorded[0]).trace(SCHEMA)
    for spoilt in (
        {"words": "x", "writes": [[["parent", "uav0"], "east0"]]},
        {"words": 1},
        [],
        {"words": "", "writes": 3},
    ):
        data["steps"][0]["observed"] = spoilt
        with pytest.raises(ValueError, match="step 1"):
            replay(mission(FLIGHT).initial, data)


@pytest.mark.parametrize("cut", [0.3, 0.6, 0.9, 0.999])
def test_a_torn_recording_is_read_up_to_its_end(recorded, cut):
    path, _ = recorded
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * cut)])
    try:
        recording = read_recording(path)
    except RecordingError as error:
        assert cut == 0.3, error  # noqa: PT017 - only where not even the run was written
        return
    assert recording.torn
    replay(mission(FLIGHT).initial, recording.trace(SCHEMA))


KILLED = """
import os, signal, sys
sys.path[:0] = ["tests", "tests/adapters/live"]
from pathlib import Path
from test_recording import HEADER, Recorder, fly
recorder = Recorder(Path(sys.argv[1]), HEADER, 0.0)
fly(recorder)
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_run_killed_with_kill_9_leaves_a_readable_recording(tmp_path):
    path = tmp_path / "killed.mcap"
    environment = {**os.environ, "PYTHONPATH": "."}
    ended = subprocess.run([sys.executable, "-c", KILLED, str(path)], env=environment, check=False)
    assert ended.returncode == -signal.SIGKILL
    recording = read_recording(path)
    assert recording.torn
    trace = replay(mission(FLIGHT).initial, recording.trace(SCHEMA))
    assert trace.configurations[-1].structure.logical.parent("uav0") == "east0"


@pytest.mark.parametrize("data", [b"", b"\x89MCAP0\r\n", b"hello", b"\x89MCAP0\r\n" + bytes(range(256)) * 9])
def test_what_is_no_recording_is_refused(tmp_path, data):
    path = tmp_path / "x.mcap"
    path.write_bytes(data)
    with pytest.raises(RecordingError):
        read_recording(path)


@pytest.mark.parametrize(
    "published",
    [
        PhysicalProperty("a", "UAV", box((1, 2), (3, 4)), Band(1, 2), ("c",), "b", 5.0, "p", Velocity(1, 2)),
        Aged(PhysicalProperty("a", "UAV", box((1, 2), (3, 4)), time=5.0, source="p"), 60.0),
        Gone("a", 5.0, "p"),
    ],
)
def test_an_arrival_is_as_its_schema_says(published):
    data = json.loads(json.dumps(arrival_json(Heard("p", published))))
    jsonschema.validate(data, SCHEMAS["arrivals"][1])
    assert (data["plugin"], data["entity"], data["time"]) == ("p", "a", 5.0)


PARTS = {
    name: value
    for names, value in (
        ("request entity name leave join source reason what detail", "a"),
        ("station agent host node slot to assumption plugin mode", "b"),
        ("kind about message fallback text lacks", "c"),
        ("time since done heard heading height", 1.5),
        ("count number severity", 1),
        ("rebooted elsewhere reached armed returning follows surface agrees begun", True),
        ("names authority", ("d",)),
        ("place waypoint shape", box((1, 2), (3, 4))),
        ("path", (box((1, 2), (3, 4)), box((1, 2), (3, 5)))),
        ("altitude", Band(1, 2)),
        ("around", Surroundings()),
        ("parcel", {"Parcel": []}),
        ("battery", Battery(87, 12.1)),
        ("home", (37.0, -8.7)),
    )
    for name in names.split()
}
"""A value for each field of commands, reports and findings."""


@pytest.mark.parametrize("kind", [*COMMANDS, *get_args(Report), Finding], ids=lambda kind: kind.__name__)
def test_a_command_a_report_or_a_finding_with_all_its_parts_has_no_member_that_its_schema_lacks(kind):
    value = kind(**{part.name: PARTS[part.name] for part in fields(kind)})
    if kind in COMMANDS:
        topic, data = "commands", command_json(value)
    elif kind is Finding:
        topic, data = "findings", finding_json(value)
    else:
        topic, data = seen_json(value) if isinstance(value, Seen) else ("reports", report_json(value))
    schema = SCHEMAS[topic][1] | {"additionalProperties": False}
    jsonschema.validate(json.loads(json.dumps(data)), schema)


class AsItIs:
    """Stands in for the writer's encoder: texts are JSON already."""

    def encode(self, data):
        return data.decode("utf-8", "surrogateescape") if isinstance(data, bytes) else json.dumps(data)


@examples(60)
@given(data=st.data())
def test_a_recording_with_a_fault_in_a_message_is_read_or_refused(spoilt, data):
    """The house's errors are Mistake, and ReplayError with the number of the step."""
    path, messages, plan = spoilt
    number = data.draw(st.integers(0, len(messages) - 1))
    changed = data.draw(mutated([messages[number].data]))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mcap_files, "_COMPACT", AsItIs())
        writer = McapWriter(path, SCHEMAS)
        for each, message in enumerate(messages):
            writer.write(message.topic, message.time, changed if each == number else message.data)
        writer.close()
    with suppress(Mistake, ReplayError):
        recording = open_recording(str(path))
        assert recording.left_out >= 0
        trace_of(recording, plan)
        resume(str(path), plan)
    path.unlink()


@pytest.fixture(scope="module")
def spoilt(tmp_path_factory):
    """Return a path, the messages of a recording, and its mission."""
    folder = tmp_path_factory.mktemp("spoilt")
    plan = mission(FLIGHT)
    header = HEADER | {"digest": digest_of(plan)}
    recorder = Recorder(folder / "run.mcap", header, 0.0)
    run = fly(recorder)
    for word in (Ordering(Fallback.HOLD, "uav0", "Ana"), GivingBack("uav0", "", "Ben")):
        recorder.turn(run.turn(3.0, sayings=[word]), 3.0, lambda _finding: ())
    recorder.report(TakenOver("uav0", 3.0, "a pilot flies it"), 3.0)
    recorder.close("done", 3.0)
    whole = read_recording(folder / "run.mcap")
    begun = Message("run", 0.0, {"schema": "bigactors.run/1", **header})
    assert resume(str(folder / "run.mcap"), plan).steps
    return folder / "spoilt.mcap", (begun, *whole.messages), plan
