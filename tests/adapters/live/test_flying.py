"""Verified missions flown by simulated vehicles over real sockets, in virtual time: what `bigactors run` does."""

import asyncio
from functools import reduce
from operator import xor

import pytest
from live_missions import TOUR, verify
from pyais.encode import encode_dict

from adapters.simulated import Disturbance, Kind, Simulator, Vehicle, run
from bigactors.arguments import parse_arguments
from bigactors.cli import main
from bigactors.commands.run.flight import fly, prepare, record
from bigactors.mistakes import Mistake
from bigactors.recordings import open_recording, trace_of
from bigactors.watchers import Terminal

AIRFIELD = (37.147, -8.582, 20.0)


@pytest.fixture
def verified(tmp_path, monkeypatch):
    """A folder with a verdict on a mission that ships."""

    def check(name, *more):
        monkeypatch.chdir(tmp_path)
        verdict = str(tmp_path / f"{name}.verdict.json")
        verify(name, verdict, *more)
        return tmp_path

    return check


def options_of(name, folder, *more):
    line = ["run", name, "--vehicle", "uav0=udp:127.0.0.1:0", "--socket", str(folder / "run.sock"), *more]
    return parse_arguments(line)


async def flown(flight, tape, kind, home, disturbance, **more):
    terminal = Terminal(flight.resting)
    task = asyncio.ensure_future(fly(flight, (terminal, *([tape] if tape else []))))
    plugin = flight.plugins[0]
    while not plugin.local and not task.done():
        await asyncio.sleep(0.05)
    vehicle = Vehicle(kind, home, **more)
    simulator = Simulator(f"udpout:127.0.0.1:{plugin.local[1]}", [vehicle], disturbance, 1)
    simulation = asyncio.ensure_future(simulator.run())
    try:
        return await task, terminal, vehicle
    finally:
        simulation.cancel()


NEST = """mission nest
signature { kind Location contains Location, UAV, Station kind UAV driven kind Station }
world {
  field0: Location = circle (37.0, -8.6) radius 900 m
  nest0: Location = circle (37.02, -8.62) radius 105 m
  gcs0: Station = point (37.001, -8.601) linked control:gcs0
  uav0: UAV = point (37.0, -8.6) linked control:gcs0
}
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO nest0)
  loop { react { case "look" => display("here") } }
}
environment { says "look" to a at most once }
live { on broken assumption: return }
"""


@pytest.mark.parametrize(("wind", "broken"), [((5.0, 6.2), False), ((12.0, 9.0), True)])
def test_a_plane_that_the_wind_carries_out_of_its_place_breaks_an_assumption_that_says_so(
    tmp_path, capsys, wind, broken
):
    (tmp_path / "nest.mission").write_text(NEST)
    asked = options_of(str(tmp_path / "nest.mission"), tmp_path, "--unverified", "--for", "400")
    flight = prepare(asked)
    _, terminal, vehicle = run(flown(flight, None, Kind.PLANE, (37.0, -8.6, 20.0), Disturbance(), wind=wind))
    told = capsys.readouterr()
    assert "⟨commit" in told.out
    assert terminal.broken == broken
    reason = "uav0 is in none of the places; it was not sent there, and has not stayed where it was"
    assert (reason in told.err) == broken
    assert vehicle.mode == (vehicle.kind.profile.home if broken else vehicle.kind.profile.guided)


@pytest.mark.long
def test_the_oil_spill_mission_flies_is_recorded_and_replays_equal(verified, capsys):
    folder = verified("oil_spill")
    path = folder / "run.mcap"
    flight = prepare(options_of("oil_spill", folder, "--record", str(path), "--for", "3000"))
    with record(flight) as tape:
        ending, terminal, vehicle = run(flown(flight, tape, Kind.PLANE, AIRFIELD, Disturbance()))
    assert ending.reason == "the mission has ended"
    assert not terminal.broken
    assert vehicle.flies
    recording = open_recording(str(path))
    trace = trace_of(recording, flight.mission)
    assert trace.configurations[-1] == ending.state.configuration
    assert ending.state.configuration.structure.logical.parent("uav0") == "oilSpill0"
    assert main(["replay", str(path)]) == 0
    assert main(["show", "--trace", str(path), "--step", "3", "--output", str(folder / "c3.svg")]) == 0
    capsys.readouterr()
    log = str(folder / "run.tlog")
    assert main(["replay", log, "--mission", "oil_spill", "--name", "mavlink:1=uav0"]) == 0
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


def test_with_a_third_of_all_packets_lost_a_mission_is_flown_and_committed_as_it_was_seen(
    tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    mission = tmp_path / "tour.mission"
    mission.write_text(TOUR_MISSION)
    verify(mission, "tour.verdict.json")
    flight = prepare(options_of(str(mission), tmp_path, "--record", "run.mcap", "--for", "1500"))
    bad = Disturbance(loss=0.3, duplication=0.1, delay=(0.0, 0.3))
    with record(flight) as tape:
        ending, terminal, _ = run(flown(flight, tape, Kind.COPTER, (37.01, -8.65, 20.0), bad))
    assert ending.reason == "the mission has ended"
    assert not terminal.broken
    logical = ending.state.configuration.structure.logical
    assert (logical.parent("uav0"), logical.links("uav0")) == ("east0", ("control:gcs1",))
    assert (
        trace_of(open_recording("run.mcap"), flight.mission).configurations[-1] == ending.state.configuration
    )


def clock(time):
    """The receiver's own time as NMEA has it: the feed is played at its pace."""
    body = f"GPRMC,{time}.00,A,3709.00000,N,00835.00000,W,0.000,,250914,,,A"
    return f"${body}*{reduce(xor, body.encode(), 0):02X}"


def test_a_vessel_in_the_way_is_said_and_the_vehicles_hold(tmp_path, monkeypatch, capsys):
    """An AIS transponder that the mission does not name comes into one of its places."""
    monkeypatch.chdir(tmp_path)
    mission = tmp_path / "tour.mission"
    mission.write_text(TOUR_MISSION)
    verify(mission, "tour.verdict.json")
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
    (tmp_path / "vessel.nmea").write_text("\n".join(heard) + "\n")
    feed = "--feed=ais=file:vessel.nmea"
    flight = prepare(options_of(str(mission), tmp_path, feed, "--record", "run.mcap", "--for", "100"))
    with record(flight) as tape:
        ending, terminal, _ = run(flown(flight, tape, Kind.COPTER, (37.01, -8.65, 20.0), Disturbance()))
    assert terminal.broken
    told = capsys.readouterr().err
    assert "mmsi244999001 (Vessel) is in east0; the mission names no such entity" in told
    assert "these verdicts rest on it: local_consistency, deadlock_freedom" in told
    assert ending.state.overrides.suspended
    finding = open_recording("run.mcap").of("findings")[0].data
    assert finding["verdicts"] == ["local_consistency", "deadlock_freedom", "computation"]


def test_changing_one_character_of_the_mission_makes_run_refuse_it(verified):
    folder = verified("oil_spill")
    text = (folder / "changed.mission").write_text
    from bigactors.missions import locate  # noqa: PLC0415

    original = locate("oil_spill").read_text()
    text(original.replace("radius 900 m", "radius 901 m"))
    verdict = str(folder / "oil_spill.verdict.json")
    with pytest.raises(Mistake, match="changed since: the mission's text"):
        prepare(options_of("changed.mission", folder, "--verdict", verdict))


def test_without_a_verdict_nothing_flies(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(Mistake, match="no verdict"):
        prepare(options_of("oil_spill", tmp_path))
