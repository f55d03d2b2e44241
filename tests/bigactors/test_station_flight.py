"""What `bigactors run --station` refuses, and how it says it; and whose steps a station's recording may have."""

from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from adapters.live.turn_result import Outgoing
from adapters.recording.mcap_files import Message
from adapters.recording.recording_reader import Recording
from adapters.stations.entries import Broke, Posted, Took, VehicleSent
from adapters.stations.journal import Journal
from bigactors.arguments import parse_arguments
from bigactors.commands.run.station_flight import company_of
from bigactors.mission_lookup import digest_of, open_mission
from bigactors.mistakes import Mistake
from bigactors.recordings import Resumed, parting_of, trace_of
from checker import ReplayError
from semantics.behaviours.values import Text
from semantics.state.parcel_serialization import parcel_json
from semantics.state.parcels import Parcel
from semantics.state.setting import Control, Scheduler
from semantics.state.station_partition import Parting, enter, parted
from specs.elaboration import Variation

STATIONS = ("gcs0", "gcs1", "gcs2")
PEERS = """
[gcs0]
connect = ["tcp/127.0.0.1:7447"]
[gcs1]
connect = ["tcp/127.0.0.1:7448"]
[gcs2]
connect = ["tcp/127.0.0.1:7449"]
"""


@pytest.fixture
def there(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "peers.toml").write_text(PEERS)
    return tmp_path


RUN = (
    "run",
    "distributed_handover",
    "--unverified",
    "--socket=s",
    "--wait=0.1",
    "--station=gcs0",
    "--peers=peers.toml",
)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (("[gcs2]", "[tower]"), "the mission has no host 'tower', a station here"),
        (("[gcs2]", 'hosts = ["ship9"]\n[gcs2]'), "the mission has no host 'ship9', a host of [gcs1] here"),
        (
            ('[gcs2]\nconnect = ["tcp/127.0.0.1:7449"]\n', ""),
            "no station runs the bigActor op2, which is hosted at gcs2",
        ),
    ],
)
def test_a_peers_file_that_is_not_of_the_mission_is_a_mistake(there, refused, change, says):
    (there / "peers.toml").write_text(PEERS.replace(*change))
    told = refused(*RUN)
    assert says in told
    assert "hint" in told


def test_a_log_of_another_station_is_a_mistake(there, refused):
    (there / "x.log").write_text('{"log": "bigactors.station/1", "station": "gcs1", "mission": "d"}\n')
    assert "the log of station 'gcs1': move it away" in refused(*RUN, "--station-log=x.log")


def test_without_its_vehicle_a_station_waits_for_another_to_tell_of_it(there, refused):
    assert "nothing was heard of uav0, vessel0" in refused(*RUN)
    assert (there / "distributed_handover.gcs0.log").exists()


@dataclass
class Flown:
    """A recording of one station that a test writes."""

    here: str

    def recording(self, *labels, **station):
        part = {"here": self.here, "hosts": {n: n for n in STATIONS}, "sent": {}, "took": {}}
        messages = [Message("steps", 1.0, {"label": label, "choice": 0}) for label in labels]
        return Recording(
            {"mission": "m", "text": "", "digest": "", "station": part | station}, tuple(messages), True
        )


def test_a_recording_has_no_steps_of_bigactors_that_run_elsewhere():
    mission = open_mission("distributed_handover", Variation(Scheduler.FCFS, Control.TIMED))
    said = '⟨say : "handover" to op0⟩'
    steps = (said, '⟨rcv_msg : op0, react("handover")⟩')
    assert len(trace_of(Flown("gcs0").recording(*steps), mission)) == 2
    with pytest.raises(ReplayError, match="rcv_msg"):
        trace_of(Flown("gcs1").recording(*steps), mission)


@pytest.mark.parametrize(
    "wrong", [{"here": 3}, {"hosts": {"gcs0": 1}}, {"sent": {"gcs1": "x"}}, {"took": None}]
)
def test_a_recording_that_does_not_say_whose_it_is_is_a_mistake(wrong):
    with pytest.raises(Mistake, match="does not name its station"):
        parting_of(Flown("gcs0").recording(**wrong))


# --- the log and the run --------------------------------------------------------------------------------

LIVE = Variation(Scheduler.FCFS, Control.TIMED)


def options():
    return parse_arguments(
        ["run", "distributed_handover", "--station=gcs0", "--peers=peers.toml", "--station-log=x.log"]
    )


def log(mission):
    return Journal(Path("x.log"), "gcs0", digest_of(mission))


@pytest.mark.usefixtures("there")
def test_a_run_that_begins_anew_takes_back_what_an_earlier_one_had_under_way():
    mission = open_mission("distributed_handover", LIVE)
    journal = log(mission)
    journal.add(
        [VehicleSent("uav0", "sea0", 1.0), Broke("it rains", 1.0), Posted("gcs1", 1, {}), Took("gcs2", 4)]
    )
    journal.close()
    company = company_of(options(), mission, None)
    company.sharing.close()
    assert company.parting == Parting(
        "gcs0", {n: n for n in STATIONS}, {"gcs1": 1, "gcs2": 0}, {"gcs1": 0, "gcs2": 4}
    )
    journal = log(mission)
    assert journal.word(("sent", "uav0")).to == journal.word(("broke",)).assumption == ""
    assert journal.waiting("gcs1") == 1
    journal.close()


@pytest.mark.usefixtures("there")
def test_a_run_that_is_resumed_posts_what_had_left_and_acknowledges_what_had_entered():
    mission = open_mission("distributed_handover", LIVE)
    parting = Parting("gcs0", {n: n for n in STATIONS}, {}, {})
    part = parted(mission.initial, parting)
    (entered,) = enter(part, "gcs1", 1, Parcel("op0", (Text("yours"),)))
    left = (
        Outgoing("gcs1", 1, Parcel("op1", (Text("yours"),))),
        Outgoing("gcs1", 2, Parcel("op1", (Text("again"),))),
    )
    before = Resumed(entered.target, 3, 0, (), (), {}, parting, left)
    journal = log(mission)
    journal.add([Posted("gcs1", 1, parcel_json(left[0].parcel)), Broke("it rains", 1.0)])
    journal.close()
    for _ in range(2):  # once, however often it is resumed
        company = company_of(options(), mission, before)
        company.sharing.close()
        journal = log(mission)
        assert (journal.sent("gcs1"), journal.took("gcs1"), journal.waiting("gcs1")) == (2, 1, 2)
        assert journal.word(("posted", "gcs1", "2")).parcel == {"Parcel": ["op1", [{"text": "again"}], None]}
        assert journal.word(("broke",)).assumption == "it rains"
        journal.close()
    with pytest.raises(Mistake, match="another station"):
        company_of(options(), mission, replace(before, station=None))
