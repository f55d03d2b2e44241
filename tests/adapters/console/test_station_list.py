"""The recording of one station among several: its part of the mission is folded as the whole would be."""

import pytest
from live_missions import LIVE, Run, seen
from recorded import written

from adapters.console.history import History
from adapters.live.batch import Saying
from adapters.live.plan import Plan
from adapters.plugin import Underway
from adapters.recording.schemas import VERSION
from adapters.recording.writing import Recorder
from bigactors.commands.console.recorded_history import rules_of
from bigactors.commands.run.station_flight import parting_json
from bigactors.mission_lookup import digest_of, open_mission
from semantics.state.station_partition import Parting, parted

STATIONS = {name: name for name in ("gcs0", "gcs1", "gcs2")}
PART = Parting("gcs0", STATIONS, {"gcs1": 0, "gcs2": 0}, {"gcs1": 0, "gcs2": 0})


@pytest.fixture(scope="module")
def mission():
    return open_mission("distributed_handover", LIVE)


@pytest.fixture
def run(mission):
    """Return the head of a station's recording."""
    head = {"mission": "distributed_handover", "text": mission.source.text, "digest": digest_of(mission)}
    head |= {"schema": f"bigactors.run/{VERSION}", "version": "0", "verified": False}
    return head | {"vehicles": {"uav0": "autopilot"}, "station": parting_json(PART)}


def view(path):
    history = History(path, rules_of)
    while history.read_on(1.0):
        pass
    return history.newest().sections


def told(path, run, *messages):
    """Return what is shown of messages that a run has not."""
    writer = written(path, run, messages)
    shown = view(path)
    writer.close()
    return shown


def test_a_stations_recording_is_replayed_by_its_part_of_the_mission(mission, run, tmp_path):
    first = parted(mission.initial, PART)
    flown = Run(Plan(first, {"uav0": "autopilot"}, mission.precautions))
    recorder = Recorder(tmp_path / "r.mcap", run, 1000.0, mission.setting.kinds)
    at = first.structure.physical.position("uav0").geometry.ring[0]
    heard = seen("uav0", (at[0] / 1e7, at[1] / 1e7), 1001.0)
    recorder.arrival(heard, 1001.0)
    recorder.turn(flown.turn(1001.0, heard), 1001.0, lambda _: ())
    recorder.turn(flown.turn(1002.0, sayings=[Saying("op0", "handover")]), 1002.0, lambda _: ())
    recorder.close("done", 1003.0)
    assert "rcv_msg" in flown.rules
    shown = view(tmp_path / "r.mcap")
    assert "0" not in shown["alerts"]  # all was replayed
    assert shown["clock"]["step"] == flown.state.number
    assert shown["mission"]["station"] == "gcs0"
    assert set(shown["sayings"]) == {'op0 "handover"'}
    assert shown["sayings"]['op0 "handover"']["left"] == 0
    assert shown["agents"]["op1"]["state"] == "runs at another station"
    assert {name: (each["here"], each["vehicles"]) for name, each in shown["stations"].items()} == {
        "gcs0": (True, ["uav0"]),
        "gcs1": (False, []),
        "gcs2": (False, []),
    }


def test_other_stations_are_reached_or_not_as_they_were_heard(run, tmp_path):
    shown = told(
        tmp_path / "r.mcap",
        run,
        ("stations", 1001.0, {"station": "gcs1", "time": 1001.0, "reached": True, "heard": 1000.5}),
        ("stations", 1003.0, {"station": "gcs1", "time": 1003.0, "reached": False, "heard": 1001.5}),
        ("stations", 1003.0, {"station": "nobody", "time": 1003.0, "reached": True, "heard": 1001.5}),
    )["stations"]
    assert shown["gcs1"] == {
        "here": False,
        "reached": False,
        "heard": 1001.5,
        "agrees": None,
        "begun": None,
        "vehicles": [],
    }
    assert shown["gcs2"] == {
        "here": False,
        "reached": None,
        "heard": None,
        "agrees": None,
        "begun": None,
        "vehicles": [],
    }
    assert set(shown) == set(STATIONS)


def test_a_vehicle_whose_station_is_not_reached_or_has_not_started_is_wrong(run, tmp_path):
    obeys = {"plugin": "autopilot", "entity": "uav0", "kind": "UAV", "ring": [[370100000, -86500000]]}
    messages = [
        ("arrivals", 1001.0, {**obeys, "channels": ["control:gcs1"]}),
        ("stations", 1002.0, {"station": "gcs1", "time": 1002.0, "reached": False, "heard": 1000.5}),
    ]
    waits = {"station": "gcs1", "time": 1003.0, "reached": True, "heard": 1003.0, "begun": False}
    messages += [("stations", 1003.0, waits), ("stations", 1004.0, waits | {"begun": True})]
    unstarted = "its station gcs1 has not started: nobody commands it"
    for count, level, why in (
        (1, 0, ""),
        (2, 2, "its station gcs1 is not reached"),
        (3, 2, unstarted),
        (4, 0, ""),
    ):
        card = told(tmp_path / f"{count}.mcap", run, *messages[:count])["vehicles"]["uav0"]
        assert (card["level"], card["why"]) == (level, why)


def test_a_flight_that_another_station_has_ordered_is_known_as_a_flight(mission, run, tmp_path):
    first = parted(mission.initial, PART)
    flown = Run(Plan(first, {"uav0": "stations"}, mission.precautions, peers="stations"))
    said = run | {"vehicles": {"uav0": "stations"}}
    recorder = Recorder(tmp_path / "r.mcap", said, 1000.0, mission.setting.kinds)
    place = next(name for name, kind in mission.setting.kinds.items() if kind == "Location")
    at = first.structure.physical.position("uav0").geometry.ring[0]
    heard = seen("uav0", (at[0] / 1e7, at[1] / 1e7), 1001.0, "stations")
    recorder.turn(flown.turn(1001.0, heard), 1001.0, lambda _: ())
    recorder.turn(flown.turn(1002.0, reports=[Underway("uav0", 1002.0, place, 1002.0)]), 1002.0, lambda _: ())
    recorder.close("done", 1003.0)
    card = view(tmp_path / "r.mcap")["vehicles"]["uav0"]
    assert (card["going"], card["request"], card["order"]) == (place, None, None)
    assert "differ" not in card["why"]
