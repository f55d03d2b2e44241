"""What `bigactors run --station` refuses, and how it says it; and whose steps a station's recording may have."""

from dataclasses import dataclass

import pytest

from adapters.recording.mcap_files import Message
from adapters.recording.reading import Recording
from bigactors.cli import main
from bigactors.missions import open_mission
from bigactors.mistakes import Mistake
from bigactors.recordings import parting_of, trace_of
from checker import ReplayError
from semantics.setting import Control, Scheduler
from specs.elaboration import Variation

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


def run(*more, mission="distributed_handover"):
    return main(["run", mission, "--unverified", "--socket", "s", "--wait", "0.1", *more])


@pytest.mark.usefixtures("there")
@pytest.mark.parametrize(
    ("more", "says"),
    [
        (["--station=gcs0"], "say so: --peers FILE"),
        (["--peers=peers.toml"], "which of the stations is this?"),
        (["--station=gcs0", "--station=gcs1", "--peers=peers.toml"], "not gcs0 and gcs1"),
        (["--station=gcs9", "--peers=peers.toml"], "no station 'gcs9': its stations are gcs0, gcs1, gcs2"),
        (["--station=gcs0", "--peers=nowhere.toml"], "No such file"),
        (["--station=gcs0=300"], "ids are from 1 to 255"),
    ],
)
def test_what_is_no_station_is_a_mistake_that_says_why(capsys, more, says):
    assert run(*more) == 2
    assert says in capsys.readouterr().err


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
def test_a_peers_file_that_is_not_of_the_mission_is_a_mistake(there, capsys, change, says):
    (there / "peers.toml").write_text(PEERS.replace(*change))
    assert run("--station=gcs0", "--peers=peers.toml") == 2
    told = capsys.readouterr().err
    assert says in told
    assert "hint" in told


def test_a_log_of_another_station_is_a_mistake(there, capsys):
    (there / "x.log").write_text('{"log": "bigactors.station/1", "station": "gcs1", "mission": "d"}\n')
    assert run("--station=gcs0", "--peers=peers.toml", "--station-log=x.log") == 2
    assert "the log of station 'gcs1': move it away" in capsys.readouterr().err


def test_without_its_vehicle_a_station_waits_for_another_to_tell_of_it(there, capsys):
    assert run("--station=gcs0", "--peers=peers.toml") == 2
    assert "nothing was heard of uav0, vessel0" in capsys.readouterr().err
    assert (there / "distributed_handover.gcs0.log").exists()


@dataclass
class Flown:
    """A recording of one station that a test writes."""

    here: str

    def recording(self, *labels, **station):
        part = {"here": self.here, "hosts": {n: n for n in ("gcs0", "gcs1", "gcs2")}, "sent": {}, "took": {}}
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
    with pytest.raises(Mistake, match="which station's"):
        parting_of(Flown("gcs0").recording(**wrong))
