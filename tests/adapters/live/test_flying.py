"""Verified missions flown by simulated vehicles over real sockets, in virtual time: what `bigactors run` does."""

from functools import reduce
from operator import xor

import pytest
from audited import copter, flown_in
from live_missions import TOUR, verify
from pyais.encode import encode_dict

from adapters.simulated import Disturbance, Kind, Vehicle
from bigactors.arguments import parse_arguments
from bigactors.cli import main
from bigactors.commands.run.flight import prepare
from bigactors.mission_lookup import locate
from bigactors.mistakes import Mistake
from bigactors.recordings import open_recording

AIRFIELD = (37.147, -8.582, 20.0)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def options_of(name, folder, *more):
    line = ["run", name, "--vehicle", "uav0=udp:127.0.0.1:0", "--socket", str(folder / "run.sock"), *more]
    return parse_arguments(line)


@pytest.mark.long
def test_the_oil_spill_mission_flies_is_recorded_and_replays_equal(folder, capsys):
    flown = flown_in(folder, "oil_spill", Vehicle(Kind.PLANE, AIRFIELD), seconds=3000)
    assert flown.ended
    assert not flown.broken
    assert flown.vehicle.flies
    assert flown.logical.parent("uav0") == "oilSpill0"
    assert main(["replay", "r.mcap"]) == 0
    assert main(["show", "--trace", "r.mcap", "--step", "3", "--output", "c3.svg"]) == 0
    capsys.readouterr()
    assert main(["replay", "r.tlog", "--mission", "oil_spill", "--name", "mavlink:1=uav0"]) == 0
    shown = capsys.readouterr()
    assert "uav0 is seen in searchArea0" in shown.out
    assert "it was not sent" in shown.err


TOUR_MISSION = (
    "mission tour\n"
    + TOUR
    + """
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO east0)
  observe(CHILDREN(PARENT(HOST)))
  react { case obs => send "there" to op }
}
BigActor op hosted_at gcs0 with_behavior {
  react { case "there" => control(HAND uav0 TO gcs1) }
  observe(LINKED_TO(uav0))
  react { case obs => display(obs) }
}
"""
)


@pytest.mark.long
def test_with_a_third_of_all_packets_lost_a_mission_is_flown_and_committed_as_it_was_seen(folder):
    bad = Disturbance(loss=0.3, duplication=0.1, delay=(0.0, 0.3))
    flown = flown_in(folder, TOUR_MISSION, copter(), disturbance=bad, seconds=1500)
    assert flown.ended
    assert not flown.broken
    assert (flown.logical.parent("uav0"), flown.logical.links("uav0")) == ("east0", ("control:gcs1",))


def clock(time):
    """The receiver's own time as NMEA has it: the feed is played at its pace."""
    body = f"GPRMC,{time}.00,A,3709.00000,N,00835.00000,W,0.000,,250914,,,A"
    return f"${body}*{reduce(xor, body.encode(), 0):02X}"


def test_a_vessel_in_the_way_is_said_and_the_vehicles_hold(folder, capsys):
    """An AIS transponder that the mission does not name comes into one of its places."""
    fields = {
        "type": 1,
        "mmsi": 244999001,
        "lat": 37.01,
        "lon": -8.61,
        "speed": 0,
        "course": 0,
        "heading": 511,
    }
    lines = encode_dict(fields, talker_id="AI", sentence_type="VDM", radio_channel="A")
    heard = [clock("100000"), clock("100040"), *lines]
    (folder / "vessel.nmea").write_text("\n".join(heard) + "\n")
    flown = flown_in(folder, TOUR_MISSION, copter(), "--feed=ais=file:vessel.nmea", seconds=100)
    assert flown.broken
    told = capsys.readouterr().err
    assert "mmsi244999001 (Vessel) is in east0; the mission names no such entity" in told
    assert "these verdicts rest on it: local_consistency, deadlock_freedom" in told
    assert flown.ending.state.overrides.suspended
    finding = open_recording("r.mcap").of("findings")[0].data
    assert finding["verdicts"] == ["local_consistency", "deadlock_freedom", "computation"]


def test_changing_one_character_of_the_mission_makes_run_refuse_it(folder):
    verify("oil_spill", "oil_spill.verdict.json")
    original = locate("oil_spill").read_text()
    (folder / "changed.mission").write_text(original.replace("radius 900 m", "radius 901 m"))
    with pytest.raises(Mistake, match="changed since: the mission's text"):
        prepare(options_of("changed.mission", folder, "--verdict", "oil_spill.verdict.json"))


def test_without_a_verdict_nothing_flies(folder):
    with pytest.raises(Mistake, match="no verdict"):
        prepare(options_of("oil_spill", folder))
